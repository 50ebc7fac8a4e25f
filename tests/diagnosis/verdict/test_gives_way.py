"""What has no name however much it takes off: a sensor at its end, unseen wind beside the ship."""

from types import SimpleNamespace

import pytest
from made_up_fits import BEFORE
from s175q import MODEL, zigzag
from test_refit import ALIKE, LESS, refit

from trialid.diagnosis.found_values import by_heading, sweeps_away
from trialid.diagnosis.objections import likeliest_refit, objection
from trialid.effects import CATALOGUE


@pytest.mark.parametrize(("name", "named"), [("force", True), ("lag", False)])
def test_a_sensor_at_the_end_of_what_is_possible_has_no_name(name, named):
    """A coefficient of the ship may be there."""
    old, new = refit(name, BEFORE, LESS)
    assert objection(old, new, 0.05) == ""
    new.fit.at_bounds = {"a": -0.005}
    assert (objection(old, new, 0.05) == "") is named


def test_only_what_nobody_recorded_is_by_the_heading_alone():
    """What takes a record beside the heading is of a wind or a tug that was measured."""
    found = {name for name, effect in CATALOGUE.items() if by_heading(effect)}
    unseen = {"current_in_sway", "current_in_surge", "current_in_speed_record"}
    assert found == {"steady_wind", *unseen}
    assert not by_heading(SimpleNamespace(signals=("psi", "true_wind")))


@pytest.mark.parametrize(("north", "east", "swept"), [(5.0, 4.0, False), (6.0, -5.0, True)])
def test_no_trial_is_sailed_in_a_current_faster_than_the_ship(north, east, swept):
    """She goes 7.33 m/s; a wind is a force, and is none of it."""
    problem = SimpleNamespace(trials=[zigzag(10)])
    for name, counted in (("current_in_speed_record", True), ("steady_wind", False)):
        effect = CATALOGUE[name]
        found = dict(zip(effect.parameters, (north, east, 0.0, 0.0), strict=False))
        fit = SimpleNamespace(model=MODEL, problem=problem, estimates=found)
        assert sweeps_away(effect, fit) is (swept and counted)


def test_wind_that_nobody_recorded_gives_way_to_whatever_of_the_ship_does_as_much():
    """Also where that does not stand out; where hers does less, the wind has the name."""
    old, wind = refit("unseen wind", BEFORE, ALIKE)
    force = refit("force", BEFORE, LESS)[1]
    assert likeliest_refit(old, [wind, force], 0.05) is force
    hidden = refit("force", BEFORE, LESS)[1]
    hidden.candidate.shown = lambda level: False
    assert likeliest_refit(old, [wind, hidden], 0.05) is None
    weak = refit("force", BEFORE, tuple(0.9 * x for x in BEFORE))[1]
    assert likeliest_refit(old, [wind, weak], 0.05) is wind
    assert likeliest_refit(old, [wind], 0.05) is wind


@pytest.mark.parametrize(
    ("wind", "hers", "named"),
    [(0.12, 0.22, True), (0.12, 0.19, False), (0.196, 0.22, False)],
    ids=["denied", "borne out", "the wind hardly helps"],
)
def test_held_out_trials_tell_the_wind_from_what_they_deny(wind, hers, named):
    """By far: with a wind that takes next to nothing off they tell nothing."""
    old, blowing = refit("unseen wind", BEFORE, ALIKE, check=(0.2, wind))
    force = refit("force", BEFORE, LESS, check=(0.2, hers))[1]
    found = likeliest_refit(old, [blowing, force], 0.05)
    assert (found is blowing) is named
