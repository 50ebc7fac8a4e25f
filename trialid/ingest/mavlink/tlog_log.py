"""MAVLink telemetry logs of ground stations (`.tlog`).

A channel is `ATTITUDE/1/1:roll`, with the system and component that sent it, then the instance of
the device where it is not 0: `BATTERY_STATUS/1/1/1:current_battery`. What a sender says after it
restarted is in channels of their own, `ATTITUDE/1/1/boot2:roll`. `servo/1/1/3:deflection` is what
rudder servo 3 of the autopilot 1/1 was ordered, `servo/1/1/1:throttle_left` what a motor was. Texts
are no channels, nor are parameters.
"""

import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trialid.errors import LogError
from trialid.ingest.adapter import NO_AIDS, Adapter, Aids, Wanted, is_wanted, sha256
from trialid.ingest.bytes.linked_records import Places
from trialid.ingest.mavlink import (
    mavlink_dialect,
    mavlink_meanings,
    servo_deflection,
    tlog_frames,
    tlog_messages,
)
from trialid.ingest.mavlink.mavlink_dialect import Definition, Field
from trialid.ingest.mavlink.tlog_messages import Log, Messages, Sender, parameters
from trialid.ingest.mavlink.tlog_remarks import damage, receive_dates, sender_remarks
from trialid.recording import Channel, Recording

CHAIN = 3
"""Frames that must follow one another for a log to be recognised, if there are so many."""
HEAD_SEARCHED = 600
"""A log cut at its front shows its first frame within so many bytes."""

PARAMETERS = frozenset({"PARAM_VALUE", "PARAM_SET", "PARAM_EXT_VALUE", "PARAM_EXT_SET"})
SERVO_MESSAGE, SERVOS_A_PORT = "SERVO_OUTPUT_RAW", 16


def recognises(head: bytes) -> bool:
    """Frames behind stamps, one exactly after the other."""
    return any(_chain(head, at) for at in range(min(HEAD_SEARCHED, len(head))))


def _chain(head: bytes, at: int) -> bool:
    """True when frames follow one another from `at`, up to the end of a short file."""
    stamps: list[int] = []
    while len(stamps) < CHAIN:
        size = _frame_size(head[at : at + 11])
        stamp = int.from_bytes(head[at : at + 8], "big")
        if (
            not size
            or stamp > tlog_frames.LATEST_US
            or (stamps and abs(stamp - stamps[-1]) > 10**12)
        ):
            return False
        stamps.append(stamp)
        at += tlog_frames.STAMP + size
        if at >= len(head):
            return len(stamps) > 1 or at == len(head)
    return True


def _frame_size(head: bytes) -> int:
    """Bytes of a frame by what follows its stamp; 0 when it is none."""
    if len(head) < 11:
        return 0
    magic, length, flags = head[8:11]
    if magic == tlog_frames.MAGIC_1:
        return length + 8
    signed = flags & tlog_frames.SIGNED
    good = magic == tlog_frames.MAGIC_2 and flags in {0, tlog_frames.SIGNED}
    return length + 12 + tlog_frames.SIGNATURE * signed if good else 0


@np.errstate(invalid="ignore", over="ignore")  # a broken number is no reason to warn
def read(path: Path, wanted: Wanted = None, aids: Aids = NO_AIDS) -> Recording:
    """Read the wanted channels; frames with a wrong checksum are left out and counted.

    Raises LogError when not one frame is good.
    """
    del aids
    known = mavlink_dialect.definitions()
    found = tlog_frames.find(tlog_frames.content(path), known)
    if not len(found.frames):
        raise LogError(f"{path}: holds no frame with a valid checksum; take another copy of it")
    log = tlog_messages.log(found, known)
    channels = {one.name: one for one in _channels(log, wanted)}
    remarks = list(damage(log))
    for sender in log.senders:
        steering, names = _deflections(log, sender, wanted)
        channels |= steering
        remarks += sender_remarks(log, sender, names)
    remarks.append(receive_dates(found))
    return Recording(path, ADAPTER.name, sha256(path), channels, tuple(remarks))


def _channels(log: Log, wanted: Wanted) -> Iterator[Channel]:
    for number in sorted({message for _, _, message in log.sources}):
        one = log.known[number]
        if one.name in PARAMETERS or not _maybe(one.name, wanted):
            continue
        for sender in log.senders:
            if (sender.system, sender.component, number) in log.sources:
                yield from _of_message(sender, log.messages(sender, number), wanted)


def _maybe(message: str, wanted: Wanted) -> bool:
    """True when a channel of this message may be wanted, of whichever sender."""
    begin = f"{message}/"
    return wanted is None or any(w.startswith(begin) or begin.startswith(w) for w in wanted)


def _of_message(sender: Sender, sent: Messages, wanted: Wanted) -> Iterator[Channel]:
    """The wanted channels of one message from one sender, device by device, start by start."""
    for source, part in _devices(sender, sent):
        t, mine = sent.sent.t[part], sent.table[part]
        received = sent.received[part] if sent.sent.own else None
        for name, one, raw in _columns(sent.definition, source, mine):
            if is_wanted(name, wanted):
                yield _channel(sent.definition, one, name, (t, raw, received), sent.sent.clock)


def _devices(sender: Sender, sent: Messages) -> Iterator[tuple[str, Places | slice]]:
    """What stands between message and field in channel names, and the rows it is for."""
    one, starts = sent.definition, sender.starts(sent.rows)
    if one.instance is None and not starts.any():
        yield f"/{sender.name}", slice(None)
        return
    device = sent.table[one.instance] if one.instance else np.zeros(len(starts), np.uint8)
    devices, which = np.unique(device, return_inverse=True)
    kind = which * (int(starts.max()) + 1) + starts
    kinds = np.unique(kind).tolist()
    for value in kinds:
        i, start = divmod(value, int(starts.max()) + 1)
        boot = f"/boot{start + 1}" if start else ""
        part = np.flatnonzero(kind == value) if len(kinds) > 1 else slice(None)
        yield f"/{sender.name}{_device(devices[i].item())}{boot}", part


def _device(instance: int | bytes) -> str:
    """How an instance stands in a channel's name; 0 does not."""
    if isinstance(instance, bytes):
        return "/" + re.sub(r"[^\w.+-]", "_", instance.decode("latin-1"))
    return f"/{instance}" if instance else ""


def _columns(
    one: Definition, source: str, table: NDArray[np.void]
) -> Iterator[tuple[str, Field, NDArray[Any]]]:
    for field in one.numbers:
        name = f"{one.name}{source}:{field.name}"
        if field.count == 1:
            yield name, field, table[field.name]
        else:
            for k in range(field.count):
                yield f"{name}[{k}]", field, table[field.name][:, k]


def _channel(
    one: Definition,
    field: Field,
    name: str,
    columns: tuple[NDArray[np.int64], NDArray[Any], NDArray[np.int64] | None],
    clock: str,
) -> Channel:
    t, raw, received = columns
    key = (one.name, field.name)
    meaning = mavlink_meanings.MAVLINK.get(key, mavlink_meanings.Meaning(""))
    unit, divisor = mavlink_meanings.unit(field.unit)
    words = meaning.words or mavlink_meanings.MAVLINK_MESSAGES.get(one.name, "")
    y = mavlink_dialect.known_values(field, raw)
    return Channel(
        name=name,
        t=t,
        y=y if divisor == 1.0 else y / divisor,
        unit=unit or meaning.unit,
        clock=clock,
        description=f"MAVLink {name}" + (f", {words}" if words else ""),
        quantity=meaning.quantity,
        positive=meaning.positive,
        received=received,
    )


def _deflections(
    log: Log, sender: Sender, wanted: Wanted
) -> tuple[dict[str, Channel], dict[int, str]]:
    """Channels of what rudder servos and motors were ordered, and their names by output."""
    said = log.messages(sender, log.number(SERVO_MESSAGE))
    starts, table = sender.starts(said.rows), said.table
    channels: dict[str, Channel] = {}
    names: dict[int, str] = {}
    for start in np.unique(starts).tolist():
        known = parameters(log, sender, start)
        for n, output in servo_deflection.outputs(known).items():
            port, place = divmod(n - 1, SERVOS_A_PORT)
            part = np.flatnonzero((starts == start) & (table["port"] == port))
            boot = f"/boot{start + 1}" if start else ""
            if servo_deflection.missing_parameters(known, n) or not len(part):
                continue
            name = f"servo/{sender.name}/{n}{boot}:{output.field}"
            names.setdefault(n, name)
            if is_wanted(name, wanted):
                pwm = table[f"servo{place + 1}_raw"][part].astype(np.float64)
                made = output.channel(name, said.sent.t[part], pwm, n, known)
                received = said.received[part]
                channels[name] = replace(made, clock=said.sent.clock, received=received)
    return channels, names


ADAPTER = Adapter("tlog", recognises, read, general=True)  # no magic: a chance chain elsewhere
