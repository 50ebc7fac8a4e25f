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
