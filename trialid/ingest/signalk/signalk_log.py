"""Logs of a Signal K server: `milliseconds since 1970;discriminator;what came in`.

N is an NMEA 0183 sentence, A a whole NMEA 2000 message as canboat writes it, I a Signal K delta in
JSON. Channels of N are named as in NMEA 0183 logs, of A as in NMEA 2000 logs; those of I are
`path/source:field`: `steering.rudderAngle/n2k.11:value`, `navigation.attitude/imu:roll`. Numbers of
Signal K are SI.
"""

import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from trialid.errors import LogError
from trialid.ingest.adapter import NO_AIDS, Adapter, Aids, Wanted, sha256
from trialid.ingest.nmea0183 import nmea0183_recorded, nmea0183_steps
from trialid.ingest.nmea2000 import nmea2000_messages
from trialid.ingest.signalk.signalk_deltas import Deltas, channels_of, take
from trialid.recording import Channel, Recording

LINE = re.compile(rb"\d{12,14};[A-Za-z];")
OTHERS = re.compile(rb"^(\d{12,14});([A-MO-Za-z]);([^\r\n]*)", re.MULTILINE)
STAMP = re.compile(rb"^(\d{12,14});", re.MULTILINE)
MESSAGE = re.compile(rb"[^,]*,\d,(\d{1,6}),(\d{1,3}),\d{1,3},(\d{1,4}),([0-9A-Fa-f,]*)\s*")
SENTENCES = re.compile(rb"^\d{12,14};N;[^\r\n]*(?:\r?\n|$)", re.MULTILINE)
MILLISECOND = 1_000_000
STAMPS = "line stamps"


@dataclass
class Messages:
    """Whole NMEA 2000 messages."""

    t: list[int] = field(default_factory=list)
    pgn: list[int] = field(default_factory=list)
    source: list[int] = field(default_factory=list)
    payload: list[bytes] = field(default_factory=list)
    damaged: int = 0


def recognises(head: bytes) -> bool:
    """Most whole lines are a time, a letter and something."""
    lines = [line for line in head.split(b"\n") if line.strip()]
    lines = lines[:-1] if len(lines) > 1 and not head.endswith(b"\n") else lines
    ours = [line for line in lines if LINE.match(line)]
    return b"\0" not in head and len(ours) > 0 and 2 * len(ours) >= len(lines)


def read(path: Path, wanted: Wanted = None, aids: Aids = NO_AIDS) -> Recording:
    """Read the wanted channels; lines that cannot be read are left out and counted.

    Raises LogError when not one line can be read.
    """
    del aids
    deltas, messages, kinds = Deltas(), Messages(), Counter[str]()
    for block in nmea0183_recorded.blocks(path):
        _take(block, wanted, deltas, messages, kinds)
    if not kinds.total():
        raise LogError(f"{path}: no line of the form time;letter;data; copy the log again")
    found, remarks = _sentences(path, wanted, len(+kinds) > 1) if kinds["N"] else ({}, [])
    more, remarks_of_bus = _of_bus(messages, wanted)
    found |= more | channels_of(deltas, STAMPS)
    if not found and wanted is None and not remarks:
        raise LogError(f"{path}: none of its {kinds.total()} lines can be read; copy it again")
    remarks += [*remarks_of_bus, *_losses(kinds, messages, deltas)]
    return Recording(path, ADAPTER.name, sha256(path), found, tuple(remarks))


def _damaged_stamps(block: bytes) -> frozenset[bytes]:
    """Stamps out of step with those of the lines around them: nothing else protects them."""
    stamps = STAMP.findall(block)
    t = np.array(stamps, "S14").astype(np.int64)
    odd = nmea0183_steps.out_of_step(t * MILLISECOND)
    return frozenset(stamps[row] for row in np.flatnonzero(odd))


def _take(
    block: bytes, wanted: Wanted, deltas: Deltas, messages: Messages, kinds: Counter[str]
) -> None:
    others = OTHERS.findall(block)
    odd = _damaged_stamps(block) if others else frozenset[bytes]()
    kinds["N"] += block.count(b";N;")
    for stamp, letter, payload in others:
        kinds[letter.decode()] += 1
        if stamp in odd:
            kinds["of a damaged time"] += 1
        elif letter == b"A":
            _message(int(stamp) * MILLISECOND, payload, messages)
        elif letter == b"I":
            take(payload, wanted, deltas, int(stamp) * MILLISECOND)


def _sentences(path: Path, wanted: Wanted, mixed: bool) -> tuple[dict[str, Channel], list[str]]:
    """Channels of the lines N, read as an NMEA 0183 log of its own; `mixed`: not all are."""

    def parts() -> Iterator[bytes]:
        for block in nmea0183_recorded.blocks(path):
            yield b"".join(SENTENCES.findall(block)) if mixed else block

    try:
        return nmea0183_recorded.channels(path, parts, wanted, None)
    except LogError as error:
        return {}, [f"NMEA 0183 left out: {str(error).partition(': ')[2]}"]


def _message(t: int, payload: bytes, messages: Messages) -> None:
    found = MESSAGE.fullmatch(payload)
    if found is None:
        messages.damaged += 1
        return
    pgn, source, length = int(found[1]), int(found[2]), int(found[3])
    octets = found[4].split(b",")
    if len(octets) != length or source > 255 or any(len(octet) != 2 for octet in octets):
        messages.damaged += 1
        return
    if pgn in nmea2000_messages.NEEDED:
        messages.t.append(t)
        messages.pgn.append(pgn)
        messages.source.append(source)
        messages.payload.append(bytes.fromhex(b"".join(octets).decode()))


def _of_bus(messages: Messages, wanted: Wanted) -> tuple[dict[str, Channel], list[str]]:
    if not messages.t:
        return {}, []
    return nmea2000_messages.channels(
        np.array(messages.t, np.int64),
        np.array(messages.pgn, np.int64),
        np.array(messages.source, np.int64),
        messages.payload,
        STAMPS,
        wanted,
    )


def _losses(kinds: Counter[str], messages: Messages, deltas: Deltas) -> list[str]:
    remarks = []
    for count, what in ((messages.damaged, "NMEA 2000 messages"), (deltas.damaged, "deltas")):
        if count:
            remarks.append(f"{count} lines that should be {what} cannot be read, left out")
    others = {kind: count for kind, count in sorted(kinds.items()) if kind not in "NAI" and count}
    if others:
        listed = ", ".join(
            f"{count} {kind if len(kind) > 1 else 'of kind ' + kind}"
            for kind, count in others.items()
        )
        remarks.append(f"lines left out: {listed}; kinds that are read: N, A, I")
    return remarks


ADAPTER = Adapter("signal k", recognises, read)
