"""Whether a sensor counts so coarsely that its error is no noise: it follows the motion."""

from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.diagnosis.noise.residual import residuals
from trialid.identification.fit import Fit
from trialid.identification.output_error import output_matrix

DITHER: Final = 0.5
"""Noise, in counts, from which on rounding is noise of its own: by Widrow & Kollar (2008,
Quantization Noise) its error keeps exp(-2 pi^2 DITHER^2) of the motion, 0.7 %; 29 % at half as
much, and nothing at twice, where sensors whose rounding is no trouble would be refused."""

GRAIN: Final = 1e-6
"""Share of the range below which two values are one that was converted twice."""
WHOLE: Final = 0.15
"""Rms by which steps of values that are counted may differ from whole counts. Counts rounded once
more to a third differ by 0.14, to a ninth by 0.06; of 4000 made records without counts none by less
than 0.22, half of them by 0.29. With half of it counts rounded to a third are missed, with twice
half of what is no count is one."""


def coarse_counts(fit: Fit) -> str:
    """Which outputs are counted more coarsely than they are noisy, in words; empty where none is.

    All that is left over is taken for noise, so that what is said to be coarse is.
    """
    found = residuals(fit)
    names = []
    for c, (name, rms) in enumerate(zip(fit.problem.outputs, fit.problem.y_rms, strict=True)):
        y = np.concatenate([output_matrix(r.trial, (name,))[r.compared[:, c], 0] for r in found])
        step = count_of(y) / rms
        if fit.eps_by_output[name] ** 2 < (DITHER**2 + 1.0 / 12.0) * step**2:
            names.append(f"{name} (steps of {step:.1%} of its size)")
    return f"counts coarser than the noise: {', '.join(names)}" if names else ""


def count_of(y: Vector) -> float:
    """Least difference between two values, where all differ by whole counts of it, else 0; (N,).

    A ship that goes on has no two positions near each other, however fine they are.
    """
    steps = np.diff(np.unique(y))
    steps = steps[steps > GRAIN * np.sum(steps)]
    if not len(steps):
        return 0.0
    count = float(np.mean(steps[steps < 1.5 * steps.min()]))  # single ones, rounded up and down
    beside = steps / count - np.rint(steps / count)
    return count if np.sqrt(np.mean(beside**2)) < WHOLE else 0.0
