"""How likely a force of unknown course is: sums over rows once, then any intensity in milliseconds.

The normed residual is  e = Psi d_theta + H f + G c + noise. Columns of H answer to a unit force at
one knot (straight lines between knots), f is an Ornstein-Uhlenbeck process; columns of G answer to
forces that are powers and products of the ship's signals, their coefficients c are of one size; and
d_theta is the change of the parameters that the force brings with it, free. The first part follows
any course, the second is what a missing effect looks like, and without it an autoregression passes
for a strong effect more cheaply than a force does. Whitened noise has variance sigma^2, which is
eliminated. What is left of everything but f is S = Z^T V^-1 Z for Z = [Psi G e] with V = 1 + H Q
H^T, where the trials meet (Searle, Casella & McCulloch, 1992, chapter 7).
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cholesky, solve_triangular

from trialid.arrays import Mask
from trialid.diagnosis.noise.noise_colour import Colour, whiten_rows, windows

Vector = NDArray[np.float64]

MEMORIES: Final = (2.0, 6.0, 20.0)
"""Memories of the force that are tried, in knots: from one roll to many minutes."""

COURSE: Final = tuple(10.0**x for x in range(-3, 3))
"""Variances of the course that are tried, by what one knot shows over the noise."""

TERMS: Final = (0.0, *(10.0**x for x in range(6)))
"""Variances of the coefficients that are tried, by what one term shows over the noise."""

SINGULAR: Final = 1e-11
"""Directions of the parameters below this share of the largest are none."""


@dataclass(frozen=True)
class Intensity:
    """Variances over that of the noise: of the force's course, with its memory, and of terms."""

    course: float = 0.0
    memory: float = 1.0
    terms: float = 0.0


NONE: Final = Intensity()


@dataclass(frozen=True)
class Sums:
    """Sums of products of whitened rows.

    Attributes
    ----------
    forces, mixed
        H^T H and H^T Z of each trial; (K, K), (K, n_Z).
    fixed
        Z^T Z over all trials; (n_Z, n_Z).
    free, terms
        Columns of Z that are Psi, and G; the last one is e.
    scale
        Twice the logarithm of what whitening divided by.
    """

    forces: tuple[Vector, ...]
    mixed: tuple[Vector, ...]
    fixed: Vector
    free: int
    terms: int
    rows: int
    scale: float

    @property
    def knot(self) -> float:
        """What a unit force at one knot shows, mean square over the noise."""
        return float(np.mean(np.concatenate([np.diag(A) for A in self.forces])))

    @property
    def term(self) -> float:
        """What a term of coefficient one shows."""
        shown = self.fixed.diagonal()[self.free : self.free + self.terms]
        return float(np.mean(shown)) if self.terms else 1.0


def sums(
    H: Sequence[Vector], Z: Sequence[Vector], compared: Sequence[Mask], noise: Colour, free: int
) -> Sums:
    """Sums over all trials; responses (n, n_y, K) and columns (n, n_y, n_Z) of each."""
    forces, mixed, fixed, rows, scale = [], [], np.zeros((Z[0].shape[2],) * 2), 0, 0.0
    for h, z, m in zip(H, Z, compared, strict=True):
        both = whiten_rows(np.concatenate([h, z], axis=2), m, noise)
        products, k = both.T @ both, h.shape[2]
        forces.append(products[:k, :k])
        mixed.append(products[:k, k:])
        fixed += products[k:, k:]
        rows += len(both)
        scale += _log_scale(m, noise)
    return Sums(
        forces=tuple(forces),
        mixed=tuple(mixed),
        fixed=fixed,
        free=free,
        terms=len(fixed) - free - 1,
        rows=rows,
        scale=2.0 * scale,
    )


def _log_scale(compared: Mask, noise: Colour) -> float:
    return sum(
        float(windows(compared[:, c], noise.reach).all(axis=1).sum() * np.log(s))
        for c, s in enumerate(noise.deviations)
    )


def without_course(sums: Sums, force: Intensity) -> tuple[Vector, float]:
    """S = Z^T V^-1 Z, (n_Z, n_Z), and the logarithm of the determinant of V."""
    S, logdet = sums.fixed.copy(), 0.0
    if force.course == 0.0:
        return S, 0.0
    for A, M in zip(sums.forces, sums.mixed, strict=True):
        precision, log_Q = _precision(len(A), force.memory)
        L = cholesky(A + precision / force.course, lower=True, check_finite=False)
        R = solve_triangular(L, M, lower=True, check_finite=False)
        S -= R.T @ R
        logdet += 2.0 * float(np.log(np.diag(L)).sum()) + log_Q + len(A) * np.log(force.course)
    return S, logdet


def _precision(knots: int, memory: float) -> tuple[Vector, float]:
    """Inverse covariance of an Ornstein-Uhlenbeck process of variance 1, and log |covariance|."""
    rho = float(np.exp(-1.0 / memory))
    diagonal = np.full(knots, 1.0 + rho**2)
    diagonal[[0, -1]] = 1.0
    T = np.diag(diagonal) - rho * (np.eye(knots, k=1) + np.eye(knots, k=-1))
    return T / (1.0 - rho**2), (knots - 1) * float(np.log(1.0 - rho**2))


def without_terms(sums: Sums, S: Vector, variance: float) -> tuple[Vector, float]:
    """S of Psi and e alone, and what the terms add to the logarithm of the determinant of V."""
    kept = [*range(sums.free), len(S) - 1]
    if variance == 0.0 or not sums.terms:
        return S[np.ix_(kept, kept)], 0.0
    terms = slice(sums.free, sums.free + sums.terms)
    L = cholesky(S[terms, terms] + np.eye(sums.terms) / variance, lower=True, check_finite=False)
    R = solve_triangular(L, S[terms, kept], lower=True, check_finite=False)
    logdet = 2.0 * float(np.log(np.diag(L)).sum()) + sums.terms * float(np.log(variance))
    return S[np.ix_(kept, kept)] - R.T @ R, logdet


def deviance(sums: Sums, force: Intensity) -> float:
    """Twice the negative log likelihood, up to a constant of the record.

    Of the restricted kind: what free columns explain of noise is allowed for (Patterson &
    Thompson, 1971).
    """
    S, logdet = without_course(sums, force)
    return _deviance(sums, S, logdet, force.terms)


def _deviance(sums: Sums, S: Vector, logdet: float, variance: float) -> float:
    rest, log_terms = without_terms(sums, S, variance)
    left, log_free, rank = _eliminated(rest, sums.fixed.diagonal()[: sums.free])
    n = sums.rows - rank
    return n * float(np.log(left / n)) + logdet + log_terms + log_free + sums.scale


def _eliminated(S: Vector, sizes: Vector) -> tuple[float, float, int]:
    """Sum of squares of the last column beyond the others, log determinant of those, rank."""
    used = sizes > 0.0
    d = 1.0 / np.sqrt(sizes[used])
    w, U = np.linalg.eigh(S[:-1, :-1][np.ix_(used, used)] * d * d[:, None])
    kept = w > SINGULAR * w.max(initial=0.0)
    g = U[:, kept].T @ (S[:-1, -1][used] * d)
    left = float(S[-1, -1] - np.sum(g**2 / w[kept]))
    log_free = float(np.log(w[kept]).sum() + np.log(sizes[used]).sum())
    return max(left, 1e-300), log_free, int(kept.sum())


def most_likely(sums: Sums, near: Intensity = NONE) -> tuple[Intensity, float]:
    """The intensity that explains the residual best, and its deviance.

    `near` is that of a similar noise: then the courses about it are tried, not all of them.
    """
    if near.course > 0.0:
        first = [(near.course, near.memory)]
    else:
        first = [(0.0, 1.0), *((x / sums.knot, MEMORIES[1]) for x in COURSE)]
    best, least = NONE, np.inf
    for course, memory in first:
        best, least = min((best, least), _with_terms(sums, course, memory), key=_second)
    if best.course == 0.0:
        return best, least
    for memory in MEMORIES:
        best, least = min((best, least), _with_terms(sums, best.course, memory), key=_second)
    for step in (-0.5, 0.5, -0.25, 0.25):
        course = best.course * 10.0**step
        best, least = min((best, least), _with_terms(sums, course, best.memory), key=_second)
    return best, least


def _second(found: tuple[Intensity, float]) -> float:
    return found[1]


def _with_terms(sums: Sums, course: float, memory: float) -> tuple[Intensity, float]:
    """The most likely variance of the terms beside a course, and the deviance."""
    S, logdet = without_course(sums, Intensity(course, memory))
    tried = [x / sums.term for x in TERMS] if sums.terms else [0.0]
    found = [(_deviance(sums, S, logdet, x), x) for x in tried]
    least, variance = min(found)
    return Intensity(course, memory, variance), least


@dataclass(frozen=True)
class Estimate:
    """A force by its parts: at the knots of each trial, coefficients of terms, parameters moved.

    Attributes
    ----------
    knots, spread, follow
        Of each trial: mean (K,), covariance given the columns (K, K), and how much a knot gives way
        for each of the columns [Psi G]; (K, n_theta + n_G).
    columns, covariance
        Mean and covariance of d_theta and c; (n_theta + n_G,).
    """

    knots: tuple[Vector, ...]
    spread: tuple[Vector, ...]
    follow: tuple[Vector, ...]
    columns: Vector
    covariance: Vector


def estimate(sums: Sums, force: Intensity) -> Estimate:
    """The force given the record.

    Its covariance holds what free parameters could have taken: a force that a parameter can mimic
    is known only as far as the intensity says how large forces are.
    """
    S, _ = without_course(sums, force)
    rest, _ = without_terms(sums, S, force.terms)
    left, _, rank = _eliminated(rest, sums.fixed.diagonal()[: sums.free])
    sigma2 = left / (sums.rows - rank)
    inverse = _inverse(sums, S, force.terms)
    columns = inverse @ S[:-1, -1]
    knots, spread, follow = [], [], []
    for A, M in zip(sums.forces, sums.mixed, strict=True):
        V: Vector = np.zeros_like(A)
        if force.course > 0.0:
            V = np.asarray(np.linalg.inv(A + _precision(len(A), force.memory)[0] / force.course))
        follow.append(V @ M[:, :-1])
        knots.append(V @ M[:, -1] - follow[-1] @ columns)
        spread.append(sigma2 * V)
    return Estimate(tuple(knots), tuple(spread), tuple(follow), columns, sigma2 * inverse)


def draws(found: Estimate, count: int) -> list[Estimate]:
    """Forces as likely as their distribution says, the same on every call, in opposite pairs."""
    rng = np.random.default_rng(0)
    root, roots = _root(found.covariance), [_root(V) for V in found.spread]
    made = []
    for _ in range(count // 2):
        columns = root @ rng.standard_normal(len(root))
        knots = [L @ rng.standard_normal(len(L)) - B @ columns
                 for L, B in zip(roots, found.follow, strict=True)]  # fmt: skip
        for sign in (-1.0, 1.0):
            moved = tuple(f + sign * d for f, d in zip(found.knots, knots, strict=True))
            made.append(replace(found, knots=moved, columns=found.columns + sign * columns))
    return made


def _root(covariance: Vector) -> Vector:
    """A matrix whose product with its transpose is this one, which may have rows of zero."""
    d = np.sqrt(np.diag(covariance))
    if not d.any():
        return np.zeros_like(covariance)
    d = np.where(d > 0.0, d, 1.0)
    least = 1e-9 * np.eye(len(d))
    return np.asarray(d[:, None] * cholesky(covariance / d / d[:, None] + least, lower=True))


def _inverse(sums: Sums, S: Vector, variance: float) -> Vector:
    """Inverse of S over [Psi G] with the prior of the terms; zero where there are no terms."""
    P = S[:-1, :-1].copy()
    terms = np.arange(sums.free, len(P))
    used = np.diag(sums.fixed)[:-1] > 0.0
    if variance > 0.0:
        P[terms, terms] += 1.0 / variance
    else:
        used[terms] = False
    d = 1.0 / np.sqrt(np.diag(sums.fixed)[:-1][used])
    inner = np.linalg.pinv(P[np.ix_(used, used)] * d * d[:, None], rcond=SINGULAR, hermitian=True)
    inverse = np.zeros_like(P)
    inverse[np.ix_(used, used)] = inner * d * d[:, None]
    return inverse
