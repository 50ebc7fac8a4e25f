"""Traces of effects the model does not have: sensitivities at their null, or differences."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from trialid.diagnosis.noise.thinning import with_means
from trialid.diagnosis.search.candidates import (
    candidates_for,
    linear_parameters,
    of_one_clock,
    out_of_reach,
    undriven,
)
from trialid.diagnosis.search.projection import Evidence, gather
from trialid.diagnosis.search.scan import secants
from trialid.effects import CATALOGUE
from trialid.identification.fit import Fit
from trialid.identification.output_error import Problem, Unknown, linearise, stretches
from trialid.names.quantities import MASS_PARAMETERS
from trialid.ship.effect import Effect
from trialid.ship.model import STATES, ShipModel
from trialid.simulation.integrate import (
    Departure,
    Simulator,
    prepare,
    shared_record,
)
from trialid.trial_rows import Stretch

Vector = NDArray[np.float64]


@dataclass(frozen=True)
class Trace:
    """One way an effect can show: by its parameters near their null, or at one value tried.

    Attributes
    ----------
    columns
        Where it stands in `Augmented.S`.
    parameters
        What the columns are by; empty where a value was tried.
    tried
        The values tried; empty where the effect is linear at its null.
    """

    effect: Effect
    columns: tuple[int, ...]
    parameters: tuple[str, ...] = ()
    tried: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Augmented:
    """Residual, base and candidate columns, normed and stacked alike.

    Attributes
    ----------
    fit
        What they are of: where trials are long a fit to means of several samples each.
    traces
        What the columns of `S` are.
    held, H
        Coefficients of the model that were held fixed, and their columns.
    """

    fit: Fit
    traces: tuple[Trace, ...]
    residual: Vector
    psi: Vector
    S: Vector
    stretches: tuple[Stretch, ...]
    left_out: Mapping[str, str]
    held: tuple[str, ...]
    H: Vector

    @property
    def effects(self) -> tuple[Effect, ...]:
        """Every effect with a trace."""
        return tuple({t.effect.name: t.effect for t in self.traces}.values())

    @cached_property
    def evidence(self) -> Evidence:
        """The same rows less what the fitted parameters reach, raw and white."""
        groups = [t.columns for t in self.traces]
        return gather(self.residual, self.psi, self.S, self.stretches, groups)


def augment(fit: Fit, catalogue: Mapping[str, Effect]) -> Augmented:
    """Traces of every candidate.

    A candidate that cannot be simulated, or acts on nothing that is an output, is left out with
    the reason.
    """
    fit = with_means(fit).examined
    problem = fit.problem
    base = _fitted_model(fit)
    length = base.ship.particulars["L"]
    sized = {name: effect.of_ship(length) for name, effect in catalogue.items()}
    able, left_out = candidates_for(base, shared_record(fit.trials), sized)
    left_out |= out_of_reach(fit.trials, able) | of_one_clock(fit.trials, able)
    left_out |= undriven(fit.model, fit.trials, fit.problem.outputs, able)
    able = {name: effect for name, effect in able.items() if name not in left_out}
    able, silent = _with_trace(able, problem.outputs)
    linear = [e for e in able.values() if not e.scanned]
    point = _linear(fit, base, linear)
    if isinstance(point, Departure):
        linear, lost = _apart(fit, base, linear)
        left_out |= lost
        point = _linear(fit, base, linear)
        assert not isinstance(point, Departure)
    residual, psi, S, H = point
    names = [p for e in linear for p in linear_parameters(e)]
    traces = [
        Trace(e, tuple(names.index(p) for p in linear_parameters(e)), linear_parameters(e))
        for e in linear
    ]
    unmoved = _without_slope(traces, S)
    tried_, columns = _scanned(fit, base, [e for e in able.values() if e.tried], len(names))
    return Augmented(
        fit=fit,
        traces=(*traces, *tried_),
        residual=residual,
        psi=psi,
        S=np.column_stack([S, *columns]),
        stretches=stretches(problem),
        left_out=left_out | silent | unmoved,
        held=fixed_coefficients(fit),
        H=H,
    )


def fixed_coefficients(fit: Fit) -> tuple[str, ...]:
    """Masses and coefficients of the simulated model that nobody seeks and that are not zero."""
    model = fit.problem.simulator.model
    sought = {x.column for x in fit.problem.unknowns}
    named = [n for e in model.effects for n in e.parameters]
    return tuple(n for n in (*MASS_PARAMETERS, *named) if n not in sought and model.stated(n))


def _fitted_model(fit: Fit) -> ShipModel:
    """The model as it was simulated, nuisance effects included, with its fitted values."""
    shared = {x.column: float(a) for x, a in zip(fit.problem.unknowns, fit.theta, strict=True)
              if x.trial is None}  # fmt: skip
    return fit.problem.simulator.model.with_values(shared)


def _apart(
    fit: Fit, base: ShipModel, effects: Sequence[Effect]
) -> tuple[list[Effect], dict[str, str]]:
    """Effects that can be simulated along the record, tried one by one, and why the others not."""
    kept, lost = list[Effect](), dict[str, str]()
    for effect in effects:
        point = _linear(fit, base, [effect])
        if isinstance(point, Departure):
            lost[effect.name] = f"is no number along the record: {point}"
        else:
            kept.append(effect)
    return kept, lost


def _linear(
    fit: Fit, base: ShipModel, effects: Sequence[Effect]
) -> tuple[Vector, Vector, Vector, Vector] | Departure:
    """Residual, columns of what is fitted, of effects at their null, and of what is held fixed.

    All from one simulation a trial.
    """
    problem = fit.problem
    model = base
    for effect in effects:
        model = model + effect
    columns = tuple(p for e in effects for p in linear_parameters(e))
    model = model.with_values({n: x for e in effects for n, x in e.nulls.items()})
    held = fixed_coefficients(fit)
    every = tuple(dict.fromkeys((*columns, *held)))  # a coefficient that might be freed is in both
    free = (*problem.simulator.equations.free, *every)
    substeps = problem.simulator.substeps
    simulator = prepare(model, free, problem.outputs, fit.settings.engine, substeps)
    point = linearise(widened_problem(problem, simulator, every),
                      np.append(fit.theta, [model.value(n) for n in every]))  # fmt: skip
    if isinstance(point, Departure):
        return point
    residual, psi = point
    psi, rest = np.split(psi, [len(fit.theta)], axis=1)
    # copies: a view of a few columns would keep those of the whole catalogue
    return residual, psi.copy(), rest[:, : len(columns)], rest[:, [every.index(n) for n in held]]


def _without_slope(traces: Sequence[Trace], S: Vector) -> dict[str, str]:
    """Effects that cannot be scored, as a parameter of theirs moves nothing where it is absent."""
    found = dict[str, str]()
    for one in traces:
        pairs = zip(one.parameters, one.columns, strict=True)
        dead = [n for n, column in pairs if not S[:, column].any()]
        product = len(dead) > 1 and one.effect.name not in CATALOGUE
        if dead:
            also = "; of a product write null=None to all but one" if product else ""
            found[one.effect.name] = f"{', '.join(dead)} moves nothing that is compared{also}"
    return found


def _scanned(
    fit: Fit, base: ShipModel, effects: Sequence[Effect], first: int
) -> tuple[list[Trace], list[Vector]]:
    """Effects at each of the values to try."""
    traces, columns = list[Trace](), list[Vector]()
    for effect in effects:
        for values, column in secants(fit, base, effect):
            if column.any():
                traces.append(Trace(effect, (first + len(columns),), (), values))
                columns.append(column)
    return traces, columns


def widened_problem(problem: Problem, simulator: Simulator, columns: Sequence[str]) -> Problem:
    """The problem with further parameters of the model as shared unknowns, simulated by another."""
    extra = tuple(
        Unknown(
            name=n,
            column=n,
            trial=None,
            start=0.0,
            size=1.0,
            low=-np.inf,
            high=np.inf,
            unit="1",
            kind="physical",
        )
        for n in columns
    )
    return replace(problem, simulator=simulator, unknowns=(*problem.unknowns, *extra))


def _with_trace(
    able: Mapping[str, Effect], outputs: Sequence[str]
) -> tuple[dict[str, Effect], dict[str, str]]:
    """Leave out sensors of signals that are not outputs."""
    kept, silent = {}, {}
    for name, effect in able.items():
        unseen = [s for s in effect.measures if s in STATES and s not in outputs]
        if unseen:
            silent[name] = f"{unseen[0]} is not an output"
        else:
            kept[name] = effect
    return kept, silent
