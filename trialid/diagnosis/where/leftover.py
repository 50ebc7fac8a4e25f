"""The residual of a whole fit on one clock, trials one after the other, and what went with it."""

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_triangular

from trialid.arrays import Mask
from trialid.diagnosis.noise.residual import Residual, residuals
from trialid.identification.fit import Fit
from trialid.identification.output_error import row_scale, stretches
from trialid.least_squares.fold import triangle
from trialid.names import units
from trialid.names.quantities import SIGNALS, Quantity

Vector = NDArray[np.float64]

FROUDE_LENGTH: Final = 175.0
"""[m] The ship whose windows are 60 s long; times of others scale with the root of the length."""

REACHED: Final = 1e-6
"""Columns of the gradient smaller than this share of the largest, after QR, are not held."""


@dataclass(frozen=True)
class Leftover:
    """Normed residuals of all trials to fit; N is the number of samples of all of them.

    Attributes
    ----------
    eps, compared
        (N, n_y) each; eps is zero where nothing was compared.
    spans
        The samples of each trial.
    """

    fit: Fit
    parts: tuple[Residual, ...]
    eps: Vector
    compared: Mask
    spans: tuple[slice, ...]

    @property
    def outputs(self) -> tuple[str, ...]:
        """Names of the outputs."""
        return self.fit.problem.outputs

    @property
    def time_scale(self) -> float:
        """By Froude's law: 1 for a ship of 175 m."""
        particulars = self.fit.model.ship.particulars
        return float(np.sqrt(particulars["L"] / FROUDE_LENGTH * 9.81 / particulars["g"]))

    @cached_property
    def basis(self) -> Vector:
        """Orthonormal basis of what the free parameters reach, rows as in `stretches`; (M, n)."""
        psi = self.fit.psi
        norms = np.linalg.norm(psi, axis=0)
        psi = psi[:, norms > 0.0] / norms[norms > 0.0]
        if psi.shape[1] == 0:
            return psi
        R = triangle(psi)
        held = np.abs(np.diag(R)) > REACHED * np.abs(np.diag(R)).max()
        if held.all():
            return np.asarray(solve_triangular(R, psi.T, trans="T").T)
        return np.asarray(np.linalg.qr(psi[:, held])[0])

    @cached_property
    def scale(self) -> Vector:
        """Factor from normed residuals to the rows of the fit; (n_y,)."""
        return row_scale(self.fit.problem) * self.fit.problem.y_rms

    def signal(self, name: str) -> Vector | None:
        """A signal over all trials [SI]: as predicted where it is an output, else as recorded.

        A recorded output holds the noise that its own residual is made of, and would find it again.
        """
        if name in self.outputs:
            c = self.outputs.index(name)
            return np.concatenate([r.predicted[:, c] for r in self.parts]) * float(
                self.fit.problem.y_rms[c]
            )
        if any(name not in r.trial.signals for r in self.parts):
            return None
        return np.concatenate([r.trial.signals[name] for r in self.parts])

    def rudder(self) -> Vector | None:
        """The rudder over all trials, the measured angle before the order."""
        angle = self.signal("delta")
        return self.signal("delta_order") if angle is None else angle

    def visible(self, columns: Vector, output: int) -> tuple[Vector, Vector]:
        """Columns on one output less what free parameters can mimic: (M, q), and its share (q,)."""
        parts = stretches(self.fit.problem)
        rows = np.zeros((parts[-1].rows.stop, columns.shape[1]))
        for part in parts:
            if part.output == output:
                rows[part.rows] = columns[self.spans[part.trial]][part.compared]
        rows /= self.scale[output]
        size = np.sum(rows**2, axis=0)
        rows -= self.basis @ (self.basis.T @ rows)
        return rows, np.sum(rows**2, axis=0) / np.where(size > 0.0, size, 1.0)


def leftover(fit: Fit) -> Leftover:
    """What a fit leaves over on the trials it was made of."""
    parts = tuple(residuals(fit))
    ends = np.cumsum([0, *(r.trial.samples for r in parts)])
    spans = tuple(slice(int(a), int(b)) for a, b in pairwise(ends))
    eps = np.concatenate([r.eps for r in parts])
    return Leftover(fit, parts, eps, np.concatenate([r.compared for r in parts]), spans)


def shown_factor(name: str) -> float:
    """Factor from SI to the unit reports show a signal in."""
    known = _quantity(name)
    return 1.0 if known.shown == known.unit else units.shown_factor(known)


def unit(name: str) -> str:
    """The unit reports show a signal in."""
    return _quantity(name).shown


def mirror(name: str) -> int:
    """Sign the signal takes when port and starboard are exchanged."""
    return _quantity(name).mirror


def signal_words(name: str) -> str:
    """A signal in words: `yaw rate`."""
    return _quantity(name).meaning.split(",")[0]


def _quantity(name: str) -> Quantity:
    return SIGNALS.get(name) or Quantity(name, name, "1", "1", name)
