import numpy as np
import pytest
from waters import VESSEL, D

from trialid.design import manoeuvres
from trialid.design.helm import Passage, carry_out
from trialid.design.imo import measures
from trialid.errors import DesignError
from trialid.trial import Trial


def circle(radius, speed, side=1.0, course=0.0):
    """A ship that turns on a circle at once, after 20 s straight ahead."""
    period = 0.5
    t = np.arange(0.0, 400.0, period)
    turned = np.maximum(t - 20.0, 0.0) * speed / radius
    psi = course + side * turned
    x = np.concatenate([[0.0], np.cumsum(period * speed * np.cos(psi[:-1]))])
    y = np.concatenate([[0.0], np.cumsum(period * speed * np.sin(psi[:-1]))])
    order = np.where(t >= 20.0, side * 0.6, 0.0)
    signals = {"psi": psi, "delta_order": order}
    return Passage(Trial("circle", "fit", period, signals, {}), x, y, None)


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("course", [0.0, 2.0])
def test_a_circle_by_hand(side, course):
    found = measures.turning(circle(250.0, 5.0, side, course))
    assert found["advance"] == pytest.approx(250.0, rel=0.01)
    assert found["transfer"] == pytest.approx(250.0, rel=0.01)
    assert found["tactical diameter"] == pytest.approx(500.0, rel=0.01)


def test_initial_turning_is_the_track_run():
    passage = circle(600.0, 5.0)
    assert measures.initial_turning(passage, 10 * D) == pytest.approx(600.0 * 10 * D, rel=0.01)


def test_a_turn_that_is_too_short():
    with pytest.raises(DesignError, match="tactical diameter needs 180 deg"):
        measures.turning(circle(5000.0, 5.0))
    with pytest.raises(DesignError, match="no rudder is ordered"):
        measures.turning(carry_out(VESSEL, iter(()), 0.0, 60.0))


def test_overshoots_of_a_zigzag():
    passage = carry_out(VESSEL, manoeuvres.zigzag(10 * D, 10 * D), 20.0, 600.0)
    found = measures.overshoots(passage)
    psi, order = (passage.trial.signals[n] for n in ("psi", "delta_order"))
    first = int(np.flatnonzero(order < 0)[0])
    then = first + int(np.flatnonzero(order[first:] > 0)[0])
    assert found[0] == pytest.approx(psi[first:then].max() - psi[first], abs=1e-4)
    assert 4 <= len(found) <= 6
    assert all(0.0 < x < 10 * D for x in found)


def test_the_criteria_grow_with_the_ships_time():
    """MSC.137(76), 5.3.3: 10 deg below 10 s, 20 deg above 30 s, a straight line between."""
    for length, speed, first, second in (
        (50.0, 10.0, 10.0, 25.0), (200.0, 10.0, 15.0, 32.5), (350.0, 10.0, 20.0, 40.0),
    ):  # fmt: skip
        table = {c.name: c for c in measures.criteria(length, speed)}
        assert table["first overshoot 10/10"].largest == pytest.approx(first)
        assert table["second overshoot 10/10"].largest == pytest.approx(second)
        assert table["advance"].largest == 4.5 * length
        assert table["tactical diameter"].largest == 5.0 * length
        assert table["initial turning"].largest == 2.5 * length


def test_the_overshoot_of_20_20_is_25_deg_at_most_for_any_ship():
    """MSC.137(76), 5.3.3.3."""
    for length, speed in ((50.0, 10.0), (350.0, 6.0)):
        table = {c.name: c for c in measures.criteria(length, speed)}
        assert table["first overshoot 20/20"].largest == 25.0
        assert table["first overshoot 20/20"].unit == "deg"


@pytest.mark.parametrize("place", [0.0, 0.3, 0.5])
def test_a_heading_that_turns_back_between_two_samples(place):
    """A parabola of 3 deg beyond the heading of the reversal, its top anywhere."""
    k = np.arange(120.0)
    psi = 3 * D * (1.0 - ((k - 60.0 - place) / 20.0) ** 2)
    begin = 60 + place - 20.0  # where it is zero
    order = np.where(k < begin, 10 * D, -10 * D)
    trial = Trial("z", "fit", 0.5, {"psi": psi, "delta_order": order}, {})
    at = int(np.ceil(begin))
    [found] = measures.overshoots(Passage(trial, 0 * k, 0 * k, None))
    assert found == pytest.approx(3 * D - psi[at], rel=1e-9)


def test_the_last_overshoot_ends_where_the_rudder_is_ordered_amidships():
    """Then she goes where she is left to: a ship that is carried round overshoots no further."""
    k = np.arange(200.0)
    order = np.where(k < 40, 10 * D, np.where(k < 100, -10 * D, 0.0))
    psi = 3 * D * (1.0 - ((k - 60.0) / 20.0) ** 2)
    psi[100:] = psi[100] + 2 * D * (k[100:] - 100)
    trial = Trial("z", "fit", 0.5, {"psi": psi, "delta_order": order}, {})
    assert measures.overshoots(Passage(trial, 0 * k, 0 * k, None)) == [pytest.approx(3 * D)]
