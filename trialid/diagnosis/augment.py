"""Sensitivities to effects the model does not have, all from one simulation per trial."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from trialid.accuracy import Stretch
from trialid.identification.fit import Fit
from trialid.identification.output_error import Problem, Unknown, linearise, stretches
from trialid.quantities import ACCELERATIONS, PARTICULARS
from trialid.ship.effect import Effect, Steered
from trialid.ship.model import STATES, ShipModel
from trialid.simulation.integrate import Departure, Simulator, prepare, recorded, signals_of
from trialid.trial import Trial

Vector = NDArray[np.float64]


@dataclass(frozen=True)
class Augmented:
    """Residual, base and candidate columns, normed and stacked alike.

    `columns` names the candidate parameters in the order of `S`.
    """

    effects: tuple[Effect, ...]
    columns: tuple[str, ...]
    residual: Vector
    psi: Vector
    S: Vector
    stretches: tuple[Stretch, ...]
    left_out: Mapping[str, str]


def candidates_for(
    model: ShipModel, trial: Trial, catalogue: Mapping[str, Effect]
) -> tuple[dict[str, Effect], dict[str, str]]:
    """Effects that can be tried on this model and record, and why the others cannot."""
    able: dict[str, Effect] = {}
    left_out: dict[str, str] = {}
    present = {e.name for e in model.effects}
    for name, effect in catalogue.items():
        if name in present:
            continue
        reason = _why_not(model, trial, effect, able)
        if reason:
            left_out[name] = reason
        else:
            able[name] = effect
    return able, left_out


def _why_not(model: ShipModel, trial: Trial, effect: Effect, able: Mapping[str, Effect]) -> str:
    if effect.scanned:
        return "not linear at its null"
    if not linear_parameters(effect):
        return "has no null at zero"
    known = {
        *model.all_states,
        *effect.states,
        *model.ship.particulars,
        "U",
        "u",
        "t",
        *ACCELERATIONS,
    }
    lacking = [s for s in signals_of(effect) if s not in known and not recorded(trial, s)]
    if lacking:
        where = "ship file" if set(lacking) <= set(PARTICULARS) else "record"
        return f"needs {', '.join(lacking)}, which the {where} does not hold"
    for s in effect.acts_on(Steered):
        if s in model.states:
            return f"acts on the record of {s}, which is simulated"
        if s in STATES and _varies(trial, s) is bool(effect.states):
            return f"stands in for a record of {s}" if effect.states else f"needs a record of {s}"
    taken = {*model.parameters, *(p for e in able.values() for p in e.parameters)}
    clash = sorted(taken & set(effect.parameters))
    return f"parameter {clash[0]!r} is already there" if clash else ""


def _varies(trial: Trial, signal: str) -> bool:
    """Whether a motion is recorded: a stated approach speed is one number all along."""
    return bool(np.ptp(trial.signals.get(signal, np.zeros(1))) > 0.0)


def linear_parameters(effect: Effect) -> tuple[str, ...]:
    """The parameters by which it is scored: those at which zero means that it is absent."""
    return tuple(n for n, p in effect.parameters.items() if p.null == 0.0 and not p.scan)


def augment(fit: Fit, catalogue: Mapping[str, Effect]) -> Augmented:
    """Sensitivities to every candidate at its null.

    A candidate that cannot be simulated, or acts on nothing that is an output, is left out with
    the reason.
    """
    problem = fit.problem
    base = problem.simulator.model
    shared = {x.column: a for x, a in zip(problem.unknowns, fit.theta, strict=True)
              if x.trial is None}  # fmt: skip
    base = base.with_values(shared)
    able, left_out = candidates_for(base, problem.trials[0], catalogue)
    able, silent = _with_trace(able, problem.outputs)
    model = base
    for effect in able.values():
        model = model + effect
    columns = tuple(p for e in able.values() for p in linear_parameters(e))
    model = model.with_values({n: x for e in able.values() for n, x in e.nulls.items()})
    free = (*problem.simulator.equations.free, *columns)
    substeps = problem.simulator.substeps
    simulator = prepare(model, free, problem.outputs, fit.settings.engine, substeps)
    point = linearise(_with_columns(problem, simulator, columns),
                      np.append(fit.theta, np.zeros(len(columns))))  # fmt: skip
    assert not isinstance(point, Departure)
    residual, psi = point
    n = len(fit.theta)
    return Augmented(
        tuple(able.values()), columns, residual, psi[:, :n], psi[:, n:], stretches(problem),
        left_out | silent,
    )  # fmt: skip


def _with_columns(problem: Problem, simulator: Simulator, columns: Sequence[str]) -> Problem:
    """The problem with candidate parameters as further shared unknowns."""
    extra = tuple(Unknown(n, n, None, 0.0, 1.0, -np.inf, np.inf, "1", "physical") for n in columns)
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
