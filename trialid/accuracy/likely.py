"""Where each parameter is likely to lie although something is missing: models averaged.

A standard error is right where the model is right. Where an effect is missing, the fitted
parameters stand in for it. To first order, with A the columns of what is fitted, S those of
something that may be missing and beta its size, the parameters move by

    dtheta = -(A^T A)^-1 A^T S beta

and what the record says of beta follows from its visible trace, S less what A reaches, with a wide
prior of its typical size. Each thing that may be missing makes a model; they are averaged by how
well they stand: Hoeting et al. (1999), Bayesian model averaging: a tutorial, Statistical Science
14. Numbers that were held fixed are part of every model, each uncertain by what its source says;
scales of the logs widen every model alike.

All of that is linear and knows no ends, as a normal distribution does; a parameter has them. Its
range ends where the search did: a GM of 0.012 m was likely from -0.012 m (`ranges`).
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.special import stdtrit  # scipy.stats would take another 0.4 s to import

from trialid.accuracy.one_missing import Reduced, Rival, posterior
from trialid.accuracy.ranges import LOG_SCALES
from trialid.arrays import Vector

WIDE: Final = 2.0
"""Standard deviation of what may be missing, in its typical sizes."""

COARSE: Final = (1.5, 6.0)
"""By how much the logarithm of the odds is divided: none of the models is the true one, and what is
missing may be outside the catalogue (Miller & Dunson 2019, Robust Bayesian inference via
coarsening, JASA 114). How much nobody knows, so that a range embraces what both say. On 650
simulated records with random effects hidden (seeds 100 to 250) ranges held 91 to 98 % of the truths
by kind of record; with 1 and 4 a point or two fewer; with 2 and 8 as many, a tenth wider."""

CONFIDENCE: Final = 0.975
"""Student's level of either end of a range."""


@dataclass(frozen=True, kw_only=True)
class Rows:
    """Normed stacked rows at a fit.

    Attributes
    ----------
    residual, psi
        (M,) and the columns of what is fitted (M, n_theta).
    priors
        Slope and gap of the row that each parameter's prior is, zero without; (n_theta, 2).
    held, deviations
        Columns of what was held fixed (M, n_h) and how uncertain each is (n_h,).
    S
        Columns of what may be missing, and last of scales of logs; (M, n_S).
    level
        What one independent row is uncertain by.
    scales
        How uncertain the last columns of `S` are beforehand, whatever is missing; (n_s,).
    """

    residual: Vector
    psi: Vector
    priors: Vector
    held: Vector
    deviations: Vector
    S: Vector
    level: float
    scales: Vector = field(default_factory=lambda: np.zeros(0))


@dataclass(frozen=True)
class Averaged:
    """By how much each parameter is likely to be off, beside noise.

    Attributes
    ----------
    shifts, variances
        Expected move and its variance for each coarseness, in the parameter's unit;
        (len(COARSE), n_theta).
    widest
        What widens each most: a rival's name, scales, or nothing where it is what was held fixed.
    """

    shifts: Vector
    variances: Vector
    widest: tuple[str, ...]

    def range(
        self, place: int, value: float, error: float, freedom: float = np.inf
    ) -> tuple[float, float] | None:
        """The 95 % range of a parameter of this value and standard error; None where unknown.

        It embraces what each coarseness says, and what the model says as it is. The error has so
        many degrees of freedom, together with what may be missing the more (Welch 1947).
        """
        own, whole = error**2, error**2 + np.append(self.variances[:, place], 0.0)
        if not np.all(np.isfinite(whole)):
            return None
        shared = np.divide(whole, own, out=np.ones_like(whole), where=own > 0.0)
        half = student(freedom * shared**2) * np.sqrt(whole)
        middle = value + np.append(self.shifts[:, place], 0.0)
        return float(np.min(middle - half)), float(np.max(middle + half))


def student(freedom: float | Vector) -> Vector:
    """How many standard errors either end of a 95 % range is away; 1.96 where they are well known.

    >>> float(student(np.inf).round(2)), float(student(10.0).round(2))
    (1.96, 2.23)
    """
    return np.asarray(stdtrit(np.maximum(freedom, 1.0), CONFIDENCE))


@dataclass(frozen=True)
class Standing:
    """How each model of what may be missing stands, with all that anything follows from it.

    Made from the rows once; they are not needed again.
    """

    known: Reduced
    rivals: tuple[Rival, ...]

    def average(self, slopes: Vector | None = None) -> Averaged:
        """Moves over all rivals and the model as it is, by how well each stands.

        Of the parameters, or of quantities that follow from them: by `slopes` of each by what is
        fitted, what is held and what may be missing; (n, n_theta + n_h + n_S). What is missing
        moves such a quantity through the parameters that stand in for it, and by itself.
        """
        known = self.known if slopes is None else _through(self.known, slopes)
        models = [_model(known, r) for r in (Rival("", (), ()), *self.rivals)]
        weights = self._weights([m.cost for m in models])
        moves, own = np.array([m.shift for m in models]), np.array([m.variance for m in models])
        scaled = np.sum(known.by_scales**2, axis=1)
        shifts = weights @ moves
        about = (moves - shifts[:, None]) ** 2
        variances = np.einsum("cm,cmi->ci", weights, own + about) + scaled
        # what is held fixed widens every model alike: a rival is named for what it adds
        added = np.maximum(own - own[0] + (moves - moves[0]) ** 2, 0.0)
        parts = weights.sum(axis=0)[:, None] * added
        parts[0] = len(COARSE) * own[0]
        parts = np.vstack([parts, len(COARSE) * scaled])
        names = ("", *(r.name for r in self.rivals), LOG_SCALES)
        return Averaged(shifts, variances, tuple(names[i] for i in parts.argmax(axis=0)))

    def draw(self, number: int, rng: np.random.Generator) -> "Drawn":
        """What might be so instead, drawn as often as each model of what is missing stands.

        Each coarseness has half of the draws; a range, which embraces what both say, is wider.
        """
        models = [Rival("", (), ()), *self.rivals]
        found = [posterior(self.known, r) for r in models]
        chances = np.mean(self._weights([m.cost for m in found]), axis=0)
        which = rng.choice(len(models), size=number, p=chances)
        columns = np.zeros((number, self.known.moves.shape[1] - 1))
        for m in np.unique(which):
            rows, one = np.flatnonzero(which == m), found[m]
            drawn = one.drawn(len(rows), rng)
            columns[np.ix_(rows, np.array(one.places, dtype=int) - 1)] = drawn * one.sizes
        off = self.known.off_in_scale
        normal = rng.standard_normal((number, len(off)))
        columns[:, columns.shape[1] - len(off) :] = normal @ off.T
        return Drawn(which - 1, -columns @ self.known.moves[:, 1:].T, columns)

    def _weights(self, costs: Sequence[float]) -> Vector:
        """How each model stands, by each coarseness; (len(COARSE), n), rows of sum one."""
        cost, before = np.array(costs), np.array([1.0, *(r.share for r in self.rivals)])
        weights = before * np.exp(-0.5 * (cost - cost.min()) / np.array(COARSE)[:, None])
        return np.asarray(weights / weights.sum(axis=1, keepdims=True))


@dataclass(frozen=True)
class Drawn:
    """What draws suppose, beside noise.

    Attributes
    ----------
    rivals
        Place of what is missing among the rivals, -1 for nothing; (n,).
    moves
        What the fitted parameters are off by, in their units; (n, n_theta).
    columns
        What was held fixed is off by, then the size of what is missing, then what scales are off
        by; (n, n_h + n_S).
    """

    rivals: NDArray[np.int64]
    moves: Vector
    columns: Vector


def average(rows: Rows, rivals: Sequence[Rival]) -> Averaged:
    """The parameters' moves over all rivals and the model as it is, by how well each stands."""
    return stand(rows, rivals).average()


def stand(rows: Rows, rivals: Sequence[Rival]) -> Standing:
    """How all rivals and the model as it is stand by these rows."""
    return Standing(_reduce(rows), tuple(rivals))


def _through(known: Reduced, slopes: Vector) -> Reduced:
    """The same for quantities that follow from parameters, from what is held and what is added."""
    fitted = len(known.moves)
    moves = slopes[:, :fitted] @ known.moves
    moves[:, 1:] -= slopes[:, fitted:]
    return replace(known, moves=moves)


def _reduce(rows: Rows) -> Reduced:
    slopes, gaps = rows.priors.T
    sizes = np.sqrt(np.sum(rows.psi**2, axis=0) + slopes**2)
    sizes = np.where(sizes > 0.0, sizes, 1.0)
    known = np.concatenate([rows.psi, np.diag(slopes)]) / sizes
    left = np.column_stack([rows.residual, rows.held, rows.S])
    beside = np.zeros((len(gaps), left.shape[1]))
    beside[:, 0] = gaps
    inverse = np.linalg.pinv(known, rcond=1e-10)
    answer = inverse[:, : len(left)] @ left + inverse[:, len(left) :] @ beside
    left -= known[: len(left)] @ answer
    beside -= known[len(left) :] @ answer
    gram = left.T @ left + beside.T @ beside
    variance = max(rows.level**2, 1e-30)
    squares = float(rows.residual @ rows.residual)
    return Reduced(
        gram=gram,
        moves=answer / sizes[:, None],
        deviations=rows.deviations,
        scales=rows.scales,
        variance=variance,
        independent=max(squares / variance, 1.0),
    )


@dataclass(frozen=True)
class _Model:
    """One model of what is missing: -2 log of its standing, the parameters' move and variance."""

    cost: float
    shift: Vector
    variance: Vector


def _model(known: Reduced, rival: Rival) -> _Model:
    """What that does to the parameters, or to what follows from them."""
    found = posterior(known, rival)
    moves, expected = known.moves[:, found.places] * found.sizes, found.expected
    return _Model(
        cost=found.cost,
        shift=-moves @ expected,
        variance=np.einsum("ij,jk,ik->i", moves, found.covariance, moves),
    )
