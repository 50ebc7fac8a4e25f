"""Directional stability of the fitted ship: levers of the yaw and sway forces."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.maths import Number

Range = tuple[float, float]

PARTS = ("Yv", "Yr", "Nv", "Nr")
ROLL_PARTS = ("Yphi", "Nphi", "Kv", "Kr")

SURE: Final = 2.0
"""Standard errors that a margin has to be off zero to tell its sign: 95 times of 100. Of a ship
without any margin one would call every third stable or unstable, four one of 16 000, and four would
be silent about margins that two tell."""


def levers(c: Mapping[str, Number]) -> tuple[Number, Number]:
    """Eq. 15: L_r = (N_r - m x_G) / (Y_r - m) and L_v = N_v / Y_v, primed.

    Yurm, where a model has it, is part of Y_r: the water that turns with the hull.

    >>> L_r, L_v = levers({"Nr": -2.0, "Yr": 1.0, "Nv": -3.0, "Yv": -12.0, "m": 9.0, "x_G": 0.0})
    >>> L_r, L_v
    (0.25, 0.25)
    """
    Yr = c["Yr"] + c.get("Yurm", 0.0)
    return (c["Nr"] - c["m"] * c["x_G"]) / (Yr - c["m"]), c["Nv"] / c["Yv"]


@dataclass(frozen=True)
class Stability:
    """Levers over L, their margin, and how sure that is.

    Attributes
    ----------
    standard_error
        Of the margin, by noise alone; None where it is not estimated.
    likely
        Where the margin is likely to lie, whatever is missing; None where nobody knows.
    """

    L_r: float
    L_v: float
    margin: float
    standard_error: float | None
    likely: Range | None = None

    @property
    def stable(self) -> bool | None:
        """Eq. 16: directionally stable when L_r - L_v > 0; None where both may be so.

        >>> Stability(0.32, 0.37, -0.05, 0.33).stable is None
        True
        >>> Stability(0.54, 0.35, 0.18, 0.02).stable
        True
        >>> Stability(0.54, 0.35, 0.18, 0.02, likely=(-0.1, 0.3)).stable is None
        True
        """
        low, high = self.likely or self._by_noise
        return (low > 0.0) if low * high > 0.0 else None

    @property
    def _by_noise(self) -> Range:
        wide = SURE * (self.standard_error or 0.0)
        return self.margin - wide, self.margin + wide


def couple_roll(c: Mapping[str, Number]) -> dict[str, Number]:
    """Sway and yaw derivatives of a ship that heels as it turns slowly; primed.

    In a slow turn the heel follows phi = (K_v v + (K_r + m z_G) r) / G_phi, with
    G_phi = 2 g nabla GM / (L^3 U^2) - K_phi, and pushes back through Y_phi and N_phi. Eq. 15 on
    these numbers includes that; the paper's form leaves it out. Kurm is part of K_r.
    """
    Kr = c["Kr"] + c.get("Kurm", 0.0)
    heel = {"v": c["Kv"] / c["G_phi"], "r": (Kr + c["m"] * c["z_G"]) / c["G_phi"]}
    changed = {f"{row}{s}": c[f"{row}{s}"] + c[f"{row}phi"] * heel[s] for row in "YN" for s in "vr"}
    return {**c, **changed}


def stability(
    values: Mapping[str, float],
    names: tuple[str, ...] = (),
    covariance: NDArray[np.float64] | None = None,
    coupled: bool = False,
) -> Stability:
    """Levers and margin with the standard error by the delta method.

    Parameters
    ----------
    values
        Primed coefficients: m, x_G and those of `PARTS`; with `coupled` also z_G, G_phi and
        those of `ROLL_PARTS`; Yurm and Kurm where the model has them.
    names, covariance
        Fitted parameters and their covariance; (n_theta,), (n_theta, n_theta).
    """
    L_r, L_v = _levers(values, coupled)
    error = None
    if covariance is not None:
        slope = margin_slopes(values, names, coupled)
        own = slope != 0.0  # of what moves nothing that is fitted nobody knows the covariance
        slope, covariance = slope[own], covariance[np.ix_(own, own)]
        error = float(np.sqrt(slope @ covariance @ slope))
    return Stability(float(L_r.real), float(L_v.real), float((L_r - L_v).real), error)


def margin_slopes(
    values: Mapping[str, float], names: Sequence[str], coupled: bool = False
) -> NDArray[np.float64]:
    """Derivatives of the margin by coefficients, zero by all else; (n,)."""
    return np.array([_slope(values, name, coupled) for name in names])


def _levers(values: Mapping[str, Number], coupled: bool) -> tuple[complex, complex]:
    numbers = {n: complex(x) for n, x in values.items()}
    return levers(couple_roll(numbers) if coupled else numbers)


def _slope(values: Mapping[str, float], name: str, coupled: bool) -> float:
    """Derivative of the margin by one coefficient; exact, by a complex step of a rational form."""
    if name not in values:
        return 0.0
    step = 1e-30
    L_r, L_v = _levers({**values, name: values[name] + 1j * step}, coupled)
    return float((L_r - L_v).imag / step)
