"""The residual and every candidate's trace, less what the fitted parameters reach; raw and white.

The colour of the noise has to come from the residual, which holds the missing effect. So the
candidate that explains most of the residual is taken out first: what is left is noise to a better
approximation, and with nothing missing one candidate of a hundred takes hardly anything.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.diagnosis.noise.whitening import Colour, colour_of, memory, whiten_columns
from trialid.diagnosis.search.p_value import inflation
from trialid.trial_rows import Stretch

Vector = NDArray[np.float64]

TOGETHER: Final = 1 << 15
"""Rows worked out at a time; those of an hour at 1 Hz, and of most trials, are fewer."""


@dataclass(frozen=True)
class Projected:
    """Residual and candidate columns with everything the base columns reach taken out.

    Attributes
    ----------
    Q
        Orthonormal columns of what the base reaches.
    gram, moment
        S^T S and S^T residual.
    """

    residual: Vector
    S: Vector
    Q: Vector
    gram: Vector
    moment: Vector


@dataclass(frozen=True)
class Evidence:
    """The same rows as they are and with the noise's colour taken out.

    Attributes
    ----------
    white
        In units of the noise: a row of noise has variance 1.
    parts
        Which rows of `white` are which output of which trial.
    inflation
        By how much rows that are not quite independent make chance greater.
    """

    raw: Projected
    white: Projected
    parts: tuple[Stretch, ...]
    colour: Colour
    inflation: float


def project(residual: Vector, psi: Vector, S: Vector) -> Projected:
    """Take out of the residual and the candidates what the base columns reach."""
    norms = np.linalg.norm(psi, axis=0)
    Q, _ = np.linalg.qr(psi[:, norms > 0.0] / norms[norms > 0.0])
    e, left = residual - Q @ (Q.T @ residual), remainder(Q, S)
    return Projected(e, left, Q, left.T @ left, left.T @ e)


def remainder(Q: Vector, S: Vector) -> Vector:
    """Columns without what those of Q reach."""
    left = S.copy()
    take_out(Q, left)
    return left


def take_out(Q: Vector, S: Vector) -> None:
    """Take out of columns, in their place, what those of Q reach.

    Some rows at a time: of a long record all that is reached takes as much room as they do.
    """
    reach = Q.T @ S
    for start in range(0, len(S), TOGETHER):
        rows = slice(start, start + TOGETHER)
        S[rows] -= Q[rows] @ reach


def products(Q: Vector, S: Vector, residual: Vector) -> tuple[Vector, Vector]:
    """Of what Q does not reach of columns: with each other and with the residual; (n, n), (n,)."""
    reach, gram = Q.T @ S, np.zeros((S.shape[1], S.shape[1]))
    moment = np.zeros(S.shape[1])
    for start in range(0, len(S), TOGETHER):
        rows = slice(start, start + TOGETHER)
        left = S[rows] - Q[rows] @ reach
        gram += left.T @ left
        moment += left.T @ residual[rows]
    return gram, moment


def gather(
    residual: Vector,
    psi: Vector,
    S: Vector,
    stretches: Sequence[Stretch],
    groups: Sequence[tuple[int, ...]],
    noise: Vector | None = None,
) -> Evidence:
    """Everything the tests need, from normed stacked rows.

    Parameters
    ----------
    groups
        Columns of `S` that belong to one candidate.
    noise
        What is taken for noise where it is known better than from the candidates; (M,).
    """
    raw = project(residual, psi, S)
    best, _ = likeliest(raw, groups, stretches)
    colour = colour_of(residual_after(raw, best) if noise is None else noise, stretches)
    rows, parts = whiten_columns(np.column_stack([residual, psi, S]), stretches, colour)
    n = psi.shape[1]
    white = project(rows[:, 0], rows[:, 1 : n + 1], rows[:, n + 1 :])
    chance = inflation(residual_after(white, best), white.S, parts) if len(white.S.T) else 1.0
    return Evidence(raw, white, parts, colour, chance)


def likeliest(
    raw: Projected, groups: Sequence[tuple[int, ...]], stretches: Sequence[Stretch]
) -> tuple[tuple[int, ...], float]:
    """The candidate that explains most of the residual at Schwarz's price, or none, and its cost.

    As many rows count as one as an autoregression of these records looks back.
    """
    samples = len(raw.residual) / memory(stretches)
    total = float(raw.residual @ raw.residual)
    best, least = tuple[int, ...](), 0.0
    for group in groups:
        _, fall = least_squares_fall(raw, group)
        cost = samples * np.log(max(1.0 - fall / total, 1e-12)) + len(group) * np.log(samples)
        if cost < least:
            best, least = group, float(cost)
    return best, least


def residual_after(rows: Projected, group: Sequence[int]) -> Vector:
    """The residual less what a candidate explains; (M,)."""
    return np.asarray(rows.residual - rows.S[:, group] @ least_squares_fall(rows, group)[0])


def least_squares_fall(rows: Projected, group: Sequence[int]) -> tuple[Vector, float]:
    """Coefficients of a candidate's columns, and the fall of the sum of squares; (q,)."""
    gram, moment = rows.gram[np.ix_(group, group)], rows.moment[list(group)]
    sizes = np.sqrt(np.maximum(np.diag(gram), 1e-300))
    inverse = np.linalg.pinv(gram / np.outer(sizes, sizes), rcond=1e-10, hermitian=True)
    beta = inverse @ (moment / sizes)
    return np.asarray(beta / sizes), float(moment / sizes @ beta)
