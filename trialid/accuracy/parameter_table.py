"""Every parameter of a fit with its sensitivities and errors."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from trialid.accuracy.coloured import (
    Coloured,
    coloured_covariance,
    row_variance,
    white_covariance,
    with_priors,
)
from trialid.accuracy.equations import (
    correlation_ratio,
    minimum_sensitivity,
    relative_error,
    relative_sensitivities,
    sensitivity,
    sensitivity_range,
)
from trialid.accuracy.felt import Draw
from trialid.accuracy.ranges import ANYWHERE, Range, share_off
from trialid.accuracy.weak import Weakness, weak_directions, without_nuisance
from trialid.arrays import Vector
from trialid.least_squares.fold import triangle
from trialid.trial_rows import Kind, Stretch


@dataclass(frozen=True)
class ParameterAccuracy:
    """One row of the accuracy table; errors absolute unless called relative.

    `freedom` are the degrees of freedom of the standard error: noise as slow as the manoeuvre tells
    little of itself. `likely` is where the parameter lies at 95 % whatever is missing, never beyond
    the `ends` that it was searched between, None where nobody can say; `widened_by` what makes it
    wider than noise does, empty where that is what was held fixed; `prior_share` how much of what
    is known of it is its prior's, None without.
    """

    name: str
    kind: Kind
    unit: str
    value: float
    reference: float
    S_i: float
    S_imin: float
    R_i: float
    noise_error: float | None
    undermodelling_error: float | None
    standard_error: float
    white_error: float
    n_effective: float
    freedom: float = np.inf
    likely: tuple[float, float] | None = None
    widened_by: str | None = None
    prior_share: float | None = None
    ends: Range = ANYWHERE

    @property
    def may_be_off(self) -> float | None:
        """How far the likely range goes from the value, as a share of it; None where unknown."""
        return share_off(self.value, self.likely)

    @property
    def relative_error(self) -> float | None:
        """Eq. 14 in full, where both parts are known."""
        if self.noise_error is None or self.undermodelling_error is None or self.reference == 0.0:
            return None
        return (self.noise_error + self.undermodelling_error) / abs(self.reference)


@dataclass(frozen=True)
class Accuracy:
    """Sensitivities and errors of a fit; S_min, S_max, R are of the physical parameters."""

    parameters: tuple[ParameterAccuracy, ...]
    S_min: float
    S_max: float
    R: float
    n_effective: float
    weak: tuple[Weakness, ...]
    covariance: Vector

    @property
    def physical(self) -> tuple[ParameterAccuracy, ...]:
        """The rows of the physical parameters."""
        return tuple(p for p in self.parameters if p.kind == "physical")


@dataclass(frozen=True)
class Subject:
    """What a parameter is, beside its column of A."""

    name: str
    kind: Kind
    unit: str
    value: float
    reference: float
    prior: float | None = None
    """Standard deviation of what is known of it beforehand, in its unit."""
    ends: Range = ANYWHERE
    """Between which it was searched: a GM is not negative."""


def assess(
    subjects: Sequence[Subject],
    psi: Vector,
    residual: Vector,
    stretches: Sequence[Stretch],
    noise: float | None,
    undermodelling: float | None,
    level: float | None = None,
    felt: Draw | None = None,
) -> Accuracy:
    """The accuracy of every parameter from the sensitivities and the residual of a fit.

    Parameters
    ----------
    subjects
        The parameters, in the order of the columns; (n_theta,).
    psi, residual
        Normed sensitivities (M, n_theta) and normed residual (M,), scaled so that the squares of
        the residual sum to eps_RMSn^2.
    noise, undermodelling
        eps^x_RMSn and eps^m_RMSn, None where they could not be separated.
    level, felt
        As in `coloured_covariance`.
    """
    reference = np.array([s.reference for s in subjects])
    A = relative_sensitivities(psi, reference)
    deviation = float(np.sqrt(row_variance(A, residual)))
    held = _held(subjects, level or deviation)
    coloured = coloured_covariance(A, residual, stretches, held, level or deviation, felt)
    covariance = coloured.covariance
    white = white_covariance(A, residual, _held(subjects, deviation))
    # the pseudo-inverse would give an error of zero to what neither record nor prior knows
    hidden = minimum_sensitivity(with_priors(A, held)) <= 0.0
    for each in (covariance, white):
        each[hidden, :] = each[:, hidden] = np.nan
    rows = _rows(subjects, A, white, coloured, noise, undermodelling)
    rows = _with_shares(rows, prior_shares(A, held))
    physical = np.array([s.kind == "physical" for s in subjects])
    clean = without_nuisance(A, physical)
    S_min, S_max, ratio = sensitivity_range(clean)
    seen = [r.n_effective for r in rows if r.kind == "physical" and np.isfinite(r.n_effective)]
    typical = float(np.median(seen)) if seen else float(len(residual))
    names = [s.name for s in subjects if s.kind == "physical"]
    weak = weak_directions(clean, names, float(np.linalg.norm(residual)) / np.sqrt(typical))
    scaled = covariance * np.outer(reference, reference)
    return Accuracy(
        parameters=rows,
        S_min=S_min,
        S_max=S_max,
        R=ratio,
        n_effective=typical,
        weak=weak,
        covariance=scaled,
    )


def _held(subjects: Sequence[Subject], deviation: float) -> Vector | None:
    """What the priors weigh against rows of this deviation; None where there is no prior."""
    if all(s.prior is None for s in subjects):
        return None
    return np.array(
        [0.0 if s.prior is None else deviation * abs(s.reference) / s.prior for s in subjects]
    )


def _rows(
    subjects: Sequence[Subject],
    A: Vector,
    white: Vector,
    found: Coloured,
    noise: float | None,
    undermodelling: float | None,
) -> tuple[ParameterAccuracy, ...]:
    R = triangle(A)  # R^T R = A^T A, and that is all that Eq. 10 to 13 look at
    S_i, S_imin, R_i = sensitivity(R), minimum_sensitivity(R), correlation_ratio(R)
    plain = np.sqrt(np.diag(white))
    coloured = np.sqrt(np.maximum(np.diag(found.covariance), 0.0))
    with np.errstate(divide="ignore", invalid="ignore"):
        n_effective = len(A) * (plain / coloured) ** 2
    x, m = relative_error(noise or 0.0, undermodelling or 0.0, S_imin, n_effective)
    return tuple(
        ParameterAccuracy(
            name=s.name,
            kind=s.kind,
            unit=s.unit,
            value=s.value,
            reference=s.reference,
            S_i=float(S_i[i]),
            S_imin=float(S_imin[i]),
            R_i=float(R_i[i]),
            noise_error=_scaled(noise, x[i], s.reference),
            undermodelling_error=_scaled(undermodelling, m[i], s.reference),
            standard_error=float(coloured[i] * abs(s.reference)),
            white_error=float(plain[i] * abs(s.reference)),
            n_effective=float(n_effective[i]),
            freedom=float(found.freedom[i]),
            ends=s.ends,
        )
        for i, s in enumerate(subjects)
    )


def prior_shares(A: Vector, held: Vector | None) -> Vector | None:
    """How much of what is known of each parameter is its prior's; (n_theta,), None without any.

    The variance that is left, over the prior's: one where the record says nothing of it, as after
    a fit of the prior alone, near zero where the record says all.
    """
    if held is None:
        return None
    narrow = np.linalg.pinv(with_priors(A, held))
    return np.asarray(held**2 * np.sum(narrow**2, axis=1))


def _with_shares(
    rows: tuple[ParameterAccuracy, ...], shares: Vector | None
) -> tuple[ParameterAccuracy, ...]:
    if shares is None:
        return rows
    return tuple(
        replace(row, prior_share=min(float(share), 1.0)) if share > 0.0 else row
        for row, share in zip(rows, shares, strict=True)
    )


def _scaled(known: float | None, relative: float, reference: float) -> float | None:
    """A relative error in the parameter's unit, None where its source is not known."""
    return None if known is None else float(relative * abs(reference))
