"""Where whatever follows from a fit is likely to lie, from how it goes with what is uncertain.

What the record leaves open of the parameters, of what was held fixed and of what may be missing is
followed to each number by its slopes. So a missing effect counts twice: it moved the parameters,
and it is not there in the prediction.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import block_diag

from trialid.accuracy.likely import Standing
from trialid.arrays import Vector
from trialid.design.imo.measure_slopes import Shows
from trialid.design.imo.speed_loss import NAMES, speed_loss
from trialid.design.prediction.rudders_zero import OfUnknowns, extend_by_zero
from trialid.identification.check.log_scales import scaled_logs
from trialid.identification.fit import Fit

Range = tuple[float, float]


@dataclass(frozen=True)
class LikelySpread:
    """All that a prediction of a fitted ship is uncertain by.

    Attributes
    ----------
    fitted, held, missing
        Columns of the fit's unknowns and her rudder's zero, coefficients held fixed, and what may
        be missing.
    covariance
        Of the unknowns by noise, and of what turns cost of the speed.
    standing
        How models of what is missing stand.
    """

    fitted: tuple[str, ...]
    held: tuple[str, ...]
    missing: tuple[Shows, ...]
    covariance: Vector
    standing: Standing

    @property
    def known(self) -> tuple[str, ...]:
        """What slopes are by, before what may be missing."""
        return (*self.fitted, *NAMES, *self.held)

    @property
    def width(self) -> int:
        """Columns of what may be missing, also of what is there whole or not at all."""
        return self.standing.known.moves.shape[1] - 1 - len(self.held)

    def ranges(
        self, values: Sequence[float] | Vector, by: Vector, beyond: Vector | float = 0.0
    ) -> list[Range | None]:
        """The 95 % range of each number; None where nobody knows.

        Parameters
        ----------
        values, by
            The numbers (n,), and their slopes by `known` and `missing`; (n, n_known + width).
        beyond
            Standard error of each by what no parameter says; (n,).
        """
        first, last = len(self.fitted), len(self.fitted) + len(NAMES)
        averaged = self.standing.average(np.delete(by, np.s_[first:last], axis=1))
        own = by[:, :last]
        errors = np.sqrt(np.einsum("ni,ni->n", own @ self.covariance, own) + np.square(beyond))
        each = zip(values, errors, strict=True)
        return [averaged.range(i, float(x), float(e)) for i, (x, e) in enumerate(each)]


def under_own_logs(fit: Fit, spread: LikelySpread) -> LikelySpread:
    """The same of a trial sailed by its own logs: what these read too much of cancels in it.

    A rudder that reads 5 % too much does 5 % less in the fit, and is over by 5 % more in the trial.
    """
    known, names = spread.standing.known, scaled_logs(fit.problem)
    if len(names) != len(known.scales):  # nobody says how far they may be off
        return spread
    of_outputs = known.scales * [name in fit.problem.outputs for name in names]
    standing = replace(spread.standing, known=replace(known, scales=of_outputs))
    return replace(spread, standing=standing)


def likely_spread(
    fit: Fit, covariance: Vector, standing: Standing, held: Sequence[str], missing: Sequence[Shows]
) -> LikelySpread:
    """All that a prediction is uncertain by; arguments as the accuracy of the fit gives them."""
    columns = tuple(x.column if x.trial is None else x.name for x in fit.problem.unknowns)
    of_fit = extend_by_zero(fit, OfUnknowns(columns, np.nan_to_num(covariance), standing))
    loss = speed_loss(fit)
    of_loss = np.zeros((len(NAMES),) * 2) if loss is None else loss.covariance
    known = block_diag(of_fit.covariance, of_loss)
    return LikelySpread(of_fit.names, tuple(held), tuple(missing), known, of_fit.standing)
