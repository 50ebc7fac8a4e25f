"""A ship that goes round with her rudder well over tells its side, whatever correlates."""

import numpy as np
import pytest

from trialid.alignment.agreement.held_turn import held_turn
from trialid.alignment.agreement.signs import answer_of, check
from trialid.alignment.sources import SignalSource
from trialid.errors import AlignmentError
from trialid.trial import Trial

T = np.arange(0.0, 108.0, 0.75)
ALL = np.ones(len(T), bool)


def boat(side, rudder=21.0, rate=4.4, seed=1):
    """A boat that turns already when her log begins; rudder [deg] and rate [deg/s], with noise."""
    rng = np.random.default_rng(seed)
    delta = side * rudder + 0.2 * rng.standard_normal(len(T))
    return np.deg2rad(delta), np.deg2rad(rate + 0.3 * rng.standard_normal(len(T)))


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_turn_that_is_held_tells_the_side(side):
    delta, r = boat(side)
    assert answer_of(delta, r, ALL, 0.75).sign == 0.0
    found = held_turn(delta, r, ALL, 0.75)
    assert (found.sign, found.correlation) == (side, side)


def test_a_heading_that_is_held_between_its_samples_tells_it_too():
    """As of a receiver that is slower than the log: most of the slopes are zero."""
    delta, r = boat(-1.0)
    held = np.where(np.arange(len(T)) % 3 == 0, 3.0 * r, 0.0)
    assert held_turn(delta, held, ALL, 0.75).sign == -1.0


@pytest.mark.parametrize(
    ("change", "why"),
    [
        ({"rudder": 5.0}, "an unstable ship turns against so little"),
        ({"rate": 1.0}, "she does not go round"),
    ],
)
def test_less_tells_no_side(change, why):
    assert held_turn(*boat(1.0, **change), ALL, 0.75).sign == 0.0, why


def test_nor_does_a_rudder_that_goes_to_both_sides():
    delta, r = boat(1.0)
    assert held_turn(delta * np.sign(np.sin(T / 8.0)), r, ALL, 0.75).sign == 0.0
    assert held_turn(delta, 3.0 * r * np.sign(np.sin(T / 17.0)), ALL, 0.75).sign == 0.0


@pytest.mark.parametrize(("side", "refused"), [(1.0, False), (-1.0, True)])
def test_a_side_that_a_held_turn_denies_is_an_error_with_its_evidence(side, refused):
    delta, r = boat(side)
    trial = Trial("turn", "fit", 0.75, {"delta": delta, "r": r}, {"delta": ALL, "r": ALL})
    sources = {"delta": SignalSource("delta", "rudder", positive="starboard")}
    if refused:
        with pytest.raises(AlignmentError, match=r"turns the other way .* in a turn that it holds"):
            list(check(trial, sources, "trial 'turn'"))
    else:
        assert list(check(trial, sources, "trial 'turn'")) == [
            "delta and r, in a turn that it holds: correlation 1.00"
        ]
