"""What speaks against a refit, and which of several is the best; on made-up fits."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from made_up_fits import BEFORE, fit

from trialid.diagnosis import objections
from trialid.diagnosis.best_refit import best_of
from trialid.diagnosis.objections import (
    AS_A_GEAR,
    AS_SLOW,
    HELD_OUT,
    SLIGHT,
    likeliest_refit,
    objection,
)
from trialid.diagnosis.search.carried import Carried
from trialid.diagnosis.search.falls import worse_held_out
from trialid.diagnosis.search.refit import Refit
from trialid.ship.effect import Force, Lagged
from trialid.trial import Trial

FORMS = ((Force,), (Lagged,))
"""Of an effect of the ship, and of a sensor."""

CHANCE = "chance would do it"


def refit(
    name,
    before,
    after,
    eps=(0.10, 0.08),
    check=(0.2, 0.15),
    seen=1.0,
    converged=True,
    p_value=0.001,
    score=50.0,
    alike=(),
):
    """A refit as far as its errors go, and the fit before it."""
    candidate = SimpleNamespace(
        effect=SimpleNamespace(
            name=name,
            parameters={"a": SimpleNamespace(unit="1", null=0.0)},
            states={},
            forms=FORMS[name == "lag"],
            held=None,
            acts_on=lambda *forms: ("r",),
            signals=("psi",) if name == "unseen wind" else ("v", "r"),
        ),
        shown=lambda level: level > 0.0,
        allowed=True,
        carried=SimpleNamespace(seen=seen),
        p_value=p_value,
        score=score,
        family=(name, *alike),
    )
    old, new = (fit(e, c) for e, c in zip(eps, check, strict=True))
    new.converged = converged
    return old, Refit(candidate, new, Carried(before, after, seen))


LESS = tuple(0.7 * x for x in BEFORE)
ALIKE = tuple(0.69 * x + 0.02 * (-1) ** i for i, x in enumerate(BEFORE))
"""A little less in all, and more in half of the blocks."""


@pytest.mark.parametrize(("changes", "words"), [
    ({}, ""),
    ({"check": (None, None)}, ""),
    ({"check": (np.inf, 0.2)}, ""),
    ({"check": (0.2, 0.2001)}, HELD_OUT),
    ({"check": (0.2, np.inf)}, HELD_OUT),
    ({"check": (0.2, np.nan)}, HELD_OUT),
    ({"check": (np.inf, np.inf)}, HELD_OUT),
    ({"converged": False}, "the search does not arrive"),
    ({"eps": (0.10, 0.0999)}, "the error hardly falls"),
    ({"eps": (0.10, 0.11)}, "the error hardly falls"),
    ({"eps": (0.10, np.nan)}, "the search does not arrive"),
])  # fmt: skip
def test_what_speaks_against_a_refit(changes, words):
    old, new = refit("a", BEFORE, LESS, **changes)
    assert objection(old, new, 0.05) == words
    assert worse_held_out(old, new.fit) is (words == HELD_OUT)
    turned_old, turned = refit("a", LESS, BEFORE)  # what it does not carry over
    assert objection(turned_old, turned, 0.05) == "the error hardly falls"
    assert objection(old, new, 0.0).startswith("chance")


@pytest.mark.parametrize(("found", "named"), [(-0.004, True), (-0.5, True), (0.003, False)])
def test_a_coefficient_that_turns_round_when_it_is_freed_has_no_name(found, named):
    old, new = refit("Yv", BEFORE, LESS)
    new.candidate.effect.held = -0.02
    new.candidate.effect.parameters = {
        "Yv": SimpleNamespace(low=-np.inf, high=0.0, unit="1", null=0.0)
    }
    new.fit.estimates = {"Yv": found}
    assert (objection(old, new, 0.05) == "") is named
    assert (likeliest_refit(old, [new], 0.05) is new) is named


def test_the_best_leaves_least_and_what_is_hardly_seen_gives_way_to_its_equal():
    force = refit("force", BEFORE, LESS)[1]
    lag = refit("lag", BEFORE, tuple(0.69 * x + 0.02 * (-1) ** i for i, x in enumerate(BEFORE)),
                seen=0.01)[1]  # fmt: skip
    assert lag.carried.ratio < force.carried.ratio
    assert best_of([lag, force], 0.05) is force
    assert best_of([replace(lag, carried=replace(lag.carried, seen=0.2)), force], 0.05) is not force
    far = refit("far", BEFORE, tuple(0.3 * x for x in BEFORE), seen=0.01)[1]
    assert best_of([far, force], 0.05) is far  # no equal: what it takes off is three times as much
    assert best_of([], 0.05) is None


def test_beside_effects_that_were_added_a_lag_gives_way_to_what_is_of_the_ship_and_as_good():
    force = refit("force", BEFORE, LESS)[1]
    lag = refit("lag", BEFORE, ALIKE)[1]
    assert best_of([force, lag], 0.05) is lag
    assert best_of([force, lag], 0.05, grown=True) is force
    better = refit("lag", BEFORE, tuple(0.5 * x for x in BEFORE))[1]
    assert best_of([force, better], 0.05, grown=True) is better


def lag_of(late, after):
    """A sensor so late [s], on a model of 3 m at 0.6 m/s."""
    old, new = refit("lag", BEFORE, after)
    new.candidate.effect.parameters = {"T_r": SimpleNamespace(unit="s", null=0.0)}
    ship = SimpleNamespace(particulars={"L": 3.0, "g": 9.81, "U0": 0.6})
    new.fit.model = SimpleNamespace(ship=ship, value=lambda name: {"T_r": late}[name])
    new.fit.problem.trials = (SimpleNamespace(signals={}),)
    old.model, old.problem, old.trials = new.fit.model, new.fit.problem, ()
    return old, new


@pytest.mark.parametrize(("late", "named"), [(0.3, "lag"), (0.7, "force"), (-5.0, "force")])
def test_a_sensor_as_slow_as_the_ship_gives_way_to_what_of_her_does_as_much(late, named):
    """The lag leaves less in all, and more in half of the blocks."""
    old, lag = lag_of(late, ALIKE)
    force = refit("force", BEFORE, LESS)[1]
    force.candidate.effect.parameters = {}
    assert likeliest_refit(old, [lag, force], 0.05).candidate.effect.name == named
    assert likeliest_refit(old, [lag], 0.05) is lag
    weak = refit("force", BEFORE, tuple(0.8 * x for x in BEFORE))[1]
    weak.candidate.effect.parameters = {}
    assert likeliest_refit(old, [lag, weak], 0.05) is lag  # it does less


def test_in_a_grown_model_any_sensor_gives_way_to_what_held_out_trials_alone_deny():
    """That the hull is another is known then; what chance denies and does as much will do, too."""
    old, lag = lag_of(0.3, ALIKE)
    denied = refit("force", BEFORE, LESS, check=(0.2, 0.21))[1]
    denied.candidate.effect.parameters = {}
    assert likeliest_refit(old, [lag, denied], 0.05) is lag
    assert likeliest_refit(old, [lag, denied], 0.05, grown=True) is None
    denied.candidate.shown = lambda level: False
    assert likeliest_refit(old, [lag, denied], 0.05) is lag
    assert likeliest_refit(old, [lag, denied], 0.05, grown=True) is None
    denied.candidate.allowed = False
    assert likeliest_refit(old, [lag, denied], 0.05, grown=True) is lag


def test_of_effects_as_good_the_one_that_held_out_trials_put_far_ahead_is_named():
    """But no sensor, nor one that takes only a little more off there."""
    old, drag = refit("drag", BEFORE, LESS, check=(0.2, 0.19))
    wind = refit("wind", BEFORE, LESS, check=(0.2, 0.12))[1]
    wind.candidate.p_value = 0.06  # of two as good this one does not stand out
    assert best_of([drag, wind], 0.05) is drag
    assert likeliest_refit(old, [drag, wind], 0.05) is wind
    slightly = refit("wind", BEFORE, LESS, check=(0.2, 0.185))[1]
    slightly.candidate.p_value = 0.06
    assert likeliest_refit(old, [drag, slightly], 0.05) is drag
    lag = refit("lag", BEFORE, LESS, check=(0.2, 0.12))[1]
    lag.candidate.p_value = 0.06
    assert likeliest_refit(old, [drag, lag], 0.05) is drag


@pytest.mark.parametrize(
    ("after", "eps", "allowed", "said"),
    [
        (tuple(0.05 * x for x in BEFORE), (0.1, 0.02), True, ""),
        (tuple(0.05 * x for x in BEFORE), (0.1, 0.08), True, CHANCE),  # little goes
        ((*LESS[:3], *BEFORE[3:]), (0.1, 0.02), True, CHANCE),  # half know nothing
        (tuple(0.05 * x for x in BEFORE), (0.1, 0.02), False, CHANCE),
    ],
)
def test_what_takes_most_off_once_it_is_fitted_is_there_whatever_its_slope_shows(
    after, eps, allowed, said
):
    """Of a boat with a weak thruster it took 0.95 of the squared error, and its slope none."""
    old, new = refit("weak", BEFORE, after, eps=eps)
    new.candidate.shown = lambda level: False
    new.candidate.allowed = allowed
    assert objection(old, new, 0.05) == said


def test_a_value_that_none_has_is_not_put_down_to_chance(monkeypatch: pytest.MonkeyPatch):
    """Of a boat in wind it was said of what took half of the error off, at p = 0.009."""
    old, new = refit("wind", BEFORE, LESS)
    assert objection(old, new, 0.05) == ""
    monkeypatch.setattr(objections, "NO_SUCH_VALUE", (lambda effect, fit: True,))
    assert objection(old, new, 0.05) == "no ship, sensor or trial has such a value"


def test_without_held_out_trials_none_is_put_ahead_by_what_it_takes_off_the_fitted():
    """There it would be by how many coefficients it has."""
    old, drag = refit("drag", BEFORE, LESS, eps=(0.2, 0.19), check=(None, None))
    shape = refit("shape", BEFORE, LESS, eps=(0.2, 0.12), check=(None, None))[1]
    shape.candidate.p_value = 0.06
    assert likeliest_refit(old, [drag, shape], 0.05) is drag


def test_what_takes_most_off_fitted_trials_does_not_give_way_to_the_held_out_ones():
    """Of a real tanker the race takes three quarters off the fitted zig-zags, a shape a third."""
    old, race = refit("race", BEFORE, LESS, eps=(0.2, 0.1), check=(0.2, 0.19))
    shape = refit("shape", BEFORE, LESS, eps=(0.2, 0.16), check=(0.2, 0.1))[1]
    shape.candidate.p_value = 0.06
    assert likeliest_refit(old, [race, shape], 0.05) is race


def test_no_sensor_is_late_where_the_rudder_jumps_but_its_record_may_be():
    """A gear that follows what is recorded is as late."""
    old, lag = lag_of(0.3, LESS)
    steps = np.deg2rad(10.0) * np.sign(np.sin(0.3 * np.arange(200.0)))
    known = {"delta": np.ones(200, dtype=bool)}
    old.trials = (Trial("z", "fit", 0.1, {"delta": steps}, known),)
    assert objection(old, lag, 0.05) == AS_A_GEAR
    lag.candidate.effect.acts_on = lambda *forms: ("delta",)
    assert objection(old, lag, 0.05) == ""
    force = refit("force", BEFORE, LESS)[1]
    assert objection(old, force, 0.05) == ""


def test_nor_is_it_named_where_held_out_trials_deny_what_of_the_ship_does_as_much():
    old, lag = lag_of(0.7, ALIKE)
    denied = refit("force", BEFORE, LESS, check=(0.2, 0.21))[1]
    denied.candidate.effect.parameters = {}
    assert likeliest_refit(old, [lag, denied], 0.05) is None
    lost = refit("force", BEFORE, LESS, converged=False)[1]
    lost.candidate.effect.parameters = {}
    assert likeliest_refit(old, [lag, lost], 0.05) is lag
    chance = refit("force", BEFORE, LESS)[1]
    chance.candidate.effect.parameters = {}
    chance.candidate.shown = lambda level: False
    assert likeliest_refit(old, [lag, chance], 0.05) is lag
    turned = refit("Yv", BEFORE, LESS)[1]
    turned.candidate.effect.held = -0.02
    turned.candidate.effect.parameters = {
        "Yv": SimpleNamespace(low=-np.inf, high=0.0, unit="1", null=0.0)
    }
    turned.fit.estimates = {"Yv": 0.003}
    assert likeliest_refit(old, [lag, turned], 0.05) is lag  # what has no name takes none away


@pytest.mark.parametrize(
    ("late", "words"), [(0.3, ""), (-0.3, ""), (0.7, AS_SLOW), (-5.0, AS_SLOW)]
)
def test_in_a_grown_model_a_sensor_as_slow_as_the_ship_is_not_told_from_her_memory(late, words):
    """A model of 3 m at 0.6 m/s: a tenth of her own time is half a second."""
    old, new = lag_of(late, LESS)
    assert objection(old, new, 0.05) == ""
    assert objection(old, new, 0.05, grown=True) == words
    new.candidate.effect.forms = (Force,)  # what is late in the ship is the ship's
    assert objection(old, new, 0.05, grown=True) == ""


def test_two_low_passes_behind_each_other_are_late_by_both():
    """0.3 s each; two of 0.49 s were named of a model in a basin, whose tenth of L/U is 0.61 s."""
    old, new = lag_of(0.3, LESS)
    new.candidate.effect.acts_on = lambda *forms: ("r", "r")
    assert objection(old, new, 0.05, grown=True) == AS_SLOW
    new.candidate.effect.acts_on = lambda *forms: ("r", "phi")  # two sensors, each as late
    assert objection(old, new, 0.05, grown=True) == ""


@pytest.mark.parametrize(
    ("ratio", "of_its_output", "words"),
    [
        (0.96, 0.96, SLIGHT),
        (0.945, 0.96, ""),  # a nineteenth more would be left without it
        (0.96, 0.945, ""),  # one output is enough
    ],
)
def test_what_joins_others_is_worth_a_twentieth(ratio, of_its_output, words):
    """By itself it is worth its name: what others lack in shape is mended by anything."""
    old, new = refit("a", BEFORE, tuple(ratio * x for x in BEFORE))
    new.candidate.effect.parameters = {}
    own = (BEFORE, tuple(of_its_output * x for x in BEFORE))
    new = replace(new, carried=replace(new.carried, own=own))
    assert objection(old, new, 0.05) == ""
    assert objection(old, new, 0.05, grown=True) == words


def test_where_no_trial_is_held_out_the_blocks_alone_tell():
    old, new = refit("a", BEFORE, LESS, check=(None, None))
    new.candidate.effect.parameters = {}
    assert objection(old, new, 0.05, grown=True) == ""
