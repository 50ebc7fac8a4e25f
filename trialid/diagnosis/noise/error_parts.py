"""The noise and the model part of an error once the noise is known, with their intervals."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from trialid.diagnosis.noise.residual import OutputNoise, heavy_tail, pool_variance, residuals
from trialid.identification.fit import Fit
from trialid.names.wording import TOO_SHORT

Interval = tuple[float, float]
CONFIDENCE: Final = 1.96
TIGHT: Final = 0.35
"""A noise estimate whose 95 % interval is wider than this share either way is no estimate."""


@dataclass(frozen=True)
class Split:
    """What the error is made of, by one route; numbers None where the route does not hold.

    `noise` and `undermodelling` are normed as eps_RMSn, their squares add up to its square. Where
    they are refused, `at_most` may still say what the noise cannot be more than.
    """

    method: str
    why: str
    noise: float | None = None
    undermodelling: float | None = None
    noise_interval: Interval | None = None
    undermodelling_interval: Interval | None = None
    by_output: Mapping[str, tuple[float, float]] | None = None
    at_most: float | None = None

    @property
    def available(self) -> bool:
        """Whether the route holds on this record."""
        return self.noise is not None


TAKEN: Final = 2.0
"""How much more of the noise than on average parameters may have taken up: there are one or two
dozen, whose squares scatter by a half and are known by those of the few that the trials share. Of
90 records of `noise_parts.py` 7 are outside, with half as much 15, with twice as much 6."""


def may_be_noise(fit: Fit, inside: float, outside: float, more: int = 0) -> float:
    """The most that the noise's square may be where a model leaves `inside` of it and its own.

    On average every unknown takes up one row's worth of noise without a colour. Of noise that runs
    with the motion it is more, and by twice of that the error grows on rows left out.

    Parameters
    ----------
    outside
        What is left on rows that neither the parameters which the trials share nor `more`
        coefficients were fitted to.
    """
    every = len(fit.problem.unknowns) + more
    shared = sum(x.trial is None for x in fit.problem.unknowns) + more
    shown = 0.5 * (outside - inside) / max(shared, 1)
    return inside + TAKEN * every * max(shown, inside / len(fit.residual))


def split_by_noise(
    fit: Fit, method: str, why: str, found: Sequence[OutputNoise], at_most: float = 0.0
) -> Split:
    """Noise and model part with intervals; refused where the noise is hardly known.

    `at_most`, as eps_RMSn: the noise may be so much whatever its standard error.
    """
    total, spread = _total(fit)
    noise2 = float(np.mean([n.variance for n in found]))
    deviation = float(np.sqrt(np.sum([n.deviation**2 for n in found])) / len(found))
    unlike = float(np.mean([n.unlike for n in found]))
    gap = CONFIDENCE * float(np.hypot(deviation, spread))
    low2, high2 = noise2 - CONFIDENCE * deviation - unlike, noise2 + CONFIDENCE * deviation
    model2 = total**2 - noise2 - gap, total**2 - noise2 + gap + unlike
    refused = _hardly_known(noise2, CONFIDENCE * deviation, unlike)
    if model2[1] < 0.0:
        refused = (
            f"not typical, noise of {np.sqrt(noise2):.2%} where {total:.2%} is the whole error"
        )
    if refused:
        return Split(method, f"{why}: {refused}")
    by_output = {}
    for (c, eps), n in zip(fit.eps_by_output.items(), found, strict=True):
        x2 = min(n.variance, eps**2)
        by_output[c] = (float(np.sqrt(x2)), float(np.sqrt(eps**2 - x2)))
    x2, m2 = (float(np.mean([part[k] ** 2 for part in by_output.values()])) for k in (0, 1))
    if at_most > 0.0:
        high2, model2 = max(high2, at_most**2), (min(model2[0], total**2 - at_most**2), model2[1])
    return Split(
        method=method,
        why=why,
        noise=float(np.sqrt(x2)),
        undermodelling=float(np.sqrt(m2)),
        noise_interval=_roots(min(low2, x2), high2),
        undermodelling_interval=_roots(*model2),
        by_output=by_output,
    )


def _hardly_known(noise2: float, off: float, unlike: float) -> str:
    """Why a noise known to `off` and `unlike`, as squares, is no estimate; empty where it is.

    >>> _hardly_known(1.0, 1.2, 0.0), _hardly_known(1e-9, 1.2, 0.0)
    ('too short, the noise is known to +-60% only', 'too short, the noise is hardly known at all')
    """
    if off + 0.5 * unlike <= 2.0 * TIGHT * noise2:
        return ""
    if unlike > off:
        return f"not alike, errors of the model may differ by {np.sqrt(unlike):.2%}"
    if off > 2.0 * noise2:  # a percentage of next to nothing says nothing
        return f"{TOO_SHORT}, the noise is hardly known at all"
    return f"{TOO_SHORT}, the noise is known to +-{0.5 * off / noise2:.0%} only"


def _roots(low: float, high: float) -> Interval:
    return float(np.sqrt(max(low, 0.0))), float(np.sqrt(max(high, 0.0)))


def _total(fit: Fit) -> tuple[float, float]:
    """eps_RMSn, and the standard error that noise gives its square."""
    found = residuals(fit)
    spread = []
    for c in range(len(fit.problem.outputs)):
        pieces, masks = [r.eps[:, c] for r in found], [r.compared[:, c] for r in found]
        known = pool_variance(pieces, masks, tail=heavy_tail(pieces, masks))
        spread.append(0.0 if known is None else known.deviation)
    return fit.eps_rmsn, float(np.sqrt(np.sum(np.square(spread))) / len(spread))
