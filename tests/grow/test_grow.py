"""The loop that adds what is missing: where it goes and stops, in made-up worlds."""

import math
from types import SimpleNamespace
from typing import Any

import pytest
from world import STANDS_IN, candidate, changed, fit_in, loop, no_fit, steps, stub_all

from trialid.diagnosis.search.backward import worth_naming
from trialid.errors import SimulationError
from trialid.progress import silent
from trialid.workflow import addition_fit, grow


def test_it_goes_on_while_something_carries_over(monkeypatch: pytest.MonkeyPatch) -> None:
    done = loop(monkeypatch, {"": (0.10, None), "a": (0.08, None), "ab": (0.06, None)})
    assert steps(done) == ["+a", "+b"]
    assert [bool(s.end) for s in done] == [False, False, True]
    assert done[-1].end == "the verdict is `nothing missing`"
    assert grow.survivors(done) == ("a", "b")


def test_what_only_stood_in_for_another_is_dropped_and_not_tried_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    done = loop(monkeypatch, STANDS_IN)
    assert steps(done) == ["+x", "+a", "+b", "-x"]
    assert grow.survivors(done) == ("a", "b")
    assert done[-1].pipeline.effects == "ab"
    assert worth_naming(done[-1].worths) == ("a", "b")  # the dearest to leave out first


@pytest.mark.parametrize(("own", "left"), [(True, ["x", "limited"]), (False, ["x"])])
def test_a_gear_takes_the_place_of_another(own: bool, left: list[str]) -> None:
    """Of one that the loop added, and may go as that might; the file's own place is never empty."""
    path = grow._Path((), lambda words, share: None)
    servo, limited, other = (SimpleNamespace(name=n) for n in ("servo", "limited", "x"))
    for effect in (other, servo) if own else (other,):
        path.join(effect, ())  # type: ignore[arg-type]
    path.join(limited, ("servo",))  # type: ignore[arg-type]
    assert [e.name for e in path.own] == left


def test_what_held_out_trials_would_miss_is_not_dropped(monkeypatch: pytest.MonkeyPatch) -> None:
    world = {
        "": (0.10, 0.2), "x": (0.07, 0.16), "a": (0.08, 0.17), "ax": (0.0405, 0.1),
        "ab": (0.0392, 0.11), "abx": (0.0390, 0.09),
    }  # fmt: skip
    assert steps(loop(monkeypatch, world)) == ["+x", "+a", "+b"]


@pytest.mark.parametrize("worse", [0.2001, math.inf, math.nan])
def test_what_raises_the_held_out_error_is_never_kept(
    monkeypatch: pytest.MonkeyPatch, worse: float
) -> None:
    """However far the fitted error falls; the next best that does not is taken in its place."""
    done = loop(monkeypatch, {"": (0.10, 0.2), "a": (0.01, worse)})
    assert steps(done) == []
    done = loop(monkeypatch, {"": (0.10, 0.2), "a": (0.01, worse), "b": (0.09, 0.19)})
    assert steps(done) == ["+b"]
    held_out = [s.run.findings.before.fit.eps_check for s in done]
    assert held_out == sorted(held_out, reverse=True)


def test_what_cannot_be_fitted_from_the_file_is_told_and_the_next_tried(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    world = {"": (0.10, None), "a": (0.05, None), "b": (0.06, None)}
    broken = dict(world)

    def fit_of(recipe: Any, *_: Any) -> Any:
        if recipe.effects == "a":
            raise SimulationError("lost at t = 3 s")
        return fit_in(broken, recipe.effects)

    loop(monkeypatch, world)  # sets the stubs
    monkeypatch.setattr(addition_fit, "fit_of", fit_of)
    recipe = SimpleNamespace(effects="", diagnose=SimpleNamespace(level=0.05))
    done = list(grow.stages(recipe, lambda words, share: None))  # type: ignore[arg-type]
    assert steps(done) == ["!a", "+b"]
    del world["b"]
    done = list(grow.stages(recipe, lambda words, share: None))  # type: ignore[arg-type]
    assert (done[-1].kept, done[-1].end) == (False, "with a: lost at t = 3 s")


def test_a_model_whose_fit_carries_no_verdict_is_not_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    world: dict[str, tuple[float, float | None]] = {"": (0.10, None), "a": (0.05, None)}
    loop(monkeypatch, world)  # sets the stubs
    done = changed(monkeypatch, "a", no_fit)
    assert (done[-1].kept, done[-1].end) == (False, "with a: no fit: x")
    world["b"] = (0.06, None)
    assert steps(changed(monkeypatch, "a", no_fit)) == ["!a", "+b"]


def test_nor_is_anything_dropped_for_one(monkeypatch: pytest.MonkeyPatch) -> None:
    """What stands in for others stays where the model without it carries no verdict."""
    loop(monkeypatch, STANDS_IN)
    assert steps(changed(monkeypatch, "ab", no_fit)) == ["+x", "+a", "+b"]


def test_it_ends_at_twelve(monkeypatch: pytest.MonkeyPatch) -> None:
    letters = "abcdefghijklmnop"
    sets = (letters[:n] for n in range(len(letters) + 1))
    full = {s: (0.1 * 0.8 ** len(s), None) for s in sets}
    done = loop(monkeypatch, full | {
        letters[:n].replace(x, ""): (0.2 * 0.8**n, None)
        for n in range(1, len(letters)) for x in letters[: n - 1]
    })  # fmt: skip
    assert steps(done) == [f"+{x}" for x in letters[: grow.MOST]]
    assert "the most" in done[-1].end


def test_what_cannot_be_told_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    (only,) = loop(monkeypatch, {"": (0.1, None), "a": (0.0999, None)})
    assert only.end == "the verdict is `nothing missing`"
    assert only.kept


def test_what_the_file_without_it_foretells_worse_is_not_dropped(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Begun where its file begins, the model without it ends elsewhere: the effect stays."""
    assert steps(loop(monkeypatch, STANDS_IN)) == ["+x", "+a", "+b", "-x"]

    def worse(findings: Any) -> None:
        findings.before.fit.eps_check = 0.5

    assert steps(changed(monkeypatch, "ab", worse)) == ["+x", "+a", "+b"]


@pytest.mark.parametrize(
    ("errors", "troubles", "begun"),
    [
        ({"typical": 0.0503, "near": 0.05}, {}, "typical"),  # as good: no line more in the file
        ({"typical": 0.08, "near": 0.05}, {}, "near"),
        ({"typical": 0.08, "near": 0.08}, {}, "typical"),
        ({"typical": 0.08, "near": 0.05}, {"near": "it rises"}, "typical"),
        ({"typical": 0.04, "near": 0.05}, {"typical": "it rises"}, "near"),
        ({"typical": 0.08}, {}, "typical"),  # from near its end nothing can be fitted
        ({"typical": 0.08, "near": 0.08, "all": 0.05}, {"typical": "no", "near": "no"}, "all"),
        ({"typical": 0.08, "near": 0.07, "all": 0.05}, {}, "near"),  # nothing speaks against it
    ],
)
def test_what_was_promised_is_begun_near_its_end(monkeypatch, errors, troubles, begun):
    """By the refit the error falls to 5 %; from typical values the search ended above."""
    after, fit, trouble = added(monkeypatch, errors, troubles)
    assert after == fit.effects == begun
    assert not trouble


def test_what_her_file_would_deny_is_not_begun_by_coefficients_of_its_own(monkeypatch):
    """They would no longer be held against it."""
    errors = {"typical": 0.08, "near": 0.08, "all": 0.05}
    after, _, trouble = added(monkeypatch, errors, {"typical": "no", "near": "no"}, left=3.0)
    assert (after, trouble) == ("typical", "no")


def added(monkeypatch, errors, troubles, left=None):
    """The file's fit with an effect whose refit left 5 %, from each of its ways to begin."""
    world = {at: (error, None) for at, error in errors.items()}
    stubs = {
        "add_to_pipeline": lambda pipeline, name: SimpleNamespace(after="typical"),
        "started_at": lambda edit, values: SimpleNamespace(after="near"),
        "all_started_at": lambda near, values: "all",
        "left_by_file": lambda fit: left,
        "available": lambda pipeline: {},
        "fit_of": lambda at, *_: fit_in(world, at),
        "_trouble": lambda before, up, fit, level: troubles.get(fit.effects, ""),
    }
    stub_all(monkeypatch, stubs)
    found = SimpleNamespace(eps_rmsn=0.05, estimates={}, model=SimpleNamespace(values={}))
    up = SimpleNamespace(effects=(candidate("a").effect,), fit=found)
    pipeline: Any = SimpleNamespace(diagnose=SimpleNamespace(level=0.05))
    return addition_fit.fit_addition(pipeline, (), None, up, silent)
