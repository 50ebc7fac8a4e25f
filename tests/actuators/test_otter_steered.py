"""Nomoto's numbers and gains of a boat that two thrusters steer, against another programme's boat.

The order is half the difference of both commands, about those that hold the speed.
"""

from dataclasses import replace

import numpy as np
import otter
import pytest
from otter_model import CANDIDATES, TRUTH, fitted, model, record
from typical import known_by, spread_of

from trialid.design.helm import vessel
from trialid.design.steering.gains import heading_gains, rate_gains
from trialid.design.steering.nomoto import nomoto
from trialid.design.steering.steered_by import steered_by
from trialid.effects.actuators import actuator_effects
from trialid.errors import DesignError
from trialid.ship.model import ShipModel
from trialid.threads import one_thread
from trialid.workflow.use.predict import ready_ship

DRAWS, FIRST = 50, 7200
SMALL, NEAR = 0.01, 0.08
"""Share of a step, and of a time, by which a promise may be missed, as in `test_gains_study`."""
SPEED, H = 1.0, 0.1
CRUISE = float(np.sqrt(-otter.XU * SPEED / (2.0 * otter.AHEAD)))
STEP = 1e-5
"""Of heading [rad] or rate of turn [rad/s]: so small that no square counts."""
MISSING = ("left_weak", "right_weak", "thrusters_deadband", "thrusters_advance")
CERTAIN = known_by("Xu0", 0.0)
NO_WEAKNESS = np.zeros(2)


def boat(one: ShipModel):
    """Steered about what holds her speed, whatever the trial's medians were."""
    return vessel(one, H, {"u": SPEED, "left_order": 40.0, "right_order": 20.0}, 0.05)


def truth() -> ShipModel:
    return model().with_values(TRUTH)


def sailed(law, duration: float) -> np.ndarray:
    """Rates of turn and headings [rad/s, rad] of the true boat by a law of both; (N, 2)."""
    state, psi, path = np.array([SPEED, 0.0, 0.0, CRUISE, CRUISE]), 0.0, []
    for _ in range(round(duration / H)):
        s = law(state[2], psi)
        orders = CRUISE + s * np.array([1.0, -1.0])
        before = state[2]
        a = otter.rates(state, orders, NO_WEAKNESS, otter.C_D)
        b = otter.rates(state + H / 2.0 * a, orders, NO_WEAKNESS, otter.C_D)
        c = otter.rates(state + H / 2.0 * b, orders, NO_WEAKNESS, otter.C_D)
        d = otter.rates(state + H * c, orders, NO_WEAKNESS, otter.C_D)
        state = state + H / 6.0 * (a + 2.0 * b + 2.0 * c + d)
        psi += H * (before + state[2]) / 2.0
        path.append((state[2], psi))
    return np.array(path)


def stepped(gains, duration: float) -> tuple[float, float]:
    """Overshoot and settling [s] of the true boat under the gains, heading or rate stepped."""
    whole = 0.0

    def law(r: float, psi: float) -> float:
        nonlocal whole
        e = STEP - (r if "FF" in gains else psi)
        whole += e * H
        if "FF" in gains:
            return gains["FF"] * STEP + gains["P"] * e + gains["I"] * whole
        return gains["Kp"] * e + gains["Ki"] * whole - gains["Kd"] * r

    path = sailed(law, duration)[:, 0 if "FF" in gains else 1] / STEP
    outside = np.flatnonzero(np.abs(path - 1.0) > 0.05)
    return max(float(path.max()) - 1.0, 0.0), (int(outside[-1]) + 2) * H


def test_k_and_t_are_what_a_small_difference_does_to_the_true_boat() -> None:
    """She turns to starboard, as K says; the heading lost until then is K T."""
    found = nomoto(boat(truth()), CERTAIN)
    assert found.ship.held == pytest.approx(CRUISE, rel=1e-6)
    order = STEP
    r = sailed(lambda *_: order, 60.0)[:, 0] / order
    assert r[-1] == pytest.approx(found.values["K"], rel=1e-3)
    assert float(np.sum(r[-1] - r)) * H / r[-1] == pytest.approx(found.values["T"], rel=0.03)
    T1, T2, T3 = (found.values[n] for n in ("T1", "T2", "T3"))
    assert pytest.approx(found.values["T"], rel=1e-6) == T1 + T2 - T3 + otter.LAG
    other = nomoto(boat(truth().with_values({"k_ahead": 2.0 * otter.AHEAD})), CERTAIN)
    assert other.ship.held == pytest.approx(CRUISE / np.sqrt(2.0), rel=1e-6)
    assert other.values["K"] == pytest.approx(np.sqrt(2.0) * found.values["K"], rel=1e-6)


@pytest.mark.parametrize("gains", [rate_gains, heading_gains])
def test_promises_are_kept_by_the_true_boat(gains, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("trialid.design.steering.gains.NUMBER", 10)
    made = gains(boat(truth()), CERTAIN)
    overshoot, settling = stepped(made.values, 80.0)
    assert overshoot == pytest.approx(made.promise.fitted.overshoot, abs=SMALL)
    assert settling == pytest.approx(made.promise.fitted.settling, rel=0.05)
    assert min(made.values.values()) > 0.0


def moved(**places: float) -> ShipModel:
    """The boat with thrusters elsewhere to the side [m]."""
    base = truth()
    ones = tuple(replace(a, y=places.get(a.name, a.y)) for a in base.ship.actuators)
    return replace(base, ship=replace(base.ship, actuators=ones))


def test_a_thruster_that_may_be_late_steers_as_before() -> None:
    """What may be missing reads order and drive: no gains were to be had of such a boat."""
    late = actuator_effects(truth().ship, ("left", "right"))["left_late"]
    ship = boat((truth() - "thrusters_lag" + late).with_values({"tau_left": 0.5}))
    assert {"left", "left_order"} <= {*ship.simulator.equations.inputs}
    found = steered_by(ship)
    assert found.inputs == {"left": 1.0, "left_order": 1.0, "right": -1.0}
    assert found.states == {"left": 1.0, "right": -1.0}


def test_what_does_not_steer_so_is_refused() -> None:
    """Both on one side, one of another command, a speed that is given; sides are by place."""
    assert [*steered_by(boat(truth())).inputs] == ["left_order", "right_order"]
    swapped = steered_by(boat(moved(left=0.4, right=-0.4)))
    assert [*swapped.inputs] == ["right_order", "left_order"]
    for wrong in (moved(left=0.2), moved(right=0.0)):
        with pytest.raises(DesignError, match=r"one to port .* inputs (left|right)_order"):
            steered_by(boat(wrong))
    one = replace(truth().ship.actuators[0], command="thrust", own=True)
    ship = replace(truth().ship, actuators=(one, truth().ship.actuators[1]))
    with pytest.raises(DesignError, match="two thrusters alike"):
        steered_by(boat(replace(truth(), ship=ship)))
    given = replace(truth(), states=("v", "r"))
    with pytest.raises(DesignError, match="put u among its states"):
        nomoto(boat(given), CERTAIN)


@one_thread
def kept(seed: int) -> list[tuple[bool, bool]]:
    """Whether overshoot and settling of the true boat are as promised, by either gains."""
    fit = fitted(record(seed, duration=45.0))
    spread = spread_of(fit, {n: CANDIDATES[n] for n in MISSING})
    found = []
    for gains in (rate_gains, heading_gains):
        made = gains(ready_ship(fit), spread)
        low, high = made.promise.ranges["settling"]
        overshoot, settling = stepped(made.values, 1.2 * high)
        sooner, later = low * (1.0 - NEAR), high * (1.0 + NEAR)
        low, high = made.promise.ranges["overshoot"]
        near = low - SMALL < overshoot < high + SMALL
        found.append((near, sooner < settling < later))
    return found


@pytest.mark.study(turn="each")
def test_a_true_boat_is_steered_as_promised() -> None:
    """Nine of ten times at the least, of 50 records: by rate and heading, overshoot, settling."""
    found = np.array([kept(seed) for seed in range(FIRST, FIRST + DRAWS)])
    shares = found.mean(axis=0)
    print(f"otter: overshoot, settling {shares.round(2).tolist()} of {DRAWS} records")
    assert shares.min() >= 0.9
