"""Samples gathered out of sentences, block after block, by what channel they are of."""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from trialid.ingest.adapter import Wanted, is_wanted
from trialid.ingest.nmea0183 import nmea0183_fields
from trialid.ingest.nmea0183.nmea0183_columns import numbers, texts
from trialid.ingest.nmea0183.nmea0183_layouts import Field, Layout
from trialid.ingest.nmea0183.nmea0183_receivers import SENTENCES
from trialid.ingest.nmea0183.nmea0183_sentences import Bytes, Mask, Places, Sentences, Span
from trialid.ingest.nmea0183.nmea0183_transducers import Transducer, transducers

ADDRESS = re.compile(r"[A-Z][A-Z0-9][A-Z]{3}|P[A-Z0-9]{3,6}")


@dataclass(frozen=True)
class Sender:
    """Who says a sentence: the sentence, over which connection, which talker."""

    sentence: str
    connection: str
    talker: str


@dataclass(frozen=True)
class Key:
    """What a channel is: who sends it, device, field, unit."""

    sender: Sender
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


def gather(block: Sentences, rows: Places, sender: Sender, offset: int, found: Found) -> None:
    """Add the samples of some sentences of one sender; sentence numbers count from `offset`."""
    if sender.sentence == "XDR":
        for entry in transducers(block, rows):
            _transducer(block, entry, sender, offset, found)
        return
    for layout in SENTENCES[sender.sentence]:
        part = _of_kind(block, rows, layout)
        for device, devices in _devices(block, part, layout):
            for one in layout.fields:
                key = Key(sender, device, one, one.unit, layout.words)
                _field(block, devices, key, offset, found)


def _transducer(
    block: Sentences, entry: Transducer, sender: Sender, offset: int, found: Found
) -> None:
    y, bad = numbers(block.data, entry.value)
    _add(
        found=found,
        key=Key(sender, entry.device, entry.field, entry.unit, entry.words),
        rows=entry.rows + offset,
        y=y,
        bad=bad,
        invalid=None,
        block=block,
        span=entry.value,
    )


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
