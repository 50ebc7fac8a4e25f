"""How two signals that should tell the same go together: correlation, gain and lag.

Both are taken as means over stretches of time, of the length that shows the relation best: short
stretches drown in noise, long ones are few. The gain is known no better than between its two
regressions: that of the second on the first is too small by the noise of the first, that of the
first on the second too large by the noise of the second.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from trialid.arrays import Mask, Vector
from trialid.white_noise import white_noise_of_most

FEWEST_STRETCHES = 20
"""Independent stretches the record must hold; fewer correlate by chance."""
MOST_SAMPLES = 20_000
"""Longer records are averaged down to so many: slow agreement needs no more."""
LONGEST_LAG = 20.0
"""[s] The longest lag looked for; real rate-of-turn sensors smooth by up to 9 s."""
PARTS = 4
"""Parts of the record the gain is found in one by one: their spread belongs to its interval."""


@dataclass(frozen=True)
class Pair:
    """Two signals on one clock: what is compared, where both are valid; (N,) each.

    In a mean over n samples the noise of the first falls as n to the power `fades`: a half where
    it is white, one where it is the slope of a noisy angle, of which only the ends count.
    """

    first: Vector
    second: Vector
    valid: Mask
    period: float
    fades: float = 0.5

    @property
    def duration(self) -> float:
        """From the first to the last sample [s]."""
        return (len(self.first) - 1) * self.period


@dataclass(frozen=True, kw_only=True)
class Relation:
    """The second signal is `gain` times the first, `lag` seconds later.

    Parameters
    ----------
    correlation
        Of the two at the lag that shows it best, with its sign.
    gain
        Lowest and highest value it may have.
    lag
        By how much the second comes later [s]; its interval holds every lag that fits nearly as
        well.
    lags
        Shortest and longest lag that fits nearly as well [s].
    at_once
        Correlation at no lag.
    against
        Largest correlation of the opposite sign with the second later: where a regular motion
        lags by half a swing, the two signs cannot be told apart.
    length
        Of the stretches [s].
    swing
        Mean time of a whole swing of the first [s].
    moves
        By how much each signal's mean varies over the stretches, in units of its own noise there.
    parts
        Correlation in each part of the record.
    """

    correlation: float
    gain: tuple[float, float]
    lag: float
    lags: tuple[float, float]
    at_once: float
    against: float
    length: float
    swing: float
    moves: tuple[float, float]
    parts: tuple[float, ...]

    @property
    def ambiguous(self) -> bool:
        """True when the opposite sign fits nearly as well with the second later."""
        return 1 - self.against**2 <= 1.5 * (1 - self.correlation**2)

    @property
    def later(self) -> bool:
        """True when no lag of zero fits nearly as well."""
        return self.lags[0] > 0 or self.lags[1] < 0


def of_slope(rate: Vector, angle: Vector, valid: Mask, period: float) -> Relation | None:
    """`rate` against the slope of `angle`; None where the record is too short to tell."""
    slope, mean = np.diff(angle) / period, (rate[1:] + rate[:-1]) / 2
    return _best(_thinned(Pair(slope, mean, valid[1:] & valid[:-1], period, fades=1.0)))


def of_values(first: Vector, second: Vector, valid: Mask, period: float) -> Relation | None:
    """`second` against `first`, as they are; None where the record is too short to tell."""
    return _best(_thinned(Pair(first, second, valid, period)))


def _thinned(pair: Pair) -> Pair:
    """Means over so many samples that no more than MOST_SAMPLES are left."""
    step = math.ceil(len(pair.first) / MOST_SAMPLES)
    whole = len(pair.first) // step * step
    first, second = (y[:whole].reshape(-1, step).mean(axis=1) for y in (pair.first, pair.second))
    valid = np.asarray(pair.valid[:whole].reshape(-1, step).all(axis=1))
    return Pair(first, second, valid, pair.period * step, pair.fades)


def _best(pair: Pair) -> Relation | None:
    """The relation for the length of stretches that shows it best."""
    found = [_relation(pair, length) for length in _lengths(len(pair.first))]
    told = [one for one in found if one is not None]
    return max(told, key=lambda one: abs(one.correlation), default=None)


def _lengths(samples: int) -> Iterator[int]:
    """Stretches of 1, 2, 4, ... samples, as long as enough of them fit."""
    length = 1
    while length * FEWEST_STRETCHES <= samples:
        yield length
        length *= 2


def _relation(pair: Pair, length: int) -> Relation | None:
    first, valid = _means(pair.first, pair.valid, length)
    second, _ = _means(pair.second, pair.valid, length)
    if np.sum(valid) < FEWEST_STRETCHES * length:
        return None
    lags = _lags(pair)
    found = correlations(first, second, valid, len(lags) // 2)
    if not np.any(found):
        return None
    best = _nearest_peak(found)
    x, y = _shifted(first, second, valid, int(lags[best]))
    against = np.max(-found[len(lags) // 2 :] * np.sign(found[best]), initial=0.0)
    noise = white_noise_of_most(pair.first[pair.valid]) / length**pair.fades
    other = white_noise_of_most(pair.second[pair.valid]) / length**0.5
    moves = _moves(x, noise), _moves(y, other)
    lag, interval = _lag(np.float64(pair.period) * lags, found, best)
    return Relation(
        correlation=float(found[best]),
        gain=_gain(x, y),
        lag=lag,
        lags=interval,
        at_once=float(found[len(lags) // 2]),
        against=float(against),
        length=length * pair.period,
        swing=_swing(x, pair.period),
        moves=moves,
        parts=tuple(_correlation(a, b) for a, b in _parts(x, y)),
    )


def _lags(pair: Pair) -> NDArray[np.int64]:
    """Lags to try [samples], as many either way."""
    most = int(min(LONGEST_LAG, pair.duration / 8) / pair.period)
    return np.arange(-most, most + 1)


def correlations(first: Vector, second: Vector, valid: Mask, most: int) -> Vector:
    """Correlation at each lag of the second from -most to most samples; (2 most + 1,).

    Each over the pairs that are both valid, 0 where one of the two does not move among them.
    """
    x = np.where(valid, first - np.mean(first[valid]), 0.0)
    y = np.where(valid, second - np.mean(second[valid]), 0.0)
    size = 2 ** math.ceil(math.log2(len(x) + most + 1))
    known, fx, fxx = (np.fft.rfft(z, size) for z in (valid.astype(np.float64), x, x**2))
    fy, fyy = np.fft.rfft(y, size), np.fft.rfft(y**2, size)

    def summed(a: NDArray[np.complex128], b: NDArray[np.complex128]) -> Vector:
        whole = np.fft.irfft(np.conj(a) * b, size)
        return np.concatenate([whole[size - most :], whole[: most + 1]])

    n = np.maximum(np.rint(summed(known, known)), 1.0)
    sx, sy = summed(fx, known), summed(known, fy)
    xx, yy = summed(fxx, known) - sx**2 / n, summed(known, fyy) - sy**2 / n
    told = (n >= FEWEST_STRETCHES) & (xx > 1e-9 * (x @ x)) & (yy > 1e-9 * (y @ y))
    product = np.where(told, xx * yy, 1.0)
    return np.where(told, (summed(fx, fy) - sx * sy / n) / np.sqrt(product), 0.0)


def _nearest_peak(found: Vector) -> int:
    """Of the peaks that fit nearly as well as the best, the one of the shortest lag.

    A regular roll agrees with itself a whole period later as well.
    """
    strength = np.abs(found)
    beside = np.pad(strength, 1)
    peaks = np.flatnonzero((strength >= beside[:-2]) & (strength >= beside[2:]))
    near = peaks[_near(strength[peaks], float(strength.max()))]
    return int(near[np.argmin(np.abs(near - len(found) // 2))])


def _near(strength: Vector, best: float) -> Mask:
    """Where what is left unexplained is less than a fifth more than at the best."""
    return 1 - strength**2 <= 1.2 * (1 - best**2) + 1e-9


def _swing(x: Vector, period: float) -> float:
    """Mean time of a whole swing about the mean [s]."""
    above = x > np.mean(x)
    crossings = int(np.sum(above[1:] != above[:-1]))
    return 2 * len(x) * period / max(crossings, 1)


def _means(y: Vector, valid: Mask, length: int) -> tuple[Vector, Mask]:
    """Mean over every stretch of `length` samples, and whether all of it is valid."""
    total = np.concatenate([[0.0], np.cumsum(np.where(valid, y, 0.0))])
    missing = np.concatenate([[0], np.cumsum(~valid)])
    return (total[length:] - total[:-length]) / length, missing[length:] == missing[:-length]


def _shifted(first: Vector, second: Vector, valid: Mask, lag: int) -> tuple[Vector, Vector]:
    """The valid pairs when the second is looked up `lag` samples later."""
    n = len(first) - abs(lag)
    a, b = max(0, -lag), max(0, lag)
    both = valid[a : a + n] & valid[b : b + n]
    return first[a : a + n][both], second[b : b + n][both]


def _correlation(x: Vector, y: Vector) -> float:
    """Correlation; 0 where one of the two does not move."""
    if len(x) < FEWEST_STRETCHES:
        return 0.0
    dx, dy = x - x.mean(), y - y.mean()
    size = math.sqrt(float(dx @ dx) * float(dy @ dy))
    small = 1e-12 * (1e-30 + float(np.abs(x).max()) * float(np.abs(y).max())) * len(x)
    return float(dx @ dy) / size if size > small else 0.0


def _lag(lags: Vector, found: Vector, best: int) -> tuple[float, tuple[float, float]]:
    """Where a peak is, by a parabola between the tried lags, and those that fit nearly as well."""
    strength = np.abs(found)
    lag = float(lags[best])
    if 0 < best < len(lags) - 1:
        a, b, c = strength[best - 1 : best + 2]
        bend = a - 2 * b + c
        lag += float(lags[1] - lags[0]) * (0.5 * (a - c) / bend if bend < 0 else 0.0)
    near = lags[_near(strength, float(strength[best]))]
    half = float(lags[1] - lags[0]) / 2 if len(lags) > 1 else 0.0
    return lag, (float(near.min()) - half, float(near.max()) + half)


def _gain(x: Vector, y: Vector) -> tuple[float, float]:
    """From the flatter to the steeper regression, over the whole and over every part."""
    both = [bound for a, b in ((x, y), *_parts(x, y)) for bound in _regressions(a, b)]
    return (min(both), max(both)) if both else (0.0, math.inf)


def _regressions(x: Vector, y: Vector) -> tuple[float, ...]:
    """Size of the second on the first, and of one over the first on the second."""
    dx, dy = x - x.mean(), y - y.mean()
    xx, xy, yy = float(dx @ dx), abs(float(dx @ dy)), float(dy @ dy)
    return (xy / xx, yy / xy) if min(xx, xy) > 0 else ()


def _parts(x: Vector, y: Vector) -> list[tuple[Vector, Vector]]:
    """The parts of the record in which the first moves as it does in the whole."""
    moves = 0.25 * float(np.std(x))
    pieces = zip(np.array_split(x, PARTS), np.array_split(y, PARTS), strict=True)
    return [(a, b) for a, b in pieces if len(a) >= FEWEST_STRETCHES and np.std(a) > moves]


def _moves(means: Vector, noise: float) -> float:
    """Spread of the means over stretches, in units of the noise left in them."""
    return float(np.std(means)) / noise if noise > 0 else math.inf
