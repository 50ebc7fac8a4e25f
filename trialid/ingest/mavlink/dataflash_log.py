"""ArduPilot dataflash logs (`.BIN`).

A channel is `ATT:Roll`, and `IMU/0:GyrZ` where one message comes from several devices. All stamps
are the autopilot's own TimeUS, from its start; `servo/1:deflection` is what a rudder servo was
ordered, `servo/3:throttle_left` what a motor was. Texts are no channels, nor are the parameters and
the log's own descriptions.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from datetime import timedelta
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
    vehicle_modes,
)
from trialid.ingest.mavlink.dataflash_layout import FMT_START, Layout
from trialid.ingest.mavlink.dataflash_walk import Gathered
from trialid.ingest.times import gps_time
from trialid.recording import Channel, Recording

FIRST = FMT_START + b"\x80\x59FMT\x00BBnNZ"
"""FMT describes itself first."""

TABLES = frozenset({"FMT", "FMTU", "UNIT", "MULT", "PARM", "FILE"})
"""Messages that describe the log or the autopilot: their numbers are no measurements."""
READ_ALWAYS = {
    "FMTU": None, "UNIT": None, "MULT": None, "MODE": None, "ARM": None,
    "PARM": ("TimeUS", "TimeMS", "Name", "Value"),
    "MSG": ("TimeUS", "TimeMS", "Message"),
    "GPS": ("TimeUS", "Status", "GMS", "GWk"),
}  # fmt: skip
"""What remarks and units need, whatever is wanted; None for all columns."""

OUTPUTS = ("RCOU", "RCO2", "RCO3")
INSTANCES = ("I", "Instance", "C")
"""What the column that tells devices apart is called, in logs that do not say."""

BATCH_BYTES = 400_000_000
"""Memory one of several readings may take; a single column of a huge log may take more."""
CLOCK_COST, COLUMN_COST = 16, 14
"""Bytes a message costs for its stamp and for each number, raw and as a channel."""
Stamps = tuple[NDArray[np.int64], NDArray[np.bool_]]

LONGEST_US = 10 * 365 * 86_400 * 10**6
"""Ten years: no autopilot has been on for so long."""
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
    gathered = dataflash_walk.gather(path, known, _columns(known, wanted))
    if gathered.counts.sum() == gathered.counts[dataflash_layout.FMT]:
        raise LogError(
            f"{path}: holds no readable message but the descriptions of messages; "
            "take another copy of the log"
        )
    log = Log(_with_units(known, gathered), gathered)
    remarks = [*odd, *_damage(gathered)]
    channels = {one.name: one for one in _channels(log, wanted, remarks)}
    steering, outputs = _deflections(log, wanted)
    remarks += [*_whole(log, steering, outputs), *_of_time(log)]
    return Recording(path, ADAPTER.name, sha256(path), channels | steering, tuple(remarks))


@dataclass(frozen=True)
class Log:
    """Message types with their units, and the columns that were gathered."""

    known: Mapping[int, Layout]
    gathered: Gathered
    stamps: dict[int, Stamps] = field(default_factory=dict)

    def times(self, number: int) -> Stamps:
        """Stamps [ns] of a message type since boot, and which of them can be true; (N,) both."""
        if number not in self.stamps:
            raw = self.gathered.column(number, 0)
            del self.gathered.columns[number][0]
            self.stamps[number] = _stamps(self.known[number], raw)
        return self.stamps[number]

    def forget(self, number: int) -> None:
        """Give the memory of a message type free that nobody asks for again."""
        if self.known[number].name not in {*READ_ALWAYS, *OUTPUTS}:
            self.gathered.columns[number] = {}
            del self.stamps[number]

    def number(self, name: str) -> int | None:
        """Number of the message type that was logged under this name."""
        found = [n for n, one in self.known.items() if one.name == name]
        return max(found, key=lambda n: int(self.gathered.counts[n]), default=None)

    def table(self, name: str) -> dict[str, NDArray[Any]]:
        """The gathered columns of a message but its clock, by their names, raw; (N,) each."""
        number = self.number(name)
        if number is None:
            return {}
        columns = self.gathered.columns.get(number, {})
        one = self.known[number]
        held = [i for i in columns if i or not one.clock]
        return {one.columns[i]: self.gathered.column(number, i) for i in held}


def _columns(known: Mapping[int, Layout], wanted: Wanted) -> dict[int, list[int]]:
    """Columns to gather by message type; the clock and what may tell devices apart go with them."""
    found = {}
    for number, one in known.items():
        columns = [i for i in one.numbers if _maybe(one, i, wanted)]
        if one.name in TABLES:
            columns = []
        if one.name in OUTPUTS and _servo_asked(wanted):
            columns = list(one.numbers)
        if one.name in READ_ALWAYS:
            names = READ_ALWAYS[one.name] or one.columns
            columns = [*columns, *(i for i, c in enumerate(one.columns) if c in names)]
        if columns:
            found[number] = sorted({*columns, *_narrow(one), 0})
    return found


def _narrow(one: Layout) -> list[int]:
    """Columns that may tell devices apart."""
    return [i for i, code in enumerate(one.codes) if code in dataflash_layout.NARROW]


def _maybe(one: Layout, column: int, wanted: Wanted) -> bool:
    """True when a channel of this column may be wanted, of whichever device."""
    name = one.columns[column]
    for want in wanted if wanted is not None else ("",):
        message, colon, field = want.partition(":")
        of_device = message.startswith(f"{one.name}/") and (not colon or name.startswith(field))
        if of_device or f"{one.name}:{name}".startswith(want) or f"{one.name}/".startswith(want):
            return True
    return False


def _servo_asked(wanted: Wanted) -> bool:
    return wanted is None or any(w.startswith("servo"[: len(w)]) for w in wanted)


def _with_units(known: Mapping[int, Layout], gathered: Gathered) -> dict[int, Layout]:
    """The message types with what UNIT, MULT and FMTU say of their columns."""
    log = Log(known, gathered)
    tables = dataflash_layout.unit_tables(log.table("UNIT"), log.table("MULT"))
    stated = log.table("FMTU")
    told = dict(known)
    ids = [stated.get(name, np.empty(0)) for name in ("FmtType", "UnitIds", "MultIds")]
    for number, units, factors in zip(*(one.tolist() for one in ids), strict=False):
        if number in known:
            told[number] = dataflash_layout.with_units(
                known[number], units.decode("latin-1"), factors.decode("latin-1"), tables
            )
    usual = dataflash_layout.with_usual_instance
    return {number: one if one.units else usual(one, INSTANCES) for number, one in told.items()}


def _damage(gathered: Gathered) -> Iterator[str]:
    """What was lost, where, and how much was read nevertheless."""
    holes, seen = gathered.holes, int(gathered.counts.sum())
    if not holes:
        return
    lost = sum(hole.size for hole in holes)
    about = seen + max(1, round(lost * seen / max(gathered.size - lost, 1)))
    spans = [_span(hole) for hole in holes[:3]]
    more = f" and at {len(holes) - 3} places more" if len(holes) > 3 else ""
    yield (
        f"recovered {seen} of about {about} messages, lost {', '.join(spans)}{more} "
        f"({lost} bytes are no message, from byte {holes[0].at}); messages carry no checksum: "
        "damage inside one is not seen"
    )


def _span(hole: dataflash_walk.Hole) -> str:
    ends = ["?" if time is None else f"{time / 1e6:.2f}" for time in (hole.before, hole.after)]
    return f"{ends[0]}-{ends[1]} s"


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


def _stamps(one: Layout, raw: NDArray[Any]) -> Stamps:
    scale = 1_000 if one.clock == "TimeUS" else 1_000_000
    good = raw <= LONGEST_US * 1_000 // scale
    t = raw.view(np.int64) if raw.dtype.itemsize == 8 else raw.astype(np.int64)
    t[~good] = 0
    t *= scale
    return t, good


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


def _parameters(log: Log) -> servo_deflection.Parameters:
    table = log.table("PARM")
    number = log.number("PARM")
    if number is None or not log.known[number].clock or not {"Name", "Value"} <= table.keys():
        return {}
    t, good = log.times(number)
    names = [name.decode("latin-1") for name in table["Name"][good].tolist()]
    return servo_deflection.parameters(names, t[good], table["Value"][good].astype(np.float64))


def _deflections(log: Log, wanted: Wanted) -> tuple[dict[str, Channel], dict[int, str]]:
    """Channels of what rudder servos and motors were ordered, and their names by output."""
    known, channels, names = _parameters(log), {}, {}
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


def _whole(log: Log, steering: Mapping[str, Channel], outputs: dict[int, str]) -> Iterator[str]:
    """Remarks on servos, parameters, modes and arming."""
    known = _parameters(log)
    yield from servo_deflection.remarks(known, outputs)
    for name, channel in steering.items():
        none = int(np.isnan(channel.y).sum())
        if none:
            yield f"{name}: {none} of {len(channel.y)} samples without an output"
    yield from servo_deflection.changes(known)
    for t, states in _states(log, "MODE", "ModeNum"):
        yield from vehicle_modes.modes(t, states, _rover(log))
    for t, states in _states(log, "ARM", "ArmState"):
        yield from vehicle_modes.arming_remark(t, states != 0)


def _states(
    log: Log, message: str, column: str
) -> Iterator[tuple[NDArray[np.int64], NDArray[np.int64]]]:
    """Times [ns] and values of one column, where it is logged; (N,) both."""
    number = log.number(message)
    values = log.table(message).get(column)
    if number is not None and log.known[number].clock and values is not None:
        t, good = log.times(number)
        yield t[good], values[good].astype(np.int64)


def _rover(log: Log) -> bool:
    texts = log.table("MSG").get("Message", np.empty(0, "S1"))
    return any(b"Rover" in text for text in texts[:1000].tolist())


def _of_time(log: Log) -> Iterator[str]:
    """A remark on the date, by the first GPS message with a fix."""
    gps, number = log.table("GPS"), log.number("GPS")
    if number is None or not log.known[number].clock or not {"Status", "GMS", "GWk"} <= gps.keys():
        yield "no GPS time in the log: times are since boot, the date is not known"
        return
    t, good = log.times(number)
    fixed = np.flatnonzero((gps["Status"] >= 3) & (gps["GWk"] > 0) & good)
    if not len(fixed):
        yield "no GPS fix in the log: times are since boot, the date is not known"
        return
    first = fixed[0]
    since = timedelta(microseconds=int(t[first]) // 1000)
    start = gps_time.utc(int(gps["GWk"][first]), int(gps["GMS"][first])) - since
    yield gps_time.words(start, "the first GPS fix")


def batches(path: Path, aids: Aids = NO_AIDS) -> Iterable[Wanted]:
    """Wanted channels, some at a time, so that each reading stays within BATCH_BYTES."""
    del aids
    known, _ = dataflash_walk.layouts(path)
    narrow = {n: _narrow(one) for n, one in known.items() if one.name not in TABLES}
    gathered = dataflash_walk.gather(path, known, narrow | _columns(known, ()))
    log = Log(_with_units(known, gathered), gathered)
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
