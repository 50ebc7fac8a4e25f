"""A finding, the picture that shows it, and what a slice hands back."""

from dataclasses import dataclass, field
from typing import Literal


@dataclass(frozen=True, kw_only=True)
class Bars:
    """Error by bins of something: one entry a bin, in the unit of reports.

    Attributes
    ----------
    by, unit
        What the bins are of, and its unit; edges in that unit, one more than there are bins.
    names
        What a bin is called where a range of numbers would not say it; else empty.
    samples, share
        Share of the compared samples and of the output's squared error.
    mean_square, low, high
        Mean square over that of all samples, and its 95 % interval.
    mean, error, mean_unit
        Measured less predicted on average, and its standard error; None where not formed.
    standing
        Whether the bin belongs to what the finding says.
    """

    form: Literal["bars"] = "bars"
    by: str
    unit: str
    edges: tuple[float, ...]
    names: tuple[str, ...]
    samples: tuple[float, ...]
    share: tuple[float, ...]
    mean_square: tuple[float, ...]
    low: tuple[float, ...]
    high: tuple[float, ...]
    mean: tuple[float, ...] | None
    error: tuple[float, ...] | None
    mean_unit: str
    standing: tuple[bool, ...]


@dataclass(frozen=True)
class Spectrum:
    """Spectrum of a residual: shares of the squared error per frequency; (F,) each.

    `coherent` is the part of `density` that follows the rudder, `threshold` the coherence that
    chance reaches at none of the frequencies in 95 of 100 records.
    """

    form: Literal["spectrum"] = field(default="spectrum", kw_only=True)
    frequency: tuple[float, ...]
    density: tuple[float, ...]
    coherent: tuple[float, ...]
    coherence: tuple[float, ...]
    threshold: float


@dataclass(frozen=True)
class Finding:
    """One slice in which an output is predicted worse than chance would have it.

    Attributes
    ----------
    kind
        What the error was sliced by: `stretch`, `rudder amplitude`, `turn-rate amplitude`,
        `roll amplitude`, `side`, `heading sector`, `speed`, `frequency`, `mean offset`.
    share
        Share of the output's squared error: what lies in the slice or, where only the mean stands
        out, what that mean makes up.
    beyond
        What of `share` goes beyond the slice's share of the samples: the order of findings.
    excess
        Mean square in the slice over that of all samples.
    p_value
        Chance of it in a record without model error, corrected for all that was examined.
    trial, t_start, t_end
        The stretch [s], or None.
    doing
        What the ship was doing, for a stretch.
    """

    output: str
    kind: str
    share: float
    beyond: float
    excess: float
    p_value: float
    sentence: str
    picture: Bars | Spectrum
    trial: str | None = None
    t_start: float | None = None
    t_end: float | None = None
    doing: str | None = None


@dataclass(frozen=True)
class Examined:
    """One question put to one output: its p-value over all bins, and what it found if it stands."""

    p_value: float
    findings: tuple[Finding, ...] = field(default=())
