"""From a channel's own clock to the grid of the trial.

When any channel of the trial is faster than the grid, every channel passes the same low-pass
filter, with the same impulse response in seconds, inputs and outputs alike: a filter on one side
only would bias the model. When none is faster, none is filtered.

Each stretch between gaps is treated on its own. It is interpolated to a uniform fine grid, PCHIP
for motions and straight lines for the rudder (which moves in ramps, and must not overshoot), and
the filter is evaluated at the instants of the trial's grid. The step of the fine grid divides the
trial's period and is no longer than the channel's own period; so a channel that is sampled evenly
and in step with the grid keeps its own samples. A channel slower than the grid is interpolated to
the fine grid in the same way and passes the same filter: it then has no less and no more delay or
smoothing than the others, but no more content than it was sampled with either.
"""

import math
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from trialid.alignment.clocks import Grid, Series
from trialid.alignment.curve import curve
from trialid.names.quantities import RUDDERS, SIGNALS

Vector = NDArray[np.float64]
Mask = NDArray[np.bool_]
Stretch = tuple[int, int]
"""First and last sample of a stretch without a gap."""

GAP_PERIODS = 3.0
"""A channel that misses two samples in a row still tells the motion; one that misses more not."""
GAP_GRID_PERIODS = 2.0
"""A hole no longer than two periods of the grid leaves a sample near every grid point."""
FASTER = 0.99
"""A channel is faster than the grid below this share of its period: jitter alone is not speed."""

CUT_OFF = 0.6
"""Frequency where the filter halves the amplitude, as a share of the grid's Nyquist frequency."""
HALF_LENGTH = 5
"""Half of the filter's length in periods of the grid."""
BETA = 5.0
"""Kaiser window: 0.3 % flat below 0.27 of the Nyquist frequency, under 0.3 % above 0.95 of it."""
FINEST = 8
"""Fine steps in a period of the grid at least: interpolation adds nothing the filter passes."""

LEEWAY = 1e-6
"""Rounding of instants, as a share of the period."""


def faster(series: Series, period: float) -> bool:
    """True when the channel has more samples than the grid and could fold motion over."""
    return series.period < FASTER * period


def longest_step(series: Series, period: float) -> float:
    """Distance between available values [s] above which there is a gap."""
    return max(GAP_PERIODS * series.period, GAP_GRID_PERIODS * period)


def stretches(t: Vector, longest: float) -> list[Stretch]:
    """The stretches of stamps [s] without a gap.

    >>> stretches(np.array([0.0, 1.0, 2.0, 9.0, 10.0]), 3.0)
    [(0, 2), (3, 4)]
    """
    breaks = np.flatnonzero(np.diff(t) > longest * (1 + LEEWAY))
    return [
        (int(i), int(j)) for i, j in zip([0, *(breaks + 1)], [*breaks, len(t) - 1], strict=True)
    ]


def available(series: Series, grid: Grid) -> tuple[Vector, Vector]:
    """Times [s] and values of the samples that are available, angles unwrapped; (n,) each."""
    finite = np.isfinite(series.y)
    y = series.y[finite]
    return grid.seconds(series.t[finite]), np.unwrap(y) if series.quantity.angle else y


def resample(series: Series, grid: Grid, *, smooth: bool) -> tuple[Vector, Mask]:
    """Values on the grid, and where they may be believed; (samples,) each.

    Outside of the stretches the values are a straight line, held at the ends, to keep a simulation
    going; they are not valid, nor are those nearer to the end of a stretch than half the filter.
    """
    t, y = available(series, grid)
    value, inside = np.zeros(grid.samples), np.zeros(grid.samples, np.bool_)
    valid = inside.copy()
    margin = (HALF_LENGTH if smooth else 0.0) * grid.period
    leeway = LEEWAY * grid.period
    for first, last in stretches(t, longest_step(series, grid.period)):
        begin, end = t[first], t[last]
        here = (grid.t >= begin - leeway) & (grid.t <= end + leeway)
        if not here.any():
            continue
        motion = _curve(series.quantity.name, t[first : last + 1], y[first : last + 1])
        steps = _fine_steps(series.period, grid.period) if smooth else 0
        value[here] = _values(motion, grid.t[here], (begin, end), grid.period, steps)
        valid |= here & (grid.t >= begin + margin - leeway) & (grid.t <= end - margin + leeway)
        inside |= here
    if inside.any():
        value = np.where(inside, value, np.interp(grid.t, grid.t[inside], value[inside]))
    return value, valid


def _curve(quantity: str, t: Vector, y: Vector) -> Callable[[Vector], Vector]:
    """The motion between its samples."""
    if quantity in RUDDERS or quantity not in SIGNALS or len(t) == 1:
        return lambda at: np.interp(at, t, y)
    with np.errstate(over="ignore"):  # beside a step of 1e-300 any other is without end
        return curve(t, y)


def _fine_steps(own: float, period: float) -> int:
    """Steps of the fine grid in a period of the trial's grid."""
    needed = max(1, math.ceil(FASTER * period / own))
    return needed * math.ceil(FINEST / needed)


def _values(
    motion: Callable[[Vector], Vector],
    t: Vector,
    ends: tuple[float, float],
    period: float,
    steps: int,
) -> Vector:
    """The motion at the instants `t` [s], a run of grid points; filtered unless `steps` is 0."""
    if not steps:
        return motion(np.clip(t, *ends))
    reach = HALF_LENGTH * steps
    count = (len(t) - 1) * steps + 2 * reach + 1
    fine = t[0] + (np.arange(count) - reach) * (period / steps)
    y = _extended(motion, fine, ends)
    windows = np.lib.stride_tricks.sliding_window_view(y, 2 * reach + 1)[::steps]
    return np.einsum("ij,j->i", windows, kernel(steps))


def _extended(motion: Callable[[Vector], Vector], t: Vector, ends: tuple[float, float]) -> Vector:
    """The motion, continued beyond its ends by its own point reflection, level and slope kept."""
    begin, end = ends
    nearest_end = np.clip(t, begin, end)
    mirrored = np.clip(2 * nearest_end - t, begin, end)
    return np.where(
        t == nearest_end, motion(nearest_end), 2 * motion(nearest_end) - motion(mirrored)
    )


def kernel(steps: int) -> Vector:
    """The filter's impulse response, `steps` samples in a period of the grid, of sum one."""
    periods = np.arange(-HALF_LENGTH * steps, HALF_LENGTH * steps + 1) / steps
    response = np.sinc(CUT_OFF * periods) * np.kaiser(len(periods), BETA)
    return response / response.sum()


def any_faster(series: Sequence[Series], period: float) -> bool:
    """True when a filter is needed."""
    return any(faster(one, period) for one in series)
