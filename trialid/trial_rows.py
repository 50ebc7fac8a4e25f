"""Which rows of a fit are which output of which trial."""

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from trialid.arrays import Mask, Vector


@dataclass(frozen=True)
class Stretch:
    """Rows of A that are one output of one trial; `compared` places them on the trial's clock."""

    trial: int
    output: int
    rows: slice
    compared: Mask

    def taken(self, values: Vector) -> Vector:
        """The rows that samples of the whole trial make; (N, ...) to (rows, ...)."""
        return np.asarray(values[self.compared])

    def on_clock(self, rows: NDArray[np.floating[Any]]) -> Vector:
        """Its rows back on the trial's clock, zero where nothing was compared; (N, ...)."""
        full = np.zeros((len(self.compared), *rows.shape[1:]))
        full[self.compared] = rows
        return full

    def within(self, samples: slice, first: int) -> "Stretch":
        """The rows that some samples make; the first is `first`."""
        compared = self.compared[samples]
        rows = slice(first, first + int(compared.sum()))
        return Stretch(self.trial, self.output, rows, compared)


Kind = Literal["physical", "nuisance"]
