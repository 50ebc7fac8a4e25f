"""What has no name however much it takes off: a sensor at its end, unseen wind beside the ship."""

from types import SimpleNamespace

import pytest
from made_up_fits import BEFORE
from s175q import MODEL, zigzag
from test_refit import ALIKE, LESS, refit

from trialid.diagnosis.found_values import by_heading, no_wind, sweeps_away
from trialid.diagnosis.objections import likeliest_refit, objection
from trialid.diagnosis.search.carried import Carried
from trialid.diagnosis.search.rivals import rivals
from trialid.effects import CATALOGUE
from trialid.ship.effect import Lagged, Steered


@pytest.mark.parametrize(("name", "named"), [("force", True), ("lag", False)])
def test_a_sensor_at_the_end_of_what_is_possible_has_no_name(name, named):
    """A coefficient of the ship may be there."""
    old, new = refit(name, BEFORE, LESS)
    assert objection(old, new, 0.05) == ""
    new.fit.at_bounds = {"a": -0.005}
    assert (objection(old, new, 0.05) == "") is named


def test_only_what_nobody_recorded_is_by_the_heading_alone():
    """What takes a record beside the heading is of a wind or a tug that was measured.

    A compass that deviates is counted with what nobody recorded: it goes by the heading alone, too.
    """
    found = {name for name, effect in CATALOGUE.items() if by_heading(effect)}
    unseen = {"current_in_sway", "current_in_surge", "current_in_speed_record"}
    assert found == {"steady_wind", "compass_deviation", *unseen}
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


@pytest.mark.parametrize(
    ("north", "ends", "none"),
    [(0.003, {}, False), (0.007, {}, True), (0.003, {"x_wind": -0.3}, True)],
)
def test_no_trial_is_sailed_in_a_hurricane_nor_wind_felt_at_one_end(north, ends, none):
    """At 7.33 m/s: 0.003 is 25 m/s on a fifth of her length squared, 0.007 is 39."""
    effect = CATALOGUE["steady_wind"]
    found = {"F_N": north, "F_E": 0.0, "x_wind": -0.3, "z_wind": 0.1}
    fit = SimpleNamespace(model=MODEL, estimates=found, at_bounds=ends)
    assert no_wind(effect, fit) is none
    assert not no_wind(CATALOGUE["yaw_cubic_rrr"], fit)


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


@pytest.mark.parametrize(
    ("more", "alike", "named"),
    [(30.0, ("force",), "force"), (6.0, ("force",), "lag"), (30.0, (), "lag")],
)
def test_a_sensor_gives_way_to_its_twin_of_the_ship_that_stands_out_more(more, alike, named):
    """Although blocks prefer the sensor, all of them."""
    old, lag = refit("lag", BEFORE, tuple(0.6 * x for x in BEFORE), alike=alike)
    force = refit("force", BEFORE, LESS, score=lag.candidate.score + more)[1]
    assert likeliest_refit(old, [lag, force], 0.05).candidate.effect.name == named
    assert likeliest_refit(old, [lag], 0.05) is lag


@pytest.mark.parametrize(("form", "check"), [(Steered, 0.15), (Lagged, 0.21)])
def test_a_gear_keeps_its_name_beside_its_twin_and_a_sensor_beside_one_that_is_denied(form, check):
    """Of a tanker with a dead band a cubic rudder stood out more, and held-out trials deny it."""
    old, mine = refit("lag", BEFORE, tuple(0.6 * x for x in BEFORE), alike=("force",))
    mine.candidate.effect.forms = (form,)
    force = refit("force", BEFORE, LESS, score=100.0, check=(0.2, check))[1]
    assert likeliest_refit(old, [mine, force], 0.05) is mine


@pytest.mark.parametrize(("most", "named"), [(3.0, True), (0.97, False)])
def test_wind_does_not_give_way_to_what_blocks_only_cannot_tell_from_it(most, named):
    """Of a ferry in wind terms of sway took a third off five blocks and trebled the sixth."""
    old, wind = refit("unseen wind", BEFORE, tuple(0.3 * x for x in BEFORE))
    after = (*(0.2 * x for x in BEFORE[:5]), most)
    hers = refit("force", BEFORE, after, p_value=0.5)[1]
    assert (likeliest_refit(old, [wind, hers], 0.05) is wind) is named


@pytest.mark.parametrize(("share", "first"), [(0.9, "plain"), (0.62, "sure")])
def test_what_stands_out_comes_first_where_it_does_as_much(share, first):
    """By blocks that scatter a fifth of the fall looks as good as all of it."""
    after = (*(0.35 * x for x in BEFORE[:4]), *(1.05 * x for x in BEFORE[4:]))
    old, plain = refit("plain", BEFORE, after, p_value=0.4)
    sure = refit("sure", BEFORE, tuple(share * x for x in BEFORE))[1]
    assert likeliest_refit(old, [plain, sure], 0.05).candidate.effect.name == first


@pytest.mark.parametrize(("whole", "falls"), [(1.25, False), (1.01, True)])
def test_nothing_falls_where_the_whole_rises_and_one_output_alone_falls(whole, falls):
    own = BEFORE, tuple(0.8 * x for x in BEFORE)
    assert Carried(BEFORE, tuple(whole * x for x in BEFORE), own=own).falls is falls


@pytest.mark.parametrize(
    ("ratio", "hers", "as_well"),
    [
        (0.75, ("v", "r"), ("twin",)),
        (0.9, ("v", "r"), ()),
        (0.75, ("psi",), ()),
    ],
)
def test_a_sensor_is_not_told_from_its_twin_of_the_ship_that_does_half_of_it(ratio, hers, as_well):
    """A twin by the heading, as of a current, is not hers."""
    lag = refit("lag", BEFORE, tuple(0.6 * x for x in BEFORE), alike=("twin",))[1]
    twin = refit("twin", BEFORE, tuple(ratio * x for x in BEFORE))[1]
    twin.candidate.effect.signals = hers
    for one in (lag, twin):
        one.candidate.carried = one.carried
        one.candidate.effect.bound_by_meaning = False
    assert rivals(lag, [lag.candidate, twin.candidate], [lag, twin]) == as_well
