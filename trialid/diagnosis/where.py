"""Where the model fails: stretches of time that hold more of the error than their share."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.diagnosis.residual import Residual, effective_of, residuals, rudder
from trialid.identification.fit import Fit

Vector = NDArray[np.float64]

WINDOW_SECONDS: Final = 60.0
STANDS_OUT: Final = 3.0
"""Standard errors by which a window's mean square must exceed that of all windows."""

REVERSAL: Final = np.deg2rad(3.0)
TURNING: Final = 0.5
"""A share of the largest rate of turn; above it the ship is turning."""

MOST: Final = 3
"""Findings for each output."""


@dataclass(frozen=True)
class Finding:
    """A stretch of one trial in which an output is predicted worse than elsewhere."""

    output: str
    trial: str
    t_start: float
    t_end: float
    share: float
    excess: float
    doing: str

    @property
    def sentence(self) -> str:
        """The finding in words."""
        return (
            f"{self.output} in {self.trial!r}, {self.t_start:.0f} to {self.t_end:.0f} s, "
            f"{self.doing}: "
            f"{self.share:.0%} of its squared error, {self.excess:.1f} times the average stretch"
        )


def where(fit: Fit) -> tuple[Finding, ...]:
    """Windows of time that stand out against the scatter of all windows, worst first."""
    found: list[Finding] = []
    parts = residuals(fit)
    for c, output in enumerate(fit.problem.outputs):
        rows = [w for r in parts for w in _windows(r, c)]
        total = sum(float(e @ e) for _, _, _, e in rows)
        if len(rows) < 4 or total == 0.0:
            continue
        typical = total / sum(len(e) for _, _, _, e in rows)
        standing = []
        for r, start, stop, e in rows:
            excess = float(np.mean(e**2) / typical)
            if excess > 1.0 + STANDS_OUT * np.sqrt(2.0 / effective_of(e)):
                times = start * r.trial.period, stop * r.trial.period
                share = float((e @ e) / total)
                standing.append(
                    Finding(output, r.trial.name, *times, share, excess, _doing(r, start, stop))
                )
        found += sorted(standing, key=lambda f: -f.share)[:MOST]
    return tuple(found)


def _windows(r: Residual, output: int) -> Sequence[tuple[Residual, int, int, Vector]]:
    length = max(round(WINDOW_SECONDS / r.trial.period), 8)
    made = []
    for start in range(0, r.trial.samples - length // 2, length):
        stop = min(start + length, r.trial.samples)
        e = r.eps[start:stop, output][r.compared[start:stop, output]]
        if len(e) >= length // 2:
            made.append((r, start, stop, e))
    return made


def _doing(r: Residual, start: int, stop: int) -> str:
    """What the ship was doing, from rudder and rate of turn."""
    delta = rudder(r.trial)
    turn = r.trial.signals.get("r")
    if delta is not None:
        here = delta[start:stop]
        if here.max() > REVERSAL and here.min() < -REVERSAL:
            return "the rudder reversing"
        if turn is None or np.abs(turn).max() == 0.0:
            return "the rudder held" if np.ptp(here) < REVERSAL else "the rudder moving"
    if turn is not None:
        mean, largest = float(turn[start:stop].mean()), float(np.abs(turn).max())
        if abs(mean) > TURNING * largest:
            return "turning to starboard" if mean > 0.0 else "turning to port"
    return "on a nearly straight course"
