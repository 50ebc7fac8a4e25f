"""`trialid start`: logs in, a pipeline, a ship and a first fit out; what is not known is asked."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from click.testing import CliRunner
from test_first_pipeline import L, trial, written

from trialid import pipeline_file
from trialid.alignment.quality import steps_back
from trialid.cli import start_command
from trialid.cli.main import commands
from trialid.inspection import inspect_trials
from trialid.inspection.relations import Side
from trialid.result.json_file import read
from trialid.ship.particulars import read_ship

NEWCOMER = Path(__file__).parents[3] / "shared" / "data" / "newcomer"
SHIP = ("--length", str(L))


def started(folder, monkeypatch, *words):
    monkeypatch.chdir(folder)
    return CliRunner().invoke(commands, ["start", *map(str, words)])


def log(path, seed=0, begun=0.0, **others):
    t, delta, r, psi, u = trial(seed=seed)
    columns = {
        "t_in_s": t + begun,
        "rudder_in_deg": delta,
        "yaw_rate_in_deg_per_s": r,
        "heading_in_deg": psi % 360.0,
        "sog_in_m_per_s": u,
    }
    return written(path, **(columns | others))


def test_logs_become_a_pipeline_a_ship_and_a_fit(tmp_path, monkeypatch):
    logs = [log(tmp_path / f"zigzag-{k}.csv", seed=k) for k in range(3)]
    done = started(tmp_path, monkeypatch, *logs, *SHIP)
    assert done.exit_code == 0, done.output
    lines = done.stdout.splitlines()
    assert lines[0].startswith("3 trials: zigzag-0.csv, zigzag-1.csv, zigzag-2.csv; zigzag-1.csv")
    assert len(lines) <= 40
    assert max(map(len, lines)) <= 80
    asked = pipeline_file.load(tmp_path / "first_trial.toml")
    assert [t.use for t in asked.trials] == ["fit", "check", "fit"]
    assert (tmp_path / "first_trial_ship.toml").is_file()
    result = read(tmp_path / "runs" / "first_trial" / "result.json")
    assert result.fit.eps_rmsn < 0.3
    assert lines[-1] == "Report: runs/first_trial/report.html"


def test_a_table_without_a_header_is_begun_by_its_template(tmp_path, monkeypatch):
    """As a basin writes it: two lines of title, and columns that nobody named."""
    plain = log(tmp_path / "plain.csv").read_text(encoding="utf-8").splitlines()[1:]
    rows = "\n".join(row.replace(",", "\t") for row in plain)
    (tmp_path / "a.dat").write_text(f"A basin\nZig-zag 10/10\n\n{rows}\n", encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    CliRunner().invoke(commands, ["inspect", "a.dat", "--template", "t.toml"])
    text = Path("t.toml").read_text(encoding="utf-8").replace("reviewed = false", "reviewed = true")
    named = {2: ("delta", "deg"), 3: ("r", "deg/s"), 4: ("psi", "deg"), 5: ("u", "m/s")}
    for column, (name, unit) in named.items():
        meant = f'{{ rename = "{name}", unit = "{unit}" }}'
        text = text.replace(f'"column {column}" = {{}}', f'"column {column}" = {meant}')
    text = text.replace('"column 1" = {}', '"column 1" = { unit = "s" }')
    Path("t.toml").write_text(text, encoding="utf-8")
    done = started(tmp_path, monkeypatch, "a.dat", "--with-template", "t.toml", *SHIP)
    assert done.exit_code == 0, done.output
    begun = Path("first_trial.toml").read_text(encoding="utf-8")
    assert 'logs = [{ path = "a.dat", template = "t.toml" }]' in begun
    assert read(Path("runs/first_trial/result.json")).fit.eps_rmsn < 0.3


def test_a_recorded_speed_is_no_constant_whatever_it_is_called(tmp_path, monkeypatch):
    """Frozen at its median the ferry's speed once named an effect that was not there."""
    started(tmp_path, monkeypatch, log(tmp_path / "a.csv"), *SHIP)
    text = (tmp_path / "first_trial.toml").read_text(encoding="utf-8")
    assert 'u     = { channel = "sog", unit = "m/s" }' in text
    assert "CAREFUL: a speed over ground" in text
    assert "speed = " not in text


def test_nothing_is_replaced(tmp_path, monkeypatch):
    made = log(tmp_path / "a.csv")
    (tmp_path / "first_trial.toml").write_text("mine", encoding="utf-8")
    done = started(tmp_path, monkeypatch, made, *SHIP)
    assert done.exit_code == 2
    assert "first_trial.toml exists; name another pipeline" in done.stderr
    assert (tmp_path / "first_trial.toml").read_text(encoding="utf-8") == "mine"


def test_what_only_the_user_knows_is_asked_and_nothing_is_fitted(tmp_path, monkeypatch):
    """A rudder that has nothing to do with the turn: its side cannot be measured."""
    t, *_ = trial()
    rudder = 10.0 * np.sign(np.sin(0.31 * t))
    made = log(tmp_path / "a.csv", rudder_in_deg=rudder)
    done = started(tmp_path, monkeypatch, made, *SHIP)
    assert done.exit_code == 0
    assert "To fill in: a.csv: delta" in done.stdout
    assert "Not fitted yet" in done.stderr
    assert not (tmp_path / "runs").exists()


def test_a_folder_of_trials_is_several_and_a_split_recording_is_one(tmp_path):
    for name, later in {"zero": 0.0, "split": 600.0, "hours": 3600.0}.items():
        (tmp_path / name).mkdir()
        for k in range(3):
            log(tmp_path / name / f"{k}.csv", seed=k, begun=later * k)
    for several in ("zero", "hours"):
        found = inspect_trials(tmp_path / several)
        assert [one.path.name for one in found] == ["0.csv", "1.csv", "2.csv"]
    (whole,) = inspect_trials(tmp_path / "split")
    assert whole.path == tmp_path / "split"
    assert len(whole.files) == 3


def of_two_rudders(path):
    _, delta, *_ = trial()
    return log(path, rudder_port_in_deg=delta, rudder_stbd_in_deg=1.01 * delta)


def test_a_rudder_that_is_left_out_is_told(tmp_path, monkeypatch):
    """Her own file has one rudder, so that of two one is read."""
    begun_by = log(tmp_path / "b.csv")
    assert started(tmp_path, monkeypatch, begun_by, *SHIP).exit_code == 0
    made = of_two_rudders(tmp_path / "a.csv")
    made.write_text(made.read_text(encoding="utf-8").replace("rudder[deg]", "spare[deg]"))
    words = ("--ship", "first_trial_ship.toml", "--pipeline", "p.toml")
    told = " ".join(started(tmp_path, monkeypatch, made, *words).stdout.split())
    assert "delta: rudder_port, by its name;" in told
    assert "; CAREFUL: rudder_stbd, another of them, left out: commented out in the" in told


def test_a_clock_that_was_set_back_by_an_hour_is_told():
    """Two hours' samples are mixed: an outsider's run named two effects of it without a word."""
    warnings = (f"the table: {steps_back(1, 3599.0)}", f"gyro: {steps_back(2, 0.5)}")
    survey = SimpleNamespace(warnings=warnings)
    begun = SimpleNamespace(trials=[SimpleNamespace(name="a.csv", survey=survey)])
    [told] = start_command._set_back(begun)
    assert told.startswith("CAREFUL, in a.csv: the table: time steps back 1 time, by up to 3599 s")
    assert "whose samples mix? state its zone, or cut the log there" in told


def test_channels_of_which_nothing_is_known_are_told_if_they_move(tmp_path, monkeypatch):
    t, delta, *_ = trial()
    fins = {"fin_port_in_deg": -delta, "fin_stbd_in_deg": delta, "spare_in_V": 0.0 * t}
    fins |= {"gps_course_in_deg": 90.0 + delta}  # known, and not needed
    told = started(tmp_path, monkeypatch, log(tmp_path / "a.csv", **fins), *SHIP).stdout
    words = " ".join(told.split())
    said = "Not read, as their names say nothing that is known: fin_port, fin_stbd."
    assert said in words
    many = {f"x{i}_in_V": i + delta for i in range(9)}
    made = log(tmp_path / "b.csv", **many)
    told = started(tmp_path, monkeypatch, made, *SHIP, "--pipeline", "q.toml").stdout
    assert "Not read" not in told


def test_the_water_and_the_natural_roll_are_her_particulars(tmp_path, monkeypatch):
    made = log(tmp_path / "a.csv")
    of_her = (*SHIP, "--rho", "998.5", "--roll-period", "12")
    begun = started(tmp_path, monkeypatch, made, *of_her)
    assert begun.exit_code == 0, begun.output
    ship = (tmp_path / "first_trial_ship.toml").read_text(encoding="utf-8")
    assert "rho = 998.5  # kg/m^3, as stated" in ship
    assert read_ship(tmp_path / "first_trial_ship.toml").particulars["rho"] == 998.5
    for words, said in (
        (("--ship", "first_trial_ship.toml", "--rho", "998.5"), "--rho is for a new ship file"),
        ((*SHIP, "--rho", "0.9985"), "density of the water 0.9985 kg/m^3 is no water's"),
    ):
        done = started(tmp_path, monkeypatch, made, *words, "--pipeline", "p.toml")
        assert done.exit_code == 2
        assert said in done.stderr


def test_a_boat_of_thrusters_is_told_what_she_is(tmp_path, monkeypatch):
    made = log(tmp_path / "a.csv")
    text = made.read_text(encoding="utf-8").replace("rudder", "thrust_left", 1)
    made.write_text(text, encoding="utf-8")
    done = started(tmp_path, monkeypatch, made, *SHIP)
    assert done.exit_code == 2
    assert "she seems to steer by thrusters (thrust_left" in done.stderr


@pytest.mark.real_data
@pytest.mark.skipif(not NEWCOMER.is_dir(), reason=f"no records in {NEWCOMER}")
@pytest.mark.parametrize(
    ("names", "length"), [(("z10", "z20", "z15"), 62), (("twin20", "twin10", "twin15"), 96)]
)
@pytest.mark.study(turn="each")
def test_a_strangers_first_logs(tmp_path, monkeypatch, names, length):
    """A cubic yaw term is what both lack: it is named, or a twin the record cannot tell from it.

    That of the coaster hides behind her roll, which is seen with a tenth of the precision; and her
    added masses, of which only formulas tell, do as well 1.3 standard deviations off: that is said.
    """
    logs = [NEWCOMER / f"{name}.csv" for name in names]
    done = started(tmp_path, monkeypatch, *logs, "--length", length)
    assert done.exit_code == 0, done.output
    result = read(tmp_path / "runs" / "first_trial" / "result.json")
    assert result.fit.converged
    assert [t.name for t in result.trials if t.use == "check"] == [names[2]]
    if length == 96 or result.verdict.kind == "missing":  # the coaster's is nearly a tie
        assert "yaw_cubic_rrr" in result.verdict.family
    else:
        assert {"Yvdot", "Nvdot"} <= {*result.verdict.held_as_well}
        assert result.verdict.sentence.startswith(
            ("yaw_drag_rar takes", "yaw_drag_vav takes", "yaw_cubic_rrr takes")
        )
    ship = read_ship(tmp_path / "first_trial_ship.toml")
    rudders = ["rudder_port", "rudder_starboard"] if length == 96 else []
    assert [one.name for one in ship.actuators] == rudders


def test_a_word_for_steering_is_a_rudder_and_its_unit_is_asked_for(tmp_path, monkeypatch):
    for word in ("steering", "nozzle", "tiller"):
        made = log(tmp_path / f"{word}.csv")
        text = made.read_text(encoding="utf-8").replace("rudder[deg]", word, 1)
        assert word in text
        made.write_text(text, encoding="utf-8")
        told = started(tmp_path, monkeypatch, made, *SHIP, "--pipeline", f"{word}_.toml")
        words = " ".join(told.stdout.split())
        assert f"{word}, by its name; FILL IN unit = " in words, told.stderr


def test_what_turns_her_is_named_where_no_rudder_is_known(tmp_path, monkeypatch):
    made = log(tmp_path / "a.csv")
    text = made.read_text(encoding="utf-8").replace("rudder[deg]", "channel_7", 1)
    made.write_text(text, encoding="utf-8")
    done = started(tmp_path, monkeypatch, made, *SHIP)
    assert done.exit_code == 2
    assert "'channel_7' goes with" in done.stderr
    assert "where it steers her, call it `steering`" in done.stderr


def test_what_goes_as_she_turns_is_not_said_to_steer_her(tmp_path, monkeypatch):
    """Of outsiders' logs a latitude, a course and the speed that a turn costs were named."""
    _, _, r, psi, u = trial()
    others = {"cog_deg": (psi - 3.0 * r) % 360.0, "lost": u - 2.0 * np.abs(r)}
    others["latitude"] = 59.0 + 1e-5 * np.cumsum(u * np.cos(np.deg2rad(psi)))
    made = log(tmp_path / "a.csv", **others)
    rows = [line.split(",") for line in made.read_text(encoding="utf-8").splitlines()]
    made.write_text("\n".join(",".join((one[0], *one[2:])) for one in rows), encoding="utf-8")
    done = started(tmp_path, monkeypatch, made, *SHIP)
    assert done.exit_code == 2
    assert "no moving rudder" in done.stderr
    assert "steers her" not in done.stderr


@pytest.mark.parametrize(("by", "named"), [("dr/dt", True), ("r, as it is first laid", False)])
def test_what_steers_her_goes_with_the_change_of_her_rate(tmp_path, monkeypatch, by, named):
    """With the rate itself a position goes in a turning circle, and a heel."""
    made = log(tmp_path / "a.csv")
    text = made.read_text(encoding="utf-8").replace("rudder[deg]", "channel_7", 1)
    made.write_text(text, encoding="utf-8")
    found = Side("starboard", 0.9, "starboard", by)
    monkeypatch.setattr("trialid.workflow.first_pipeline.not_begun.side", lambda *more: found)
    assert ("steers her" in started(tmp_path, monkeypatch, made, *SHIP).stderr) is named
