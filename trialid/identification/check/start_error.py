"""How sure it is where a trial that is not fitted was found to start."""

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from trialid.accuracy.coloured import draws_for
from trialid.accuracy.felt import felt_by
from trialid.arrays import Mask
from trialid.identification.check.own_start import OwnRows, columns_of_its_own, priors_of
from trialid.identification.input_noise import input_noise, moved_by
from trialid.identification.output_error import Problem, stretches_of
from trialid.simulation.integrate import respond, starts_of
from trialid.trial import Trial
from trialid.trial_rows import Stretch

Vector = NDArray[np.float64]


@dataclass(frozen=True)
class StartError:
    """What a start that was found for fitted parameters is uncertain by.

    Attributes
    ----------
    names, shared
        Columns of what the trial has for itself, and of the parameters that all trials share.
    by
        How what it has for itself moves with those; (n_own, n_shared).
    noise
        Root of the covariance by noise: noise noise^T; (n_own, k).
    """

    names: tuple[str, ...]
    shared: tuple[str, ...]
    by: Vector
    noise: Vector


def start_error(
    problem: Problem, trial: Trial, compared: Mask, values: Mapping[str, float], level: float
) -> StartError | None:
    """How sure `own_start` is; None where a trial has nothing for itself, or leaves the model.

    Noise of each output is what the trial itself is off its simulation; noise of recorded inputs is
    drawn.

    Parameters
    ----------
    values
        All the trial was simulated with, its start by the name of the column.
    """
    names = tuple(columns_of_its_own(problem))
    response = respond(problem.simulator, trial, values, starts_of(values))
    if not names or not compared.any() or response.departure is not None or response.S is None:
        return None
    rows = OwnRows(problem, trial, compared, values, priors_of(problem, trial, names), level)
    shared = tuple(x.column for x in problem.unknowns if x.trial is None)
    columns = [problem.simulator.columns.index(c) for c in shared]
    psi = rows.taken(response.S[:, :, columns])
    gap, own = rows.of(response, np.array([values[n] for n in names]))
    inverse = _inverse(own)
    parts, measured = stretches_of((compared,)), slice(len(gap) - len(names))
    sizes = [np.full(p.rows.stop - p.rows.start, _rms(gap[p.rows])) for p in parts]
    weights = np.concatenate([*sizes, np.full(len(names), level)])
    white = np.asarray(np.linalg.qr((own * weights[:, None]) @ inverse, mode="r")).T
    gain = inverse @ own[measured].T
    felt = _felt(rows, own[measured], gain, gap[measured], parts)
    return StartError(names, shared, -gain @ psi, np.hstack([white, felt]))


def _inverse(own: Vector) -> Vector:
    """(A^T A)^-1 of columns whose units have nothing in common."""
    scale = np.linalg.norm(own, axis=0)
    scale[scale == 0.0] = 1.0
    return np.asarray(
        np.linalg.pinv((own / scale).T @ (own / scale), hermitian=True) / np.outer(scale, scale)
    )


def _rms(gap: Vector) -> float:
    return float(np.sqrt(np.mean(gap**2))) if len(gap) else 0.0


def _felt(
    rows: OwnRows, own: Vector, gain: Vector, gap: Vector, parts: Sequence[Stretch]
) -> Vector:
    """Root of what noise of recorded inputs adds; (n_own, n_own), or no column."""
    simulator, trial = rows.problem.simulator, rows.trial
    none, noise = np.zeros((len(gain), 0)), input_noise(simulator, trial)
    if not noise:
        return none

    def draw(draws: int) -> Vector:
        moved = moved_by(simulator, trial, rows.values, noise, np.random.default_rng(0))
        made = np.array([rows.taken(y) for y in itertools.islice(moved, draws)])
        return np.asarray(made[np.isfinite(made).all(axis=1)])

    felt = felt_by(own, gain, gap, parts, draw, draws_for(len(gap)))
    if felt is None:
        return none
    size, direction = np.linalg.eigh(felt.covariance)
    return np.asarray(direction * np.sqrt(np.maximum(size, 0.0)))
