"""Values a quantity may take on a moving ship, for tests that ask for any signal there is."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from trialid.accuracy.likely import Rows, stand
from trialid.design.imo.speed_loss import NAMES
from trialid.design.prediction.likely_spread import LikelySpread, likely_spread
from trialid.diagnosis.may_be_off import doubts, may_be_off
from trialid.diagnosis.noise.split import split
from trialid.diagnosis.search.augment import augment
from trialid.diagnosis.trust import accuracy_of
from trialid.identification.fit import Fit
from trialid.names.quantities import QUANTITIES
from trialid.ship.effect import Effect

KNOWN = {
    "u": (5.0, 9.0), "n": (-9.0, 9.0), "U": (5.0, 9.0), "U0": (7.0, 8.0), "L": (170.0, 180.0),
    "rho": (1000.0, 1025.0), "g": (9.8, 9.82), "nabla": (2e4, 2.2e4), "p": (-0.05, 0.05),
    "r": (-0.02, 0.02), "n_p": (5.0, 9.0), "n_s": (5.0, 9.0), "T": (8.0, 9.0), "h": (12.0, 40.0),
}  # fmt: skip
SPAN = {
    "s": 300.0, "m/s^2": 0.2, "rad/s^2": 0.01, "m/s": 1.5, "rad/s": 0.1, "rad": 0.4, "N": 1e5,
    "N m": 1e6, "m": 1.0, "1": 1.0,
}  # fmt: skip
"""Unit to the size of a quantity that has no row of its own yet."""


def interval(name: str) -> tuple[float, float]:
    """Lowest and highest value [SI]; on both sides of zero where the mirror reverses the sign."""
    if name in KNOWN or name not in QUANTITIES:
        return KNOWN.get(name, (-0.3, 0.3))
    quantity = QUANTITIES[name]
    span = SPAN[quantity.unit]
    return (-span, span) if quantity.mirror < 0 else (0.5 * span, 1.5 * span)


def draw(name: str, rng: np.random.Generator) -> float:
    """One value of a quantity, or of a state of an effect's own [SI]."""
    return float(rng.uniform(*interval(name)))


def wave(name: str, t: NDArray[np.float64], seed: int) -> NDArray[np.float64]:
    """A quantity that never rests; like t."""
    low, high = interval(name)
    rng = np.random.default_rng([seed, sum(name.encode())])
    phase, rate = rng.uniform(0.0, 6.0), rng.uniform(0.1, 0.3)
    return 0.5 * (low + high) + 0.4 * (high - low) * np.sin(rate * t + phase)


def known_by(name: str, deviation: float) -> LikelySpread:
    """One parameter of this deviation, and nothing else that is uncertain."""
    nothing = np.zeros((9, 0))
    rows = Rows(
        residual=np.ones(9),
        psi=np.ones((9, 1)),
        priors=np.zeros((1, 2)),
        held=nothing,
        deviations=np.zeros(0),
        S=nothing,
        level=1.0,
    )
    covariance = np.zeros((1 + len(NAMES),) * 2)
    covariance[0, 0] = deviation**2
    return LikelySpread((name,), (), (), covariance, stand(rows, []))


def spread_of(fit: Fit, candidates: Mapping[str, Effect]) -> LikelySpread:
    """What predictions of a fit are uncertain by, of these effects one may be missing."""
    augmented = augment(fit, candidates)
    off = doubts(augmented)
    parts, _ = split(fit, augmented, {})
    covariance = accuracy_of(fit, parts, off.averaged).covariance
    return likely_spread(fit, covariance, off.standing, off.held, off.missing)


def distances(fit: Fit, truth: Mapping[str, float]) -> dict[str, float]:
    """How many standard errors each physical parameter of a fit is off its truth."""
    assert fit.converged
    augmented = augment(fit, {})
    parts, _ = split(fit, augmented, {})
    rows = accuracy_of(fit, parts, may_be_off(augmented)).physical
    return {r.name: (r.value - truth[r.name]) / r.standard_error for r in rows}
