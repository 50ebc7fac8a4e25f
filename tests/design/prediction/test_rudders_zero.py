"""What a prediction takes of the rudder's zero, which each fitted trial has for itself."""

from dataclasses import replace

import numpy as np
import pytest
import s175q
from typical import spread_of

from trialid.design.following import measures_within, sailed_ship, vessel_of
from trialid.design.prediction.drawn_ships import draw_ships
from trialid.design.prediction.rudders_zero import OFFSET, OfUnknowns, extend_by_zero
from trialid.design.standard import predict
from trialid.effects import CATALOGUE
from trialid.identification.fit import Fit, identify
from trialid.identification.problem import Settings
from trialid.simulation.integrate import prepare, respond

D = np.deg2rad(1.0)
ANGLES = (5, 10, 20)
ASKED = Settings(("Nr", "Nv", "Ndelta"), s175q.OUTPUTS, nuisance=("initial_state", "rudder_offset"))


def fitted(zeros: tuple[float, ...], model=s175q.MODEL) -> Fit:
    """Zig-zags of a ship whose rudder stands that far off its record in each."""
    trials = []
    for i, (angle, zero) in enumerate(zip(ANGLES, zeros, strict=True)):
        blank = s175q.zigzag(angle)
        moved = {**blank.signals, "delta": blank.signals["delta"] + zero}
        simulator = prepare(s175q.MODEL, (), s175q.OUTPUTS)
        true = replace(blank, signals=moved)
        y = respond(simulator, true, {}, {"u": 7.33}, sensitivities=False).y
        seen = replace(blank, signals={**blank.signals, "r": y[:, 0], "phi": y[:, 1]})
        trials.append(
            s175q.with_noise(seen, *s175q.white(np.random.default_rng([5, i]), blank.samples))
        )
    return identify(trials, model, ASKED)


@pytest.fixture(scope="module")
def off() -> Fit:
    return fitted((2.0 * D, 2.1 * D, 1.9 * D))


@pytest.fixture(scope="module")
def apart() -> Fit:
    return fitted((2.0 * D, -2.0 * D, 0.0))


def zero_of(spread) -> float:
    """How uncertain the ship's own zero is [rad]."""
    place = spread.fitted.index("delta_0")
    return float(np.sqrt(spread.covariance[place, place]))


def test_she_is_sailed_with_the_zero_that_her_trials_have_together(off: Fit) -> None:
    assert sailed_ship(off).model.value("delta_0") == pytest.approx(2.0 * D, rel=0.02)
    assert zero_of(spread_of(off, {})) == pytest.approx(np.sqrt(0.5) * 2.0 * D, rel=0.05)
    assert "rudder_offset" not in [e.name for e in off.model.effects]


def test_zeros_that_differ_leave_the_next_open_by_as_much(apart: Fit) -> None:
    assert abs(sailed_ship(apart).model.value("delta_0")) < 0.1 * D
    assert zero_of(spread_of(apart, {})) == pytest.approx(2.0 * D, rel=0.3)


def test_ranges_hold_her_by_the_recorded_rudder_and_by_the_true_one(off: Fit) -> None:
    """Which of them it is no record tells; what is predicted lies at the recorded one's."""
    found = measures_within(off, spread_of(off, {}))
    recorded = (s175q.MODEL + OFFSET).with_values({"delta_0": 2.0 * D})
    by_record, by_truth = (predict([vessel_of(off, m)]) for m in (recorded, s175q.MODEL))
    moved = 0
    for one, seen, true in zip(found, by_record, by_truth, strict=True):
        assert one.interval is not None
        low, high = one.interval
        assert low < seen.value < high, one.criterion.name
        assert low < true.value < high, one.criterion.name
        moved += abs(one.value - true.value) > 4.0 * abs(one.value - seen.value)
    assert moved >= 5


def test_ships_are_drawn_with_zeros_of_their_own(off: Fit) -> None:
    drawn = draw_ships(sailed_ship(off), spread_of(off, {}), 2000, 3).known["delta_0"]
    assert np.mean(drawn) == pytest.approx(2.0 * D, abs=0.15 * D)
    assert np.std(drawn) == pytest.approx(np.sqrt(0.5) * 2.0 * D, rel=0.1)


def test_what_may_be_missing_moves_the_ships_zero_with_her_trials(off: Fit) -> None:
    spread = spread_of(off, {"propeller_side_force": CATALOGUE["hull_asymmetry"]})
    moves = spread.standing.known.moves
    own = [i for i, n in enumerate(spread.fitted) if n.startswith("delta_0 [")]
    weights = off.of_all_trials["delta_0"].weights
    np.testing.assert_allclose(moves[spread.fitted.index("delta_0")], weights @ moves[own])
    assert np.any(moves[own] != 0.0)


def test_a_ship_whose_model_has_the_zero_has_it_once() -> None:
    own = fitted((D, D, D), (s175q.MODEL + OFFSET).with_values({"delta_0": D}))
    spread = spread_of(own, {})
    assert sailed_ship(own).model.value("delta_0") == D
    assert "delta_0" not in spread.fitted
    known = OfUnknowns(spread.fitted, spread.covariance, spread.standing)
    assert extend_by_zero(own, known) is known
