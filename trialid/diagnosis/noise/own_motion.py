"""How much of what a model leaves over lies at the frequencies at which the ship herself moves.

Noise of a sensor does not know how fast she turns, and what turbulence or waves do to her reaches
well beyond it. What a force does that nobody logged, or that the model lacks, passes through her:
it is as slow as she is. Where no route but the dependence on the input is open, that would be
called noise: on real zig-zags in wind 27 % of 28 %.
"""

from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.diagnosis.noise.residual import Residual, residuals
from trialid.identification.fit import Fit

WITHIN: Final = 0.95
"""Share of the power of the predicted motion that lies at her own frequencies: that of a measured
one is noise itself where she hardly moves."""


def share_at_own_frequencies(fit: Fit) -> float:
    """Share of the squared error at the frequencies below which the predicted motion lies; 0 to 1.

    Of white noise it is 0.01, of waves 0.03, of turbulence that moves her 0.13 (S-175, zig-zags),
    of the shipped record 0.2, of a model of 3 m in wind without its wind 0.75.
    """
    found = residuals(fit)
    low = whole = 0.0
    for output in range(len(fit.problem.outputs)):
        spectra = [_spectra(one, output) for one in found]
        f, moved, left = (np.concatenate(x) for x in zip(*spectra, strict=True))
        order = np.argsort(f, kind="stable")
        within = np.cumsum(moved[order]) < WITHIN * moved.sum()  # none of a ship that lies still
        low += float(left[order][within].sum())
        whole += float(left.sum())
    return low / whole if whole > 0.0 else 0.0


def _spectra(one: Residual, output: int) -> tuple[Vector, Vector, Vector]:
    """Frequencies [Hz], and the power of motion and error; what was not compared is 0."""
    seen, y = one.compared[:, output], one.predicted[:, output]
    y = np.where(seen, y - np.mean(y[seen]), 0.0) if seen.any() else np.zeros(len(y))
    moved, left = (np.abs(np.fft.rfft(x)) ** 2 / len(y) for x in (y, one.eps[:, output]))
    return np.asarray(np.fft.rfftfreq(len(y), one.trial.period)), moved, left
