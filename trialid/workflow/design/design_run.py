"""A design file carried out: tests sailed, rated and optimised, and rivals told apart."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from trialid.design import signals
from trialid.design.kinds import KINDS, Test, Value
from trialid.design.limits import Limits
from trialid.design.ordered_signals import late_orders
from trialid.design.rating import Goal
from trialid.design.search import Found, Outcome, Search, Ship, optimise, outcome, sail_all, score
from trialid.design.separation import Separation, likeness, rivals, separate
from trialid.effects.actuators.astern_gains import drives_astern, held_astern
from trialid.errors import DesignError, PipelineError, nearest
from trialid.identification.problem import Settings
from trialid.names.wording import named_together
from trialid.pipeline_file import where
from trialid.pipeline_file.design_file import DesignFile, Numbers, TestSection
from trialid.pipeline_file.finished_run import FinishedRun, finished_run
from trialid.ship.effect import Effect
from trialid.threads import one_thread
from trialid.workflow.build_model import available, settings_of
from trialid.workflow.design import design_imo
from trialid.workflow.design.design_ships import limits_of_design, ships_of_design

Progress = Callable[[str, float | None], None]


@dataclass(frozen=True)
class Rated:
    """One programme of tests on the ship as she is known: what came of it.

    `found` says how it was searched for, None where nothing was open.
    """

    name: str
    programme: tuple[Test, ...]
    outcome: Outcome
    found: Found | None
    remarks: tuple[str, ...]


@dataclass(frozen=True, kw_only=True)
class Plan:
    """What a design file asked for; `run` is the one that it builds on."""

    pipeline: DesignFile
    run: FinishedRun
    ship: Ship
    limits: Limits
    rated: tuple[Rated, ...]
    separation: Separation | None
    imo: design_imo.Imo | None

    @property
    def best(self) -> Rated | None:
        """Of the programmes that may run, the best by the criterion of the search."""
        able = [r for r in self.rated if r.outcome.rating is not None]
        return min(able, key=self._score, default=None)

    def _score(self, rated: Rated) -> float:
        assert rated.outcome.rating is not None
        return score(rated.outcome.rating, self.pipeline.search.criterion, self.ship.goal.wanted)


def largest_error(rated: Rated, goal: Goal) -> float:
    """Largest expected error of the wanted parameters, a share of each one's size."""
    assert rated.outcome.rating is not None
    return max(rated.outcome.rating.of(name).error for name in goal.wanted)


@one_thread
def plan(pipeline: DesignFile, progress: Progress = lambda words, share: None) -> Plan:
    """Carry out a design file.

    Raises
    ------
    PipelineError, DesignError, NotIdentifiable
        In one line: what cannot be done, and the limit that binds.
    """
    progress("making the ship ready", 0.0)
    catalogue = available(pipeline)
    ships = ships_of_design(pipeline, catalogue)
    limits = limits_of_design(pipeline, ships[0].vessel.model)
    separation = _separation(pipeline, catalogue, ships[0], limits, progress)
    chosen = {} if separation is None else {t.name: t for t in separation.programme}
    tests = tuple(chosen.get(t.name) or _test(pipeline, t) for t in pipeline.tests)
    programmes = [("programme", tests)] if pipeline.together else [(t.name, (t,)) for t in tests]
    rated = []
    for i, (name, programme) in enumerate(programmes):
        tell = _told(progress, name, i / len(programmes), pipeline.search.criterion)
        rated.append(_rated(pipeline, name, programme, ships, limits, tell))
    run = finished_run(pipeline)
    imo = design_imo.imo(ships, run) if pipeline.imo else None
    return Plan(
        pipeline=pipeline,
        run=run,
        ship=ships[0],
        limits=limits,
        rated=tuple(rated),
        separation=separation,
        imo=imo,
    )


BEST: Final[Mapping[str, tuple[str, Callable[[float], float]]]] = {
    "error": ("largest error", math.exp),
    "A": ("mean error", math.exp),
    "R": ("R", math.exp),
    "S_imin": ("least S_imin", lambda score: math.exp(-score)),
    "D": ("log volume", float),
    "separate": ("score", float),
}
"""What a search makes better, in words, and its value from the score."""


def _told(
    progress: Progress, name: str, share: float, criterion: str
) -> Callable[[int, float], None]:
    words, value = BEST[criterion]

    def tell(tried: int, best: float) -> None:
        shown = f", {words} {value(best):.3g}" if best < 100.0 else ""
        progress(f"{name}: {tried} candidates{shown}", share)

    return tell


def _rated(
    pipeline: DesignFile, name: str, tests: tuple[Test, ...], ships: list[Ship], limits: Limits,
    tell: Callable[[int, float], None],
) -> Rated:  # fmt: skip
    found = None
    r = pipeline.search
    search = Search(r.criterion, pipeline.ships.over, r.candidates, r.seed)
    try:
        if any(test.open for test in tests):
            found = optimise(tests, ships, limits, search, tell)
            tests = found.programme
        came = outcome(tests, ships[0], limits)
    except DesignError as error:
        raise DesignError(f"{pipeline.path}: test {name!r}: {error}") from error
    _check_visible(pipeline, name, came, ships[0].goal)
    lines = [r for test in tests for r in _of_lines(test, ships[0])]
    late = [r for passage in came.passages for r in late_orders(passage)]
    return Rated(name, tests, came, found, (*lines, *late, *_held_astern(pipeline, came, ships[0])))


def _held_astern(pipeline: DesignFile, came: Outcome, ship: Ship) -> list[str]:
    """That what she does astern goes by a gain that nothing has found."""
    model = ship.vessel.model
    held = [*held_astern(model, pipeline.identify.free, ())]
    if not held or not drives_astern(model.ship, (p.trial.signals for p in came.passages)):
        return []
    are = "is" if len(held) == 1 else "are"
    return [
        f"goes astern by {named_together(held)} as stated, which {are} held and not found: how far "
        "she turns and runs there is no better known than that"
    ]


def _check_visible(pipeline: DesignFile, name: str, came: Outcome, goal: Goal) -> None:
    """Refuse a wish that no test can grant: a parameter these outputs cannot see."""
    if came.rating is None:
        return
    for parameter in goal.wanted:
        if came.rating.of(parameter).S_imin <= 0.0:
            raise DesignError(
                f"{pipeline.path}: test {name!r}: outputs {', '.join(goal.settings.outputs)} "
                f"cannot see {parameter} beside the other free parameters; record more outputs, "
                "fix it, or name in `wanted` those that count (a design counts with no priors)"
            )


def _of_lines(test: Test, ship: Ship) -> list[str]:
    """What became of the lines of a multi-frequency test."""
    if test.kind != "multi_frequency_binary":
        return []
    made = signals.lines(test.duration - test.approach, ship.roll_frequency)
    said = []
    if made.merged:
        said.append(f"lines {', '.join(map(str, made.merged))} fell together in rounding")
    if made.collisions:
        listed = ", ".join(f"{i} and {j} on {k}" for i, j, k in made.collisions[:3])
        more = f" and {len(made.collisions) - 3} more" if len(made.collisions) > 3 else ""
        said.append(
            f"second-order products fall on lines ({listed}{more}): even nonlinearities will not "
            "show there; another duration avoids it"
        )
    return said


def _test(pipeline: DesignFile, test: TestSection) -> Test:
    """A test of the file with its numbers in SI."""
    variables = KINDS[test.kind].variables
    factors = {n: _factor(v.unit) for n, v in variables.items()} | {"duration": 1.0}
    values = {n: _scaled(v, factors[n]) for n, v in test.set.items()}
    ranges = {n: (a * factors[n], b * factors[n]) for n, (a, b) in test.open.items()}
    for name, (low, high) in ranges.items():
        if name != "duration" and variables[name].many:
            values[name] = ((low + high) / 2.0,) * test.steps
    duration = test.duration or ranges["duration"][1]
    return Test(test.kind, values, duration, pipeline.at_sea.approach, ranges, test.name)


def _factor(unit: str) -> float:
    return np.deg2rad(1.0) if unit.startswith("deg") else 1.0


def _scaled(value: Numbers, factor: float) -> Value:
    return tuple(x * factor for x in value) if isinstance(value, tuple) else value * factor


def _separation(
    pipeline: DesignFile, catalogue: Mapping[str, Effect], ship: Ship, limits: Limits,
    progress: Progress,
) -> Separation | None:  # fmt: skip
    """The test that tells two effects apart, where the file asks for one.

    Tests with nothing open are what it is compared with: how alike the two look without it.
    """
    if pipeline.separate is None:
        return None
    for i, name in enumerate(pipeline.separate.effects):
        if name not in catalogue:
            at = where(pipeline, f"separate.effects[{i}]")
            raise PipelineError(f"{at}: there is no effect {name!r}; {nearest(name, catalogue)}")
    one, other = (catalogue[name] for name in pipeline.separate.effects)
    pair = rivals(
        model=ship.vessel.model,
        settings=_without_bias(settings_of(pipeline, ship.vessel.model)),
        noise=dict(ship.goal.noise),
        effects=(one, other),
        vessel=ship.vessel,
        roll_frequency=ship.roll_frequency,
        speed=ship.speed,
    )
    tests = [_test(pipeline, t) for t in pipeline.tests]
    run, new = ([t for t in tests if bool(t.open) is wanted] for wanted in (False, True))
    so_far = [p.trial for p in sail_all(run, ship.vessel, ship.roll_frequency)]
    before = likeness(pair, so_far) if so_far else None
    if not new:
        return Separation(pair.names, (), None, likeness(pair, so_far), 0)
    search = Search(candidates=pipeline.search.candidates, seed=pipeline.search.seed)
    tell = _told(progress, "telling apart", 0.0, "separate")
    try:
        found = separate(new, pair, limits, search, (), tell)
    except DesignError as error:
        raise DesignError(f"{pipeline.path}: separate: {error}") from error
    chosen = tuple(replace(t, open={}) for t in found.programme)
    return replace(found, programme=chosen, before=before)


def _without_bias(settings: Settings) -> Settings:
    """Nuisances that are among the effects to be told apart would hide them."""
    kept = tuple(n for n in settings.nuisance if n == "initial_state")
    return replace(settings, nuisance=kept)
