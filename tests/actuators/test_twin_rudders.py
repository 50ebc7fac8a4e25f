"""Two rudders, one half as effective: named on its side where they moved apart, else not at all."""

from collections import Counter
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from boats import both, ship_with
from click.testing import CliRunner

import trialid
from trialid.cli.main import commands
from trialid.design.following import vessel_of
from trialid.design.helm import Vessel, carry_out
from trialid.design.imo.measure_slopes import measure_slopes
from trialid.design.prediction.keeping_place import sail_each
from trialid.design.standard import MANOEUVRES
from trialid.diagnosis.diagnose import diagnose
from trialid.diagnosis.diagnosed import DiagnoseSettings
from trialid.diagnosis.verdict import Verdict
from trialid.effects import CATALOGUE
from trialid.identification.fit import identify
from trialid.identification.problem import Settings
from trialid.result.json_file import read
from trialid.ship.actuators import Actuator
from trialid.ship.model import ShipModel
from trialid.ship.particulars import Ship
from trialid.trial import Trial

KNOWN = ("Nv", "Nr", "Ydelta", "Ndelta")
TWINS = (
    Actuator(name="port", kind="rudder", x=-80.0, y=-4.0),
    Actuator(name="stbd", kind="rudder", x=-80.0, y=4.0),
)
SHIP = ship_with(TWINS)
EFFECTS = both(SHIP)
SPEED, NOISE = 7.3, np.deg2rad(0.01)
NAMES = ("port", "stbd")
NEWCOMER = Path(__file__).parents[3] / "shared" / "data" / "newcomer"


def sway_and_yaw(mean_rudder: np.ndarray, period: float) -> np.ndarray:
    """Rate of turn [rad/s] by the linear equations in primes, written out; (N,)."""
    m, c, L = SHIP.mass, SHIP.coefficients, SHIP.particulars["L"]
    inertia = np.array(
        [
            [m["m"] - m["Yvdot"], -m.get("Yrdot", 0.0)],
            [-m.get("Nvdot", 0.0), m["I_zz"] - m["Nrdot"]],
        ]
    )
    damping = np.array([[c["Yv"], c["Yr"] - m["m"]], [c["Nv"], c["Nr"]]])
    A = np.linalg.solve(inertia, damping) * SPEED / L
    b = np.linalg.solve(inertia, [c["Ydelta"], c["Ndelta"]]) * SPEED / L
    x, r = np.zeros(2), []
    h = period / 10.0
    for now, after in pairwise([*mean_rudder, mean_rudder[-1]]):
        r.append(x[1] * SPEED / L)
        for i in range(10):  # the angle moves evenly from sample to sample
            delta = now + (after - now) * (i + 0.5) / 10.0
            x = x + h * (A @ (x + h / 2.0 * (A @ x + b * delta)) + b * delta)
    return np.array(r)


def record(seed: int, kept: tuple[float, float], apart: bool, stuck: int | None = None) -> Trial:
    """Steps of both rudders, of which these shares act; each by itself where they move apart.

    The rudder that is `stuck` stays at an angle of 2 to 8 deg, and the log shows its order.
    """
    rng = np.random.default_rng(seed)
    t = np.arange(0.0, 900.0, 1.0)
    angles = np.zeros((len(t), 2))
    for start in range(20, 900, 40):
        step = np.deg2rad(rng.uniform(-12.0, 12.0, 2))
        angles[start:] = step if apart else step[0]
    acting = angles.copy()
    if stuck is not None:
        acting[:, stuck] = np.deg2rad(rng.uniform(2.0, 8.0)) * rng.choice([-1.0, 1.0])
    r = sway_and_yaw(acting @ np.array(kept) / 2.0, 1.0)
    signals = dict(zip(NAMES, angles.T, strict=True))
    signals["r"] = r + NOISE * rng.standard_normal(len(t))
    signals["u"] = np.full(len(t), SPEED)
    valid = {n: np.ones(len(t), dtype=bool) for n in signals}
    return Trial(f"twin {seed}", "fit", 1.0, signals, valid)


def found(
    seed: int, kept: tuple[float, float] = (1.0, 1.0), apart: bool = True, stuck: int | None = None
) -> Verdict:
    effects = (EFFECTS["linear_hull"], EFFECTS["rudders"])
    asked = Settings(
        free=("Nv", "Nr", "Ydelta", "Ndelta"), outputs=("r",), nuisance=("initial_state",)
    )
    fit = identify((record(seed, kept, apart, stuck),), ShipModel(SHIP, ("v", "r"), effects), asked)
    return diagnose(fit, DiagnoseSettings(candidates=EFFECTS)).verdict


def test_the_half_rudder_is_named_and_its_healthy_twin_is_not() -> None:
    verdict = found(500, (1.0, 0.5))
    assert (verdict.effect, verdict.family) == ("stbd_weak", ("stbd_weak",))


def steered(trial: Trial, ship: Ship, rudder: str) -> Vessel:
    effects = (CATALOGUE["linear_hull"], both(ship)[rudder])
    asked = Settings(free=KNOWN, outputs=("r",), nuisance=("initial_state",))
    return vessel_of(identify((trial,), ShipModel(ship, ("v", "r"), effects), asked))


def test_two_rudders_steer_her_as_the_one_that_does_what_both_do() -> None:
    """`she has no rudder to steer by` was said of a ferry with two: no measure, no prediction."""
    twin = record(510, (1.0, 1.0), apart=False)
    one = replace(twin, signals={**twin.signals, "delta": twin.signals["port"]})
    ships = steered(twin, SHIP, "rudders"), steered(one, ship_with(()), "linear_rudder")
    of_two, of_one = (measure_slopes(ship, KNOWN, (), 0) for ship in ships)
    assert {*of_two.values} >= {"advance", "tactical diameter", "first overshoot 10/10"}
    assert of_two.values == pytest.approx(of_one.values, rel=1e-4)
    np.testing.assert_allclose(of_two.by, of_one.by, rtol=1e-3, atol=1e-3)


@pytest.mark.parametrize("slower", [np.inf, np.deg2rad(1.0)])
def test_a_ship_of_two_rudders_keeps_her_place_as_she_is_carried_out(slower: float) -> None:
    """The same orders at the same samples, each rudder at its own rate."""
    slow = ship_with((TWINS[0], replace(TWINS[1], rate=slower)))
    ship = steered(record(510, apart=False, kept=(1.0, 1.0)), slow, "rudders")
    parameters = ship.simulator.equations.parameters
    theta = np.array([[ship.simulator.fixed[n] for n in parameters]])
    told = MANOEUVRES["zig-zag 10/10"]
    [quick] = [
        {n: x.copy() for n, x in passage.trial.signals.items()}
        for passage in sail_each(ship, theta, told, 30.0, 600.0)
    ]
    whole = carry_out(ship, told(), 30.0, 600.0, "zig-zag").trial.signals
    for name in ("r", "port", "stbd", "delta_order"):
        np.testing.assert_allclose(quick[name], whole[name][: len(quick[name])], atol=1e-9)


def test_rudders_that_move_as_one_do_not_tell_which_of_them_is_weak() -> None:
    assert found(501, (1.0, 0.5), apart=False).effect is None


@pytest.mark.study(turn=2)
def test_a_stuck_rudder_is_named_where_its_ship_looks_like_another() -> None:
    """Four coefficients of 0.04 to 0.5 of the file's, and an error of 0.30: her file was blamed."""
    assert found(73100, stuck=0).family == ("port_stuck",)


@pytest.mark.study(turn=3)
def test_one_rudder_half_as_effective_is_named_with_its_side() -> None:
    """Forty records moved apart, half of them healthy; the side that is right, and no other."""
    right: Counter[str] = Counter()
    wrong = []
    for seed in range(600, 620):
        side = seed % 2
        kept = (0.5, 1.0) if side == 0 else (1.0, 0.5)
        verdict = found(seed, kept)
        right["half"] += verdict.family == (f"{NAMES[side]}_weak",)
        wrong += [verdict.sentence] if verdict.effect not in (None, f"{NAMES[side]}_weak") else []
        healthy = found(seed, (1.0, 1.0))
        right["healthy"] += healthy.effect is None
        wrong += [healthy.sentence] if healthy.effect is not None else []
    print(dict(right), wrong)
    assert right["half"] >= 19
    assert len(wrong) <= 0.02 * 40


@pytest.mark.study(turn=6)
def test_one_rudder_stuck_is_named_with_its_side() -> None:
    """Twenty records; a name of the other side or of another cause is a wrong one."""
    right, wrong = 0, []
    for seed in range(640, 660):
        own = NAMES[seed % 2]
        verdict = found(seed, stuck=seed % 2)
        if verdict.effect == f"{own}_stuck":
            right += 1
        elif verdict.effect is not None:
            wrong.append(f"{seed}: {verdict.sentence}")
    print(right, wrong)
    assert right >= 0.95 * 20
    assert wrong == []


ACTUATORS = """
[[actuator]]
name = "rudder_port"
kind = "rudder"
at = [-46.0, -4.0]

[[actuator]]
name = "rudder_stbd"
kind = "rudder"
at = [-46.0, 4.0]
"""
SIGNALS = """
[signals]
rudder_port = { channel = "rudder_port_deg", unit = "deg", positive = "starboard" }
rudder_stbd = { channel = "rudder_stbd_deg", unit = "deg", positive = "starboard" }
r = { channel = "rot_deg_min", unit = "deg/min" }
u = { channel = "sog_kn", unit = "kn" }
[align]
period = 0.5
[model]
states = ["v", "r"]
effects = ["linear_hull", "rudders", "yaw_cubic_rrr"]
[identify]
free = ["Nv", "Nr", "Ndelta", "Nrrr"]
outputs = ["r"]
nuisance = ["initial_state", "bias"]
"""


def logged(path: Path) -> Path:
    """A record of both as a table, moved in 5 s; the rudder to port counts to port."""
    trial = record(520, (1.0, 1.0), apart=True)
    port, starboard = (np.convolve(trial.signals[n], np.ones(5) / 5.0, "same") for n in NAMES)
    columns = {
        "time_s": np.arange(900.0),
        "rudder_port_deg": -np.rad2deg(port),
        "rudder_stbd_deg": np.rad2deg(starboard),
        "yaw_rate_degps": np.rad2deg(trial.signals["r"]),
    }
    rows = (",".join(f"{x:.6f}" for x in row) for row in np.column_stack([*columns.values()]))
    path.write_text("\n".join([",".join(columns), *rows]) + "\n", encoding="utf-8")
    return path


def test_start_writes_a_row_for_each_rudder_and_says_what_the_turn_shows(tmp_path, monkeypatch):
    """How each turns the ship is measured; which is to port no motion of alike ones shows."""
    monkeypatch.chdir(tmp_path)
    given = [str(logged(tmp_path / "a.csv")), "--speed", "14.2"]
    done = CliRunner().invoke(commands, ["inspect", *given, "--init", "p.toml", "--length", "175"])
    assert done.exit_code == 0, done.output
    text = Path("p.toml").read_text(encoding="utf-8")
    assert (
        'rudder_port      = { channel = "rudder_port_deg", unit = "deg", positive = "port" }'
        in text
    )
    assert '"rudder_stbd_deg", unit = "deg", positive = "starboard" }' in text
    assert "the motion does not show which is to port" in text
    ship = trialid.read_ship("p_ship.toml")
    assert [(a.name, a.kind, a.x < 0.0, a.y < 0.0) for a in ship.actuators] == [
        ("rudder_port", "rudder", True, True),
        ("rudder_starboard", "rudder", True, False),
    ]
    CliRunner().invoke(commands, ["ship", "one.toml", "--length", "175", "--quiet"])
    CliRunner().invoke(commands, ["inspect", *given, "--init", "one_p.toml", "--ship", "one.toml"])
    assert "\ndelta = {" in Path("one_p.toml").read_text(encoding="utf-8")


@pytest.mark.study(turn="each")
@pytest.mark.real_data
@pytest.mark.skipif(not NEWCOMER.is_dir(), reason=f"no records in {NEWCOMER}")
def test_a_ferry_of_a_stranger_with_two_rudders(tmp_path, monkeypatch) -> None:
    """Her rudders moved as one but for their zeros: none of them may be called weak."""
    monkeypatch.chdir(tmp_path)
    made = CliRunner().invoke(commands, ["ship", "ferry.toml", "--length", "96", "--quiet"])
    assert made.exit_code == 0, made.output
    with Path("ferry.toml").open("a", encoding="utf-8") as ship:
        ship.write(ACTUATORS)
    trials = [
        f'[[trial]]\nname = "{n}"\nlogs = ["{(NEWCOMER / n).as_posix()}.csv"]\n'
        for n in ("twin10", "twin20")
    ]
    Path("p.toml").write_text('ship = "ferry.toml"\n' + "".join(trials) + SIGNALS, "utf-8")
    done = CliRunner().invoke(commands, ["run", "p.toml", "--quiet"])
    assert done.exit_code == 0, done.output
    result = read(tmp_path / "runs" / "p" / "result.json")
    assert result.fit.converged
    assert result.fit.eps_rmsn < 0.1
    assert result.verdict.effect not in {f"rudder_{s}_weak" for s in ("port", "stbd")}
