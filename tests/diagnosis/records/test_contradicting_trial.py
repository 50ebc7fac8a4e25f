"""A trial of another ship among those of one: nothing has a name before that is settled."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest
import s175q

from trialid.diagnosis.records import contradicting_trial as contradicting
from trialid.diagnosis.records.contradicting_trial import (
    Contradicting,
    contradicting_held_out,
    contradicting_trial,
    settle_held_out,
    settle_trials,
)
from trialid.diagnosis.records.left_without import falls_without
from trialid.diagnosis.verdict import Verdict
from trialid.identification.fit import Fit, identify
from trialid.trial import Trial

NAMED = Verdict("missing", "rudder_cubic", ("rudder_cubic",), "rudder_cubic is missing")
FREE = ("Nv", "Nr", "Ndelta", "Yv")
SETTINGS = replace(s175q.SETTINGS, free=FREE)
OTHER = {n: s175q.MODEL.value(n) * by for n, by in {"Nr": 1.4, "Ndelta": 0.6, "Nv": 0.8}.items()}
"""Another ship: she turns less for the same rudder."""
ANGLES = (2, 5, 10, 20)


def sailed(of_another: int = 0, held: int = 0, values: Mapping[str, float] = OTHER) -> list[Trial]:
    """Zig-zags of these angles [deg]; that of one by another ship, one of them held out."""
    rng, made = np.random.default_rng(17), []
    for angle in ANGLES:
        model = s175q.MODEL.with_values(values) if angle == of_another else s175q.MODEL
        trial = s175q.zigzag(angle, model, "check" if angle == held else "fit")
        made.append(s175q.with_noise(trial, *s175q.white(rng, trial.samples)))
    return made


def fitted(trials: list[Trial]) -> Fit:
    return identify(trials, s175q.MODEL, SETTINGS)


@pytest.fixture(scope="module")
def alike() -> Fit:
    return fitted(sailed(held=5))


@pytest.fixture(scope="module")
def one_apart() -> Fit:
    return fitted(sailed(of_another=10, held=5))


@pytest.fixture(scope="module")
def one_held_apart() -> Fit:
    return fitted(sailed(of_another=10, held=10))


def test_of_one_ship_none_contradicts(alike: Fit) -> None:
    assert max(falls_without(alike).values()) < 0.1
    assert contradicting_trial(alike) is None
    assert contradicting_held_out(alike) is None
    assert settle_trials(alike, NAMED, None) is NAMED
    assert settle_held_out(alike, NAMED, None) is NAMED


def test_the_trial_of_another_ship_is_found_and_nothing_named(one_apart: Fit) -> None:
    found = contradicting_trial(one_apart)
    assert found is not None
    assert found.trial == "zigzag-10"
    said = settle_trials(one_apart, NAMED, None)
    assert (said.kind, said.effect, said.family) == ("cannot tell", None, ())
    assert said.doubts == (found.sentence,)
    assert said.sentence.startswith("zigzag-10 contradicts the others: without it their squared")


def test_slopes_foretell_what_a_fit_without_it_finds(one_apart: Fit) -> None:
    falls = falls_without(one_apart)
    assert max(falls, key=lambda name: falls[name]) == "zigzag-10"
    found = contradicting_trial(one_apart)
    assert found is not None
    assert falls["zigzag-10"] == pytest.approx(found.fall, abs=0.03)
    assert found.fall_of_held is not None
    assert found.fall_of_held > 0.5


def test_where_those_held_out_are_of_the_other_ship_nobody_knows(one_apart: Fit) -> None:
    """Two and two: the others are followed better without it, and the one held out worse."""
    trials = [t for t in sailed(of_another=5, held=5) if t.name != "zigzag-10"]
    both = fitted([*trials, next(t for t in one_apart.trials if t.name == "zigzag-10")])
    assert falls_without(both)["zigzag-10"] > 0.5
    assert contradicting_trial(both) is None


def test_what_she_does_in_no_other_trial_contradicts_none() -> None:
    """The largest zig-zag may show what is missing, as no other does."""
    fit = fitted(sailed(of_another=20, held=5))
    assert falls_without(fit)["zigzag-20"] > 0.5
    assert contradicting_trial(fit) is None


def test_an_effect_that_does_as_much_keeps_its_name(one_apart: Fit, alike: Fit) -> None:
    assert settle_trials(one_apart, NAMED, alike) is NAMED
    assert settle_trials(one_apart, NAMED, one_apart).kind == "cannot tell"


@pytest.mark.study(turn="each")
def test_one_held_out_is_told_beside_the_name(one_held_apart: Fit) -> None:
    found = contradicting_held_out(one_held_apart)
    assert found is not None
    assert found.trial == "zigzag-10"
    said = settle_held_out(one_held_apart, NAMED, None)
    assert said == replace(NAMED, sentence=f"{NAMED.sentence}; {found.sentence}")
    nothing = Verdict("nothing missing", None, (), "no effect stands out")
    said = settle_held_out(one_held_apart, nothing, None)
    assert (said.kind, said.doubts) == ("cannot tell", (found.sentence,))
    failed = Verdict("no fit", None, (), "no fit: too short")
    assert settle_held_out(one_held_apart, failed, None) is failed


def test_one_that_is_followed_once_it_is_fitted_contradicts_none(
    one_held_apart: Fit, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What it teaches may be what the others do not."""
    learnt = fitted(sailed())
    found = Contradicting("zigzag-10", one_held_apart, learnt, held=True)
    assert not found.stays
    monkeypatch.setattr(contradicting, "_told", lambda fit, name: found)
    assert contradicting_held_out(one_held_apart) is None
