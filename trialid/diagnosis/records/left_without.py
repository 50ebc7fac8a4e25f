"""By how much the error of all other trials would fall without one, as their slopes have it.

Sums of products of each trial, with all that is its own taken out, tell it without another fit.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.diagnosis.search.carry_over import prior_rows, take_out
from trialid.identification.fit import Fit
from trialid.identification.output_error import stretches

OTHERS: Final = 2
"""Fitted trials beside it: one alone can be followed by any model."""


@dataclass(frozen=True)
class Products:
    """Products of what shared parameters move in one trial, with what is left of it.

    Attributes
    ----------
    gram, moment, square
        Of the slopes, all of the trial's own taken out, (n, n); of them with the residual, (n,);
        of the residual.
    """

    gram: Vector
    moment: Vector
    square: float

    def __add__(self, other: "Products") -> "Products":
        return Products(
            self.gram + other.gram, self.moment + other.moment, self.square + other.square
        )

    def best(self) -> Vector:
        """The step of the shared parameters that leaves least; (n,)."""
        return np.asarray(np.linalg.lstsq(self.gram, self.moment, rcond=1e-12)[0])

    def left(self, step: Vector) -> float:
        """What is left of the residual's square after that step."""
        return self.square - 2.0 * float(self.moment @ step) + float(step @ self.gram @ step)


def falls_without(fit: Fit) -> dict[str, float]:
    """Share of the others' squared error that goes without each fitted trial, by the slopes."""
    each, prior = _products(fit)
    falls = dict[str, float]()
    for name, own in each.items():
        others = [part for other, part in each.items() if other != name]
        if len(others) >= OTHERS:
            rest = sum(others[1:], others[0])
            alone, beside = ((part + prior).best() for part in (rest, rest + own))
            falls[name] = 1.0 - rest.left(alone) / max(rest.left(beside), 1e-300)
    return falls


def _products(fit: Fit) -> tuple[Mapping[str, Products], Products]:
    """Of every trial that is fitted, and of the priors of what all share."""
    unknowns, priors = fit.problem.unknowns, prior_rows(fit)
    shared = [i for i, x in enumerate(unknowns) if x.trial is None]
    slope, gap = priors[shared].T
    found = dict[str, Products]()
    for place, trial in enumerate(fit.problem.trials):
        parts = [p for p in stretches(fit.problem) if p.trial == place]
        rows = slice(parts[0].rows.start, parts[-1].rows.stop)
        own = [i for i, x in enumerate(unknowns) if x.trial == place]
        X = np.column_stack([fit.psi[rows][:, shared], fit.residual[rows]])
        X = take_out(fit.psi[rows][:, own], X, priors[own], len(shared))
        slopes, residual = X[:, :-1], X[:, -1]
        square = float(residual @ residual)
        found[trial.name] = Products(slopes.T @ slopes, slopes.T @ residual, square)
    return found, Products(np.diag(slope**2), slope * gap, 0.0)
