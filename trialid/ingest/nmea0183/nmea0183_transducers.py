"""XDR sentences: any number of transducers, each type, value, unit and name."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from trialid.ingest.nmea0183.nmea0183_columns import texts
from trialid.ingest.nmea0183.nmea0183_layouts import Field, Side
from trialid.ingest.nmea0183.nmea0183_sentences import Mask, Places, Sentences, Span

NUMERIC = np.frombuffer(b"0123456789+-. ", np.uint8)


@dataclass(frozen=True)
class Transducer:
    """One transducer of a log: in which sentences it stands, and where its values are."""

    device: str
    field: Field
    unit: str | None
    words: str
    rows: Places
    value: Span


@dataclass(frozen=True)
class _Places:
    """Transducers found: sentence, number of the first of their four fields; (N,) each."""

    rows: Places
    first: Places


def transducers(block: Sentences, rows: Places) -> Iterator[Transducer]:
    """The transducers of XDR sentences.

    A field too many somewhere in a sentence moves all that follow; transducers are found by their
    shape then: one letter, a number or what was meant as one, one letter or none, a name.
    """
    found = _found(block, rows)
    kind = block.letter(found.rows, found.first)
    unit = block.letter(found.rows, found.first + 2)
    names = block.field(found.rows, found.first + 3)
    for part, name in texts(block.data, names):
        codes = kind[part].astype(np.int64) * 256 + unit[part]
        for code in np.unique(codes):
            same = part[codes == code]
            yield from _numbered(block, found, same, name, int(code))


def _numbered(
    block: Sentences, found: _Places, part: Places, name: str, code: int
) -> Iterator[Transducer]:
    """Transducers of one name in one sentence are several."""
    order = part[np.lexsort((found.first[part], found.rows[part]))]
    rows = found.rows[order]
    begins = np.flatnonzero(np.concatenate([[True], rows[1:] != rows[:-1]]))
    turn = np.arange(len(rows)) - np.repeat(begins, np.diff(np.append(begins, len(rows))))
    for number in range(int(turn.max(initial=0)) + 1):
        same = order[turn == number]
        device = (name or "unnamed") + (f".{number + 1}" if number else "")
        value = block.field(found.rows[same], found.first[same] + 1)
        yield _transducer(device, name, code, found.rows[same], value)


def _transducer(device: str, name: str, code: int, rows: Places, value: Span) -> Transducer:
    kind, letter = chr(code // 256), chr(code % 256) if 0 < code % 256 < 128 else ""
    what = TRANSDUCERS.get(kind, f"type_{kind}")
    quantity, side = (None, None)
    if kind == "A":
        quantity, side = TRANSDUCER_QUANTITIES.get(name.upper(), (None, None))
    unit = TRANSDUCER_UNITS.get(kind + letter)
    field = Field(what, 0, unit, f"{what}, the log's own name of it", quantity, side)
    return Transducer(device, field, unit, "transducer", rows, value)


def _found(block: Sentences, rows: Places) -> _Places:
    regular = block.fields[rows] % 4 == 0
    where, first = [rows[:0]], [rows[:0]]
    for number in range(1, int(block.fields[rows].max(initial=0)) + 1, 4):
        regular &= _shaped(block, rows, np.full(len(rows), number)) | (block.fields[rows] < number)
    for number in range(1, int(block.fields[rows].max(initial=0)) + 1, 4):
        here = rows[regular & (block.fields[rows] >= number)]
        where.append(here)
        first.append(np.full(len(here), number))
    for row in rows[~regular]:
        numbers = _by_shape(block, row)
        where.append(np.full(len(numbers), row))
        first.append(np.array(numbers, np.intp))
    return _Places(np.concatenate(where), np.concatenate(first))


def _by_shape(block: Sentences, row: int) -> list[int]:
    """Numbers of the fields at which a transducer begins, in one sentence."""
    count, number = int(block.fields[row]), 1
    last = np.arange(1, max(count - 2, 1))
    shaped = _shaped(block, np.full(len(last), row), last) if count > 3 else np.zeros(0, np.bool_)
    numbers = []
    while number <= count - 3:
        if shaped[number - 1]:
            numbers.append(number)
            number += 4
        else:
            number += 1
    return numbers


def _shaped(block: Sentences, rows: Places, number: NDArray[np.intp]) -> Mask:
    """True where four fields from `number` on look like a transducer; (n,)."""
    kind = block.letter(rows, number)
    shaped = (kind >= ord("A")) & (kind <= ord("Z")) & (block.letter(rows, number + 2) != 255)
    value = block.field(rows, number + 1)
    for column in range(int((value.b - value.a).max(initial=0))):
        inside = value.a + column < value.b
        cells = block.data[np.minimum(value.a + column, len(block.data) - 1)]
        shaped &= ~inside | np.isin(cells, NUMERIC)
    return shaped & (number + 3 <= block.fields[rows])


TRANSDUCERS = {
    "A": "angle",
    "C": "temperature",
    "D": "displacement",
    "F": "frequency",
    "G": "generic",
    "H": "humidity",
    "I": "current",
    "L": "salinity",
    "N": "force",
    "P": "pressure",
    "R": "flow",
    "S": "switch",
    "T": "speed",
    "U": "voltage",
    "V": "volume",
}
"""Types of transducers of XDR."""
TRANSDUCER_UNITS = {
    "AD": "deg",
    "AR": "rad",
    "CC": "degC",
    "CK": "kelvin",
    "DM": "m",
    "DI": "inch",
    "FH": "Hz",
    "HP": "percent",
    "IA": "A",
    "NN": "N",
    "PB": "bar",
    "PP": "Pa",
    "TR": "rpm",
    "UV": "V",
    "VM": "m^3",
}
"""Type and unit letter of a transducer to its unit; others have none a text could state."""
TRANSDUCER_QUANTITIES: Mapping[str, tuple[str, Side | None]] = {
    "ROLL": ("phi", "starboard"),
    "HEEL": ("phi", None),
    "RUDDER": ("delta", None),
}
"""What the usual names of angles mean; only the roll has a side by the standard's own list."""
