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
SLOWEST: Final = 10.0
"""[s] No log of a manoeuvre is slower: a longer step is rather one of milliseconds or finer. Half
of it asks of logs every 5 s, twice takes milliseconds at 50 a second for seconds."""
HALF_ROUND: Final = {"delta": "rudder", "delta_order": "rudder", "phi": "ship"}
"""Angles that are never beyond 180 deg, and whose."""
WRAPPED: Final = 4.0 * np.pi
"""[rad] A heading jumps by a turn where it begins again, and in degrees by 57 of them: half of it
is that turn, twice of it says the same."""
CLOCK: Final = "t"
"""What the time is called; its unit is seconds where none is stated."""


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
    clock = _clock(name, t, units.get(CLOCK))
    period = _period(name, clock, stated=CLOCK in units)
    _check_names(name, signals, units, positive, wanted)
    _check_stated(name, units, positive, wanted)
    values, valid = dict[str, Vector](), dict[str, Mask]()
    for quantity, given in signals.items():
        y = numbers(f"trial {name!r}, {quantity}", given)
        if y.shape != clock.shape:
            shown = f"{y.size} values" if y.ndim == 1 else f"values of shape {y.shape}"
            raise AlignmentError(
                f"trial {name!r}, {quantity}: {shown} for {clock.size} times; give one value a "
                f"time, of shape ({clock.size},)"
            )
        side = -1.0 if positive.get(quantity) == "port" else 1.0
        valid[quantity] = np.isfinite(y)
        in_si = side * unit_table.factor(units[quantity], wanted[quantity]) * y
        _check_turned(name, quantity, in_si[valid[quantity]], units[quantity])
        values[quantity] = _filled(name, quantity, in_si, valid[quantity])
    return period, values, valid


def _check_turned(name: str, quantity: str, y: Vector, unit: str) -> None:
    """Refuse degrees as radians: a rudder or a heel more than half round, a heading over turns."""
    if quantity in HALF_ROUND and float(np.abs(y).max(initial=0.0)) > np.pi:
        raise AlignmentError(
            f"trial {name!r}, {quantity}: reaches {np.rad2deg(np.abs(y).max()):.4g} deg in "
            f"{unit!r}; no {HALF_ROUND[quantity]} is turned half round: state the unit its numbers "
            "are in"
        )
    jump = float(np.abs(np.diff(y)).max(initial=0.0))
    if quantity == "psi" and jump > WRAPPED:
        raise AlignmentError(
            f"trial {name!r}, psi: jumps by {jump:.4g} rad as {unit!r}, and a heading begins again "
            "after a turn of 6.283 rad: state the unit its numbers are in"
        )


def columns_of(frame: "pd.DataFrame", units: Mapping[str, str]) -> tuple[Any, dict[str, Any]]:
    """Times as the table has them, and the columns that a unit is stated for; (N,) each."""
    if not hasattr(frame, "columns") or not hasattr(frame, "index"):
        raise AlignmentError(
            f"expected a pandas DataFrame, got a {type(frame).__name__}; of arrays "
            "ti.Trial.from_arrays makes a trial"
        )
    wanted = [name for name in units if name != CLOCK]
    if not wanted:
        raise AlignmentError(
            'no column has a unit; name those that are signals, such as units={"r": "deg/s"}'
        )
    columns = [str(column) for column in frame.columns]
    for name in wanted:
        if name not in frame.columns:
            raise AlignmentError(f"the table has no column {name!r}; {nearest(name, columns)}")
    for name in (n for n in (CLOCK, *wanted) if columns.count(n) > 1):
        raise AlignmentError(f"the table has {columns.count(name)} columns {name!r}; leave one")
    return _stamps(frame), {name: frame[name] for name in wanted}


def _stamps(frame: "pd.DataFrame") -> Any:
    """The column of times, else the index; never one that only numbers the rows."""
    if CLOCK in frame.columns:
        return frame[CLOCK]
    if frame.index.name is None and frame.index.dtype.kind in "iu":
        raise AlignmentError(
            "the table has no column 't', and its index only numbers the rows; add the times [s] "
            "as a column t, or call the index t where it holds them"
        )
    return frame.index


def _clock(name: str, t: Any, unit: str | None) -> Vector:
    """Times [s], whatever they were given as: of dates and spans from the first."""
    stamps = np.asarray(t)
    if stamps.dtype.kind in "OUST":
        stamps = _read_stamps(name, stamps)
    if stamps.dtype.kind not in "mM":
        factor = unit_table.factor(unit or "s", "s")
        return factor * numbers(f"trial {name!r}, {CLOCK}", stamps)
    if unit is not None:
        raise AlignmentError(
            f"trial {name!r}: t holds dates or spans of time, which need no unit; take t={unit!r} "
            "out of units"
        )
    return np.asarray((stamps - stamps[:1]) / np.timedelta64(1, "s"))


def _read_stamps(name: str, stamps: Any) -> Any:
    """Numbers, or dates of any zones as UTC, that a column holds as objects or texts."""
    import pandas as pd

    try:
        return stamps.astype(float)
    except (TypeError, ValueError):
        pass
    try:
        dates = pd.to_datetime(stamps, utc=True, format="ISO8601")
        return pd.DatetimeIndex(dates).tz_localize(None).to_numpy()
    except (TypeError, ValueError, OverflowError) as error:
        raise AlignmentError(
            f"trial {name!r}: t begins with {stamps.ravel().tolist()[0]!r}; expected seconds, "
            "dates as 2026-03-01T12:00:00+01:00, or spans as pandas.to_timedelta makes them"
        ) from error


def numbers(where: str, given: Any) -> Vector:
    """Values as numbers, one that is missing as NaN; AlignmentError where one is none."""
    plain = np.asarray(given)
    if plain.dtype.kind in "bcmM":
        raise AlignmentError(f"{where}: expected numbers, got {plain.dtype}")
    try:
        return np.asarray(plain, dtype=float)
    except (TypeError, ValueError):  # which value it is, the library does not say
        return np.array(
            [_number(where, row, value) for row, value in enumerate(plain.ravel().tolist())]
        )


def _number(where: str, row: int, value: Any) -> float:
    """One value that is a number, or none at all."""
    import pandas as pd

    if value is None or value is pd.NA:
        return float("nan")
    try:
        return float(value)
    except (TypeError, ValueError) as error:
        comma = "; of decimal commas pandas.read_csv(..., decimal=',') makes numbers"
        hint = comma if "," in str(value) else ""
        raise AlignmentError(f"{where}: {value!r} (row {row}) is no number{hint}") from error


def _period(name: str, t: Vector, *, stated: bool) -> float:
    """The step of a uniform clock [s]."""
    if t.ndim != 1 or t.size < 2 or not np.isfinite(t).all():
        raise AlignmentError(f"trial {name!r}: t must be a row of at least two finite times [s]")
    period = float(t[-1] - t[0]) / (t.size - 1)
    if period <= 0.0:
        raise AlignmentError(f"trial {name!r}: t runs backwards, from {t[0]:.6g} to {t[-1]:.6g} s")
    off = np.abs(t - t[0] - period * np.arange(t.size))
    if off.max() > UNIFORM * period:
        worst = int(off.argmax())
        raise AlignmentError(
            f"trial {name!r}: t is not uniform (at index {worst} it is {off[worst]:.3g} s off a "
            f"step of {period:.4g} s); resample it, or give the log to trialid.align"
        )
    if period > SLOWEST and not stated:
        raise AlignmentError(
            f"trial {name!r}: t goes by {period:.4g} s from row to row, too slow for a manoeuvre; "
            'state its unit, such as units={"t": "ms"}, or "s" where it is right'
        )
    return period


def _check_stated(
    name: str, units: Mapping[str, str], positive: Mapping[str, str], wanted: Mapping[str, str]
) -> None:
    """Refuse a unit or a side of what is no signal, and a side that is none."""
    for quantity in units:
        if quantity not in wanted:
            raise AlignmentError(
                f"trial {name!r}: units names {quantity!r}, which is no signal; "
                f"{nearest(quantity, wanted)}"
            )
    for quantity, side in positive.items():
        if quantity not in wanted:
            raise AlignmentError(
                f"trial {name!r}: positive names {quantity!r}, which is no signal; "
                f"{nearest(quantity, wanted)}"
            )
        if side not in ("port", "starboard"):
            raise AlignmentError(
                f"trial {name!r}: positive={{{quantity!r}: {side!r}}}; expected 'port' or "
                "'starboard'"
            )
        if quantity in SIGNALS and SIGNALS[quantity].mirror == 1:
            raise AlignmentError(
                f"trial {name!r}: {quantity!r} has no port or starboard "
                f"({SIGNALS[quantity].meaning}); leave it out of positive"
            )


def _check_names(
    name: str,
    signals: Mapping[str, object],
    units: Mapping[str, str],
    positive: Mapping[str, str],
    wanted: Mapping[str, str],
) -> None:
    for quantity in signals:
        if quantity == CLOCK:
            raise AlignmentError(f"trial {name!r}: 't' is the time; it is no signal beside it")
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
