"""The noise and the model part of an error once the noise is known, with their intervals."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from trialid.diagnosis.noise.residual import OutputNoise, pool_variance, residuals
from trialid.identification.fit import Fit

Interval = tuple[float, float]
CONFIDENCE: Final = 1.96
TIGHT: Final = 0.35
"""A noise estimate whose 95 % interval is wider than this share either way is no estimate."""


@dataclass(frozen=True)
class Split:
    """What the error is made of, by one route; numbers None where the route does not hold.

    `noise` and `undermodelling` are normed as eps_RMSn, their squares add up to its square.
    """

    method: str
    why: str
    noise: float | None = None
    undermodelling: float | None = None
    noise_interval: Interval | None = None
    undermodelling_interval: Interval | None = None
    by_output: Mapping[str, tuple[float, float]] | None = None

    @property
    def available(self) -> bool:
        """Whether the route holds on this record."""
        return self.noise is not None


def split_by_noise(fit: Fit, method: str, why: str, found: Sequence[OutputNoise]) -> Split:
    """Noise and model part with intervals; refused where the noise is hardly known."""
    total, spread = _total(fit)
    noise2 = float(np.mean([n.variance for n in found]))
    deviation = float(np.sqrt(np.sum([n.deviation**2 for n in found])) / len(found))
    if CONFIDENCE * deviation > 2.0 * TIGHT * noise2:
        share = 0.5 * CONFIDENCE * deviation / noise2
        return Split(method, f"{why}: too short, the noise is known to +-{share:.0%} only")
    by_output = {}
    for (c, eps), n in zip(fit.eps_by_output.items(), found, strict=True):
        x2 = min(n.variance, eps**2)
        by_output[c] = (float(np.sqrt(x2)), float(np.sqrt(eps**2 - x2)))
    x2, m2 = (float(np.mean([part[k] ** 2 for part in by_output.values()])) for k in (0, 1))
    gap = CONFIDENCE * float(np.hypot(deviation, spread))
    model2 = (total**2 - noise2 - gap, total**2 - noise2 + gap)
    return Split(
        method=method,
        why=why,
        noise=float(np.sqrt(x2)),
        undermodelling=float(np.sqrt(m2)),
        noise_interval=_roots(noise2 - CONFIDENCE * deviation, noise2 + CONFIDENCE * deviation),
        undermodelling_interval=_roots(*model2),
        by_output=by_output,
    )


def _roots(low: float, high: float) -> Interval:
    return float(np.sqrt(max(low, 0.0))), float(np.sqrt(max(high, 0.0)))


def _total(fit: Fit) -> tuple[float, float]:
    """eps_RMSn, and the standard error that noise gives its square."""
    found = residuals(fit)
    spread = []
    for c in range(len(fit.problem.outputs)):
        known = pool_variance([r.eps[:, c] for r in found], [r.compared[:, c] for r in found])
        spread.append(0.0 if known is None else known.deviation)
    return fit.eps_rmsn, float(np.sqrt(np.sum(np.square(spread))) / len(spread))
