"""A design file carried out: tests sailed, rated and optimised, and rivals told apart."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np

from trialid.design import signals
from trialid.design.helm import vessel
from trialid.design.kinds import KINDS, Test, Value
from trialid.design.limits import Limits
from trialid.design.ordered_signals import late_orders, ordered_signals
from trialid.design.rating import Goal, Noise, goal
from trialid.design.search import (
    Found,
    Outcome,
    Search,
    Ship,
    natural_roll,
    optimise,
    outcome,
    sail_all,
    score,
)
from trialid.design.separation import Separation, likeness, rivals, separate
from trialid.errors import DesignError, PipelineError, UnitError, nearest
from trialid.identification.problem import Settings, with_starts
from trialid.names import units
from trialid.names.quantities import SIGNALS, Quantity
from trialid.pipeline_file import where
from trialid.pipeline_file.design_file import DesignFile, Numbers, TestSection
from trialid.pipeline_file.finished_run import FinishedRun, finished_run
from trialid.pipeline_file.form import GivenValue
from trialid.report.files import design_data
from trialid.ship.actuators import actuator_quantities
from trialid.ship.effect import Effect
from trialid.ship.model import ShipModel
from trialid.threads import one_thread
from trialid.version import VERSION
from trialid.workflow.build_model import available, build_model, settings_of
from trialid.workflow.design import design_imo

Progress = Callable[[str, float | None], None]

NO_ROLL: Final = 2.0 * np.pi / 15.0
"""rad/s, where the model does not roll and nothing depends on it."""


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


@dataclass(frozen=True)
class Plan:
    """What a design file asked for."""

    pipeline: DesignFile
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
    ships = _ships(pipeline, catalogue)
    limits = _limits(pipeline, ships[0].vessel.model)
    separation = _separation(pipeline, catalogue, ships[0], limits, progress)
    chosen = {} if separation is None else {t.name: t for t in separation.programme}
    tests = tuple(chosen.get(t.name) or _test(pipeline, t) for t in pipeline.tests)
    programmes = [("programme", tests)] if pipeline.together else [(t.name, (t,)) for t in tests]
    rated = []
    for i, (name, programme) in enumerate(programmes):
        tell = _told(progress, name, i / len(programmes), pipeline.search.criterion)
        rated.append(_rated(pipeline, name, programme, ships, limits, tell))
    imo = design_imo.imo(ships, finished_run(pipeline)) if pipeline.imo else None
    return Plan(pipeline, ships[0], limits, tuple(rated), separation, imo)


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
    return Rated(name, tests, came, found, (*lines, *late))


def _check_visible(pipeline: DesignFile, name: str, came: Outcome, goal: Goal) -> None:
    """Refuse a wish that no test can grant: a parameter these outputs cannot see."""
    if came.rating is None:
        return
    for parameter in goal.wanted:
        if came.rating.of(parameter).S_imin <= 0.0:
            raise DesignError(
                f"{pipeline.path}: test {name!r}: outputs {', '.join(goal.settings.outputs)} "
                f"cannot see {parameter} beside the other free parameters; record more outputs, "
                "or fix it"
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


def _ships(pipeline: DesignFile, catalogue: Mapping[str, Effect]) -> list[Ship]:
    """The ship as she is known, first, and others she might be."""
    model = build_model(pipeline, catalogue)
    run = finished_run(pipeline)
    known = {n: x for n, x in run.values.items() if n in model.parameters}
    settings = settings_of(pipeline, model)
    model = with_starts(model.with_values(known), pipeline.identify.free, settings)
    full = _full(pipeline, model, catalogue)
    made = [_ship(pipeline, run, model, full)]
    draw = np.random.default_rng(pipeline.ships.seed)
    for _ in range(pipeline.ships.count - 1):
        factors = {
            n: 1.0 + pipeline.ships.spread * draw.standard_normal()
            for n in pipeline.identify.free
            if n in model.parameters
        }
        values = {n: model.value(n) * f for n, f in factors.items()}
        made.append(_ship(pipeline, run, model.with_values(values), full.with_values(values)))
    return made


def _full(pipeline: DesignFile, model: ShipModel, catalogue: Mapping[str, Effect]) -> ShipModel:
    """What is sailed: the model to be fitted and what the ship has beyond it."""
    full = model
    for i, name in enumerate(pipeline.full.effects):
        if name not in catalogue:
            at = where(pipeline, f"full.effects[{i}]")
            raise PipelineError(f"{at}: there is no effect {name!r}; {nearest(name, catalogue)}")
        full = full + catalogue[name]
    values = {}
    for name, given in pipeline.full.values.items():
        if name not in full.parameters:
            at = where(pipeline, f"full.values.{name}")
            raise PipelineError(f"{at}: no such parameter; {nearest(name, full.parameters)}")
        values[name] = _si(pipeline, f"full.values.{name}", given, full.parameters[name].unit, None)
    typical = {
        n: p.start
        for e in full.effects
        if e.name in pipeline.full.effects
        for n, p in e.parameters.items()
        if full.stated(n) is None
    }
    return full.with_values({**typical, **values})


def _ship(pipeline: DesignFile, run: FinishedRun, model: ShipModel, full: ShipModel) -> Ship:
    at_sea, known = pipeline.at_sea, SIGNALS | actuator_quantities(full.ship.actuators)
    constants = {n: x for n, x in run.constants.items() if n in full.recorded} | {
        name: _si(pipeline, f"at_sea.constant.{name}", given, known[name].unit, known[name].shown)
        for name, given in at_sea.constant.items()
    }
    ready = vessel(full, at_sea.period, constants, run.gear_rate(at_sea.rudder_rate))
    noise = {
        c: Noise(n.sigma / units.shown_factor(SIGNALS[c]), n.memory)
        for c, n in pipeline.noise.items()
    }
    asked = goal(model, settings_of(pipeline, model), noise, pipeline.wanted, pipeline.scale)
    rolls = {"p", "phi"} <= {*model.states}
    speed = model.ship.particulars["U0"]
    return Ship(ready, asked, natural_roll(ready) if rolls else NO_ROLL, speed)


def _si(pipeline: DesignFile, key: str, given: GivenValue, unit: str, bare: str | None) -> float:
    """A given number in SI; without a unit it is in `bare`, or as it is."""
    stated = given.unit or bare
    try:
        return given.value if stated is None else given.value * units.factor(stated, unit)
    except UnitError as error:
        raise UnitError(f"{where(pipeline, key)}: {error}") from error


def _limits(pipeline: DesignFile, model: ShipModel) -> Limits:
    """The file's limits in SI; one of a motion that is not simulated would never bind."""
    r = pipeline.limits
    for name, state, given in (("heel", "phi", r.heel), ("speed_loss", "u", r.speed_loss)):
        if given is not None and state not in model.states:
            raise PipelineError(
                f"{where(pipeline, f'limits.{name}')}: {state} is not simulated, so nothing can be "
                f"held against it; put {state} among model.states, or leave the limit out"
            )
    degrees = np.deg2rad(1.0)
    return Limits(
        rudder=None if r.rudder is None else r.rudder * degrees,
        rudder_rate=None if r.rudder_rate is None else r.rudder_rate * degrees,
        heel=None if r.heel is None else r.heel * degrees,
        speed_loss=r.speed_loss, room=r.room, duration=r.duration,
        rudders=tuple(one for one in model.ship.actuators if one.kind == "rudder"),
    )  # fmt: skip


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


def steering(plan: Plan) -> dict[str, Quantity]:
    """What the tests order, and what comes of it, by the signal's name."""
    return ordered_signals([p for rated in plan.rated for p in rated.outcome.passages])


def _recorded(plan: Plan) -> list[str]:
    """What the crew must record, in words."""
    known = SIGNALS | steering(plan)
    outputs, still = plan.pipeline.identify.outputs, plan.ship.vessel.constants
    names = [*steering(plan), *outputs, *(n for n in still if n in known), "psi", "u"]
    return [known[n].meaning.partition(",")[0] for n in dict.fromkeys(names)]


def plain(plan: Plan) -> dict[str, Any]:
    """A plan as plain data, schema `trialid-design/1`."""
    best = plan.best
    tests = [
        {
            "name": rated.name,
            "programme": [design_data.of_test(t) for t in rated.programme],
            "searched": None if rated.found is None else rated.found.tried,
            "remarks": list(rated.remarks),
            **design_data.of_outcome(rated.outcome),
        }
        for rated in plan.rated
    ]
    return {
        "schema": design_data.SCHEMA,
        "version": VERSION,
        "name": plan.pipeline.name,
        "design": plan.pipeline.path.name,
        "ship": plan.ship.vessel.model.ship.name,
        "wanted": list(plan.ship.goal.wanted),
        "outputs": list(plan.pipeline.identify.outputs),
        "recorded": _recorded(plan),
        "roll_period": 2.0 * np.pi / plan.ship.roll_frequency,
        "tests": tests,
        "best": None if best is None else best.name,
        "separation": design_data.of_separation(plan.separation),
        **design_imo.plain(plan.imo),
    }
