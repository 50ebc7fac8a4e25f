"""A stretch of stamps as a regression on its own count of samples, or as it was and why.

What speaks against the regression is in the stamps and, where they say nothing, in the values: true
instants make a smoother record than wrong ones.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from trialid.alignment.stamps.sample_index import (
    SINGLE,
    Count,
    Index,
    Vector,
    number_messages,
    pace,
    quantum,
)

FEWEST_COUNTED = 30
"""Samples in a row below which a pace cannot be told from chance."""
EVEN = 0.01
"""Jitter [periods] up to which stamps are left as logged."""
CHANCE = 0.18
"""Distance of the level from whole periods [periods] above which a series is not even: 0.29 is what
stamps at random give."""
MOST_JUMPS = 0.25
"""Share of messages that may follow a loss, ..."""
IN_WINDOW = 0.3
"""... and losses that may fall into one running median."""
WORTH = 1.1
"""Times the residual of a count without a loss that a count with losses must better."""
WANDER = 0.6
"""Correlation of neighbouring residuals above which it is the pace that varies, not the stamping"""
ROUGHER = 3.0
"""Standard errors by which the record may be rougher on the repaired stamps."""
PAIR = 2.0
"""Messages of one stamp up to which they may be two sources rather than a bundle."""
PIECES = (1, 4, 16, 64)
"""Pieces of the regression to choose from; each has at least FEWEST_IN_PIECE marks."""
FEWEST_IN_PIECE = 60
STIFF = 1e-9
"""Weight against bends, for pieces without a sample."""
TINY = 1e-9
"""Rounding of a stamp [s]."""
BETTER = 0.98
"""A regression in more pieces is taken when it leaves less than this share of the residual."""
MARKS = 50_000
"""Marks that a regression is taken of; more make it no better than a tenth of a millisecond."""
OUTLYING = 5.0
"""Residuals, in robust standard deviations, that a regression does not follow."""
UNEVEN = "it is sent on change, at no even pace, or too much is lost to count"


@dataclass(frozen=True)
class Line:
    """What became of a stretch of stamps.

    Parameters
    ----------
    t
        Stamps [s]; (N,).
    period
        Time between samples [s].
    before
        Jitter that was taken out [s rms]; 0 where nothing was.
    after
        What is left: the standard error of the regression [s].
    lost
        Samples the count misses.
    late
        Words on the constant that the regression cannot know.
    why_not
        Why the stamps stayed as they were, empty where they were even or were repaired.
    """

    t: Vector
    period: float
    before: float = 0.0
    after: float = 0.0
    lost: int = 0
    late: str = ""
    why_not: str = ""


def is_even(t: NDArray[np.int64]) -> bool:
    """True of stamps that step by whole periods, as near as nobody would mend them."""
    steps = np.diff(t).astype(np.float64)
    period = float(np.median(steps))
    if period <= 0 or steps.min() <= 0:
        return False
    near = steps[steps < 10 * period] / period
    return float(np.sqrt(np.mean((near - np.rint(near)) ** 2) / 2)) <= EVEN


def regress_stamps(t: Vector, y: Vector) -> Line:
    """The stretch on a regression, or as it is with the reason."""
    if len(t) < FEWEST_COUNTED:
        return Line(t, 0.0)
    if is_even(np.rint(t * 1e9).astype(np.int64)):
        return Line(t, float(np.median(np.diff(t))))
    if pace(t) <= 0.0:
        return Line(t, 0.0, why_not="the clock stood still")
    count, plain = number_messages(t), _unbroken(t)
    if count.misfit > CHANCE or count.jumps > min(MOST_JUMPS, IN_WINDOW / count.width):
        line = Line(t, 0.0) if count.bundled else _regressed(t, y, plain)
        return line if line.before else Line(t, 0.0, why_not=UNEVEN)
    if count.jumps and not count.bundled:
        bridged, whole = (_straightened(t, one)[1] for one in (count, plain))
        hidden = bridged > SINGLE * count.period  # below it single stamps tell whole periods
        count = plain if hidden and whole <= WORTH * bridged else count
    return _regressed(t, y, count)


def _unbroken(t: Vector) -> Count:
    """Every message as one sample: what is left to believe where jitter hides a whole period."""
    n = np.arange(len(t))
    return Count(
        period=max(pace(t), TINY), n=n, marks=n, bundled="", misfit=0.0, jumps=0.0, width=1
    )


def _regressed(t: Vector, y: Vector, count: Count) -> Line:
    """The stretch on a regression, unless it is even enough or something speaks against it."""
    fit, before, after = _straightened(t, count)
    period = float(fit[-1] - fit[0]) / max(1, int(count.n[-1] - count.n[0]))
    if before <= EVEN * count.period and not count.bundled:
        return Line(t, period)
    if why_not := _doubt(t, fit, count, y):
        return Line(t, 0.0, why_not=why_not)
    late, words = _constant(t, count)
    return Line(fit + late, period, before, after, _lost(count), words)


def _straightened(t: Vector, count: Count) -> tuple[Vector, float, float]:
    """Stamps on a line in pieces over the count, jitter about it and its standard error [s]."""
    residual = t - count.period * count.n
    marks = count.marks[:: 1 + len(count.marks) // MARKS]
    n, y = count.n[marks], residual[marks]
    allowed = [p for p in PIECES if p == 1 or len(n) >= FEWEST_IN_PIECE * p]
    knots, least = np.zeros(0), np.inf
    for pieces in allowed:
        heights = _heights(n, y, int(count.n[-1]), pieces)
        left = _spread(y - _between(heights, n, count))
        if left < BETTER * least:
            knots, least = heights, left
    fit = _between(knots, count.n, count)
    error = least * np.sqrt(len(knots) / len(n))
    return count.period * count.n + fit, _spread(residual - fit), error


def _spread(off: Vector) -> float:
    """Standard deviation of residuals, single odd stamps left out."""
    size = np.abs(off - np.median(off))
    return float(np.std(off[size <= OUTLYING * 1.4826 * np.median(size) + TINY]))


def _between(heights: Vector, n: Index, count: Count) -> Vector:
    """The line in pieces of equal length with these heights at its knots."""
    return np.interp(n, np.linspace(0.0, max(1, count.n[-1]), len(heights)), heights)


def _heights(n: Index, y: Vector, last: int, pieces: int) -> Vector:
    """Heights at the knots of the line in pieces nearest to `y` but for outliers; (pieces + 1,)."""
    place = n * (pieces / max(1, last))
    left = np.clip(place.astype(np.int64), 0, pieces - 1)
    share = place - left
    use = np.ones(len(n))
    heights: Vector = np.zeros(pieces + 1)
    for _ in range(3):
        normal = np.zeros((pieces + 1, pieces + 1))
        for a, wa in ((0, 1 - share), (1, share)):
            for b, wb in ((0, 1 - share), (1, share)):
                sums = np.bincount(left, use * wa * wb, pieces)
                normal[np.arange(pieces) + a, np.arange(pieces) + b] += sums
        right = np.bincount(left, use * (1 - share) * y, pieces + 1)
        right += np.bincount(left + 1, use * share * y, pieces + 1)
        bend = np.diff(np.eye(pieces + 1), 2, axis=0)
        normal += STIFF * len(n) * bend.T @ bend
        heights = np.asarray(np.linalg.lstsq(normal, right, rcond=None)[0], np.float64)
        off = np.abs(y - heights[left] * (1 - share) - heights[left + 1] * share)
        use = (off <= OUTLYING * 1.4826 * np.median(off) + TINY).astype(np.float64)
    return heights


def _doubt(t: Vector, fit: Vector, count: Count, y: Vector) -> str:
    """Why the logged stamps may be the true ones; empty where nothing says so."""
    if count.bundled:
        return _not_a_bundle(t, count, y)
    off = t - fit
    if np.corrcoef(off[1:], off[:-1])[0, 1] > WANDER:
        return "its pace varies slowly"
    return "the record is smoother on the logged stamps" if _rougher(t, fit, count.n, y) else ""


def _not_a_bundle(t: Vector, count: Count, y: Vector) -> str:
    """Why messages with one stamp may not follow one another in time; empty if nothing says so."""
    together = np.diff(t) == 0
    if together.any() and len(t) <= PAIR * len(count.marks):
        return "messages come in pairs of one stamp: two sources, or each delivered twice"
    same = np.diff(y) == 0
    if together.any() and same[together].mean() > 0.9 and same[~together].mean() < 0.5:
        return "messages of one stamp repeat one value"
    return ""


def _rougher(t: Vector, fit: Vector, n: Index, y: Vector) -> bool:
    """True when neighbours foretell the values better at the logged instants than at the fitted."""
    some = slice(0, MARKS)
    t, fit, n, y = t[some], fit[some], n[some], y[some]
    in_row = (np.diff(n) == 1) & (np.diff(t) > 0)
    inside = in_row[:-3] & in_row[1:-2] & in_row[2:-1] & in_row[3:]
    worse = _surprise(fit, y)[inside] - _surprise(t, y)[inside]
    worse = worse[np.isfinite(worse) & (worse != 0)]
    if len(worse) < FEWEST_COUNTED:
        return False
    # a sample is in five comparisons
    return float(np.mean(np.sign(worse))) * np.sqrt(len(worse) / 5.0) > ROUGHER


def _surprise(t: Vector, y: Vector) -> Vector:
    """Distance of each value from the cubic through its four neighbours; (N - 4,)."""
    count = len(t) - 4
    at, foretold = t[2:-2], np.zeros(count)
    places = (0, 1, 3, 4)
    with np.errstate(divide="ignore", invalid="ignore"):
        for i in places:
            weight = np.ones(count)
            for j in places:
                if j != i:
                    weight *= (at - t[j : j + count]) / (t[i : i + count] - t[j : j + count])
            foretold += weight * y[i : i + count]
    return np.abs(y[2:-2] - foretold)


def _constant(t: Vector, count: Count) -> tuple[float, str]:
    """What is added to the regression [s], and words on what it cannot know."""
    step = quantum(t)
    if step >= count.period / 2:
        added = count.period / 2 if count.bundled else step / 2
        return (
            added,
            f"taken as cut to {step:g} s; if they were rounded, they are {step / 2:g} s late",
        )
    if count.bundled:
        return 0.0, "by the last of those delivered together; their least latency stays as a delay"
    return 0.0, "their mean latency stays as a delay"


def _lost(count: Count) -> int:
    return int(np.sum(np.maximum(np.diff(count.n) - 1, 0)))
