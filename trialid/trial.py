"""A trial: one manoeuvre, every signal in SI on one clock; the only thing the identifier sees."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Final, Literal

import numpy as np

from trialid.arrays import Mask, Vector
from trialid.errors import AlignmentError
from trialid.names.quantities import SIGNALS
from trialid.signal_arrays import CLOCK, columns_of, in_si

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True)
class LogSource:
    """Where a trial's signals came from, enough to repeat the run."""

    path: str
    sha256: str
    adapter: str


@dataclass(frozen=True, kw_only=True)
class Contradiction:
    """A rate that is not the slope of its angle, measured on the record.

    Parameters
    ----------
    rate, angle
        Signals, as `r` and `psi`.
    late
        By how much the rate comes later [s]; less than nothing where the angle does.
    factor
        The rate over the slope of the angle; 1 where that is not told.
    sentence
        In words, with the line of a pipeline's signal that would mend it, where it is known.
    drift
        By how much the rate drifts against that slope from begin to end [rad/s].
    """

    rate: str
    angle: str
    sentence: str
    late: float = 0.0
    factor: float = 1.0
    drift: float = 0.0


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
    opening
        Where a window of the logs begins that the trial is [s], as a pipeline states it.
    sided
        Quantities whose positive side was stated: what speaks against it is no doubt of it.
    contradictions
        Rates that are not the slopes of their angles.
    logged_every
        Time between samples as the slowest of orders, rates and roll was logged [s]; zero where
        nobody says.
    """

    name: str
    use: Literal["fit", "check"]
    period: float
    signals: Mapping[str, Vector]
    valid: Mapping[str, Mask]
    remarks: tuple[str, ...] = field(default=())
    logs: tuple[LogSource, ...] = field(default=())
    start: int = 0
    opening: float = 0.0
    sided: frozenset[str] = frozenset()
    contradictions: tuple[Contradiction, ...] = ()
    logged_every: float = 0.0

    def __post_init__(self) -> None:
        if self.use not in ("fit", "check"):
            raise AlignmentError(
                f"trial {self.name!r}: use = {self.use!r}; expected 'fit', or 'check' of one that "
                "is held out"
            )
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

    @classmethod
    def from_arrays(
        cls,
        name: str,
        t: Sequence[float] | Vector,
        signals: Mapping[str, Sequence[float] | Vector],
        *,
        units: Mapping[str, str],
        positive: Mapping[str, Literal["port", "starboard"]] | None = None,
        use: Literal["fit", "check"] = "fit",
        own: Mapping[str, str] | None = None,
    ) -> "Trial":
        """A trial from arrays on one uniform clock.

        Parameters
        ----------
        t
            Time [s], or as dates or spans of time; (N,), uniform to a hundredth of its step.
        signals
            Quantity name to values; (N,) each. NaN is what was not measured.
        units
            Quantity name to the unit its values are in: `deg`, `deg/s`, `kn`; of `t` too, where it
            is not in seconds: `ms`.
        positive
            The side a quantity counts positive; of a rudder it has to be said, others are positive
            to starboard where nothing is said.
        own
            Names beside the dictionary, an actuator's or one's own, to the unit in which the
            effects read them: `{"left": "rad/s", "tow": "N"}`.

        Raises
        ------
        TrialidError
            The clock is not uniform, or goes by more than 10 s from row to row and states no unit;
            a name, a unit or a side is not known, a rudder's side is not said.
        """
        wanted = {n: q.unit for n, q in SIGNALS.items()} | dict(own or {})
        period, values, valid = in_si(name, t, signals, units, positive or {}, wanted=wanted)
        return cls(name, use, period, values, valid, sided=frozenset(positive or {}))

    @classmethod
    def from_frame(
        cls,
        name: str,
        frame: "pd.DataFrame",
        *,
        units: Mapping[str, str],
        positive: Mapping[str, Literal["port", "starboard"]] | None = None,
        use: Literal["fit", "check"] = "fit",
        own: Mapping[str, str] | None = None,
    ) -> "Trial":
        """A trial from a table: a column for each signal named in `units`.

        Time is a column `t`, else the index: in seconds, or the unit stated for `t`; as dates, with
        or without a zone, or as spans of time. The rest as `from_arrays`.
        """
        t, signals = columns_of(frame, units)
        made = cls.from_arrays(name, t, signals, units=units, positive=positive, use=use, own=own)
        left = [str(c) for c in frame.columns if str(c) in {*SIGNALS} - {CLOCK, *units}]
        said = f"left out, as units states none of them: {', '.join(left)}"
        return replace(made, remarks=(said,)) if left else made

    def part(self, begin: int, end: int, remark: str) -> "Trial":
        """The samples from `begin` up to `end`, as a window of the logs, with a remark on it."""
        return replace(
            self,
            signals={name: y[begin:end] for name, y in self.signals.items()},
            valid={name: mask[begin:end] for name, mask in self.valid.items()},
            remarks=(*self.remarks, remark),
            start=self.start + round(begin * self.period * 1e9),
            opening=self.opening + begin * self.period,
        )


WIND: Final = ("V_aw", "gamma_aw")
"""What an anemometer logs: speed [m/s] and angle [rad]."""


def heel_in_calm(trial: Trial, turning: Vector, valid: Mask) -> Vector:
    """Her roll angle [rad] less what goes with a logged wind from the side; (N,).

    By least squares over the `valid` samples, beside `turning`, the rate of turn times the speed
    [m rad/s^2]; (N,) each. A yacht heeled 1.3 deg out of her turns and more by gusts: her heel went
    with r u by 0.88.
    """
    heel = trial.signals["phi"]
    if not {*WIND} <= trial.signals.keys():
        return heel
    speed, angle = (trial.signals[name] for name in WIND)
    push = np.nan_to_num(speed**2 * np.sin(angle))
    columns = np.column_stack([np.ones(trial.samples), turning, push])
    (_, _, by_wind), *_ = np.linalg.lstsq(columns[valid], heel[valid], rcond=None)
    return np.asarray(heel - by_wind * push)
