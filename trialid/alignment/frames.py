"""From a channel as logged to a quantity in SI, positive in our own direction."""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from trialid.alignment.clocks import Series
from trialid.alignment.sources import SignalSource, find
from trialid.errors import AlignmentError, UnitError, nearest
from trialid.names import units
from trialid.names.quantities import SIGNALS, Quantity
from trialid.recording import Channel, Recording

MARKER = 1e30
"""No measurement is as large: loggers write the largest number for what is not available."""
TURNS_OF_WHAT = frozenset(("1/s", "s^-1", "s-1", "Hz"))
"""Units of a log that do not say whether revolutions or radians; of a shaft a pipeline says it, a
rate of turn in them is in radians."""
SHAFTS = frozenset(("n", "n_p", "n_s"))

Vector = NDArray[np.float64]


def series(source: SignalSource, recordings: Sequence[Recording], where: str) -> Series:
    """The signal in SI on its sensor's own clock, in the order of the log."""
    quantity = _quantity(source, where)
    _check_side(source, quantity, where)
    taken = _velocity if source.as_ in ("speed", "course") else _angle
    channel = taken(source, recordings, where) if source.as_ else None
    channel = channel or find(source.channel, recordings, where)
    size = _factor(_unit(source, channel, quantity, where), quantity, where)
    t, y = channel.t - round(source.delay * 1e9), sensor_values(channel.y)
    if _may_go_round(source, quantity):
        y = about_amidships(y, 2.0 * np.pi / size)
    value = _read(source, y) * _side(source) * size
    return Series(quantity, t, value, channel.clock, channel.received)


def _read(source: SignalSource, y: Vector) -> Vector:
    """The signal in its own unit, from the logged numbers."""
    if source.curve is None:
        return source.gain * y + source.offset
    logged, signal = np.transpose(source.curve)
    return np.interp(y, logged, signal, left=np.nan, right=np.nan)


def sensor_values(y: Vector) -> Vector:
    """The values that a sensor may have sent; NaN for codes of `not available` and damage."""
    return np.where(np.abs(y) < MARKER, y, np.nan)


def _may_go_round(source: SignalSource, quantity: Quantity) -> bool:
    return quantity.steers and quantity.unit == "rad" and source.curve is None


def counted_round(source: SignalSource, recordings: Sequence[Recording]) -> Iterator[str]:
    """A remark on a rudder whose angles are counted from 0 to a whole turn."""
    quantity = _quantity(source, "")
    if not _may_go_round(source, quantity):
        return
    channel = find(source.channel, recordings, "")
    turn = 2.0 * np.pi / _factor(_unit(source, channel, quantity, ""), quantity, "")
    if np.nanmin(about_amidships(channel.y, turn) - channel.y, initial=0.0) < 0.0:
        yield f"{quantity.name}: counted from 0 to {turn:.4g}, negative above {turn / 2:.4g}"


def about_amidships(y: Vector, turn: float) -> Vector:
    """Angles of a rudder, of those counted from 0 to a whole `turn` the last quarter as negative.

    At 355 deg it is 5 deg to the other side. None is between a quarter of a turn and three.

    >>> [about_amidships(np.array(y), 360.0).tolist() for y in ([5.0, 355.0], [5.0, 95.0, 355.0])]
    [[5.0, -5.0], [5.0, 95.0, 355.0]]
    """
    there = y[np.isfinite(y)]
    within = bool(np.all((there >= 0.0) & (there <= turn)))
    aside = np.abs(there - 0.5 * turn) > 0.25 * turn
    return np.where(y > 0.5 * turn, y - turn, y) if within and bool(np.all(aside)) else y


def _quantity(source: SignalSource, where: str) -> Quantity:
    if source.of is not None:
        return source.of
    if source.quantity not in SIGNALS:
        known = nearest(source.quantity, SIGNALS)
        raise AlignmentError(f"{where}: no quantity of that name ({known})")
    return SIGNALS[source.quantity]


def _check_side(source: SignalSource, quantity: Quantity, where: str) -> None:
    if source.positive is None and quantity.steers:
        raise AlignmentError(
            f"{where}: the sign of a rudder is never guessed; say which way the ship turns when "
            f'{source.channel!r} is positive: add positive = "starboard" or positive = "port"'
        )
    if source.positive is not None and quantity.mirror > 0:
        raise AlignmentError(
            f"{where}: {quantity.meaning} has no port or starboard; remove "
            f'positive = "{source.positive}"'
        )


def _side(source: SignalSource) -> float:
    return -1.0 if source.positive == "port" else 1.0


def _unit(source: SignalSource, channel: Channel, quantity: Quantity, where: str) -> str:
    """The one unit that pipeline and log agree on; a curve's is the pipeline's alone.

    So is that of a gain, where the log's unit is of something else: percent of the full rudder.
    """
    logged = channel.unit if source.curve is None else None
    if source.gain != 1.0 and source.unit and logged and not units.becomes(logged, quantity.unit):
        logged = None
    stated = source.unit or logged
    if stated is None:
        raise AlignmentError(
            f"{where}: neither the log nor the pipeline states the unit of {channel.name!r}; "
            f'add unit = "{quantity.shown}" or whatever it is in'
        )
    if source.unit and logged and not _same(source.unit, logged, quantity, where):
        raise AlignmentError(
            f"{where}: the log states {logged!r} for {channel.name!r}, the pipeline "
            f"{source.unit!r}; remove unit if the log is right, correct the log's header if not"
        )
    return stated


def _same(stated: str, logged: str, quantity: Quantity, where: str) -> bool:
    factor = _factor(stated, quantity, where)
    if logged in TURNS_OF_WHAT and quantity.name in SHAFTS:
        return True  # it leaves open what turns, and the pipeline says it
    try:
        return bool(np.isclose(units.factor(logged, quantity.unit), factor, rtol=1e-6))
    except UnitError:
        return False


def _factor(unit: str, quantity: Quantity, where: str) -> float:
    try:
        return units.factor_of(unit, quantity)
    except UnitError as error:
        raise UnitError(f"{where}: {error}") from error


def _angle(source: SignalSource, recordings: Sequence[Recording], where: str) -> Channel:
    """One angle [rad] of the quaternion whose fields are `channel`.x, .y, .z and .w.

    Roll in the ROS frame (REP-103: x forward, y to port, z up) has our sign; pitch and yaw have
    the opposite. Yaw is the rotation about z as logged, counterclockwise where z points up; with
    positive = "port" it becomes our heading but for the constant between the frame's x axis and
    north.
    """
    parts = [find(f"{source.channel}.{axis}", recordings, where) for axis in "xyzw"]
    if any(not np.array_equal(part.t, parts[0].t) for part in parts[1:]):
        raise AlignmentError(
            f"{where}: the four fields of {source.channel!r} do not share their stamps; "
            "a quaternion needs all of them at once"
        )
    x, y, z, w = (sensor_values(part.y) for part in parts)
    square = x**2 + y**2 + z**2 + w**2
    angle = np.where(square > 0, _euler(source.as_, x, y, z, w), np.nan)
    first = parts[0]
    return Channel(source.channel, first.t, angle, "rad", first.clock, received=first.received)


def _velocity(source: SignalSource, recordings: Sequence[Recording], where: str) -> Channel:
    """The length of a horizontal velocity, whatever its axes, or its angle from x to y [rad].

    Fields `channel`.x and .y. Of the axes of ROS, x to the east and y to the north, the
    angle counts as yaw does: positive = "port", and zero in the east.
    """
    x, y = (find(f"{source.channel}.{axis}", recordings, where) for axis in "xy")
    if not np.array_equal(x.t, y.t):
        raise AlignmentError(
            f"{where}: the fields of {source.channel!r} do not share their stamps; a velocity "
            "needs both at once"
        )
    ahead, aside = sensor_values(x.y), sensor_values(y.y)
    angle = source.as_ == "course"
    value = np.arctan2(aside, ahead) if angle else np.hypot(ahead, aside)
    unit = "rad" if angle else x.unit
    return Channel(source.channel, x.t, value, unit, x.clock, received=x.received)


def _euler(name: str | None, x: Vector, y: Vector, z: Vector, w: Vector) -> Vector:
    """Angle [rad] of a quaternion, normalised or not; rotations taken as yaw, pitch, roll."""
    if name == "roll":
        return np.arctan2(2 * (w * x + y * z), w**2 - x**2 - y**2 + z**2)
    if name == "yaw":
        return np.arctan2(2 * (w * z + x * y), w**2 + x**2 - y**2 - z**2)
    square = np.maximum(x**2 + y**2 + z**2 + w**2, np.finfo(float).tiny)
    return np.arcsin(np.clip(2 * (w * y - z * x) / square, -1.0, 1.0))
