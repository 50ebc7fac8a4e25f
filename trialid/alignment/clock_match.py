"""How far two clocks are apart, by a motion that both logs hold.

The lag at which two measurements agree best, of either sign and any size, each as logged or its
rate (`clock_lag`). The best lag is refined, with a drift, by least squares, and its interval comes
from how differently the parts of the record would place it. What is weak, or as good elsewhere, is
refused.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from trialid.alignment.clock_lag import FEWEST, NARROW, PARTS, Peak, Steps, best_lag
from trialid.arrays import Vector
from trialid.errors import AlignmentError

MOST = 2**17
"""Steps of the common grid at most."""
SMOOTH = (4, 16, 64)
"""Steps of the running mean, taken twice, and of the difference that gives a rate."""
CLEAN = 0.9
"""Correlation of the slopes from which on no smoothing more is needed. The choice must not depend
on the interval that comes of it: that would be the shortest by chance."""
WORSE = 1.3
"""Times what the best relation leaves unexplained that any other must leave, at another lag."""
ROUNDS = 8
"""Steps of least squares."""
GAP = 5.0
"""Periods without a sample that are a gap."""
SURE = 3.0
"""Standard errors from which on a drift is believed."""
QUANTILE = 2.12
"""Student's t with 16 degrees of freedom, for 95 %."""


@dataclass(frozen=True)
class Signal:
    """A channel in the order of time: stamps [ns] and values; (N,) each."""

    name: str
    t: NDArray[np.int64]
    y: Vector


@dataclass(frozen=True)
class Match:
    """How far the clock here is ahead.

    Parameters
    ----------
    offset, reach
        Seconds beyond what was assumed, and half of the 95 % interval.
    drift, drift_reach
        How much it runs fast, 0 where that cannot be told from none, and half of its interval.
    middle
        Instant of the trial at which the offset holds [ns].
    clean
        Correlation of the slopes of what was compared, which is low where noise makes them.
    how
        What was compared, in words.
    """

    offset: float
    reach: float
    drift: float
    drift_reach: float
    middle: float
    clean: float
    how: str


def refuse_few(signal: Signal, where: str) -> None:
    """AlignmentError for a channel of too few values to match anything with."""
    if len(signal.t) < FEWEST:
        raise AlignmentError(
            f"{where}: {signal.name!r} has {len(signal.t)} values, at least {FEWEST} are needed"
        )


def match_clocks(here: Signal, there: Signal, about: int, within: float, where: str) -> Match:
    """How far the clock of `here` is ahead of `there`, beyond `about` [ns] and `within` [s].

    AlignmentError where it cannot be told.
    """
    origin = int(there.t[0])
    widths = _widths(here, there)
    if not widths:
        raise AlignmentError(
            f"{where} and {there.name!r} there cannot tell the offset: they are too short for "
            "their rate; give offset or events"
        )
    tries = [_best(here, there, origin + about, origin, width, within) for width in widths]
    good = [one for one in tries if isinstance(one, Match) and one.reach < NARROW * within]
    if good:
        return next((one for one in good if one.clean > CLEAN), good[-1])
    reasons = [one for one in tries if isinstance(one, str)]
    reason = reasons[0] if reasons else "no lag is better than its neighbours"
    raise AlignmentError(
        f"{where} and {there.name!r} there cannot tell the offset: {reason}; match other channels, "
        "or give offset or events"
    )


def _widths(here: Signal, there: Signal) -> list[tuple[float, int]]:
    """Steps of the common grid [s] with the running means on it."""
    spans = [(s.t[-1] - s.t[0]) / 1e9 for s in (here, there)]
    dt = max(float(np.median(np.diff(s.t))) / 1e9 / 2 for s in (here, there))
    dt = max(dt, max(spans) / MOST)
    return [(dt, width) for width in SMOOTH if 5 * PARTS * width * dt < min(spans)]


def _best(
    here: Signal, there: Signal, start: int, origin: int, smooth: tuple[float, int], within: float
) -> Match | str:
    """The offset by the relation that holds best, as logged or the rate of one, or why not."""
    dt, width = smooth
    a, b = _grid(here, start, dt, width), _grid(there, origin, dt, width)
    pairs = [
        (best_lag(left, right, within), left, right, f"{of_a} against {of_b}")
        for left, of_a in ((a, here.name), (_rate(a, width), f"the rate of {here.name}"))
        for right, of_b in ((b, there.name), (_rate(b, width), f"the rate of {there.name}"))
    ]
    peak, left, right, how = max(pairs, key=lambda one: one[0].strength)
    if peak.why_not:
        return peak.why_not
    found = _refined(peak, left, right, f"{how}, smoothed over {2 * width * dt:.2g} s", origin)
    for other, c, d, as_well in pairs:
        apart = abs(c.start - d.start + dt * other.lag - found.offset)
        if apart > max(3 * found.reach, 4 * width * dt) and _as_strong(other, peak):
            return f"{as_well} agrees as well, {apart:.3g} s away"
    return found


def _as_strong(other: Peak, best: Peak) -> bool:
    return 1 - other.strength**2 < WORSE * (1 - best.strength**2)


def _grid(signal: Signal, origin: int, dt: float, width: int) -> Steps:
    t = (signal.t - origin) / 1e9
    start = np.ceil(t[0] / dt) * dt
    at = start + dt * np.arange(int((t[-1] - start) / dt) + 1)
    after = np.clip(np.searchsorted(t, at), 1, len(t) - 1)
    apart = t[after] - t[after - 1]
    good = apart <= GAP * np.median(np.diff(t))
    y: Vector = np.interp(at, t, _unwrapped(signal.y))
    mean = np.ones(width) / width
    y = np.convolve(y - np.mean(y), np.convolve(mean, mean), "same")
    edge = np.convolve(~good, np.ones(2 * width + 1), "same") > 0.5
    edge[:width] = edge[-width:] = True
    return Steps(float(start), dt, y, ~edge)


def _unwrapped(y: Vector) -> Vector:
    """A heading without its jumps of a whole turn, in degrees or radians; else as it is."""
    for turn in (360.0, 2 * np.pi):
        jumps = np.abs(np.diff(y))
        if np.ptp(y) <= 1.001 * turn and np.any(jumps > 0.75 * turn):
            return np.unwrap(y, period=turn)
    return y


def _rate(grid: Steps, width: int) -> Steps:
    half = max(1, width // 2)
    y = np.zeros_like(grid.y)
    y[half:-half] = (grid.y[2 * half :] - grid.y[: -2 * half]) / (2 * half * grid.dt)
    good = grid.good & np.roll(grid.good, half) & np.roll(grid.good, -half)
    good[:half] = good[-half:] = False
    return Steps(grid.start, grid.dt, y, good)


def _refined(peak: Peak, a: Steps, b: Steps, how: str, origin: int) -> Match:
    """Lag and drift where the squares are least; their spread by parts of the record."""
    middle = float(np.mean(b.t[b.good]))
    ahead, drift = a.start - b.start + a.dt * peak.lag, 0.0
    for _ in range(ROUNDS):
        pulls, curve, gain, clean = _pull(a, b, ahead, drift, middle)
        step = -np.linalg.solve(curve, pulls.sum(axis=0))
        limit = np.array([1.0, 2.0 / max(1.0, len(pulls) * a.dt)])
        ahead, drift = np.array([ahead, drift]) + np.clip(step, -limit, limit)
    inverse = np.linalg.inv(curve)
    errors = np.sqrt(np.diag(inverse @ _spread(pulls) @ inverse.T))
    words = f"{how}, correlation {peak.strength:.2f} over {len(pulls) * a.dt:.0f} s"
    return Match(
        offset=float(ahead),
        reach=QUANTILE * float(errors[0]),
        drift=float(drift) if abs(drift) > SURE * errors[1] else 0.0,
        drift_reach=QUANTILE * float(errors[1]),
        middle=origin + middle * 1e9,
        clean=clean,
        how=words + (", of opposite sign" if gain < 0 else ""),
    )


def _pull(
    a: Steps, b: Steps, ahead: float, drift: float, middle: float
) -> tuple[Vector, Vector, float, float]:
    """Pull of each sample at lag and drift (n, 2), curvature (2, 2), gain, likeness of slopes.

    The curvature is that of the correlation, to which the noise of neither channel adds; the sum of
    squared slopes would take their noise for motion, and the interval would be too small.
    """
    slope = np.gradient(a.y, a.dt)
    bend = np.gradient(slope, a.dt)
    at = b.t + ahead + drift * (b.t - middle)
    use = b.good & (np.interp(at, a.t, a.good, 0.0, 0.0) > 0.999)
    t, at, y = b.t[use] - middle, at[use], b.y[use]
    level, rise = np.interp(at, a.t, a.y), np.interp(at, a.t, slope)
    design = np.column_stack([np.ones(len(t)), level])
    offset, gain = np.linalg.lstsq(design, y, rcond=None)[0]
    by = np.column_stack([np.ones(len(t)), t])
    pulls = ((y - offset - gain * level) * rise)[:, None] * by
    curve = by.T @ (((y - offset) * np.interp(at, a.t, bend))[:, None] * by)
    clean = abs(float(np.corrcoef(rise, np.gradient(b.y, b.dt)[use])[0, 1]))
    return pulls, curve, float(gain), clean


def _spread(pulls: Vector) -> Vector:
    """Covariance of the sum of pulls of which neighbours go together; (n, 2) to (2, 2)."""
    parts = np.array([part.sum(axis=0) for part in np.array_split(pulls, PARTS)])
    parts = parts - parts.mean(axis=0)
    return parts.T @ parts * (PARTS / (PARTS - 4))
