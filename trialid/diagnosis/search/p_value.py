"""How likely chance alone makes a score: the wild bootstrap over blocks of time.

The score of a candidate is a sum over time of its trace times the residual. Blocks of time longer
than the memory of the disturbances are as good as independent, so with no effect missing each
block's residual could as well have had the other sign. Signs are drawn for all candidates at once,
the parameters are fitted again to each draw (Cameron, Gelbach & Miller 2008), and the largest
score of the whole catalogue is compared with the observed ones: twins do not count twice, and no
distribution is assumed.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.special import fdtrc  # scipy.stats would take another 0.4 s to import

from trialid.diagnosis.noise.variance import lag_window
from trialid.trial_rows import Stretch

Vector = NDArray[np.float64]
Whole = NDArray[np.int_]

DRAWS: Final = 999
BLOCK_LAGS: Final = 3
"""Length of a block in lag windows: 180 s of 20 minutes, for a rolling ship in waves remembers long
(false alarms at 5 %: 12 % with blocks of 60 s, 6 % with 120 s, 2 % with 180 s)."""

LEAST_BLOCKS: Final = 12
"""Shorter records have shorter blocks: fewer of them could not tell an effect from chance."""

NO_DEGREES: Final = 1e-6
"""Degrees of freedom of a trace in a single block: it fits what is there, and any score is likely.
With one or two granted to it, it beats the whole catalogue in every draw (a tank that the first
seconds of a roll decay show alone)."""

SEED: Final = 1999
"""Any other would do; the same makes a second run give the same numbers."""


@dataclass(frozen=True)
class Chance:
    """One candidate against chance.

    Attributes
    ----------
    score
        Hotelling's statistic over blocks of time: chi-square of as many degrees as columns where
        blocks are many and nothing is missing.
    p_value
        How often the best of all candidates scores as well by chance alone.
    """

    score: float
    p_value: float


def against_chance(
    residual: Vector,
    Q: Vector,
    S: Vector,
    groups: Sequence[Sequence[int]],
    parts: Sequence[Stretch],
) -> list[Chance]:
    """Every group of columns against the residual, with the chance of the best of them all.

    Parameters
    ----------
    residual, S
        With everything the fitted parameters reach taken out; (M,), (M, n_S).
    Q
        Orthonormal columns that the fitted parameters reach; (M, n_theta).
    groups
        Columns of S that are tested together, one group a candidate.
    """
    if not groups:
        return []
    sums = _sums(residual, Q, S, parts)
    signs = _signs(len(sums.products))
    moved = signs @ sums.moved  # what a refit of the parameters takes up in each draw
    found = [_scores(sums, list(g), signs, moved) for g in groups]
    scores = np.column_stack([score for score, _ in found])
    p = np.column_stack([p for _, p in found])
    best = np.sort(p[1:].min(axis=1))
    beaten = np.searchsorted(best, p[0] * (1.0 + 1e-9), side="right")
    return [
        Chance(float(t), float((1 + b) / (len(best) + 1)))
        for t, b in zip(scores[0], beaten, strict=True)
    ]


def _blocks(parts: Sequence[Stretch]) -> Whole:
    """The block of time each row lies in; the outputs of one trial share its blocks."""
    total = sum({p.trial: len(p.compared) for p in parts}.values())
    length = min(BLOCK_LAGS * lag_window(parts), max(total // LEAST_BLOCKS, 1))
    blocks = np.zeros(parts[-1].rows.stop, dtype=int)
    first: dict[int, int] = {}
    total = 0
    for part in parts:
        samples = len(part.compared)
        whole = max(round(samples / length), 1)
        if part.trial not in first:
            first[part.trial], total = total, total + whole
        at = np.flatnonzero(part.compared)
        blocks[part.rows] = first[part.trial] + np.minimum(at * whole // samples, whole - 1)
    return np.unique(blocks, return_inverse=True)[1]  # a block in a gap holds nothing


@dataclass(frozen=True)
class _Sums:
    """Sums of products over each block of time.

    Attributes
    ----------
    products, grams, reach
        S^T e (blocks, n_S), S^T S (blocks, n_S, n_S) and S^T Q (blocks, n_S, n_theta).
    moved
        Q^T e; (blocks, n_theta).
    """

    products: Vector
    grams: Vector
    reach: Vector
    moved: Vector


def _sums(e: Vector, Q: Vector, S: Vector, parts: Sequence[Stretch]) -> _Sums:
    blocks = _blocks(parts)
    rows = [np.flatnonzero(blocks == b) for b in range(int(blocks.max()) + 1)]
    S = S / np.maximum(np.linalg.norm(S, axis=0), 1e-300)
    pieces = [(S[at], Q[at], e[at]) for at in rows]
    return _Sums(
        np.array([s.T @ x for s, _, x in pieces]), np.array([s.T @ s for s, _, _ in pieces]),
        np.array([s.T @ q for s, q, _ in pieces]), np.array([q.T @ x for _, q, x in pieces]),
    )  # fmt: skip


def _signs(count: int) -> Vector:
    """The signs as observed, then random ones; (1 + DRAWS, blocks)."""
    drawn = np.random.default_rng(SEED).integers(0, 2, (DRAWS, count)) * 2.0 - 1.0
    return np.concatenate([np.ones((1, count)), drawn])


def _scores(
    sums: _Sums, group: Sequence[int], signs: Vector, moved: Vector
) -> tuple[Vector, Vector]:
    """Score and nominal chance of one group in every draw; (1 + DRAWS,) each."""
    q = len(group)
    products, reach = sums.products[:, group], sums.reach[:, group]
    grams = sums.grams[:, group][:, :, group]
    terms = signs[:, :, None] * products
    terms -= np.einsum("rp,bqp->rbq", moved, reach, optimize=True)
    totals = terms.sum(axis=1)
    total = np.linalg.pinv(grams.sum(axis=0), rcond=1e-10, hermitian=True)
    coefficients = totals @ total
    terms -= (coefficients @ grams.reshape(-1, q).T).reshape(terms.shape)
    variance = np.einsum("rbi,rbj->rij", terms, terms)
    scores = np.einsum("ri,rij,rj->r", totals, _inverse(variance), totals)
    weight = np.trace(grams, axis1=1, axis2=2)
    effective = float(weight.sum() ** 2 / (weight @ weight))
    rest = max(effective - q, NO_DEGREES)
    return scores, np.asarray(fdtrc(q, rest, scores * rest / ((rest + q - 1.0) * q)))


def _inverse(matrices: Vector) -> Vector:
    """Inverses of many small matrices, of what is not singular in them; (R, q, q)."""
    if matrices.shape[-1] == 1:
        return np.asarray(1.0 / np.maximum(matrices, 1e-300))
    return np.asarray(np.linalg.pinv(matrices, rcond=1e-10, hermitian=True))


def inflation(noise: Vector, S: Vector, parts: Sequence[Stretch]) -> float:
    """Variance of a score over what it is for independent rows: the median of all columns; >= 1.

    `noise` is the residual less what is taken to be missing; (M,).
    """
    blocks = _blocks(parts)
    sums = np.zeros((int(blocks.max()) + 1, S.shape[1]))
    np.add.at(sums, blocks, S * noise[:, None])
    white = np.mean(noise**2) * np.sum(S**2, axis=0)
    return max(float(np.median(np.sum(sums**2, axis=0)[white > 0.0] / white[white > 0.0])), 1.0)
