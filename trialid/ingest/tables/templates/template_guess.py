"""How a text seems to be laid out: a guess for the draft of a template, never used to read."""

import re
from collections import Counter
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from trialid.ingest.bytes.encoded_text import UTF_16, unify_text
from trialid.ingest.tables.table import MISSING
from trialid.ingest.tables.table_layout import SPACES, decode_text

TOP, TAIL = 262_144, 16_384
"""Bytes looked at, at the beginning and at the end."""
SEPARATORS = (";", "\t", "|", ",", SPACES)
"""The likelier ones first."""
COMMENTS = ("#", "%", "//", "!")
NUMBER = re.compile(
    r"[-+]?(\d{1,3}([., '\u00a0\u202f]\d{3})+[.,]\d*|\d+([.,]\d*)?|[.,]\d+)([eE][-+]?\d+)?"
)
CLOCK = r"\d{1,2}:\d\d(:\d\d([.,:]\d+)?)?\s*+([ap]m)?\s*+([a-z]{1,5}|[+-]\d\d:?\d\d)?"
DATE = re.compile(
    rf"(\d{{4}}[./-]\d\d[./-]\d\d|\d{{1,2}}[./-]\d{{1,2}}[./-]\d{{2,4}})([t,_\s]\s*+{CLOCK})?|{CLOCK}",
    re.IGNORECASE,
)
UNIT = re.compile(r"[\[(].*[\])]|-|[A-Za-z%°µ][A-Za-z°µ]{0,5}[A-Za-z°²^\d]*([/*][A-Za-z°²^\d]+)*")


@dataclass(frozen=True)
class Guess:
    """A layout as it seems; the names as in a template. `rows` are the first ones of the data."""

    separator: str
    decimal: str
    encoding: str
    skip: int
    header_rows: int
    units_row: bool
    comment: str | None
    end: str | None
    header: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    units: tuple[str, ...]
    missing: tuple[str, ...]
    mixed: bool
    """True where points and commas both stand in numbers."""


def guess(path: Path) -> Guess | None:
    """The layout a text seems to have; None where no two lines look like rows of one table."""
    with path.open("rb") as file:
        raw = file.read(TOP)
    text = decode_text(unify_text(raw, None))
    lines = [line.rstrip("\r") for line in text.split("\n")]
    lines = lines[:-1] if len(raw) == TOP else lines
    found = max(
        (_table_by(lines, separator) for separator in SEPARATORS),
        key=lambda one: one[0],
        default=None,
    )
    if found is None or found[0][0] < 2:
        return None
    _, separator, data = found
    return _laid_out(lines, separator, data, _encoding(raw), _tail(path, raw))


def fields(line: str, separator: str) -> list[str]:
    """The fields of a line, without blanks and quotes around them."""
    parts = line.split() if separator == SPACES else line.split(separator)
    return [part.strip(' "\t') for part in parts]


def is_number(text: str) -> bool:
    """True for what looks like a number with either decimal mark."""
    return NUMBER.fullmatch(text) is not None


def _table_by(lines: list[str], separator: str) -> tuple[tuple[int, int], str, list[int]]:
    """How many lines are rows of one width, how many of their fields are clean; and which."""
    split = [fields(line, separator) for line in lines]
    likely = [i for i, row in enumerate(split) if len(row) > 1 and _is_data(row)]
    widths = Counter(len(split[i]) for i in likely)
    if not widths:
        return (0, 0), separator, []
    width = max(widths, key=lambda one: (widths[one], one))
    data = [i for i in likely if len(split[i]) == width]
    told = _told([split[i] for i in data])
    clean = sum(_clean(field) for i in data for field in split[i][:told])
    whole = told * len(data)
    return (len(data) * (10 * clean // whole), clean // len(data)), separator, data


def _told(rows: Sequence[Sequence[str]]) -> int:
    """How many fields the rows have, one less where a separator ends each and names nothing."""
    return len(rows[0]) - all(not row[-1] for row in rows)


def _clean(field: str) -> bool:
    return is_number(field) or DATE.fullmatch(field) is not None


def _is_data(row: Sequence[str]) -> bool:
    told = [field for field in row if field.lower() not in MISSING]
    return bool(told) and sum(map(_clean, told)) > 0.5 * len(told)


def _encoding(raw: bytes) -> str:
    if raw.startswith(UTF_16):
        return "utf-16"
    try:
        raw[:-4].decode("utf-8")
    except UnicodeDecodeError:
        return "cp1252"
    return "utf-8"


def _tail(path: Path, raw: bytes) -> list[str]:
    """The last lines of the file, the first of them perhaps not from its beginning."""
    with path.open("rb") as file:
        size = file.seek(0, 2)
        file.seek(max(size - TAIL, 0) // 2 * 2)
        last = file.read()
    wide = raw.startswith(UTF_16)
    text = last.decode("utf-16-le", "replace") if wide else decode_text(last)
    return [line.rstrip("\r") for line in text.split("\n")]


def _laid_out(
    lines: list[str], separator: str, data: list[int], encoding: str, tail: list[str]
) -> Guess:
    rows = tuple(tuple(fields(lines[i], separator)) for i in data[:200])
    width, first = len(rows[0]), data[0]
    comment = next((c for c in COMMENTS if any(x.startswith(c) for x in lines[:first])), None)
    at, units_row = _named(lines, separator, {width, _told(rows)}, first)
    bare = at is None or lines[at].startswith(COMMENTS) or at != first - 1 - units_row
    named = [] if at is None else fields(_uncommented(lines[at]), separator)
    decimal, mixed = _decimal(rows, separator)
    return Guess(
        separator,
        decimal,
        encoding,
        skip=first if bare or at is None else _physical(lines, at, comment),
        header_rows=0 if bare else 1,
        units_row=units_row and not bare,
        comment=None if bare else comment,
        end=_end(tail, separator, width),
        header=tuple(named or [f"column {i + 1}" for i in range(width)]),
        rows=rows,
        units=tuple(fields(lines[first - 1], separator)) if units_row else (),
        missing=_missing(rows),
        mixed=mixed,
    )


def _named(
    lines: list[str], separator: str, widths: Collection[int], first: int
) -> tuple[int | None, bool]:
    """The line above the data that has a text for each column, and whether units lie between."""
    rows = [fields(_uncommented(line), separator) for line in lines[:first]]
    above = [i for i, row in enumerate(rows) if len(row) in widths]
    units_row = above[-2:] == [first - 2, first - 1] and _units(rows[first - 1])
    return (first - 2 if units_row else above[-1] if above else None), units_row


def _uncommented(line: str) -> str:
    return line.lstrip("".join(COMMENTS)).lstrip() if line.startswith(COMMENTS) else line


def _physical(lines: list[str], at: int, comment: str | None) -> int:
    """Lines before the header, those that a comment takes out not counted."""
    return sum(not (comment and line.startswith(comment)) for line in lines[:at])


def _units(row: Sequence[str]) -> bool:
    told = [field for field in row if field]
    return bool(told) and all(UNIT.fullmatch(field) for field in told)


def _decimal(rows: Sequence[Sequence[str]], separator: str) -> tuple[str, bool]:
    numbers = [field for row in rows for field in row if is_number(field)]
    commas = separator != "," and any("," in one for one in numbers)
    return ("," if commas else "."), commas and any("." in one for one in numbers)


def _missing(rows: Sequence[Sequence[str]]) -> tuple[str, ...]:
    """Texts among numbers, which may stand for no value."""
    found: dict[str, None] = {}
    for column in zip(*rows, strict=True):
        words = [one for one in column if not _clean(one) and one.lower() not in MISSING]
        if 0 < len(words) < 0.5 * len(column):
            found |= dict.fromkeys(words)
    return tuple(found)[:8]


def _end(tail: Iterable[str], separator: str, width: int) -> str | None:
    """The text that begins the lines after the data, if there are any."""
    after: list[str] = []
    for line in reversed(list(tail)[1:]):
        row = fields(line, separator)
        if len(row) == width and _is_data(row) and _clean(row[0]):
            break
        after.append(line)
    told = [line for line in reversed(after) if line.strip()]
    first = fields(told[0], separator)[0] if told else ""
    return first if first and len(told) < 30 else None
