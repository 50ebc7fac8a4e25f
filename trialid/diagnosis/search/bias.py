"""Omitted-variable bias: how far the fitted parameters move when an effect joins or leaves a model.

A model without an effect lets its parameters stand in for it. To first order, with Psi the columns
of what is fitted, s those of the effect and beta its parameters,

    dtheta = -(Psi^T Psi)^-1 Psi^T s dbeta

where dbeta is from the null to the expected value when the effect is added, and from the fitted
value back to the null when it is dropped. Rows of priors count as rows of the record.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from trialid.diagnosis.search.augment import (
    Augmented,
    Trace,
    augment,
    widened_problem,
)
from trialid.diagnosis.search.candidates import linear_parameters
from trialid.identification.fit import Fit
from trialid.identification.output_error import Unknown, linearise
from trialid.ship.effect import Effect
from trialid.simulation.integrate import Departure, prepare

Vector = NDArray[np.float64]


@dataclass(frozen=True)
class Foreseen:
    """What linearisation foresees of a change of the model, before anything is fitted.

    `moves` of the parameters that stay, `values` of the effect's own, both by name and in their
    unit; `eps_rmsn` afterwards.
    """

    moves: Mapping[str, float]
    values: Mapping[str, float]
    eps_rmsn: float


def foresee_adding(fit: Fit, effect: Effect) -> Foreseen | str:
    """What an effect would change; words instead where it cannot be linearised at its null."""
    if effect.name in {e.name for e in fit.problem.simulator.model.effects}:
        return "the fit has it already, as a nuisance of each trial"
    augmented = augment(fit, {effect.name: effect})
    if effect.name in augmented.left_out:
        return augmented.left_out[effect.name]
    each = [_by_trace(fit, augmented, trace) for trace in augmented.traces]
    return min(each, key=lambda f: f.eps_rmsn) if each else "it changes no output in this record"


def _by_trace(fit: Fit, augmented: Augmented, trace: Trace) -> Foreseen:
    """What one trace of an effect foresees: by its slopes at the null, or by one value tried."""
    S = augmented.S[:, list(trace.columns)]
    residual, psi, S = _with_priors(augmented.fit, augmented.residual, augmented.psi, S)
    shift = _mimicked(psi, S)
    visible = S - psi @ shift
    sizes = np.maximum(np.linalg.norm(S, axis=0), 1e-300)
    beta = np.linalg.lstsq(visible / sizes, residual, rcond=1e-10)[0] / sizes
    nulls = trace.effect.nulls
    slopes = {n: nulls[n] + float(x) for n, x in zip(trace.parameters, beta, strict=False)}
    typical = {n: p.start for n, p in trace.effect.parameters.items()}
    return Foreseen(
        _named(fit.problem.unknowns, -shift @ beta),
        {**typical, **trace.tried, **slopes},
        _eps(fit, augmented.residual, residual - visible @ beta),
    )


def foresee_dropping(fit: Fit, effect: Effect) -> Foreseen | str:
    """What leaving an effect out would change; words where it cannot be linearised."""
    linear = linear_parameters(effect)
    if effect.scanned or effect.states or not linear:
        return "not linear at its null"
    found = _columns(fit, linear)
    if isinstance(found, Departure):
        return f"cannot be simulated: {found}"
    residual, every = found
    names = [x.column for x in fit.problem.unknowns]
    kept = [i for i, n in enumerate(names) if n not in effect.parameters]
    theirs = [fit.problem.unknowns[i] for i in kept]
    fixed = [n for n in linear if n not in names]
    which = [names.index(n) if n in names else len(names) + fixed.index(n) for n in linear]
    residual, psi, S = _with_priors(fit, residual, every[:, kept], every[:, which], theirs)
    shift = _mimicked(psi, S)
    step = np.array([effect.nulls[n] - fit.model.value(n) for n in linear])
    left = residual - (S - psi @ shift) @ step
    return Foreseen(
        _named(theirs, -shift @ step),
        {n: effect.nulls[n] for n in linear},
        _eps(fit, fit.residual, left),
    )


def _columns(fit: Fit, parameters: Sequence[str]) -> tuple[Vector, Vector] | Departure:
    """Residual and columns of all unknowns, then of those parameters that were held fixed."""
    problem = fit.problem
    fixed = tuple(n for n in parameters if n not in {x.column for x in problem.unknowns})
    if not fixed:
        return fit.residual, fit.psi
    simulator = problem.simulator
    values = {n: fit.model.value(n) for n in fixed}
    finer = prepare(
        simulator.model.with_values(values), (*simulator.equations.free, *fixed),
        problem.outputs, fit.settings.engine, simulator.substeps,
    )  # fmt: skip
    wider = widened_problem(problem, finer, fixed)
    return linearise(wider, np.append(fit.theta, list(values.values())))


def _with_priors(
    fit: Fit,
    residual: Vector,
    psi: Vector,
    S: Vector,
    unknowns: Sequence[Unknown] | None = None,
) -> tuple[Vector, Vector, Vector]:
    """One more row for each prior, weighed by the noise level of the record as in the fit."""
    unknowns = fit.problem.unknowns if unknowns is None else unknowns
    noise = fit.level
    for i, x in enumerate(unknowns):
        if x.prior is not None:
            mean, deviation = x.prior
            row = np.zeros((1, psi.shape[1]))
            row[0, i] = noise / deviation
            residual = np.append(residual, (mean - fit.value(x.name)) * noise / deviation)
            psi, S = np.vstack([psi, row]), np.vstack([S, np.zeros((1, S.shape[1]))])
    return residual, psi, S


def _mimicked(psi: Vector, S: Vector) -> Vector:
    """Parameters that come nearest to the effect's own columns; (n_theta, q)."""
    sizes = np.maximum(np.linalg.norm(psi, axis=0), 1e-300)
    return np.asarray(np.linalg.lstsq(psi / sizes, S, rcond=1e-10)[0]) / sizes[:, None]


def _named(unknowns: Sequence[Unknown], moves: Vector) -> dict[str, float]:
    return {x.name: float(d) for x, d in zip(unknowns, moves, strict=True)}


def _eps(fit: Fit, residual: Vector, left: Vector) -> float:
    """eps_RMSn by what is left of a residual; the record's own rows come first."""
    rows = left[: len(residual)]
    fall = float(residual @ residual - rows @ rows)
    return float(np.sqrt(max(fit.eps_rmsn**2 - fall, 0.0)))
