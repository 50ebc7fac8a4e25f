"""NMEA 0183 sentences to channels, in columns.

A channel is `sentence/talker:field`, and `sentence/talker/device:field` where the sentence numbers
or names its devices: `ROT/TI:rate`, `RPM/II/S1:speed`, `XDR/II/ROLL:angle`. What a talker sends
over several connections is kept apart: `ROT/GP0001.TI:rate`.
"""

import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from trialid.ingest.adapter import Wanted, is_wanted
from trialid.ingest.nmea0183 import nmea0183_fields
from trialid.ingest.nmea0183.nmea0183_layouts import SHAFTS, Field, Layout
from trialid.ingest.nmea0183.nmea0183_receivers import SENTENCES
from trialid.ingest.nmea0183.nmea0183_sentences import (
    Bytes,
    Mask,
    Places,
    Sentences,
    Span,
    numbers,
    texts,
)
from trialid.ingest.nmea0183.nmea0183_transducers import transducers
from trialid.recording import Channel

Ints = NDArray[np.int64]

ADDRESS = re.compile(r"[A-Z][A-Z0-9][A-Z]{3}|P[A-Z0-9]{3,6}")
RARE = 0.05
"""Share of the samples below which another connection is none."""
LISTED = 6
"""Channels without a value a remark names at most."""


@dataclass(frozen=True)
class Key:
    """What a channel is: sentence, who sends it over which connection, device, field."""

    sentence: str
    connection: str
    talker: str
    device: str
    field: Field
    unit: str | None
    words: str


@dataclass
class Column:
    """The samples of a channel as they are gathered, block after block."""

    rows: list[Places] = field(default_factory=list)
    y: list[NDArray[np.float64]] = field(default_factory=list)
    invalid: int = 0
    bad: int = 0
    example: str = ""


Found = dict[Key, Column]


def wants(sentence: str, wanted: Wanted) -> bool:
    """True when a channel of the sentence may be wanted."""
    return is_wanted(f"{sentence}/", wanted) or any(
        want.startswith(f"{sentence}/") for want in wanted or ()
    )


def addresses(block: Sentences) -> Iterator[tuple[Places, str, str]]:
    """Rows, sentence and talker of the sentences that hold anything for a trial."""
    rows = np.arange(len(block.fields))
    for part, text in texts(block.data, block.field(rows, 0)):
        if not ADDRESS.fullmatch(text):
            continue
        sentence, talker = (text, "") if text in SENTENCES else (text[2:], text[:2])
        known = sentence in SENTENCES or sentence in ("XDR", "ZDA")
        if known and block.data[block.body.a[part[0]] - 1] == ord("$"):
            yield part, sentence, talker


def gather(
    block: Sentences,
    rows: Places,
    sentence: str,
    talker: str,
    connection: str,
    offset: int,
    found: Found,
) -> None:
    """Add the samples of some sentences of one address; sentence numbers count from `offset`."""
    if sentence == "XDR":
        for entry in transducers(block, rows):
            key = Key(
                sentence=sentence,
                connection=connection,
                talker=talker,
                device=entry.device,
                field=entry.field,
                unit=entry.unit,
                words=entry.words,
            )
            y, bad = numbers(block.data, entry.value)
            _add(
                found=found,
                key=key,
                rows=entry.rows + offset,
                y=y,
                bad=bad,
                invalid=None,
                block=block,
                span=entry.value,
            )
        return
    for layout in SENTENCES[sentence]:
        part = _of_kind(block, rows, layout)
        for device, devices in _devices(block, part, layout):
            for one in layout.fields:
                base = Key(
                    sentence=sentence,
                    connection=connection,
                    talker=talker,
                    device=device,
                    field=one,
                    unit=one.unit,
                    words=layout.words,
                )
                _field(block, devices, base, offset, found)


def _of_kind(block: Sentences, rows: Places, layout: Layout) -> Places:
    """The sentences of a layout: those with its word in the first field, and not too long."""
    if layout.at_most is not None:
        rows = rows[block.fields[rows] <= layout.at_most]
    if layout.kind is None or not len(rows):
        return rows
    span = block.field(rows, 1)
    if not layout.kind:
        return rows[numbers(block.data, span)[1] == 0]
    return np.concatenate(
        [rows[part] for part, text in texts(block.data, span) if text == layout.kind] or [rows[:0]]
    )


def _devices(block: Sentences, rows: Places, layout: Layout) -> list[tuple[str, Places]]:
    """The sentences by the device they are of."""
    groups = [("", rows)]
    for number in layout.instance:
        groups = [
            (name + text, part[same])
            for name, part in groups
            for same, text in texts(block.data, block.field(part, number))
        ]
    return groups


def _field(block: Sentences, rows: Places, key: Key, offset: int, found: Found) -> None:
    one = key.field
    if one.only is not None:
        rows = rows[block.letter(rows, one.only[0]) == ord(one.only[1])]
    if not len(rows):
        return
    span = block.field(rows, one.at)
    y, bad = numbers(block.data, span)
    invalid = nmea0183_fields.invalid_numbers(block, rows, one)
    if one.minutes:
        y, lost = nmea0183_fields.whole_degrees(y)
        bad |= lost
    if one.mark is not None:
        bad |= nmea0183_fields.other_letters(block, rows, one.mark)
    if one.side is not None:
        y, lost = nmea0183_fields.signed_numbers(block, rows, one.side, y)
        bad |= lost
    given = np.isfinite(y)
    y[invalid | bad] = np.nan
    invalid &= given
    for unit, same in _units(block, rows, one):
        part = Span(span.a[same], span.b[same])
        _add(
            found=found,
            key=replace(key, unit=unit),
            rows=rows[same] + offset,
            y=y[same],
            bad=bad[same],
            invalid=invalid[same],
            block=block,
            span=part,
        )


def _units(block: Sentences, rows: Places, one: Field) -> list[tuple[str | None, Mask]]:
    if one.unit_at is None:
        return [(one.unit, np.ones(len(rows), np.bool_))]
    letter = block.letter(rows, one.unit_at)
    known = {unit: letter == ord(code) for code, unit in one.units}
    return [(unit, same) for unit, same in known.items() if same.any()]


def _add(
    found: Found,
    key: Key,
    rows: Places,
    y: NDArray[np.float64],
    bad: Mask,
    invalid: Mask | None,
    block: Sentences,
    span: Span,
) -> None:
    column = found.setdefault(key, Column())
    column.rows.append(rows)
    column.y.append(y)
    column.bad += int(bad.sum())
    column.invalid += int(invalid.sum()) if invalid is not None else 0
    if bad.any() and not column.example:
        row = int(np.argmax(bad))
        text: Bytes = block.data[span.a[row] : min(span.b[row], span.a[row] + 24)]
        column.example = text.tobytes().decode("ascii", "replace")


def channels(
    found: Found, t: Ints, received: Ints | None, clock: str, wanted: Wanted, none: int
) -> tuple[dict[str, Channel], list[str]]:
    """Channels of what was gathered, and remarks; LogError never.

    Parameters
    ----------
    t, received
        Stamp of every sentence of the log [ns], `none` where it has none; (N,).
    clock
        Words for `Channel.clock`.

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
        name = _name(key, (key.sentence, key.talker) in several)
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
    counts = Counter[tuple[str, str, str]]()
    for key, column in found.items():
        counts[key.sentence, key.talker, key.connection] += _size(column)
    most = Counter[tuple[str, str]]()
    for (sentence, talker, _), count in counts.items():
        most[sentence, talker] = max(most[sentence, talker], count)
    real = {who for who, count in counts.items() if count > RARE * most[who[:2]]}
    senders = Counter((sentence, talker) for sentence, talker, _ in real)
    kept = {
        key: c for key, c in found.items() if (key.sentence, key.talker, key.connection) in real
    }
    strange = sum(_size(column) for key, column in found.items() if key not in kept)
    return kept, {pair for pair, count in senders.items() if count > 1}, strange


def _name(key: Key, several: bool) -> str:
    sender = ".".join(part for part in (key.connection if several else "", key.talker) if part)
    return (
        "/".join(part for part in (key.sentence, sender, key.device) if part) + f":{key.field.name}"
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
    if key.sentence == "RPM" and key.field.name == "speed":
        quantity, words = SHAFTS.get(key.device, (None, "engine or further shaft"))
        device += f" ({words})"
    talker = f", talker {key.talker}" if key.talker else ""
    source = f", source {key.connection}" if key.connection else ""
    words = f"{key.sentence} {key.words}{talker}{source}{device}: {key.field.words}"
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
