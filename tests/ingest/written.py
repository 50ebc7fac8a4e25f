"""What a writer of test logs is: the same series in a format, by the real library of the format."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from trialid.alignment import SignalSource
from trialid.ingest.adapter import NO_AIDS, Aids

Series = tuple[NDArray[np.int64], NDArray[np.float64]]
"""Stamps [ns since 1970] and values in SI, positive as in the dictionary of quantities; (N,)."""


@dataclass(frozen=True)
class Written:
    """A log that was written, and how to get its signals back.

    `resolution` is the step of the format's numbers by quantity [SI], `clock_resolution` of its
    stamps [s]; a quantity the format cannot hold is left out of all three.
    """

    sources: tuple[SignalSource, ...]
    resolution: Mapping[str, float]
    clock_resolution: float = 1e-9
    aids: Aids = NO_AIDS


@dataclass(frozen=True)
class Format:
    """A format and its writer; series come by quantity: delta, r, phi, u, psi."""

    name: str
    write: Callable[[Path, Mapping[str, Series]], Written]
