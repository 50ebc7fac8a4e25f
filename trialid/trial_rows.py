"""Which rows of a fit are which output of which trial."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from trialid.arrays import Mask, Vector


@dataclass(frozen=True)
class Stretch:
    """Rows of A that are one output of one trial; `compared` places them on the trial's clock.

    With `every` above 1 a row is so many samples of the trial's as one, and so is an instant of
    the clock; what is left over at the end is left out.
    """

    trial: int
    output: int
    rows: slice
    compared: Mask
    every: int = 1

    def taken(self, values: Vector) -> Vector:
        """The rows that samples of the whole trial make; (N, ...) to (rows, ...).

        Several samples as one are their sum over sqrt(every): a slow signal's squares add up to
        what they were, and white noise keeps its variance a row.
        """
        if self.every == 1:
            return np.asarray(values[self.compared])
        whole = values[: len(self.compared) * self.every]
        sums = whole.reshape(len(self.compared), self.every, *values.shape[1:]).sum(axis=1)
        return np.asarray(sums[self.compared] / np.sqrt(self.every))

    def within(self, samples: slice, first: int) -> "Stretch":
        """The rows that some samples make, from a multiple of `every` on; the first is `first`."""
        compared = self.compared[samples.start // self.every : samples.stop // self.every]
        rows = slice(first, first + int(compared.sum()))
        return Stretch(self.trial, self.output, rows, compared, self.every)


Kind = Literal["physical", "nuisance"]
