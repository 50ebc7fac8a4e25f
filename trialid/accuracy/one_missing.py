"""What a record says of one thing that may be missing, beside all that was held fixed."""

from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.special import ndtr, ndtri  # scipy.stats would take another 0.4 s to import

from trialid.arrays import Vector

FAR: Final = 35.0
"""Standard deviations that nothing goes beyond: the density is there still a number."""


@dataclass(frozen=True)
class Rival:
    """Something that may be missing: its columns, and the standard deviation of each size.

    Attributes
    ----------
    limits
        Lowest and highest size of a single column: what is weak has lost something, and what is
        tried at a value is there in part or whole, never the other way round.
    share
        Of the chance beforehand that anything has: an effect tried at ten values is one effect.
    """

    name: str
    columns: tuple[int, ...]
    deviations: tuple[float, ...]
    limits: tuple[float, float] | None = None
    share: float = 1.0


@dataclass(frozen=True, kw_only=True)
class Reduced:
    """Sums of products with the fitted parameters taken out; the residual first, then the held.

    `moves` is what the parameters, or what follows from them, do per unit of each column, with its
    sign turned; (n, 1 + n_h + n_S). The last columns are of scales, uncertain by `scales`.
    """

    gram: Vector
    moves: Vector
    deviations: Vector
    scales: Vector
    variance: float
    independent: float

    @property
    def off_in_scale(self) -> Vector:
        """Columns that add up to how far scales may be off together; (n_s, n_s).

        What they leave to see says how far they are, to the noise, were nothing else missing. What
        is missing looks like scales, too: all that is left along them counts as noise.
        """
        last = np.s_[len(self.gram) - len(self.scales) :]
        seen = self.gram[last, last] * np.outer(self.scales, self.scales)
        moment = self.gram[last, 0] * self.scales
        along = float(moment @ np.linalg.pinv(seen, hermitian=True) @ moment)
        told = np.eye(len(self.scales)) + seen / (self.variance + along)
        root = np.linalg.cholesky(np.linalg.inv(told))
        return np.asarray(self.scales[:, None] * root)

    @property
    def by_scales(self) -> Vector:
        """Moves by each of these columns; (n, n_s)."""
        first = self.moves.shape[1] - len(self.scales)
        return np.asarray(self.moves[:, first:] @ self.off_in_scale)


@dataclass(frozen=True, kw_only=True)
class Posterior:
    """What the record says of the columns of a model, in sizes, and -2 log of its standing.

    The last of them lies within `cut`, the others as normal as they are without it.
    """

    places: list[int]
    sizes: Vector
    middle: Vector
    spread: Vector
    cut: "Cut | None"
    cost: float

    @property
    def expected(self) -> Vector:
        """Mean of each size."""
        if self.cut is None:
            return self.middle
        return self.middle + self._with_last() * self.cut.mean * self._deviation

    @property
    def covariance(self) -> Vector:
        """Of the sizes."""
        if self.cut is None:
            return self.spread
        by = self._with_last() * self._deviation
        return np.asarray(self.spread + (self.cut.variance - 1.0) * np.outer(by, by))

    def drawn(self, number: int, rng: np.random.Generator) -> Vector:
        """Sizes as likely as they are; (number, n)."""
        white = rng.standard_normal((number, len(self.places)))
        sizes = self.middle + white @ np.linalg.cholesky(self.spread).T
        if self.cut is not None:
            last = (sizes[:, -1] - self.middle[-1]) / self._deviation
            moved = (self.cut.of(last) - last) * self._deviation
            sizes += moved[:, None] * self._with_last()
        return np.asarray(sizes)

    @property
    def _deviation(self) -> float:
        return float(np.sqrt(self.spread[-1, -1]))

    def _with_last(self) -> Vector:
        """What each size moves by as the last one does."""
        return np.asarray(self.spread[:, -1] / self.spread[-1, -1])


@dataclass(frozen=True)
class Cut:
    """The standard normal distribution between two limits."""

    low: float
    high: float

    @property
    def mass(self) -> float:
        """How much of it lies between them."""
        if self.low > 0.0:
            return Cut(-self.high, -self.low).mass
        return max(float(ndtr(self.high) - ndtr(self.low)), 1e-300)

    @property
    def mean(self) -> float:
        """Its mean."""
        low, high = _density(self.low), _density(self.high)
        return float(np.clip((low - high) / self.mass, self.low, self.high))

    @property
    def variance(self) -> float:
        """Its variance."""
        low, high = (x * _density(x) for x in (self.low, self.high))
        return max(1.0 + (low - high) / self.mass - self.mean**2, 0.0)

    def of(self, normal: Vector) -> Vector:
        """Standard normal numbers brought between the limits, in their order."""
        if self.low > 0.0:
            return -Cut(-self.high, -self.low).of(-normal)
        level = ndtr(self.low) + ndtr(normal) * self.mass
        return np.asarray(np.clip(ndtri(level), self.low, self.high))


def _density(x: float) -> float:
    return float(np.exp(-0.5 * x * x) / np.sqrt(2.0 * np.pi))


def posterior(known: Reduced, rival: Rival) -> Posterior:
    """What the record says if this is missing, and all that was held fixed is uncertain."""
    held = len(known.deviations)
    places = [*range(1, held + 1), *(1 + held + c for c in rival.columns)]
    sizes = np.append(known.deviations, rival.deviations)
    gram = known.gram[np.ix_(places, places)] * np.outer(sizes, sizes) / known.variance
    moment = known.gram[places, 0] * sizes / known.variance
    spread = np.asarray(np.linalg.inv(gram + np.eye(len(places))), dtype=np.float64)
    middle = spread @ moment
    cost = len(rival.columns) * float(np.log(known.independent)) - float(moment @ middle)
    cut = None
    if rival.limits is not None:
        limits = np.array(rival.limits) / sizes[-1]
        deviation = float(np.sqrt(spread[-1, -1]))
        before, cut = _between(limits), _between((limits - middle[-1]) / deviation)
        cost -= 2.0 * float(np.log(cut.mass / before.mass))
    return Posterior(places=places, sizes=sizes, middle=middle, spread=spread, cut=cut, cost=cost)


def _between(limits: Vector) -> Cut:
    low, high = np.clip(limits, -FAR, FAR).tolist()
    return Cut(low, high)
