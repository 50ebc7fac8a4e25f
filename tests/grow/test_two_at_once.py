"""The loop where no effect alone stands every check, and two together do."""

import math
from dataclasses import replace

import numpy as np
import pytest
from s175q import MODEL, SETTINGS, white, with_noise, zigzag
from world import changed, loop, no_fit, steps

from trialid.diagnosis.search.augment import augment
from trialid.diagnosis.search.carry_over import left_out
from trialid.diagnosis.search.together import _worth_a_fit
from trialid.effects import CATALOGUE
from trialid.identification.fit import identify
from trialid.workflow import grow

ALONE = {"": (0.10, 0.2), "a": (0.0999, 0.19), "b": (0.09, 0.21)}
"""One takes nothing off, the other makes trials held out worse."""


def test_two_join_at_once_where_none_does_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    done = loop(monkeypatch, ALONE | {"ab": (0.05, 0.1)})
    assert steps(done) == ["+a, b"]
    assert grow.survivors(done) == ("a", "b")
    assert grow.stage_row(done[1], grow.StepRow(step="as written")).joined == ("a", "b")


def test_and_others_after_them(monkeypatch: pytest.MonkeyPatch) -> None:
    done = loop(monkeypatch, ALONE | {"ab": (0.05, 0.1), "abc": (0.04, 0.09)})
    assert steps(done) == ["+a, b", "+c"]
    assert grow.survivors(done) == ("a", "b", "c")


@pytest.mark.parametrize("held_out", [0.199, 0.21, math.inf, math.nan])
def test_not_where_trials_held_out_gain_nothing(
    monkeypatch: pytest.MonkeyPatch, held_out: float
) -> None:
    (only,) = loop(monkeypatch, ALONE | {"ab": (0.05, held_out)})
    assert only.end == "the verdict is `nothing missing`"


def test_one_alone_comes_before_two(monkeypatch: pytest.MonkeyPatch) -> None:
    done = loop(monkeypatch, ALONE | {"c": (0.08, 0.19), "ab": (0.05, 0.1)})
    assert steps(done)[0] == "+c"


def test_what_failed_alone_may_join_with_another(monkeypatch: pytest.MonkeyPatch) -> None:
    world = ALONE | {"c": (0.08, 0.19), "bc": (0.05, 0.1)}
    loop(monkeypatch, world)
    assert steps(changed(monkeypatch, "c", no_fit)) == ["!c", "+b, c"]


def test_but_not_twice_as_a_pair(monkeypatch: pytest.MonkeyPatch) -> None:
    loop(monkeypatch, ALONE | {"ab": (0.05, 0.1)})
    assert steps(changed(monkeypatch, "ab", no_fit)) == ["!a, b"]


def test_of_two_one_that_is_worth_nothing_is_dropped_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Beside what came later."""
    world = {"ab": (0.05, 0.1), "abc": (0.03, 0.09), "ac": (0.0301, 0.089), "bc": (0.06, 0.15)}
    done = loop(monkeypatch, ALONE | world)
    assert steps(done) == ["+a, b", "+c", "-b"]
    assert grow.survivors(done) == ("a", "c")


@pytest.mark.study(turn="each")
def test_no_two_are_worth_a_fit_where_one_of_them_does_as_much():
    """Of a ship with a list the list takes half of it off, and so do the list and a damping."""
    truth = (MODEL + CATALOGUE["static_list"]).with_values({"Nrar": -0.0084, "a_0": 0.05})
    rng, made = np.random.default_rng(3), []
    for angle in (5, 10, 20):
        trial = zigzag(angle, truth)
        made.append(with_noise(trial, *white(rng, trial.samples)))
    fewer = replace(SETTINGS, free=tuple(n for n in SETTINGS.free if n != "Nrar"))
    fit = identify(made, MODEL - "yaw_drag_rar", fewer)
    tried = ("yaw_drag_rar", "static_list", "heel_yaw_modulus")
    seen = augment(fit, {n: CATALOGUE[n] for n in tried})
    blocks = left_out(seen.fit, seen.residual, seen.psi, seen.S, seen.stretches)
    columns = {t.effect.name: t.columns for t in seen.traces}
    both = blocks.carried((*columns["yaw_drag_rar"], *columns["static_list"]))
    assert both.large
    assert both.ratio < blocks.carried(columns["static_list"]).ratio < 0.6
    assert _worth_a_fit(seen) == []
