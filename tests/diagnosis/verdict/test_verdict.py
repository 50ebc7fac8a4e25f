"""Which of several refits is named, on made-up fits: the gates, each from both sides."""

from dataclasses import replace

import numpy as np
import pytest
from made_up_fits import BEFORE, NO_ROUTE, fit, refit, split

from trialid.diagnosis import left_out_motion
from trialid.diagnosis.best_refit import best_of
from trialid.diagnosis.left_out_motion import with_motion
from trialid.diagnosis.noise.error_parts import Split
from trialid.diagnosis.objections import NOT_ARRIVED
from trialid.diagnosis.search.carried import Carried, as_good
from trialid.diagnosis.search.completeness import Completeness, _Search
from trialid.diagnosis.search.refit import Refit
from trialid.diagnosis.search.rivals import rivals, to_fit
from trialid.diagnosis.verdict import Verdict, decide
from trialid.ship.effect import Force


@pytest.mark.parametrize(
    ("eps", "kind"),
    [
        (0.10 * np.sqrt(0.80), "missing"),
        (0.10 * np.sqrt(0.89), "missing"),  # 0.11 of 0.84 that are not noise
        (0.10 * np.sqrt(0.92), "not in catalogue"),
    ],
)
def test_what_is_named_explains_an_eighth_of_what_is_not_noise(eps, kind):
    """An error of 10 % with 4 % of noise in it: 84 % of its square are the model's."""
    named = refit("a", 0.7, eps)
    found = decide(fit(0.10), (), [named], split(0.04), None, 0.05)
    assert found.kind == kind
    assert found.effect == ("a" if kind == "missing" else None)
    alone = decide(fit(0.10), (), [named], Split("not separable", "no route"), None, 0.05)
    assert alone.kind == "missing"  # of an unknown share nothing is asked
    bound = Split("not separable", "slopes of a model that lacks b", at_most=0.04)
    found = decide(fit(0.10), (), [named], bound, None, 0.05)
    assert found.kind == kind  # whatever the noise is, it is not more
    assert ("explains at most 10% of" in found.sentence) is (kind == "not in catalogue")


@pytest.mark.parametrize(
    ("ratio", "kind"), [(0.96, "cannot tell"), (0.92, "cannot tell"), (0.90, "missing")]
)
def test_beside_effects_that_were_added_a_name_costs_a_tenth(ratio, kind):
    named = refit("a", ratio, 0.08)
    found = [
        decide(fit(0.10), (), [named], split(0.04), None, 0.05, grown=g) for g in (True, False)
    ]
    assert [f.kind for f in found] == [kind, "missing"]
    assert ("may be a correction of their shape" in found[0].sentence) is (kind == "cannot tell")


def test_of_two_that_leave_as_much_the_one_of_fewer_parameters_is_taken():
    """One per cent of the squared error for each further one."""
    simple, many = refit("simple", 0.800, 0.08), refit("many", 0.790, 0.08, parameters=3)
    assert best_of([simple, many], 0.05) is simple
    assert best_of(
        [refit("more", 0.770, 0.08, parameters=3), simple], 0.05
    ).candidate.effect.name == ("more")


def test_what_held_out_trials_lose_by_is_not_named():
    named = refit("a", 0.7, 0.08, check=0.21)
    assert decide(fit(0.10, 0.20), (), [named], split(0.04), None, 0.05).kind == "cannot tell"
    lost = refit("a", 0.7, 0.08, check=np.inf)
    assert decide(fit(0.10, 0.20), (), [lost], split(0.04), None, 0.05).kind == "cannot tell"
    better = refit("a", 0.7, 0.08, check=0.19)
    assert decide(fit(0.10, 0.20), (), [better], split(0.04), None, 0.05).kind == "missing"


@pytest.mark.parametrize(
    ("eps", "check", "kind"),
    [
        (0.08, 0.2001, "cannot tell"),  # 36 % of the square, where the one with a name takes 3
        (0.094, 0.2001, "cannot tell"),  # 12 %
        (0.096, 0.2001, "missing"),  # 8 %: less than a tenth
        (0.08, np.inf, "cannot tell"),
        (0.08, 0.1999, "missing"),  # nothing is said against it, and it has the name
    ],
)
def test_who_explains_far_less_than_another_does_has_no_name(eps, check, kind):
    """Although held-out trials deny the other: what it does is no noise."""
    named = refit("small", 0.975, 0.0985, check=0.19)
    denied = refit("large", 0.74, eps, check=check)
    found = decide(fit(0.10, 0.20), (), [named, denied], NO_ROUTE, None, 0.05)
    assert found.kind == kind
    told, lost = kind == "cannot tell", check == np.inf  # nobody is sent to what is lost
    assert ("`trialid add PIPELINE large` and other" in found.sentence) is (told and not lost)
    assert ("other trials may tell" in found.sentence) is told


def test_a_tenth_more_is_not_far():
    """Twice as much is asked for, of what the one with a name takes off."""
    named = refit("small", 0.9, 0.0950, check=0.19)  # 10 % of the square
    denied = refit("large", 0.74, 0.0900, check=0.21)  # 19 %
    assert decide(fit(0.10, 0.20), (), [named, denied], NO_ROUTE, None, 0.05).effect == "small"


def test_what_nothing_denies_loses_by_what_it_carries():
    """It does more where it was fitted, and less where it was not."""
    named = refit("carries", 0.70, 0.0945, check=0.19)
    close = refit("close", 0.85, 0.08, check=0.19)
    assert decide(fit(0.10, 0.20), (), [named, close], NO_ROUTE, None, 0.05).effect == "carries"


def unfinished(name, ratio, eps, **given):
    """A refit whose search did not arrive."""
    found = refit(name, ratio, eps, **given)
    found.fit.converged = False
    return found


@pytest.mark.parametrize(
    ("other", "kind"),
    [
        (unfinished("b", 0.40, 0.06, check=0.15), "cannot tell"),
        (unfinished("b", 0.40, 0.06, check=0.21), "missing"),  # held-out trials speak against it
        (unfinished("b", 0.69, 0.079, check=0.15, wobble=0.5), "missing"),  # chance would do it
        (unfinished("b", 0.75, 0.085, check=0.15), "missing"),  # it leaves more
    ],
)
def test_what_leaves_less_takes_the_name_although_its_search_did_not_arrive(other, kind):
    named = refit("a", 0.7, 0.08, check=0.18)
    found = decide(fit(0.10, 0.20), (), [named, other], split(0.04), None, 0.05)
    assert (found.kind, found.effect) == (kind, "a" if kind == "missing" else None)
    if kind == "cannot tell":
        assert "with b the error falls from 10.00% to 6.00% although" in found.sentence
        assert "with a to 8.00%" in found.sentence


def test_rivals_explain_more_than_half_and_differ_by_no_more_than_chance():
    named = refit("named", 0.50, 0.07, family=("twin",))
    close = refit("close", 0.55, 0.07, wobble=0.3)  # its blocks disagree by more than it lags
    clear = refit("clear", 0.55, 0.07)
    weak = refit("weak", 0.75, 0.09, wobble=0.9)  # less than half of the fall
    every = [named, close, clear, weak]
    found = rivals(named, [r.candidate for r in every], every)
    assert found == ("close", "twin")


def test_blocks_that_agree_are_apart_although_one_holds_most_of_the_error():
    """A fault that fits against one that does not, six of six, one block ten times the others."""
    fits, fails = [0.27, 0.23, 0.26, 0.26, 0.26, 0.27], [1.03, 0.38, 1.55, 0.53, 0.66, 3.28]
    assert not as_good(fits, fails)
    assert as_good(fails, fits)
    assert as_good(fits, [*fits[:5], 3.28])  # one block alone may be chance


def test_six_blocks_of_six_agree_although_two_of_them_differ_by_far_more_than_four():
    """A weak screw against terms of another shape, which fit four blocks hardly worse."""
    weak = [2301.0, 2659.0, 2554.0, 2564.0, 2285.0, 2262.0]
    bent = [3484.0, 2956.0, 2725.0, 2770.0, 2475.0, 3768.0]
    assert not as_good(weak, bent)
    assert as_good(weak, [*bent[:3], 2500.0, *bent[4:]])  # five of six may be chance


def test_slopes_are_believed_where_that_of_the_named_effect_foretold_its_fall():
    by_slope = refit("by_slope", 0.55, 0.07, wobble=0.3)
    believed = refit("named", 0.50, 0.07, family=("twin",))
    ranking = [r.candidate for r in (believed, by_slope, refit("twin", 0.5, 0.07))]
    assert to_fit(believed, ranking, [believed], False) == ()
    assert rivals(believed, ranking, [believed]) == ("by_slope", "twin")
    fell = Carried(BEFORE, tuple(0.01 * x for x in BEFORE))  # and its slope says a half
    named = Refit(believed.candidate, believed.fit, fell)
    assert to_fit(named, ranking, [named], False) == (by_slope.candidate,)
    assert to_fit(named, ranking, [named, by_slope], False) == ()
    assert rivals(named, ranking, [named]) == ("twin",)


def test_in_a_grown_model_what_a_sensor_may_give_way_to_is_fitted():
    """Of the ship, and as good by its slope or alike in trace; another sensor is not."""
    sensor = refit("named", 0.50, 0.07, family=("twin",))
    others = [refit("by_slope", 0.55, 0.07, wobble=0.3), refit("twin", 0.5, 0.07)]
    ranking = [r.candidate for r in (sensor, *others)]
    for one in others:
        one.candidate.effect.forms = (Force,)
    assert to_fit(sensor, ranking, [sensor], True) == tuple(ranking[1:])
    assert to_fit(sensor, ranking, [sensor], False) == ()
    assert to_fit(sensor, ranking, [sensor, others[0]], True) == (others[1].candidate,)
    others[0].candidate.effect.forms = ()
    assert to_fit(sensor, ranking, [sensor], True) == (others[1].candidate,)
    sensor.candidate.effect.forms = (Force,)
    assert to_fit(sensor, ranking, [sensor], True) == ()


@pytest.mark.parametrize(("gap", "good"), [(1.5, True), (2.2, True), (2.7, False)])
def test_two_lists_differ_by_student_s_97_5_per_cent(gap, good):
    """Six blocks: 2.57 standard errors."""
    one = np.array(BEFORE)
    spread = np.array([1.0, -1.0, 1.0, -1.0, 1.0, -1.0])
    spread *= np.sqrt(6.0) / np.std(spread, ddof=1)
    other = one * np.exp(1e-3 * (gap + spread))
    assert bool(as_good(one, other)) is good


@pytest.mark.parametrize(
    ("catalogue", "any_shape", "gap"),
    [
        (5.0, 34.0, False),
        (5.0, 36.0, True),
        (300.0, 395.0, False),
        (300.0, 405.0, True),
    ],
)
def test_a_gap_is_of_thirty_and_of_a_quarter(catalogue, any_shape, gap):
    assert Completeness(catalogue, any_shape).gap is gap


def test_each_step_of_a_selection_pays_for_its_coefficient_and_for_the_search():
    """Independent columns, scores z: z^2 - ln N - 2 ln J for each of J that is worth it."""
    z = np.array([9.0, 7.0, 2.0, 6.5])
    rows = 1000
    search = _Search(np.eye(4), z, rows, 1.0)
    effects, forces = [(0,), (2,)], [(1,), (3,)]
    price = np.log(rows) + 2.0 * np.log(2.0)
    alone = z[0] ** 2 - price  # the other is not worth its price
    assert search.gain(effects, []) == pytest.approx(alone)
    both = alone + z[1] ** 2 + z[3] ** 2 - 2.0 * price
    assert search.gain(effects, forces) == pytest.approx(both)
    inflated = _Search(np.eye(4), z, rows, 2.0)
    assert inflated.gain([(0,)], []) == pytest.approx(z[0] ** 2 / 2.0 - np.log(rows))


def test_where_one_output_hides_another_the_error_of_that_one_is_told():
    """A roll known to 20 % beside a rate known to 2 %: of all outputs nobody would see it fall."""
    before = fit(0.142, 0.15)
    before.eps_by_output = {"r": 0.02, "phi": 0.20}
    before.eps_check_by_output = {"r": 0.025, "phi": 0.21}
    before.problem.weights = np.ones(2)
    named = refit("a", 0.999, 0.1419, check=0.15)
    named = replace(named, carried=replace(named.carried, own=(BEFORE, [0.95 * x for x in BEFORE])))
    named.fit.eps_by_output = {"r": 0.018, "phi": 0.20}
    named.fit.eps_check_by_output = {"r": 0.022, "phi": 0.21}
    found = decide(before, (), [named], Split("not separable", "no route"), None, 0.05)
    assert found.effect == "a"
    assert "the error of r falls from 2.00% to 1.80%, on held-out trials from 2.50% to 2.20%; " in (
        found.sentence
    )
    assert "of all outputs from 14.20% to 14.19%" in found.sentence


NAMED, SWAY = refit("a", 0.78, 0.08), refit("moves", 0.78, 0.08, stands_for="v")
SAID = Verdict("missing", "a", ("a", "b", "moves"), "a is missing")


def judged(monkeypatch, verdict: Verdict, beside: str, refits=(NAMED, SWAY)) -> Verdict:
    """The verdict where this speaks against the named effect in a model that has the motion."""
    before = fit(0.10)
    before.scores = ()
    monkeypatch.setattr(left_out_motion, "objection", lambda *_: beside)
    monkeypatch.setattr(left_out_motion, "refit", lambda *asked: [NAMED for _ in asked[1]])
    ranking = [NAMED.candidate, SWAY.candidate]
    return with_motion(before, verdict, ranking, refits, 0.05)


@pytest.mark.parametrize("refits", [(NAMED, SWAY), (NAMED,)])
def test_no_name_where_the_motion_does_as_well_and_leaves_nothing_to_name(monkeypatch, refits):
    found = judged(monkeypatch, SAID, "the error hardly falls", refits)
    assert (found.kind, found.effect, found.family) == ("cannot tell", None, ())
    assert "the sway speed that the model does not have" in found.sentence
    assert "record v, or `trialid add PIPELINE moves`" in found.sentence


def test_what_is_worth_a_name_beside_the_motion_keeps_it(monkeypatch):
    assert judged(monkeypatch, SAID, "") is SAID


def test_the_motion_itself_and_what_it_does_not_do_keep_their_names(monkeypatch):
    alone = replace(SAID, family=("a", "b"))
    itself = replace(SAID, effect="moves", family=("moves", "a"))
    nothing = Verdict("nothing missing", None, (), "")
    for said in (alone, itself, nothing):
        assert judged(monkeypatch, said, NOT_ARRIVED) is said


@pytest.mark.parametrize(
    ("ratio", "said"),
    [(0.7, "no effect that stands out stands every check, but noise"), (0.99, "no effect stands")],
)
def test_what_the_table_calls_standing_out_is_not_denied(ratio, said):
    """Its refit left as much as before, so that it has no name."""
    seen = refit("a", ratio, 0.10, check=0.2)
    found = decide(fit(0.10, 0.1), (seen.candidate,), [], NO_ROUTE, None, 0.05)
    assert found.sentence.startswith(said)
    assert found.kind == "cannot tell"
    little = decide(fit(0.004, 0.004), (seen.candidate,), [], NO_ROUTE, None, 0.05)
    assert little.sentence.startswith(said.partition(", but")[0])
