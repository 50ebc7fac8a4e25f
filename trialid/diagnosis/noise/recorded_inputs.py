"""What the noise of recorded inputs leads a simulation to.

A rudder angle or a wind that drives the simulation was measured, too. Its noise pushes the ship of
the model as nothing pushed the true one, and what comes of it is slow: a heading that walks, a
track that drifts like a current. Beside the noise of positions it is small, so that the residual
hardly shows it, and what is slow in the track takes it up. So it is drawn, simulated and fitted.
"""

import functools
from collections.abc import Mapping, Sequence

import numpy as np

from trialid.accuracy.felt import Draw
from trialid.arrays import Vector
from trialid.identification.fit import Fit
from trialid.identification.input_noise import input_noise, moved_by
from trialid.identification.output_error import row_scale, stretches


def felt_noise(fit: Fit) -> Draw | None:
    """Normed rows that noise of the inputs moves the simulation by, for a number of draws.

    None where no input has noise that could be seen. The noise is taken as white; what cannot be
    simulated is left out.
    """
    levels = [input_noise(fit.problem.simulator, trial) for trial in fit.problem.trials]
    return functools.partial(_drawn, fit, levels) if any(levels) else None


def _drawn(fit: Fit, levels: Sequence[Mapping[str, float]], draws: int) -> Vector:
    """Rows of so many draws, or of fewer; (draws, M)."""
    made = np.zeros((draws, len(fit.residual)))
    for i, level in enumerate(levels):
        if level:
            _felt_in(fit, i, level, made)
    return made[np.isfinite(made).all(axis=1)]


def _felt_in(fit: Fit, place: int, level: Mapping[str, float], made: Vector) -> None:
    """Write the rows of one trial."""
    problem, trial = fit.problem, fit.problem.trials[place]
    values, scale = problem.values(fit.theta, place), row_scale(problem)
    parts = [p for p in stretches(problem) if p.trial == place]
    rng = np.random.default_rng([0, place])
    for row, moved in zip(
        made, moved_by(problem.simulator, trial, values, level, rng), strict=False
    ):
        for part in parts:
            row[part.rows] = part.taken(moved[:, part.output]) * scale[part.output]
