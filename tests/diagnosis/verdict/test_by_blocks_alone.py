"""What no test against the noise shows: who explains most of the error is named, others are not."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from made_up_fits import NO_ROUTE, fit, refit

from trialid.diagnosis import diagnose
from trialid.diagnosis.diagnosed import DiagnoseSettings
from trialid.diagnosis.verdict import decide
from trialid.diagnosis.verdict_sentences import contradiction, significant_and_small
from trialid.progress import silent
from trialid.ship.effect import Delayed, Force, Lagged, Mass, Rate


def decided(fall, *, p_value, alike=(), other=None):
    """The verdict on two effects unlike each other in trace that do as well."""
    eps = 0.10 * np.sqrt(1.0 - fall)
    first = refit("a", 1.0 - fall, eps, family=alike)
    second = refit("b", 1.02 * (1.0 - fall), 1.001 * eps, wobble=0.1)
    first.candidate.p_value = p_value
    second.candidate.p_value = p_value if other is None else other
    if other is not None:  # wind that nobody recorded, which gives way to a hull
        first.candidate.effect.forms, second.candidate.effect.signals = (Force,), ("psi",)
    ranking = (first.candidate, second.candidate)
    return decide(fit(0.10), ranking, [first, second], NO_ROUTE, None, 0.05)


@pytest.mark.parametrize(
    ("fall", "p_value", "kind"),
    [(0.98, 1.0, "missing"), (0.45, 1.0, "cannot tell"), (0.45, 0.01, "missing")],
)
def test_of_effects_unlike_each_other_one_that_explains_most_is_named(fall, p_value, kind):
    found = decided(fall, p_value=p_value)
    assert found.kind == kind
    if kind == "cannot tell":
        assert "as well it may be b" in found.sentence
        assert "(p = 1 over the catalogue)" in found.sentence
    assert found.family == ("a", "b")


@pytest.mark.parametrize(("alike", "kind"), [((), "cannot tell"), (("b",), "missing")])
def test_what_alone_stands_out_is_not_put_behind_what_does_not(alike, kind):
    """Of a real boat wind stood out, p = 0.011, and an asymmetry with p = 1 had the name."""
    found = decided(0.65, p_value=1.0, other=0.011, alike=alike)
    assert found.kind == kind
    assert found.family == ("a", "b")
    said = "b stands out against the noise, a does not (p = 1 over the catalogue)"
    assert (said in found.sentence) == (kind == "cannot tell")
    assert decided(0.65, p_value=0.011, other=1.0).kind == "missing"


def test_of_several_of_which_one_is_missing_no_two_are_tried_at_once(monkeypatch):
    found = decided(0.45, p_value=1.0)
    tried, hulls = [], []
    monkeypatch.setattr(diagnose, "two_at_once", lambda *given: tried.append(given))
    monkeypatch.setattr(diagnose, "hull_at_once", lambda *given: hulls.append(given))
    monkeypatch.setattr(diagnose, "in_doubt", lambda fit: False)
    monkeypatch.setattr(diagnose, "why_no_fit", lambda fit: None)
    asked = DiagnoseSettings(candidates={})
    assert diagnose._or_of_several(fit(0.10), found, None, (), asked, silent) == (found, None)
    assert not tried
    assert not hulls
    none = replace(found, family=())
    diagnose._or_of_several(fit(0.10), none, None, (), asked, silent)
    assert len(tried) == len(hulls) == 1
    diagnose._or_of_several(fit(0.10), replace(none, effect="a"), None, (), asked, silent)
    assert len(tried) == len(hulls) == 1
    diagnose._or_of_several(fit(0.10), replace(none, held_as_well=("m",)), None, (), asked, silent)
    assert len(tried) == len(hulls) == 1
    nothing = replace(none, kind="nothing missing")
    assert diagnose._or_of_several(fit(0.10), nothing, None, (), asked, silent) == (nothing, None)
    assert (len(tried), len(hulls)) == (1, 2)


@pytest.mark.parametrize("kind", ["cannot tell", "not in catalogue", "nothing missing"])
def test_two_come_before_all_that_a_hull_has(monkeypatch, kind):
    """Where no two do it, or nothing seems missing, all at once are told with their names."""
    several = SimpleNamespace(names=("a", "b", "c"), fit=fit(0.02), alike=())
    pair = SimpleNamespace(**{**vars(several), "names": ("a", "b")})
    found = replace(decided(0.45, p_value=1.0), family=(), kind=kind)
    monkeypatch.setattr(diagnose, "in_doubt", lambda fit: False)
    monkeypatch.setattr(diagnose, "why_no_fit", lambda fit: None)
    monkeypatch.setattr(diagnose, "hull_at_once", lambda *given: several)
    monkeypatch.setattr(diagnose, "with_other_fault", lambda fit, found, *asked: found)
    asked = DiagnoseSettings(candidates={})
    for two in (pair, None):
        together = several if kind == "nothing missing" else two or several
        monkeypatch.setattr(diagnose, "two_at_once", lambda *given, two=two: two)
        said, there = diagnose._or_of_several(fit(0.10), found, None, (), asked, silent)
        assert (said.kind, said.effect, said.together) == ("cannot tell", None, together.names)
        assert there is together
        assert ("a, b and c together" in said.sentence) == (together is several)


def test_the_sentence_says_no_chance_that_was_not_shown():
    """`is missing (p = 1)` reads as a contradiction."""
    assert "p = 0.01 over the catalogue" in decided(0.98, p_value=0.01).sentence
    said = decided(0.98, p_value=1.0).sentence
    assert "p = " not in said
    assert "no test against the noise shows it" in said


@pytest.mark.parametrize(
    ("forms", "left", "kind"),
    [
        ((Rate, Force), 0.88, "cannot tell"),  # a gear with play, and a hull's force
        ((Delayed, Mass), 0.88, "cannot tell"),
        ((Rate, Force), 0.92, "missing"),  # the force leaves more where it was not fitted
        ((Rate, Force), 0.895, "missing"),  # or hardly less
        ((Delayed, Lagged), 0.88, "missing"),  # sensors both: which of them the family says
        ((Force, Force), 0.88, "missing"),
        ((Force, Delayed), 0.88, "missing"),
    ],
)
def test_what_is_no_force_has_no_name_where_a_force_carries_over_better(forms, left, kind):
    """A gear's play was named for a model on a pond, whose rudder is an order, in wind of no log.

    A third power of sway left 0.89 on blocks, the play 0.93; but against the noise it alone stood
    out, as it does of a gear that has it, and there it leaves less than every force.
    """
    first, second = refit("a", 0.90, 0.095), refit("b", left, 0.0951, wobble=0.1)
    for one, form in zip((first, second), forms, strict=True):
        one.candidate.effect.forms = (form,)
    ranking = (first.candidate, second.candidate)
    found = decide(fit(0.10), ranking, [first], NO_ROUTE, None, 0.05)
    assert (found.kind, found.family) == (kind, ("a", "b"))
    if kind == "cannot tell":
        assert "a, which is no force, stands out, but forces leave less" in found.sentence
        assert "as well it may be b" in found.sentence


def test_what_is_no_force_keeps_its_name_beside_a_force_alike_in_trace():
    """Twins are one family, whatever they are."""
    first = refit("a", 0.90, 0.095, family=("b",))
    second = refit("b", 0.88, 0.0951, wobble=0.1)
    first.candidate.effect.forms, second.candidate.effect.forms = (Delayed,), (Force,)
    ranking = (first.candidate, second.candidate)
    assert decide(fit(0.10), ranking, [first], NO_ROUTE, None, 0.05).effect == "a"


def test_those_alike_in_trace_are_one_family_whatever_they_explain():
    assert decided(0.45, p_value=1.0, alike=("b",)).kind == "missing"


@pytest.mark.parametrize(
    ("count", "begins"),
    [(3, "a is missing: with it the error"), (9, "one of 10 is missing, first of them a: with it")],
)
def test_a_name_with_many_as_good_is_said_to_be_the_first_of_them(count, begins):
    names = [f"other_{k}" for k in range(count)]
    first = refit("a", 0.5, 0.07, family=names)
    others = [refit(name, 0.51, 0.0701, wobble=0.1) for name in names]
    ranking = [one.candidate for one in (first, *others)]
    found = decide(fit(0.10), ranking, [first, *others], NO_ROUTE, None, 0.05)
    assert found.effect == "a"
    assert found.sentence.startswith(begins)


@pytest.mark.parametrize(
    ("own", "said"),
    [((), "by 10%, but"), (((1.0,) * 8, (0.7,) * 8), "by 30% of each output's own")],
)
def test_a_fall_that_held_out_trials_deny_is_that_of_the_output_that_shows_it(own, said):
    """Of a boat it was said to be 0 %: of the whole, where her rate alone fell."""
    found = refit("a", 0.9, 0.09, check=0.12)
    found = replace(found, carried=replace(found.carried, after=(0.9,) * 8, before=(1.0,) * 8))
    if own:
        found = replace(found, carried=replace(found.carried, own=own))
    assert said in contradiction(fit(0.10, 0.11), found)


@pytest.mark.parametrize(
    ("check", "means"),
    [(0.1101, "it does nothing there"), (0.115, "the trials contradict each other about it")],
)
def test_trials_that_hardly_become_worse_do_not_contradict(check, means):
    """`From 3.12% to 3.12%: the trials contradict each other` was said of an outsider's ship."""
    found = refit("a", 0.9, 0.09, check=check)
    assert contradiction(fit(0.10, 0.11), found).endswith(f": {means}")


@pytest.mark.parametrize(
    ("ratio", "said"), [(0.999, "is significant and small"), (3.65, "rises by")]
)
def test_what_stands_out_and_makes_others_worse_is_not_small(ratio, said):
    candidate = refit("a", ratio, 0.1).candidate
    assert said in significant_and_small([candidate])
    assert significant_and_small([]) == ""


def test_what_falls_in_few_blocks_is_not_small():
    candidate = refit("a", 0.97, 0.1, wobble=0.05).candidate
    assert not candidate.carried.in_most
    assert "falls in 3 of 6 blocks only" in significant_and_small([candidate])
