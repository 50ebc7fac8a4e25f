"""One channel as read from a file to what is known of it; parts of many files to one channel."""

import dataclasses
import itertools
from collections.abc import Iterator, Mapping, Sequence
from typing import Final, Literal

import numpy as np

from trialid.alignment import frames
from trialid.alignment.sources import SignalSource
from trialid.arrays import Vector
from trialid.errors import TrialidError
from trialid.inspection import channel_names
from trialid.inspection.inspected import ChannelInspection, Gaps, Guess
from trialid.inspection.name_words import words as words_of
from trialid.inspection.sketch import join_sketches, sketch
from trialid.inspection.stamps import Health, health
from trialid.inspection.usual_units import of_angle, to_si
from trialid.names.quantities import RUDDERS, SIGNALS
from trialid.recording import Channel, Recording

ANGLES_OF_A_QUATERNION: Final[tuple[tuple[Literal["roll", "yaw"], str], ...]] = (
    ("roll", "phi"),
    ("yaw", "psi"),
)
NO_ROS: Final = "px4 ulog"
"""The format whose quaternions are of axes that point down: a turn to starboard is positive."""
TABLES: Final = frozenset(("csv", "excel", "json", "mat", "npz", "parquet"))
"""Formats that define no quantity: a column is what somebody called it."""
AXES = ("x", "y", "z", "w")
REP_103: Final[Mapping[str, Literal["port"]]] = {"r": "port", "psi": "port"}
"""ROS counts about an axis that points up: a turn to port is positive."""


def of_recording(recording: Recording) -> Iterator[ChannelInspection]:
    """Every channel that holds a sample, and the roll and yaw of every quaternion."""
    seen: tuple[Channel, Health] | None = None
    for channel in recording.channels.values():
        if not len(channel.t):
            continue
        if seen is None or not _same_stamps(seen[0], channel):
            seen = channel, health(channel.t, channel.clock, channel.received)
        yield _channel(channel, seen[1], defines=recording.adapter not in TABLES)
    yield from _orientations(recording)


def _same_stamps(one: Channel, other: Channel) -> bool:
    """Fields of a message share their stamps, which need not be looked at again."""
    if one.clock != other.clock:
        return False
    if one.received is not None or other.received is not None:
        return one.t is other.t and one.received is other.received
    return one.t is other.t or np.array_equal(one.t, other.t)


def _channel(channel: Channel, stamps: Health, *, defines: bool) -> ChannelInspection:
    t, y, own = channel.t, channel.y, stamps
    low, high = y.min(), y.max()
    if not (low > -frames.MARKER and high < frames.MARKER):  # nor where one is NaN
        there = np.isfinite(frames.sensor_values(y))
        t, y = t[there], y[there]
        low, high = (y.min(), y.max()) if len(y) else (np.nan, np.nan)
        own = health(t, channel.clock, None) if len(t) else stamps
        own = dataclasses.replace(own, clock=stamps.clock)
    if own.order is not None and len(t):
        t, y = t[own.order], y[own.order]
    unit = channel.unit or channel_names.unit_in_name(channel.name)
    guess = _guess(channel, unit, defines)
    angle = guess is not None and SIGNALS[guess.quantity].angle
    able = unit is None and guess is not None and (angle or guess.quantity == "phi")
    by_size = of_angle(y, goes_round=angle) if able else None
    size = to_si(unit or by_size or "", "rad") if angle else None
    if guess is not None and guess.quantity in RUDDERS and len(y):
        y = _about_amidships(y, to_si(unit or "deg", "rad"))
        low, high = y.min(), y.max()
    return ChannelInspection(
        name=channel.name,
        start=stamps.start,
        end=stamps.end,
        samples=len(channel.t),
        missing=1.0 - len(y) / len(channel.y),
        rate=1.0 / own.period if own.period else 0.0,
        gaps=own.gaps,
        low=float(low),
        high=float(high),
        clock=own.clock,
        unit=channel.unit,
        unit_in_name=None if channel.unit else channel_names.unit_in_name(channel.name),
        unit_by_size=by_size,
        description=channel.description,
        guess=guess,
        sketch=sketch(t, y, 2.0 * np.pi / size if size else None),
    )


def _about_amidships(y: Vector, size: float | None) -> Vector:
    return frames.about_amidships(y, 2.0 * np.pi / size) if size else y


def _guess(channel: Channel, unit: str | None, defines: bool) -> Guess | None:
    if channel.quantity is not None and defines:
        return Guess(channel.quantity, "format", "defined by the format", channel.positive)
    if channel.quantity is not None:
        return Guess(channel.quantity, "exact name", "by its name", channel.positive)
    found = channel_names.quantity(channel.name, unit)
    if found is None:
        return None
    if channel.name.endswith("angular_velocity.z"):
        return Guess(found, "name", "by its name (ROS: to port)", REP_103[found])
    words = "by its name"
    if "kurs" in words_of(channel.name):
        words = "by its name (if it is not the course over ground)"
    return Guess(found, "name", words, channel.positive)


def _orientations(recording: Recording) -> Iterator[ChannelInspection]:
    for name in _quaternions(recording.channels):
        for angle, quantity in ANGLES_OF_A_QUATERNION:
            source = SignalSource(quantity, name, as_=angle)
            try:
                found = frames.series(source, [recording], "")
            except TrialidError:
                return  # its four fields do not share their stamps: not one quaternion
            side = None if recording.adapter == NO_ROS else REP_103.get(quantity)
            y = np.asarray(found.y)
            one = Channel(name, found.t, y, "rad", found.clock, quantity=quantity, positive=side)
            seen = _channel(one, health(one.t, one.clock, None), defines=True)
            yield dataclasses.replace(seen, angle=angle)


def _quaternions(channels: Mapping[str, Channel]) -> Iterator[str]:
    """Names whose fields x, y, z and w are of length one."""
    for name in channels:
        stem = name.removesuffix(".w")
        fields = [channels.get(f"{stem}.{axis}") for axis in AXES]
        if stem == name or any(field is None for field in fields):
            continue
        values = [frames.sensor_values(field.y) for field in fields if field is not None]
        if len({len(y) for y in values}) != 1 or not len(values[0]):
            continue
        square = np.sum([y**2 for y in values], axis=0)
        known = square[np.isfinite(square)]
        if len(known) and abs(float(np.median(known)) - 1.0) < 0.01:
            yield stem


def merge_channels(parts: Sequence[ChannelInspection]) -> ChannelInspection:
    """A channel of several files as one; what lies between two files is a gap if it is long."""
    if len(parts) == 1:
        return parts[0]
    first, *_ = ordered = sorted(parts, key=lambda part: part.start)
    samples = sum(part.samples for part in ordered)
    weights = [part.samples / samples for part in ordered]
    rate = float(np.average([part.rate for part in ordered], weights=weights))
    return dataclasses.replace(
        first,
        end=max(part.end for part in ordered),
        samples=samples,
        missing=sum(w * part.missing for w, part in zip(weights, ordered, strict=True)),
        rate=rate,
        gaps=_gaps(ordered, rate),
        low=float(np.nanmin([part.low for part in ordered])),
        high=float(np.nanmax([part.high for part in ordered])),
        clock=dataclasses.replace(
            first.clock,
            jitter=max(part.clock.jitter for part in ordered),
            steps_back=sum(part.clock.steps_back for part in ordered),
            furthest_back=max(part.clock.furthest_back for part in ordered),
            same=sum(part.clock.same for part in ordered),
        ),
        sketch=join_sketches([part.sketch for part in ordered]),
    )


def _gaps(ordered: Sequence[ChannelInspection], rate: float) -> Gaps:
    holes = [(b.start - a.end) / 1e9 for a, b in itertools.pairwise(ordered)]
    between = [hole for hole in holes if rate and hole > 3.0 / rate]
    inside = [part.gaps for part in ordered]
    return Gaps(
        sum(one.count for one in inside) + len(between),
        sum(one.total for one in inside) + sum(between),
        max([*(one.longest for one in inside), *between]),
    )
