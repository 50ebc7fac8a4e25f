"""The S-175 against the figures of an independent simulation, to the digits printed.

That program ran RK4 at 0.25 s, with a steering gear of 1 s and 5 deg/s.
"""

import math
from pathlib import Path

import numpy as np
import pytest

from trialid.effects import CATALOGUE
from trialid.ship.model import ShipModel
from trialid.simulation.integrate import Simulator, prepare, respond
from trialid.simulation.reference import evaluator
from trialid.simulation.trace import trace
from trialid.trial import Trial

REFERENCE = Path(__file__).parents[1] / "reference"
DEG = math.pi / 180.0
PERIOD = 0.25
EQUILIBRIUM = {70: 7.330, 80: 8.377, 110: 11.518}
SPEED_PER_RPM = 0.10471


def shaft(rpm: float, samples: int) -> np.ndarray:
    return np.full(samples, rpm * 2.0 * math.pi / 60.0)


@pytest.fixture(scope="module")
def rudder_held(s175: ShipModel) -> Simulator:
    return prepare(s175, (), ("r",))


@pytest.fixture(scope="module")
def steered(s175: ShipModel) -> Simulator:
    model = s175 + CATALOGUE["rudder_servo_limited"]
    return prepare(model.with_values({"T_servo": 1.0, "rate_max": 5.0 * DEG}), (), ("r",))


def run(
    simulator: Simulator,
    rpm: float,
    rudder: float,
    seconds: float,
    start: dict[str, float],
    period: float = PERIOD,
) -> dict[str, np.ndarray]:
    samples = round(seconds / period) + 1
    rudders = np.full(samples, rudder * DEG)
    signals = {"n": shaft(rpm, samples), "delta": rudders, "delta_order": rudders}
    answer = respond(simulator, Trial("x", "fit", period, signals, {}), {}, start, False)
    assert answer.departure is None
    return dict(zip(simulator.equations.states, answer.states.T, strict=True))


@pytest.mark.parametrize("rpm", EQUILIBRIUM)
def test_equilibrium_speed(rpm: int, rudder_held: Simulator) -> None:
    """Three digits behind the point, as printed; proportional to the shaft speed."""
    speed = run(rudder_held, rpm, 0.0, 3000.0, {"u": 0.09 * rpm})["u"][-1]
    assert speed == pytest.approx(EQUILIBRIUM[rpm], abs=0.0005)
    assert speed / rpm == pytest.approx(SPEED_PER_RPM, rel=1e-4)


TURNS = [
    # rpm, rudder, r [deg/s], U/U0, drift [deg], heel [deg], first inward heel [deg], diameter [L]
    (70, 5, 0.353, 0.895, 4.7, -3.29, 0.17, 12.5),
    (70, 10, 0.472, 0.801, 6.8, -3.84, 0.33, 8.4),
    (70, 20, 0.581, 0.650, 9.5, -3.60, 0.61, 5.8),
    (70, 35, 0.631, 0.454, 12.7, -2.36, 0.80, 4.2),
]


@pytest.mark.parametrize(
    ("rpm", "rudder", "rate", "speed", "drift", "heel", "inward", "diameter"), TURNS
)
def test_turning_circle(
    rpm: int, rudder: float, rate: float, speed: float, drift: float, heel: float,
    inward: float, diameter: float, steered: Simulator,
) -> None:  # fmt: skip
    """Steady values to half a unit of the last printed digit (0.3 %), the transient to 3 %."""
    x = run(steered, rpm, rudder, 2400.0, {"u": EQUILIBRIUM[rpm], "delta": 0.0})
    u, v = x["u"][-1], x["v"][-1]
    assert x["r"][-1] / DEG == pytest.approx(rate, abs=0.0006)
    assert math.hypot(u, v) / EQUILIBRIUM[rpm] == pytest.approx(speed, abs=0.0006)
    assert math.atan2(-v, u) / DEG == pytest.approx(drift, abs=0.06)
    assert x["phi"][-1] / DEG == pytest.approx(heel, abs=0.006)
    assert x["phi"].max() / DEG == pytest.approx(inward, abs=0.006)
    assert tactical_diameter(x) / 175.0 == pytest.approx(diameter, rel=0.012)


def tactical_diameter(x: dict[str, np.ndarray]) -> float:
    """Transfer at 180 deg of heading change [m]."""
    east = x["u"] * np.sin(x["psi"]) + x["v"] * np.cos(x["psi"])
    across = np.concatenate([[0.0], np.cumsum(0.5 * PERIOD * (east[1:] + east[:-1]))])
    return float(np.interp(math.pi, x["psi"], across))


@pytest.mark.parametrize(("rudder", "heel"), [(5, -8.6), (10, -9.7), (20, -8.9), (35, -5.8)])
def test_heel_at_110_rpm(rudder: float, heel: float, steered: Simulator) -> None:
    x = run(steered, 110, rudder, 2400.0, {"u": EQUILIBRIUM[110], "delta": 0.0})
    assert x["phi"][-1] / DEG == pytest.approx(heel, abs=0.06)
    if rudder == 35:
        assert x["phi"].min() / DEG == pytest.approx(-24.7, abs=0.06)


def test_it_runs_away_at_high_speed(rudder_held: Simulator) -> None:
    """Physics: without a hardening GZ the cubic heel terms blow up in finite time at 16.5 m/s."""
    samples = 2400
    signals = {"n": shaft(158.0, samples), "delta": np.full(samples, 5.0 * DEG)}
    trial = Trial("x", "fit", PERIOD, signals, {})
    answer = respond(rudder_held, trial, {}, {"u": 16.54}, sensitivities=False)
    assert answer.departure is not None
    assert abs(answer.states[: round(answer.departure.t / PERIOD), 4]).max() > 0.5


def test_roll_decay(rudder_held: Simulator) -> None:
    """Peaks from 10 deg, in degrees; every 28.9 s; damping ratio .043."""
    phi = run(rudder_held, 70, 0.0, 160.0, {"u": EQUILIBRIUM[70], "phi": 10.0 * DEG})["phi"] / DEG
    peak = np.flatnonzero((phi[1:-1] > phi[:-2]) & (phi[1:-1] >= phi[2:])) + 1
    np.testing.assert_allclose(phi[peak], [7.48, 5.70, 4.34, 3.31, 2.52], atol=0.006)
    assert np.diff(peak).mean() * PERIOD == pytest.approx(28.9, abs=0.05)
    decrement = np.log(phi[peak[0]] / phi[peak[-1]]) / (len(peak) - 1)
    assert decrement / math.hypot(2.0 * math.pi, decrement) == pytest.approx(0.043, abs=0.0005)


HELM = 0.05
"""[s] How promptly the helm is reversed here; 0.25 s where the printed figures come from."""


def zigzag(simulator: Simulator, rpm: int, angle: float) -> dict[str, float]:
    """First overshoot, rate at the first reversal, period, largest |r| and |phi|; deg, s."""
    x, side, switches = {"u": EQUILIBRIUM[rpm], "delta": 0.0}, 1, [0.0]
    found = {"r": 0.0, "phi": 0.0}
    for leg in range(6):
        path = run(simulator, rpm, side * angle, 200.0, x, HELM)
        turned = side * path["psi"] / DEG
        k = int(np.argmax(turned >= angle))
        assert k > 0
        if leg == 0:
            found["reversal"] = path["r"][k] / DEG
        if leg == 1:
            found["overshoot"] = -float(turned[:k].min()) - angle
        for s in ("r", "phi"):
            found[s] = max(found[s], float(np.abs(path[s][: k + 1]).max()) / DEG)
        x, side = {s: values[k] for s, values in path.items()}, -side
        switches.append(switches[-1] + k * HELM)
    return found | {"period": switches[6] - switches[4]}


ZIGZAGS = [
    # angle, first overshoot and half its last digit, period, largest r, largest phi
    (2, 0.70, 0.005, 204.0, None, None),
    (5, 1.75, 0.005, 200.0, None, 3.7),
    (10, 3.55, 0.005, 196.0, 0.50, 5.4),
    (20, 6.0, 0.05, 208.0, 0.70, 7.9),
]


@pytest.mark.parametrize(("angle", "overshoot", "digit", "period", "rate", "heel"), ZIGZAGS)
def test_zigzag(
    angle: float, overshoot: float, digit: float, period: float, rate: float | None,
    heel: float | None, steered: Simulator,
) -> None:  # fmt: skip
    """The printed overshoot is at most one sample of 0.25 s at the rate of turn too long."""
    found = zigzag(steered, 70, angle)
    late = PERIOD * found["reversal"]
    assert found["overshoot"] - digit < overshoot < found["overshoot"] + late + digit
    assert found["period"] == pytest.approx(period, rel=0.02)
    if rate is not None:
        assert found["r"] == pytest.approx(rate, rel=0.02)
    if heel is not None:
        assert found["phi"] == pytest.approx(heel, rel=0.02)


def eigenvalues(model: ShipModel, speed: float) -> np.ndarray:
    """Of the lateral motions on a straight course at the equilibrium of this speed."""
    eq = trace(model, (), ("r",))
    x = {"u": speed, "n": float(shaft(speed / 0.1047084, 1)[0])}
    x |= {n: model.value(n) for n in eq.parameters}
    symbols = (*eq.states, *eq.inputs, *eq.parameters)
    entries = evaluator(list(eq.J.values()), symbols, scalar=True)([x.get(s, 0.0) for s in symbols])
    J = np.zeros((len(eq.states), len(eq.states)))
    for place, entry in zip(eq.J, entries, strict=True):
        J[place] = entry
    lateral = [i for i, s in enumerate(eq.states) if s in ("v", "p", "r", "phi")]
    return np.linalg.eigvals(J[np.ix_(lateral, lateral)])


def slow(values: np.ndarray) -> float:
    return max(float(e.real) for e in values if abs(e.imag) < 1e-9)


SLOW = [
    # U, roll locked, roll coupled at GM .15, .3, 1.0
    (7.33, -0.01024, -0.00874, -0.00945, -0.0100),
    (11.52, -0.01610, -0.01106, -0.01325, -0.01516),
    (16.54, -0.02312, -0.01119, -0.01571, -0.02045),
]


@pytest.mark.parametrize(("speed", "locked", "tender", "normal", "stiff"), SLOW)
def test_slow_yaw_eigenvalue(
    speed: float, locked: float, tender: float, normal: float, stiff: float, s175: ShipModel
) -> None:
    """Rolling takes directional stability away, the more the faster and the more tender."""
    for GM, printed in ((0.15, tender), (0.3, normal), (1.0, stiff)):
        model = s175.with_values({"GM": GM})
        assert slow(eigenvalues(model, speed)) == pytest.approx(printed, rel=1e-3)
    upright = ShipModel(s175.ship, ("u", "v", "r"), _without_roll(s175))
    assert slow(eigenvalues(upright, speed)) == pytest.approx(locked, rel=1e-3)


def _without_roll(model: ShipModel) -> tuple:
    return tuple(e for e in model.effects if not {"p", "phi"} & set(e.signals))


@pytest.mark.parametrize(("GM", "period"), [(0.15, 39.2), (0.3, 28.8), (0.6, 20.9), (1.0, 16.3)])
def test_roll_period(GM: float, period: float, s175: ShipModel) -> None:
    [mode] = [
        e for e in eigenvalues(s175.with_values({"GM": GM}), EQUILIBRIUM[70]) if e.imag > 0.0
    ]  # fmt: skip
    assert 2.0 * math.pi / abs(mode) == pytest.approx(period, abs=0.06)


def test_s175q_answers_a_recorded_rudder_as_the_independent_program_did(s175q: ShipModel) -> None:
    """Twenty minutes of the 10-10 zig-zag, r and phi once a second, to 1e-4 of their range."""
    rudder = np.loadtxt(REFERENCE / "zz_rudder_deg.csv", delimiter=",", comments="#")[:, 3] * DEG
    expected = np.loadtxt(REFERENCE / "zz10_response_deg.csv", delimiter=",", comments="#")[:, 1:]
    signals = {"delta": rudder, "n": shaft(70, len(rudder))}
    trial = Trial("zigzag-10", "fit", 0.5, signals, {})
    simulator = prepare(s175q, (), ("r", "phi"))
    y = respond(simulator, trial, {}, {"u": 7.3295883}, False).y[::2] / DEG
    assert np.all(np.abs(y - expected) < 1e-4 * np.abs(expected).max(axis=0))
