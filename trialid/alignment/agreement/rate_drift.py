"""Does a rate drift against the slope of its angle? A gyro warms up, a compass does not.

The integral of the difference is a straight line where a gyro's zero stands, goes as the angle
where its gain is wrong, and is a parabola where it drifts evenly. A fit takes a zero for each
trial, and no drift: an effect has that to explain.
"""

from typing import Final

import numpy as np

from trialid.alignment.agreement.channel_finding import Finding
from trialid.arrays import Mask, Vector
from trialid.names import units
from trialid.names.quantities import SIGNALS

LARGE: Final = 0.1
"""Drift from the first to the last sample, as a share of what the rate moves, that is told. Of
1406 logs of a rate and an angle, real and made, the eight are told whose gyro was made to drift,
and at half and at twice of this and of what `CURVED` leaves the same."""

CURVED: Final = 0.95
"""Share of what a zero and a gain leave of the difference in angle that an even drift explains."""

KNOWN: Final = 0.95
"""Share of the samples that both are measured in: through a gap nobody knows how she turned."""


def _integral(rate: Vector, period: float) -> Vector:
    return np.concatenate([[0.0], np.cumsum((rate[1:] + rate[:-1]) / 2.0) * period])


def drift_of(rate: Vector, angle: Vector, valid: Mask, period: float) -> float:
    """By how much a rate drifts from begin to end [rad/s]; 0 where it does not, or nobody knows.

    >>> t = np.arange(0.0, 100.0, 0.1)
    >>> round(drift_of(np.cos(t / 5) / 5 + 0.001 * t, np.sin(t / 5), t >= 0.0, 0.1), 3)
    0.1
    """
    if len(rate) < 3 or valid.mean() < KNOWN:
        return 0.0
    turned = _integral(rate, period)
    x = np.linspace(-1.0, 1.0, len(rate))
    curve = np.column_stack([x**2, x, np.ones(len(x)), angle])
    off = turned - angle
    left = off - curve[:, 1:] @ np.linalg.lstsq(curve[:, 1:], off, rcond=None)[0]
    found = np.linalg.lstsq(curve, off, rcond=None)[0]
    rest = off - curve @ found
    duration = (len(rate) - 1) * period
    drift = float(8.0 * found[0] / duration)  # off = a x^2 is a rate of 4 a x / duration
    told = float(rest @ rest) < (1.0 - CURVED) * float(left @ left)
    moves = float(np.std(rate - drift * x / 2.0))
    return drift if told and abs(drift) > LARGE * moves else 0.0


def late_of(rate: Vector, angle: Vector, valid: Mask, period: float) -> float:
    """By how much a rate comes later than the slope of its angle [s]; 0 where nobody knows.

    While she turns its integral is behind the angle by what it comes late times the rate, which is
    plain in a turning circle, too, where the rate itself changes once.

    >>> t = np.arange(0.0, 100.0, 0.1)
    >>> turning = 0.1 * np.clip(t - 20.0, 0.0, 10.0)
    >>> late = 0.1 * np.clip(t - 22.0, 0.0, 10.0)
    >>> round(late_of(late, np.cumsum(turning) * 0.1, t >= 0.0, 0.1))
    2
    """
    if len(rate) < 3 or valid.mean() < KNOWN:
        return 0.0
    turned = _integral(rate, period)
    x = np.linspace(-1.0, 1.0, len(rate))
    behind = angle - turned
    known = np.column_stack([np.ones(len(x)), x, turned])
    moves, left = (y - known @ np.linalg.lstsq(known, y, rcond=None)[0] for y in (rate, behind))
    late = float(moves @ left / max(float(moves @ moves), 1e-300))
    rest = left - late * moves
    return late if float(rest @ rest) < (1.0 - CURVED) * float(left @ left) else 0.0


def drift_finding(rate: str, angle: str, drift: float, duration: float) -> Finding:
    """That a rate drifts against its angle, in words."""
    shown = SIGNALS[rate].shown
    by = drift / units.factor(shown, SIGNALS[rate].unit)
    words = (
        f"{rate} drifts by {by:.2g} {shown} against the slope of {angle} from begin to end of "
        f"{duration:.0f} s, which no zero of a sensor does; leave {rate} out, {angle} tells it"
    )
    return Finding("drift", "remark", (rate, angle), words, {"drift": drift})
