"""When a model leaves its noise band: a cumulative sum of the whitened residual.

Each output's residual goes through the inverse of the colour its noise had in the fit, so that
noise comes out white with deviation 1 however slow it was. A two-sided cumulative sum (Page 1954)
adds what is beyond half a deviation; it is an alarm where the sum passes the threshold that noise
passes once in `HOURS` of record, over all outputs and both sides.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from trialid.arrays import Mask
from trialid.diagnosis.noise.error_parts import Split
from trialid.diagnosis.noise.whitening import Colour, colour_of
from trialid.diagnosis.search.augment import Augmented
from trialid.identification.fit import Fit
from trialid.identification.output_error import row_scale, stretches

Vector = NDArray[np.float64]

HOURS: Final = 24.0
"""Record in which noise alone is expected to raise one alarm."""

REFERENCE: Final = 0.5
"""Deviations that are let pass: shifts of twice as many are found soonest."""

OUTLIER: Final = 4.0
"""Deviations that one sample counts at most: a wild value alone is no alarm."""

OVERSHOOT: Final = 1.166
"""By how much a cumulative sum of normal steps jumps over its threshold, on both ends together."""

MOST: Final = 2.0
"""Thresholds up to which a sum grows: it shall come down once the cause is gone."""


@dataclass(frozen=True)
class Band:
    """The noise of one output: its deviation [SI], and what makes it white; (p+1,)."""

    output: str
    sigma: float
    whitening: Vector


@dataclass(frozen=True)
class Bands:
    """The noise of every output, and how it is known, in words."""

    of: tuple[Band, ...]
    source: str
    separated: bool


@dataclass(frozen=True)
class Alarm:
    """An output that left its band.

    Attributes
    ----------
    since
        When the sum began to grow: the estimate of when the model left its band [s].
    raised, over
        When that was sure, and when the sum was back at zero [s]; None while it lasts.
    side
        1 where more is measured than predicted, -1 where less.
    """

    output: str
    since: float
    raised: float
    over: float | None
    side: int


def bands(fit: Fit, split: Split, augmented: Augmented) -> Bands:
    """The noise band of each output; that of the whole residual where noise is not separable.

    What a model leaves out is in the residual of its own fit. Where the noise alone is known, the
    band is the noise's, and a model that was never good is outside from the beginning.
    """
    problem = fit.problem
    scale = row_scale(problem)
    if split.by_output is not None and augmented.traces:
        colour = _colour(fit, augmented)
        sigma = [noise for noise, _ in split.by_output.values()]
        source = f"noise part of the fit's error ({split.method})"
    else:
        colour = colour_of(fit.residual, stretches(problem))
        sigma = list(fit.eps_by_output.values())
        source = "RMS of the fit's residual: noise and model part could not be separated"
    return Bands(
        tuple(
            Band(c, float(s * y), colour[i] * scale[i])
            for i, (c, s, y) in enumerate(zip(problem.outputs, sigma, problem.y_rms, strict=True))
        ),
        source,
        split.by_output is not None,
    )


def _colour(fit: Fit, augmented: Augmented) -> Colour:
    """The noise's colour, sample by sample; of the residual where the record was too long."""
    if augmented.fit is not fit:  # a long one, by its means
        return colour_of(fit.residual, stretches(fit.problem))
    return augmented.evidence.colour


def threshold(samples: float) -> float:
    """The height that a one-sided sum of white noise passes once in so many samples.

    Siegmund (1985): samples = (exp(2 k b) - 2 k b - 1) / (2 k^2), b = h + 1.166.

    Tables have 465 for both sides together at a height of 5:

    >>> round(threshold(2 * 465.0), 2)
    4.99
    """

    def excess(b: float) -> float:
        return (math.expm1(2 * REFERENCE * b) - 2 * REFERENCE * b) / (2 * REFERENCE**2) - samples

    return float(brentq(excess, OVERSHOOT, 700.0)) - OVERSHOOT


class Monitor:
    """Cumulative sums of every output, so far.

    Attributes
    ----------
    score
        The larger sum of each output over the threshold; (N, n_y), NaN from sample `at` on.
    alarms
        In the order in which they were raised.
    """

    def __init__(
        self, bands: Sequence[Band], period: float, samples: int, hours: float = HOURS
    ) -> None:
        self.bands, self.period = tuple(bands), period
        self.threshold = threshold(hours * 3600.0 / period * 2 * len(bands))
        self.score = np.full((samples, len(bands)), np.nan)
        self.alarms: list[Alarm] = []
        self.at = 0
        self._sums = np.zeros((len(bands), 2))
        self._since = np.zeros((len(bands), 2), dtype=int)
        self._lasting: dict[tuple[int, int], int] = {}

    def advance(self, residual: Vector, compared: Mask, to: int) -> None:
        """Judge every sample before `to`; (N, n_y) each."""
        for k in range(self.at, to):
            for c, band in enumerate(self.bands):
                reach = len(band.whitening)
                near = slice(k - reach + 1, k + 1)
                if k + 1 >= reach and compared[near, c].all():
                    drive = float(band.whitening[::-1] @ residual[near, c])
                    self._add(k, c, min(max(drive, -OUTLIER), OUTLIER))
                self.score[k, c] = self._sums[c].max() / self.threshold
        self.at = max(to, self.at)

    def _add(self, k: int, c: int, drive: float) -> None:
        for i, side in enumerate((1, -1)):
            before = self._sums[c, i]
            grown = before + side * drive - REFERENCE
            now = min(max(grown, 0.0), MOST * self.threshold)
            self._sums[c, i] = now
            if before == 0.0 < now:
                self._since[c, i] = k
            self._tell(k, c, i, now)

    def _tell(self, k: int, c: int, i: int, now: float) -> None:
        """Raise an alarm, or end one."""
        place = self._lasting.get((c, i))
        t = k * self.period
        if place is None and now > self.threshold:
            self._lasting[c, i] = len(self.alarms)
            since = float(self._since[c, i] * self.period)
            self.alarms.append(Alarm(self.bands[c].output, since, t, None, 1 - 2 * i))
        elif place is not None and now == 0.0:
            self.alarms[place] = replace(self.alarms[place], over=t)
            del self._lasting[c, i]
