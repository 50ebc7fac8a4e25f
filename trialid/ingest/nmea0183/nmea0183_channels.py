"""NMEA 0183 sentences to channels, in columns.

A channel is `sentence/talker:field`, and `sentence/talker/device:field` where the sentence numbers
or names its devices: `ROT/TI:rate`, `RPM/II/S1:speed`, `XDR/II/ROLL:angle`. What a talker sends
over several connections is kept apart: `ROT/GP0001.TI:rate`.
"""

from collections import Counter
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from trialid.ingest.adapter import Wanted, is_wanted
from trialid.ingest.nmea0183.nmea0183_evened import evenly
from trialid.ingest.nmea0183.nmea0183_gather import Column, Found, Key, Sender
from trialid.ingest.nmea0183.nmea0183_instruments import SHAFTS
from trialid.recording import Channel

Ints = NDArray[np.int64]

RARE = 0.05
"""Share of the samples below which another connection is none."""
LISTED = 6
"""Channels without a value a remark names at most."""


def channels(
    found: Found,
    t: Ints,
    received: Ints | None,
    clock: str,
    wanted: Wanted,
    none: int,
    *,
    tick: int = 0,
) -> tuple[dict[str, Channel], list[str]]:
    """Channels of what was gathered, and remarks; LogError never.

    Parameters
    ----------
    t, received
        Stamp of every sentence of the log [ns], `none` where it has none; (N,).
    clock
        Words for `Channel.clock`.
    tick
        Usual time between two sentences that state one [ns], where times are by place; else 0.

    A channel that holds not one value is left out and named in a remark; so are the samples in the
    rarer units of a channel whose unit changes.
    """
    kept: dict[str, Channel] = {}
    remarks: list[str] = []
    empty: list[str] = []
    found, several, strange = _by_sender(found)
    if strange:
        remarks.append(
            f"{strange} samples left out, their source is named nowhere else: damaged tag or column"
        )
    for key, column in sorted(found.items(), key=lambda item: -_size(item[1])):
        name = _name(key, (key.sender.sentence, key.sender.talker) in several)
        if not is_wanted(name, wanted):
            continue
        if name in kept:
            remarks.append(
                f"{name}: {_size(column)} samples in {key.unit} left out, the unit changes"
            )
            continue
        remarks += _complaints(name, column)
        channel = _channel(
            name=name, key=key, column=column, t=t, received=received, clock=clock, none=none
        )
        channel = replace(channel, t=evenly(channel.t, tick)) if tick else channel
        if np.isnan(channel.y).all():
            empty.append(name)
        else:
            kept[name] = channel
    if empty:
        more = f" and {len(empty) - LISTED} more" if len(empty) > LISTED else ""
        remarks.append(f"left out, not one value: {', '.join(empty[:LISTED])}{more}")
    return dict(sorted(kept.items())), remarks


def _size(column: Column) -> int:
    return sum(len(rows) for rows in column.rows)


def _by_sender(found: Found) -> tuple[Found, set[tuple[str, str]], int]:
    """What comes over a real connection, what over more than one, and how much was left out.

    The name of a connection is hardly protected, or lost with its tag: one that has next to
    nothing beside another of the same sentence and talker is a damaged name.
    """
    counts = Counter[Sender]()
    for key, column in found.items():
        counts[key.sender] += _size(column)
    most = Counter[tuple[str, str]]()
    for one, count in counts.items():
        most[one.sentence, one.talker] = max(most[one.sentence, one.talker], count)
    real = {one for one, n in counts.items() if n > RARE * most[one.sentence, one.talker]}
    senders = Counter((one.sentence, one.talker) for one in real)
    kept = {key: column for key, column in found.items() if key.sender in real}
    strange = sum(_size(column) for key, column in found.items() if key not in kept)
    return kept, {pair for pair, count in senders.items() if count > 1}, strange


def _name(key: Key, several: bool) -> str:
    sender = key.sender
    who = ".".join(part for part in (sender.connection if several else "", sender.talker) if part)
    return "/".join(part for part in (sender.sentence, who, key.device) if part) + (
        f":{key.field.name}"
    )


def _channel(
    name: str,
    key: Key,
    column: Column,
    t: Ints,
    received: Ints | None,
    clock: str,
    none: int,
) -> Channel:
    rows, y = np.concatenate(column.rows), np.concatenate(column.y)
    column.rows, column.y = [], []  # a long log's samples are not held twice
    timed = t[rows] != none
    rows, y = rows[timed], y[timed]
    quantity, device = key.field.quantity, f", {key.device}" if key.device else ""
    sender = key.sender
    if sender.sentence == "RPM" and key.field.name == "speed":
        quantity, words = SHAFTS.get(key.device, (None, "engine or further shaft"))
        device += f" ({words})"
    talker = f", talker {sender.talker}" if sender.talker else ""
    source = f", source {sender.connection}" if sender.connection else ""
    words = f"{sender.sentence} {key.words}{talker}{source}{device}: {key.field.words}"
    return Channel(
        name=name,
        t=t[rows],
        y=y,
        unit=key.unit,
        clock=clock,
        description=words,
        quantity=quantity,
        positive=key.field.positive,
        received=None if received is None else received[rows],
    )


def _complaints(name: str, column: Column) -> Iterator[str]:
    total = _size(column)
    if column.bad:
        first = f"(the first: {column.example!r})"
        yield f"{name}: {column.bad} of {total} values are no numbers {first}; not available"
    if column.invalid:
        yield f"{name}: {column.invalid} of {total} values flagged invalid by their status"
