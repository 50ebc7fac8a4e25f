"""Signals from arrays or a table in memory: units to SI, sides to ours, gaps masked."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Final, Literal

import numpy as np

from trialid.arrays import Mask, Vector
from trialid.errors import AlignmentError, nearest
from trialid.names import units as unit_table
from trialid.names.quantities import RUDDERS, SIGNALS

if TYPE_CHECKING:
    import pandas as pd

UNIFORM: Final = 0.01
"""Share of a step by which a clock may waver and still be uniform."""


def in_si(
    name: str,
    t: Sequence[float] | Vector,
    signals: Mapping[str, Sequence[float] | Vector],
    units: Mapping[str, str],
    positive: Mapping[str, Literal["port", "starboard"]],
    *,
    wanted: Mapping[str, str],
) -> tuple[float, dict[str, Vector], dict[str, Mask]]:
    """The period [s], values in SI and where they were measured; errors as `Trial.from_arrays`.

    Parameters
    ----------
    wanted
        Every signal there may be, to its unit in SI.
    """
    clock = np.asarray(t, dtype=float)
    period = _period(name, clock)
    _check_names(name, signals, units, positive, wanted)
    values, valid = dict[str, Vector](), dict[str, Mask]()
    for quantity, given in signals.items():
        y = np.asarray(given, dtype=float)
        if y.shape != clock.shape:
            raise AlignmentError(
                f"trial {name!r}, {quantity}: {y.size} values for {clock.size} times; give one "
                "value a time"
            )
        side = -1.0 if positive.get(quantity) == "port" else 1.0
        valid[quantity] = np.isfinite(y)
        in_si = side * unit_table.factor(units[quantity], wanted[quantity]) * y
        values[quantity] = _filled(name, quantity, in_si, valid[quantity])
    return period, values, valid


def columns_of(frame: "pd.DataFrame", units: Mapping[str, str]) -> tuple[Vector, dict[str, Vector]]:
    """Time [s] from the first row, and the columns that a unit is stated for; (N,) each."""
    missing = [name for name in units if name not in frame.columns]
    if missing:
        hint = nearest(missing[0], [str(column) for column in frame.columns])
        raise AlignmentError(f"the table has no column {missing[0]!r}; {hint}")
    stamps: Any = frame["t"] if "t" in frame.columns else frame.index
    given = np.asarray(stamps)
    if given.dtype.kind == "M":
        given = (given - given[0]) / np.timedelta64(1, "s")
    return given.astype(float), {name: frame[name].to_numpy(float) for name in units}


def _period(name: str, t: Vector) -> float:
    """The step of a uniform clock [s]."""
    if t.ndim != 1 or t.size < 2 or not np.isfinite(t).all():
        raise AlignmentError(f"trial {name!r}: t must be a row of at least two finite times [s]")
    period = float(t[-1] - t[0]) / (t.size - 1)
    off = np.abs(t - t[0] - period * np.arange(t.size))
    if period <= 0.0 or off.max() > UNIFORM * period:
        worst = int(off.argmax())
        raise AlignmentError(
            f"trial {name!r}: t is not uniform (at index {worst} it is {off[worst]:.3g} s off a "
            f"step of {period:.4g} s); resample it, or give the log to trialid.align"
        )
    return period


def _check_names(
    name: str,
    signals: Mapping[str, object],
    units: Mapping[str, str],
    positive: Mapping[str, str],
    wanted: Mapping[str, str],
) -> None:
    for quantity in signals:
        if quantity not in wanted:
            raise AlignmentError(
                f"trial {name!r}: there is no signal {quantity!r}; {nearest(quantity, wanted)}"
            )
        if quantity not in units:
            raise AlignmentError(
                f"trial {name!r}: the unit of {quantity!r} is not stated; add it to units, such as "
                f'{{"{quantity}": "{_shown(quantity, wanted)}"}}'
            )
        if quantity in RUDDERS and positive.get(quantity) not in ("port", "starboard"):
            raise AlignmentError(
                f"trial {name!r}: the sign of a rudder is never guessed; say which way the ship "
                f'turns when {quantity!r} is positive: positive={{"{quantity}": "starboard"}}, or '
                '"port"'
            )


def _shown(quantity: str, wanted: Mapping[str, str]) -> str:
    return SIGNALS[quantity].shown if quantity in SIGNALS else wanted[quantity]


def _filled(name: str, quantity: str, y: Vector, valid: Mask) -> Vector:
    """Values that keep a simulation going in gaps: on a straight line; `valid` says where."""
    if valid.all():
        return y
    if not valid.any():
        raise AlignmentError(f"trial {name!r}, {quantity}: no value is a number")
    place = np.arange(y.size)
    return np.interp(place, place[valid], y[valid])
