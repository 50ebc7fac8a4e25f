"""What a trial that is not fitted leaves when all that is its own is fitted to it."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from trialid.arrays import Mask, Vector
from trialid.identification.check.own_start import OwnRows, columns_of_its_own, priors_of
from trialid.identification.output_error import Problem
from trialid.simulation.integrate import respond, starts_of
from trialid.trial import Trial

TINY: Final = 1e-300
"""What nothing counts as where it is divided by."""


@dataclass(frozen=True, eq=False)
class OwnTakenOut:
    """Rows of one trial less what its start, its current and its sensors reach.

    Attributes
    ----------
    residual
        Normed as the rows of the fit, one output after the other; (M,).
    psi
        What they move by with the parameters that all trials share; (M, n_shared).
    alone
        Of each sensor: how far it is off the others' mean if it alone is the trial's own, and what
        is left then, as a share of what is left with none.
    """

    residual: Vector
    psi: Vector
    alone: Mapping[str, tuple[float, float]]


def own_taken_out(
    problem: Problem, trial: Trial, compared: Mask, values: Mapping[str, float], level: float
) -> OwnTakenOut | None:
    """The rows of a trial to check, as if it had been fitted but for what all trials share.

    None where the trial leaves the model, or nothing was compared.

    Parameters
    ----------
    values
        All the trial was simulated with, its start by the name of the column.
    level
        What one independent row of the fit is uncertain by: see `Weighing`.
    """
    response = respond(problem.simulator, trial, values, starts_of(values))
    if not compared.any() or response.departure is not None or response.S is None:
        return None
    starts = columns_of_its_own(problem)
    rows = OwnRows(problem, trial, compared, values, priors_of(problem, trial, starts), level)
    gap, by_start = rows.of(response, np.array([values[n] for n in starts]))
    of_each = dict.fromkeys(x.column for x in problem.unknowns if x.trial is not None)
    sensors = [c for c in of_each if c not in starts]
    shared = [x.column for x in problem.unknowns if x.trial is None]
    places = [problem.simulator.columns.index(c) for c in (*sensors, *shared)]
    slopes = np.zeros((len(gap), len(places)))
    slopes[: len(gap) - len(starts)] = rows.taken(response.S[:, :, places])
    of_sensors, of_shared = slopes[:, : len(sensors)], slopes[:, len(sensors) :]
    own = np.column_stack([by_start, of_sensors])
    left = _less(own, np.column_stack([gap, of_shared]))
    measured = left[: len(gap) - len(starts)]
    each = _alone(_less(by_start, np.column_stack([gap, of_sensors])))
    return OwnTakenOut(measured[:, 0], measured[:, 1:], dict(zip(sensors, each, strict=True)))


def _less(own: Vector, rows: Vector) -> Vector:
    """Columns less what these columns reach of them."""
    return rows - own @ np.linalg.lstsq(own, rows, rcond=None)[0] if own.size else rows


def _alone(columns: Vector) -> list[tuple[float, float]]:
    """Of each column after the first: its coefficient in the first, and what it leaves of that."""
    gap, slopes = columns[:, 0], columns[:, 1:]
    sizes = np.maximum(np.einsum("ij,ij->j", slopes, slopes), TINY)
    off = slopes.T @ gap / sizes
    left = np.linalg.norm(gap[:, None] - slopes * off, axis=0) / max(np.linalg.norm(gap), TINY)
    return [(float(a), float(b)) for a, b in zip(off, left, strict=True)]
