import numpy as np
import pytest
from waters import SPEED, VESSEL, D

from trialid.design import manoeuvres
from trialid.design.helm import carry_out
from trialid.design.limits import Limits, excesses

CIRCLE = carry_out(VESSEL, manoeuvres.turning_circle(20 * D), 20.0, 900.0)


def broken(**limits):
    return {e.limit: e for e in excesses(CIRCLE, Limits(**limits), SPEED)}


def test_nothing_is_broken_where_nothing_limits():
    assert broken() == {}
    generous = {"rudder": 20 * D, "heel": 1.0, "speed_loss": 0.9, "room": (1e5, 1e5, 1e5)}
    assert broken(**generous, duration=900.0) == {}


@pytest.mark.parametrize(
    ("limits", "name", "words"),
    [
        ({"rudder": 15 * D}, "rudder", "20 deg of rudder are ordered, 15 are allowed"),
        ({"heel": 2 * D}, "heel", "deg of heel are reached, 2 are allowed"),
        ({"speed_loss": 0.1}, "speed loss", "% of speed are lost, 10 are allowed"),
        ({"room": (300.0, 1e5, 1e5)}, "room ahead", "m are run ahead, 300 are allowed"),
        ({"room": (1e5, 300.0, 1e5)}, "room to the side", "m are run to the side, 300"),
        ({"duration": 600.0}, "duration", "it takes 900 s, 600 s are allowed"),
    ],
)
def test_each_limit_binds_with_its_figures(limits, name, words):
    found = broken(**limits)
    assert list(found) == [name]
    assert words in found[name].sentence
    assert found[name].share > 0.0


def test_when_it_is_passed():
    t = broken(heel=2 * D)["heel"].t
    heel = np.abs(CIRCLE.trial.signals["phi"])
    assert heel[round(t / 0.5)] > 2 * D >= heel[round(t / 0.5) - 1]


def test_the_worst_comes_first():
    found = list(excesses(CIRCLE, Limits(rudder=19 * D, heel=1 * D), SPEED))
    assert [e.limit for e in found] == ["heel", "rudder"]


def test_rolling_to_port_is_as_much_as_to_starboard():
    """A turn the other way heels to the other side, and is broken at the same angle."""
    other = carry_out(VESSEL, manoeuvres.turning_circle(-20 * D), 20.0, 900.0)
    found = [excesses(p, Limits(heel=2 * D), SPEED)[0] for p in (CIRCLE, other)]
    assert found[1].found == pytest.approx(found[0].found, rel=1e-6)
    assert CIRCLE.trial.signals["phi"][-1] * other.trial.signals["phi"][-1] < 0.0


def test_a_gear_that_runs_faster_than_it_may_is_seen():
    """Five degrees a second of the vessel's own gear, in a turn of a single order."""
    [found] = excesses(CIRCLE, Limits(rudder_rate=4 * D), SPEED)
    assert found.limit == "rudder rate"
    assert found.found == pytest.approx(5 * D, rel=1e-6)
    assert excesses(CIRCLE, Limits(rudder_rate=5.1 * D), SPEED) == ()


def test_room_astern_is_behind_where_she_began():
    """A circle comes back beyond its beginning only where she has slowed down; here she has not."""
    far = (1e5, 1e5)
    reach = float(-CIRCLE.x.min())
    assert [e.limit for e in excesses(CIRCLE, Limits(room=(*far, reach + 1.0)), SPEED)] == []
    turned = carry_out(VESSEL, manoeuvres.zigzag(20 * D, 170 * D), 0.0, 900.0)
    back = float(-turned.x.min())
    assert back > 50.0
    assert [e.limit for e in excesses(turned, Limits(room=(*far, back - 10.0)), SPEED)] == [
        "room astern"
    ]
    assert excesses(turned, Limits(room=(*far, back + 10.0)), SPEED) == ()
