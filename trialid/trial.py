"""A trial: one manoeuvre, every signal in SI on one clock; the only thing the identifier sees."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]
Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class LogSource:
    """Where a trial's signals came from, enough to repeat the run."""

    path: str
    sha256: str
    adapter: str


@dataclass(frozen=True)
class Trial:
    """Signals of one manoeuvre on one uniform clock.

    Parameters
    ----------
    name, use
        The trial's name, and `fit` or `check` (simulated and scored, never fitted).
    period
        Time between samples [s].
    signals
        Quantity name to values in SI, finite everywhere; (N,) each. Inside a gap the values only
        keep the simulation going; `valid` says that they are not to be believed.
    valid
        Quantity name to True where the value was measured; (N,) each.
    remarks
        What was noticed on the way, in words, for the report.
    logs
        The files behind it.
    start
        Stamp of the first sample on the clock of the logs [ns].
    """

    name: str
    use: Literal["fit", "check"]
    period: float
    signals: Mapping[str, Vector]
    valid: Mapping[str, Mask]
    remarks: tuple[str, ...] = field(default=())
    logs: tuple[LogSource, ...] = field(default=())
    start: int = 0

    def __post_init__(self) -> None:
        for array in (*self.signals.values(), *self.valid.values()):
            array.setflags(write=False)

    @property
    def samples(self) -> int:
        """Number of samples N."""
        return len(next(iter(self.signals.values())))

    @property
    def t(self) -> Vector:
        """Time from the start of the trial [s]; (N,)."""
        return np.asarray(np.arange(self.samples) * self.period)

    @property
    def duration(self) -> float:
        """From the first to the last sample [s]."""
        return (self.samples - 1) * self.period
