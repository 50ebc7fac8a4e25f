"""Made-up worlds for the loop: what each set of effects would leave, and the loop in them."""

from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from itertools import combinations
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from trialid.diagnosis.objections import likeliest_refit
from trialid.diagnosis.search.backward import Worth
from trialid.diagnosis.search.carried import Carried, Errors
from trialid.diagnosis.search.refit import Refit
from trialid.diagnosis.search.together import Together, stands
from trialid.errors import SimulationError
from trialid.ship.effect import Force
from trialid.workflow import addition_fit, grow
from trialid.workflow.edit_pipeline import Edit

World = Mapping[str, tuple[float, float | None]]
"""Effects in the model, letter by letter, to the error of the fitted and of the held-out trials."""

STANDS_IN: World = {
    "": (0.10, 0.2), "x": (0.07, 0.16), "a": (0.08, 0.17), "b": (0.085, 0.18),
    "ax": (0.060, 0.15), "bx": (0.065, 0.155), "ab": (0.040, 0.1), "abx": (0.0399, 0.1),
}  # fmt: skip
"""x stands in for a and b, and is worth nothing beside both."""

ERRORS = np.array([0.9, 1.1, 1.0, 0.95, 1.05, 1.0])
"""How unlike the blocks of time are."""


def fit_in(world: World, effects: str) -> Any:
    """A fit as far as its errors go; what the world does not hold cannot be fitted."""
    if effects not in world:
        raise SimulationError(f"lost with {effects} at t = 3 s")
    eps, check = world[effects]
    return SimpleNamespace(effects=effects, eps_rmsn=eps, eps_check=check, converged=True,
                           at_bounds={}, eps_by_output={"r": eps}, eps_check_by_output={},
                           model=SimpleNamespace(values={}, displaced_by=lambda effect: ()),
                           problem=SimpleNamespace(weights=np.ones(1), unknowns=()),
                           theta=np.zeros(0))  # fmt: skip


def with_(effects: str, more: str) -> str:
    return "".join(sorted(effects + more))


def own_errors(fit: Any, times: float = 1.0) -> Errors:
    errors = tuple(times * fit.eps_rmsn**2 * ERRORS)
    return Errors(errors, errors)


def carried_between(before: Any, after: Any, *_: Any) -> Carried:
    return Carried.between(own_errors(before), own_errors(after))


def candidate(name: str) -> Any:
    return SimpleNamespace(
        effect=SimpleNamespace(
            name=name, parameters={name: SimpleNamespace(unit="1", null=0.0)}, states={},
            forms=(Force,), held=None, signals=(),
        ),
        family=(name,), p_value=0.001,
        shown=lambda level: True, carried=SimpleNamespace(seen=1.0),
    )  # fmt: skip


def pairs_in(world: World, fit: Any) -> Iterator[Together]:
    """Two effects at once, wherever the world holds both together."""
    for names in combinations(sorted(set("".join(world)) - set(fit.effects)), 2):
        with suppress(SimulationError):
            new = fit_in(world, with_(fit.effects, "".join(names)))
            carried = carried_between(fit, new)
            effects = tuple(candidate(name).effect for name in names)
            if stands(fit, found := Together(effects, new, carried)):
                yield found


def found_in(world: World, fit: Any, grown: bool) -> Any:
    """What a run would find: every refit there is, and the verdict on them."""
    refits = []
    for name in sorted(set("".join(world)) - set(fit.effects)):
        with suppress(SimulationError):
            new = fit_in(world, with_(fit.effects, name))
            found = carried_between(fit, new)
            refits.append(Refit(candidate(name), new, found))
    named = likeliest_refit(fit, refits, 0.05)
    pair = next(pairs_in(world, fit), None)
    effect = named.candidate.effect.name if named else None
    kind = "missing" if named else "cannot tell" if pair else "nothing missing"
    return SimpleNamespace(
        before=SimpleNamespace(fit=fit), refits=tuple(refits),
        ranking=tuple(r.candidate for r in refits),
        verdict=SimpleNamespace(kind=kind, effect=effect, held_as_well=()), together=pair,
    )  # fmt: skip


def stub_all(monkeypatch: pytest.MonkeyPatch, stubs: Mapping[str, Any]) -> None:
    """Set each stub in the loop and in the fit of what joins, wherever its name is used."""
    for name, stub in stubs.items():
        for where in (grow, addition_fit):
            if hasattr(where, name):
                monkeypatch.setattr(where, name, stub)


def loop(monkeypatch: pytest.MonkeyPatch, world: World) -> list[grow.Stage]:
    """The stages of the loop in a world, from the model without any effect."""

    def recipe(effects: str) -> Any:
        return SimpleNamespace(
            effects=effects,
            diagnose=SimpleNamespace(level=0.05),
            model=SimpleNamespace(effects=effects),
            identify=SimpleNamespace(free=()),
        )

    def examine(asked: Any, *_: Any, grown: bool = False) -> Any:
        fit = next((x for x in _ if hasattr(x, "eps_rmsn")), None) or fit_in(world, asked.effects)
        return SimpleNamespace(pipeline=asked, findings=found_in(world, fit, grown))

    def edit(step: str, asked: Any, name: str, effects: str) -> Any:
        effect = SimpleNamespace(name=name, parameters={name: None})
        return Edit(step, effect, asked, recipe(effects))  # type: ignore[arg-type]

    def worths(
        fit: Any, trials: Any, own: Any, kin: Any = None, known: Any = ()
    ) -> tuple[Worth, ...]:
        made = []
        for effect in own:
            rest = fit.effects.replace(effect.name, "")
            less = fit_in(world, rest) if rest in world else None
            before = own_errors(less) if less else own_errors(fit, times=100.0)
            found = Carried.between(before, own_errors(fit))
            made.append(Worth(effect.name, (effect.name,), less, found))
        return tuple(sorted(made, key=lambda w: -w.costs))

    stubs = {
        "align_trials": lambda *_: (), "available": lambda *_: {}, "examine": examine,
        "add_to_pipeline": lambda r, n: edit("added", r, n, with_(r.effects, n)),
        "free_in_pipeline": lambda r, names: recipe(with_(r.effects, "".join(names))),
        "drop_from_pipeline": lambda r, n: edit("dropped", r, n, r.effects.replace(n, "")),
        "started_at": lambda *_: None, "fit_of": lambda r, *_: fit_in(world, r.effects),
        "carried_between": carried_between, "worths": worths,
    }  # fmt: skip
    stub_all(monkeypatch, stubs)
    return list(grow.stages(recipe(""), lambda words, share: None))


def changed(
    monkeypatch: pytest.MonkeyPatch, of: str, change: Callable[[Any], None], priors: Any = None
) -> list[grow.Stage]:
    """The loop once more, where what is found of a model with these effects is changed."""
    usual = grow.examine

    def examine(asked: Any, *more: Any, **words: Any) -> Any:
        run = usual(asked, *more, **words)
        if asked.effects == of:
            change(run.findings)
        return run

    monkeypatch.setattr(grow, "examine", examine)
    identify = SimpleNamespace(free=(), priors=priors)
    diagnose = SimpleNamespace(level=0.05)
    recipe = SimpleNamespace(effects="", diagnose=diagnose, identify=identify)
    return list(grow.stages(recipe, lambda words, share: None))  # type: ignore[arg-type]


def no_fit(findings: Any) -> None:
    findings.verdict = SimpleNamespace(
        kind="no fit", effect=None, sentence="no fit: x", held_as_well=()
    )


def steps(done: list[grow.Stage]) -> list[str]:
    """What was added, dropped, or tried and not kept."""
    return [
        f"-{s.dropped}" if s.dropped else f"+{s.added}" if s.kept else f"!{s.added}"
        for s in done[1:]
    ]
