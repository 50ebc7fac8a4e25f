"""ArduPilot dataflash logs (`.BIN`).

A channel is `ATT:Roll`, and `IMU/0:GyrZ` where one message comes from several devices. All stamps
are the autopilot's own TimeUS, from its start; `servo/1:deflection` is what a rudder servo was
ordered, `servo/3:throttle_left` what a motor was. Texts are no channels, nor are the parameters and
the log's own descriptions.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trialid.errors import LogError
from trialid.ingest.adapter import NO_AIDS, Adapter, Aids, Wanted, is_wanted, sha256
from trialid.ingest.mavlink import (
    dataflash_layout,
    dataflash_walk,
    mavlink_meanings,
    servo_deflection,
)
from trialid.ingest.mavlink.dataflash_layout import FMT_START, Layout
from trialid.ingest.mavlink.dataflash_messages import (
    OUTPUTS,
    TABLES,
    Log,
    columns_to_gather,
    narrow_columns,
    parameters,
    with_units,
)
from trialid.ingest.mavlink.dataflash_remarks import damage, servos_and_modes, start_date
from trialid.recording import Channel, Recording

FIRST = FMT_START + b"\x80\x59FMT\x00BBnNZ"
"""FMT describes itself first."""

BATCH_BYTES = 400_000_000
"""Memory one of several readings may take; a single column of a huge log may take more."""
CLOCK_COST, COLUMN_COST = 16, 14
"""Bytes a message costs for its stamp and for each number, raw and as a channel."""

WILD_NS = 1_000 * 10**9
"""A sample this far from both its neighbours, which agree, has a broken stamp."""


def recognises(head: bytes) -> bool:
    """The message with which FMT describes itself."""
    return FIRST in head


@np.errstate(invalid="ignore", over="ignore")  # a broken number is no reason to warn
def read(path: Path, wanted: Wanted = None, aids: Aids = NO_AIDS) -> Recording:
    """Read the wanted channels; damage is skipped and said in the remarks.

    Raises LogError when no message can be read.
    """
    del aids
    known, odd = dataflash_walk.layouts(path)
    gathered = dataflash_walk.gather(path, known, columns_to_gather(known, wanted))
    if gathered.counts.sum() == gathered.counts[dataflash_layout.FMT]:
        raise LogError(
            f"{path}: holds no readable message but the descriptions of messages; "
            "take another copy of the log"
        )
    log = Log(with_units(known, gathered), gathered)
    remarks = [*odd, *damage(gathered)]
    channels = {one.name: one for one in _channels(log, wanted, remarks)}
    steering, outputs = _deflections(log, wanted)
    remarks += [*servos_and_modes(log, steering, outputs), *start_date(log)]
    return Recording(path, ADAPTER.name, sha256(path), channels | steering, tuple(remarks))


def _channels(log: Log, wanted: Wanted, remarks: list[str]) -> Iterator[Channel]:
    for number, columns in log.gathered.columns.items():
        one = log.known[number]
        if one.name in TABLES or not log.gathered.counts[number]:
            continue
        if one.clock is None:
            remarks.append(f"{one.name}: left out, its messages carry no time")
            continue
        numbers = [i for i in columns if i in one.numbers]
        yield from _of_message(log, number, numbers, wanted)
        log.forget(number)


def _of_message(log: Log, number: int, columns: Sequence[int], wanted: Wanted) -> Iterator[Channel]:
    """The wanted channels of one message type, by device; those of one share stamps."""
    one = log.known[number]
    t, good = log.times(number)
    for source, mine in _devices(log, number):
        names = {i: f"{one.name}{source}:{one.columns[i]}" for i in columns}
        held = {i: name for i, name in names.items() if is_wanted(name, wanted)}
        if not held:
            continue
        rows = mine & good
        stamps = t[rows]
        wild = _wild(stamps)
        if len(wild):
            rows[np.flatnonzero(rows)[wild]] = False
            stamps = t[rows]
        for i, name in held.items():
            yield _channel(one, i, name, stamps, log.gathered.column(number, i)[rows])


def _devices(log: Log, number: int) -> Iterator[tuple[str, NDArray[np.bool_]]]:
    """How the name of each device's channels goes on, and which messages are of it, (N,)."""
    one = log.known[number]
    if one.instance is None:
        yield "", np.ones(int(log.gathered.counts[number]), bool)
        return
    which = log.gathered.column(number, one.instance)
    for device in np.flatnonzero(np.bincount(which.view(np.uint8), minlength=256)).tolist():
        value = np.uint8(device).view(which.dtype)
        yield f"/{value}", which == value


def _wild(t: NDArray[np.int64]) -> NDArray[np.int64]:
    """Rows whose stamps are far from both neighbours though these agree."""
    step = np.diff(t)
    far = np.flatnonzero((step > WILD_NS) | (step < -WILD_NS))
    both = far[1:][np.diff(far) == 1]
    return both[np.abs(t[both + 1] - t[both - 1]) < WILD_NS]


def _channel(
    one: Layout, column: int, name: str, t: NDArray[np.int64], raw: NDArray[Any]
) -> Channel:
    key = (one.name, one.columns[column])
    meaning = mavlink_meanings.DATAFLASH.get(key, mavlink_meanings.Meaning(""))
    stated = one.units[column] if one.units else ""
    unit, divisor = mavlink_meanings.unit(stated)
    y = dataflash_layout.scale_column(one, column, raw)
    words = meaning.words or mavlink_meanings.DATAFLASH_MESSAGES.get(one.name, "")
    return Channel(
        name=name,
        t=t,
        y=y if divisor == 1.0 else y / divisor,
        unit=unit or meaning.unit,
        clock=_clock(one),
        description=f"dataflash {name}" + (f", {words}" if words else ""),
        quantity=meaning.quantity,
        positive=meaning.positive,
    )


def _clock(one: Layout) -> str:
    return f"boot clock {one.clock}"


def _deflections(log: Log, wanted: Wanted) -> tuple[dict[str, Channel], dict[int, str]]:
    """Channels of what rudder servos and motors were ordered, and their names by output."""
    known, channels, names = parameters(log), {}, {}
    for n, output in servo_deflection.outputs(known).items():
        number = _message_of(log, n)
        if number is None or servo_deflection.missing_parameters(known, n):
            continue
        names[n] = f"servo/{n}:{output.field}"
        one = log.known[number]
        if is_wanted(names[n], wanted):
            t, good = log.times(number)
            pwm = log.gathered.column(number, one.columns.index(f"C{n}")).astype(np.float64)
            made = output.channel(names[n], t[good], pwm[good], n, known)
            channels[names[n]] = replace(made, clock=_clock(one))
    return channels, names


def _message_of(log: Log, n: int) -> int | None:
    """The message type that logs output `n`."""
    for name in OUTPUTS:
        number = log.number(name)
        if number is not None and log.gathered.counts[number]:
            one = log.known[number]
            if f"C{n}" in one.columns and one.clock:
                return number
    return None


def batches(path: Path, aids: Aids = NO_AIDS) -> Iterable[Wanted]:
    """Wanted channels, some at a time, so that each reading stays within BATCH_BYTES."""
    del aids
    known, _ = dataflash_walk.layouts(path)
    narrow = {n: narrow_columns(one) for n, one in known.items() if one.name not in TABLES}
    gathered = dataflash_walk.gather(path, known, narrow | columns_to_gather(known, ()))
    log = Log(with_units(known, gathered), gathered)
    return _portions(log)


def _portions(log: Log) -> Iterator[list[str]]:
    portion: list[str] = []
    size = 0
    for name, cost, clock in (one for number in log.known for one in _prefixes(log, number)):
        if portion and size + cost + clock > BATCH_BYTES:
            yield portion
            portion, size = [], 0
        size += cost if portion and _message(portion[-1]) == _message(name) else cost + clock
        portion.append(name)
    yield [*portion, "servo/"]


def _message(channel: str) -> str:
    return channel.partition(":")[0].partition("/")[0]


def _prefixes(log: Log, number: int) -> Iterator[tuple[str, int, int]]:
    """Beginnings of channel names that cover a message, what each costs and its clock [bytes]."""
    one, count = log.known[number], int(log.gathered.counts[number])
    if one.name in TABLES or one.clock is None or not count:
        return
    clock, column = CLOCK_COST * count, COLUMN_COST * count
    devices = [source for source, _ in _devices(log, number)]
    whole = clock + column * len(one.numbers) <= BATCH_BYTES
    for source in devices:
        if whole:
            yield f"{one.name}{source}:", column * len(one.numbers) // len(devices), clock
            continue
        for i in one.numbers:
            yield f"{one.name}{source}:{one.columns[i]}", column, clock


ADAPTER = Adapter("dataflash", recognises, read, batches=batches)
