"""`trialid start` with a boat that steers by two thrusters and has no rudder."""

from pathlib import Path

import numpy as np
import otter
import pytest
from click.testing import CliRunner

import trialid
from trialid import pipeline_file
from trialid.cli.main import commands
from trialid.result.json_file import read
from trialid.workflow.run import run

NEWCOMER = Path(__file__).parents[3] / "shared" / "data" / "newcomer"


def started(folder: Path, monkeypatch: pytest.MonkeyPatch, logs: list[Path], options: str):
    monkeypatch.chdir(folder)
    return CliRunner().invoke(commands, ["start", *map(str, logs), *options.split()])


def log(
    path: Path, *, swapped: bool = False, seed: int = 700, drive: str = "rpm", full: float = 0.0
) -> Path:
    """The Otter's log as a table: revolutions, rate of turn, speed."""
    t = np.arange(0.0, 90.0, 0.2)
    sailed = otter.sail(t, otter.some_orders(t, seed))
    rng = np.random.default_rng(seed)
    rpm = sailed.revolutions * 60.0 / (2.0 * np.pi)
    rpm *= full / np.abs(rpm).max() if full else 1.0
    columns = {
        "time_s": t,
        f"{drive}_port": rpm[:, 1 if swapped else 0],
        f"{drive}_starboard": rpm[:, 0 if swapped else 1],
        "yaw_rate_degps": np.rad2deg(sailed.r) + 0.1 * rng.standard_normal(len(t)),
        "stw_mps": sailed.u + 0.02 * rng.standard_normal(len(t)),
    }
    rows = (",".join(f"{x:.6f}" for x in row) for row in np.column_stack([*columns.values()]))
    path.write_text("\n".join([",".join(columns), *rows]) + "\n", encoding="utf-8")
    return path


@pytest.mark.study(turn="each")
def test_a_boat_of_two_shafts_is_begun_and_fitted(tmp_path, monkeypatch) -> None:
    done = started(tmp_path, monkeypatch, [log(tmp_path / "a.csv")], "--length 2")
    assert done.exit_code == 0, done.output
    assert "side confirmed by the turn" in " ".join(done.stdout.split())
    text = (tmp_path / "first_trial.toml").read_text(encoding="utf-8")
    assert 'thruster_port      = { channel = "rpm_port", unit = "rpm" }' in text
    assert 'free = ["k_ahead", "k_astern", "Xu0", "Xuu", "I_zz", "Nr0", "Nrar0"]' in text
    ship = trialid.read_ship(tmp_path / "first_trial_ship.toml")
    assert [(a.name, a.y, a.command) for a in ship.actuators] == [
        ("thruster_port", -0.4, "revolutions"),
        ("thruster_starboard", 0.4, "revolutions"),
    ]
    fit = read(tmp_path / "runs" / "first_trial" / "result.json").fit
    assert fit.converged
    assert fit.eps_rmsn < 0.2


def test_sides_that_the_turn_contradicts_are_asked(tmp_path, monkeypatch) -> None:
    done = started(tmp_path, monkeypatch, [log(tmp_path / "a.csv", swapped=True)], "--length 2")
    assert done.exit_code == 0, done.output
    said = " ".join(done.stdout.split())
    assert "she turns towards the stronger one" in said
    assert "or the side of r is wrong" in said
    assert "Not fitted yet" in done.stderr
    assert not (tmp_path / "runs").exists()


@pytest.mark.parametrize("swapped", [False, True])
def test_of_two_by_number_the_turn_tells_the_sides(tmp_path, monkeypatch, swapped) -> None:
    """`n1` and `n2` have none; without a turn that tells nothing is taken for granted."""
    made = log(tmp_path / "a.csv", swapped=swapped)
    text = made.read_text(encoding="utf-8").replace("rpm_port", "n1_rpm")
    made.write_text(text.replace("rpm_starboard", "n2_rpm"), encoding="utf-8")
    done = started(tmp_path, monkeypatch, [made], "--length 2")
    assert done.exit_code == 0, done.output
    assert "side confirmed by the turn" in " ".join(done.stdout.split())
    signals = pipeline_file.load(Path("first_trial.toml")).trials[0].signals
    assert signals["thruster_port"].channel == ("n2_rpm" if swapped else "n1_rpm")
    assert signals["thruster_starboard"].channel == ("n1_rpm" if swapped else "n2_rpm")
    assert read(Path("runs/first_trial/result.json")).fit.eps_rmsn < 0.2


def test_two_by_number_whose_turn_tells_nothing_are_asked(tmp_path, monkeypatch) -> None:
    made = log(tmp_path / "a.csv")
    table = np.loadtxt(made, delimiter=",", skiprows=1)
    table[:, 3] = 0.1 * np.random.default_rng(1).standard_normal(len(table))
    heads = "time_s,motor 1 [rpm],motor 2 [rpm],yaw_rate_degps,stw_mps"
    np.savetxt(made, table, delimiter=",", header=heads, comments="", fmt="%.6f")
    done = started(tmp_path, monkeypatch, [made], "--length 2")
    assert done.exit_code == 0, done.output
    assert "settling which is to port" in " ".join(done.stdout.split())
    assert not (tmp_path / "runs").exists()


def test_shares_of_thrust_are_no_newton(tmp_path, monkeypatch) -> None:
    """Thrust goes with the square of a share: as newton three effects were named of nothing."""
    made = log(tmp_path / "a.csv", drive="thrust", full=85.0)
    done = started(tmp_path, monkeypatch, [made], "--length 2")
    assert "FILL IN its unit: nothing tells what up to 85 is" in " ".join(done.stdout.split())
    table = made.read_text(encoding="utf-8").replace("thrust_port,", "thrust_port_pct,")
    made.write_text(table.replace("thrust_starboard,", "thrust_starboard_pct,"), encoding="utf-8")
    (tmp_path / "first_trial.toml").unlink()
    (tmp_path / "first_trial_ship.toml").unlink()
    assert started(tmp_path, monkeypatch, [made], "--length 2").exit_code == 0
    text = (tmp_path / "first_trial.toml").read_text(encoding="utf-8")
    assert 'thruster_port      = { channel = "thrust_port_pct", unit = "%" }' in text
    ship = (tmp_path / "first_trial_ship.toml").read_text(encoding="utf-8")
    assert ship.count('command = "share"') == 2


@pytest.mark.study(turn=10)
def test_a_unit_that_nothing_tells_is_asked(tmp_path, monkeypatch) -> None:
    """Counts of an engine may be anything; what is called a thrust is read as one, with care."""
    made = log(tmp_path / "a.csv", drive="engine")
    done = started(tmp_path, monkeypatch, [made], "--length 2")
    assert done.exit_code == 0, done.output
    assert "FILL IN its unit" in " ".join(done.stdout.split())
    assert not (tmp_path / "runs").exists()
    text = (tmp_path / "first_trial.toml").read_text(encoding="utf-8")
    assert 'thruster_port      = { channel = "engine_port", unit = "?" }' in text
    (tmp_path / "named").mkdir()
    made = log(tmp_path / "named" / "a.csv", drive="thrust")
    done = started(tmp_path / "named", monkeypatch, [made], "--length 2")
    assert "CAREFUL: a thrust by its name" in " ".join(done.stdout.split())


def test_a_ship_file_gives_its_own_names_or_says_what_it_lacks(tmp_path, monkeypatch) -> None:
    made = log(tmp_path / "a.csv")
    monkeypatch.chdir(tmp_path)
    CliRunner().invoke(commands, ["ship", "boat.toml", "--length", "2", "--quiet"])
    done = started(tmp_path, monkeypatch, [made], "--ship boat.toml --speed 2")
    assert done.exit_code == 2
    assert "write an [[actuator]] for each" in done.stderr
    with Path("boat.toml").open("a", encoding="utf-8") as ship:
        for name, y in (("one", -0.4), ("two", 0.4)):
            ship.write(f'[[actuator]]\nname = "{name}"\nkind = "thruster"\nat = [-1.0, {y}]\n')
    done = started(tmp_path, monkeypatch, [made], "--ship boat.toml --speed 2")
    assert done.exit_code == 0, done.output
    signals = pipeline_file.load(Path("first_trial.toml")).trials[0].signals
    assert signals["one"].channel == "rpm_port"


@pytest.mark.real_data
@pytest.mark.skipif(not NEWCOMER.is_dir(), reason=f"no records in {NEWCOMER}")
@pytest.mark.study(turn="each")
@pytest.mark.parametrize("record", ["usv1", "usv2"])
def test_of_a_stranger_without_a_rudder_noise_is_left_and_nothing_is_named_alone(
    tmp_path, monkeypatch, record
) -> None:
    """Nothing stated and nothing changed: the noise is what is left while both thrusters rest.

    Her receiver stands aft of midships, which nobody told: of her sway a little more shows, and no
    name is alone.
    """
    done = started(tmp_path, monkeypatch, [NEWCOMER / f"{record}.mcap"], "--length 4.9")
    assert done.exit_code == 0, done.output
    found = read(tmp_path / "runs" / "first_trial" / "result.json")
    assert found.fit.converged
    assert "lever_arm_x" in [m.effect for m in found.missing if m.p_value < 0.05]
    assert found.verdict.kind == "cannot tell" or len(found.verdict.family) > 1
    assert found.verdict.effect is None or "lever_arm_x" in found.verdict.family
    assert found.split.method == "quiet stretch"
    assert found.fit.eps_rmsn < 1.2 * found.split.noise, found.split


@pytest.mark.real_data
@pytest.mark.skipif(not NEWCOMER.is_dir(), reason=f"no records in {NEWCOMER}")
@pytest.mark.study(turn=12)
def test_a_stranger_without_a_rudder_is_followed_to_the_noise(tmp_path, monkeypatch) -> None:
    """By second differences of the raw channels: 0.005 rad/s at 25 Hz and 0.03 m/s at 5 Hz."""
    logs = [NEWCOMER / f"usv{i}.mcap" for i in (1, 2)]
    done = started(tmp_path, monkeypatch, logs, "--length 4.9")
    assert done.exit_code == 0, done.output
    path = tmp_path / "first_trial.toml"
    text = path.read_text(encoding="utf-8")
    path.write_text(text.replace("period = 0.2 ", "period = 0.04 "), encoding="utf-8")
    fit = run(pipeline_file.load(path)).findings.before.fit
    assert np.diff(fit.problem.trials[0].t)[0] == pytest.approx(0.04)
    assert fit.converged
    assert fit.settings.outputs == ("u", "v", "r")
    channels = trialid.read(logs[0]).channels
    x, y = (channels[f"/gps/vel:twist.linear.{axis}"].y for axis in "xy")
    noise = [_noise(x), _noise(y), _noise(channels["/imu/data:angular_velocity.z"].y)]
    error = [fit.eps_by_output[c] * y for c, y in zip("uvr", fit.problem.y_rms, strict=True)]
    assert np.all(np.array(error) < 1.2 * np.array(noise)), (error, noise)
    said = " ".join([done.output, (tmp_path / "runs/first_trial/report.html").read_text("utf-8")])
    wrong = [
        "same rudder",
        "rudder record repeats",
        "rudder at rest",
        "rudder angle,",
        "its rudder",
    ]
    assert [words for words in wrong if words in said] == []
    held_out = [fit.eps_check_by_output[c] / fit.eps_by_output[c] for c in "uvr"]
    assert max(held_out) < 1.1


def _noise(y: np.ndarray) -> float:
    return float(np.std(np.diff(y, 2)) / np.sqrt(6.0))


def test_a_heading_stands_for_the_rate_of_turn(tmp_path, monkeypatch) -> None:
    """A compass of 1 Hz in a table of 5 Hz: empty between its rows."""
    made = log(tmp_path / "a.csv", drive="cmd")
    names, *rows = made.read_text(encoding="utf-8").splitlines()
    table = np.array([[float(x) for x in row.split(",")] for row in rows])
    psi = np.rad2deg(np.cumsum(np.deg2rad(table[:, 3]) * 0.2)) % 360.0
    lines = [names.replace("yaw_rate_degps", "heading_deg").replace("cmd_", "thr_")]
    for k, row in enumerate(table):
        heading = "" if k % 5 else f"{psi[k]:.4f}"
        lines.append(",".join([*(f"{x:.6f}" for x in row[:3]), heading, f"{row[4]:.6f}"]))
    made.write_text("\n".join(lines) + "\n", encoding="utf-8")
    done = started(tmp_path, monkeypatch, [made], "--length 2")
    assert done.exit_code == 0, done.output
    text = Path("first_trial.toml").read_text(encoding="utf-8")
    assert 'outputs = ["u", "psi"]' in text
    assert "nothing tells what up to" in text  # a command without a unit is asked for
    Path("first_trial.toml").write_text(
        text.replace('unit = "?"', 'unit = "rpm"'), encoding="utf-8"
    )
    ship = Path("first_trial_ship.toml")
    ship.write_text(
        ship.read_text(encoding="utf-8").replace('"thrust"', '"revolutions"'), encoding="utf-8"
    )
    found = run(pipeline_file.load(Path("first_trial.toml"))).result
    assert found.verdict.kind != "no fit", found.verdict.sentence
    assert found.fit.eps_rmsn_by_output["psi"] < 0.15


def test_pulse_widths_are_known_by_their_size(tmp_path, monkeypatch) -> None:
    made = log(tmp_path / "a.csv", drive="pwm")
    names, *rows = made.read_text(encoding="utf-8").splitlines()
    table = np.array([[float(x) for x in row.split(",")] for row in rows])
    most = np.abs(table[:, 1:3]).max()
    table[:, 1:3] = 1500.0 + 400.0 * table[:, 1:3] / most
    np.savetxt(made, table, delimiter=",", header=names, comments="", fmt="%.6f")
    done = started(tmp_path, monkeypatch, [made], "--length 2")
    assert done.exit_code == 0, done.output
    said = " ".join(done.stdout.split())
    assert "look like pulse widths [us], about 1500 at rest" in said
    assert "side confirmed by the turn" in said
    [ship] = tmp_path.glob("*_ship.toml")
    assert ship.read_text(encoding="utf-8").count('command = "share"') == 2
    assert not (tmp_path / "runs").exists()
