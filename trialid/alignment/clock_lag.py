"""The lag at which two measurements on even steps agree best, and whether it stands alone.

The agreement is a correlation over what overlaps at each lag, gaps left out.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from trialid.arrays import Vector

WEAK = 0.7
"""Correlation below which two channels do not show the same motion."""
BEYOND = 2.0
"""Times less that may be left unexplained further apart than the clocks are said to be."""
NARROW = 0.1
"""Share of the search that the interval may be."""
UNIQUE = 3.0
"""Standard errors by which the best lag must be better than any other."""
PARTS = 20
"""Parts of the record that show the spread."""
FEWEST = 100
"""Steps that must overlap."""
SHARE = 0.3
"""Share of the shorter record that must overlap."""
MOVES = 0.05
"""Share of a channel's variance that what overlaps must have."""


@dataclass(frozen=True)
class Steps:
    """Values on steps of `dt` from `start` [s]; those in gaps and at the ends are not `good`."""

    start: float
    dt: float
    y: Vector
    good: NDArray[np.bool_]

    @property
    def t(self) -> Vector:
        """Instants of the steps [s]; (N,)."""
        return self.start + self.dt * np.arange(len(self.y), dtype=np.float64)


@dataclass(frozen=True)
class Peak:
    """Where two grids agree best: correlation, lag [steps], or why that tells nothing."""

    strength: float
    lag: int = 0
    why_not: str = ""


def best_lag(a: Steps, b: Steps, within: float) -> Peak:
    """The lag at which `a` agrees best with `b`, and whether it stands alone."""
    lags, rho = _correlation(a, b)
    ahead = a.start - b.start + a.dt * lags
    far = np.abs(ahead) > within
    near = np.where(far, 0.0, np.abs(rho))
    best, beyond = int(np.argmax(near)), int(np.argmax(np.where(far, np.abs(rho), 0.0)))
    strength, lag = float(near[best]), int(lags[best])
    if abs(rho[beyond]) > WEAK and 1.0 - rho[beyond] ** 2 < (1.0 - strength**2) / BEYOND:
        words = f"they agree better {abs(ahead[beyond]):.4g} s apart, and within = {within:g} s"
        return Peak(float(abs(rho[beyond])), lag, words)
    if strength < WEAK:
        return Peak(strength, lag, f"the best correlation within {within:g} s is {strength:.2f}")
    lobe = np.sign(rho[best]) * rho > 0.5 * strength
    ends = np.flatnonzero(~lobe)
    near[ends[ends < best].max(initial=-1) + 1 : ends[ends > best].min(initial=len(rho))] = 0.0
    beside = round(NARROW * within / a.dt)
    for rival in (int(np.argmax(near)), best - beside, best + beside):
        if 0 <= rival < len(rho) and not _better(a, b, int(lags[best]), int(lags[rival]), rho):
            return Peak(
                strength,
                lag,
                f"they agree as well {abs(ahead[rival] - ahead[best]):.3g} s away (correlation "
                f"{strength:.2f} and {abs(rho[rival]):.2f})",
            )
    return Peak(strength, lag)


def _correlation(a: Steps, b: Steps) -> tuple[NDArray[np.int64], Vector]:
    """Lags [steps] of a behind b and the correlation of what overlaps there; 0 where too little."""
    size = 1 << int(len(a.y) + len(b.y)).bit_length()
    parts = [
        np.fft.rfft(np.where(g.good, y, 0.0), size) for g in (a, b) for y in (1.0, g.y, g.y**2)
    ]
    one_a, a1, a2, one_b, b1, b2 = parts

    def summed(f: NDArray[np.complex128], g: NDArray[np.complex128]) -> Vector:
        return np.roll(np.fft.irfft(f * np.conj(g), size), len(b.y) - 1)[: len(a.y) + len(b.y) - 1]

    count = np.maximum(summed(one_a, one_b), 1.0)
    sum_a, sum_b = summed(a1, one_b), summed(one_a, b1)
    var_a = summed(a2, one_b) / count - (sum_a / count) ** 2
    var_b = summed(one_a, b2) / count - (sum_b / count) ** 2
    both = summed(a1, b1) / count - sum_a * sum_b / count**2
    least = max(FEWEST, SHARE * min(a.good.sum(), b.good.sum()))
    enough = count >= least
    for grid, var in ((a, var_a), (b, var_b)):
        enough &= var > MOVES * max(
            float(np.var(grid.y[grid.good])) if grid.good.any() else 0.0, 1e-300
        )
    rho = np.zeros(len(count))
    rho[enough] = both[enough] / np.sqrt(var_a[enough] * var_b[enough])
    return np.arange(len(count)) - (len(b.y) - 1), np.clip(rho, -1.0, 1.0)


def _better(a: Steps, b: Steps, best: int, rival: int, rho: Vector) -> bool:
    """True when the record agrees better at one lag [steps] than at the other, part by part."""
    first = len(b.y) - 1
    if rho[rival + first] ** 2 < rho[best + first] ** 2 / 2:
        return True
    at = np.arange(len(b.y))
    use = b.good.copy()
    for lag in (best, rival):
        inside = (at + lag >= 0) & (at + lag < len(a.y))
        use &= inside & a.good[np.clip(at + lag, 0, len(a.y) - 1)]
    at = at[use]
    if len(at) < FEWEST:
        return False
    left = []
    for lag in (best, rival):
        design = np.column_stack([np.ones(len(at)), a.y[at + lag]])
        fit = np.linalg.lstsq(design, b.y[at], rcond=None)[0]
        left.append((b.y[at] - design @ fit) ** 2)
    gain = np.array([part.sum() for part in np.array_split(left[1] - left[0], PARTS)])
    return bool(gain.mean() > UNIQUE * gain.std(ddof=1) / np.sqrt(PARTS))
