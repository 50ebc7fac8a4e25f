"""A first template of a table, with what was guessed and what to ask; it loads once reviewed."""

import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from trialid.errors import LogError, printable
from trialid.ingest.tables import json_log, mat_log, npz_arrays, parquet_log
from trialid.ingest.tables.clock.table_time import DAYS
from trialid.ingest.tables.excel import excel_log
from trialid.ingest.tables.mat_arrays import Arrays
from trialid.ingest.tables.table import head
from trialid.ingest.tables.table_header import is_data
from trialid.ingest.tables.table_layout import SPACES
from trialid.ingest.tables.table_names import is_date, is_time
from trialid.ingest.tables.templates.template import TAB, WHITESPACE, distinct
from trialid.ingest.tables.templates.template_guess import Guess, guess, is_number
from trialid.names.quantities import SIGNALS
from trialid.signal_arrays import SLOWEST
from trialid.toml_text import quote

HEAD = 4096
TOP = (
    "# How a table is laid out, guessed from {name}.",
    "# Compare it with the file, answer the questions, then write reviewed = true: until then",
    "# nothing is read by it. A file with another header will be refused.",
    "reviewed = false",
    "",
)


def draft(path: Path) -> str:
    """The text of a template for a table, guessed; `reviewed = false` keeps it from being used.

    Raises LogError for a file that is no table.
    """
    with path.open("rb") as file:
        start = file.read(HEAD)
    if excel_log.recognises(start):
        return _of_excel(path)
    if parquet_log.recognises(start):
        kinds = parquet_log.kinds(path)
        header = tuple(kinds)
        return _text(path, [], header, _times(header, (tuple(kinds.values()),)))
    if mat_log.recognises(start):
        return _of_arrays(path, mat_log.arrays(path))
    if npz_arrays.recognises(start):
        return _of_arrays(path, npz_arrays.of_npz(path))
    if json_log.may_be_one(start):
        header, rows = json_log.top(path)
        return _text(path, [], header, _times(header, rows), rows)
    found = guess(path)
    if found is None:
        raise LogError(f"{path}: no lines of numbers side by side in it; it is no table")
    return _of_text(path, found)


def _of_text(path: Path, found: Guess) -> str:
    header = distinct([head(text).text for text in found.header])
    separator = {SPACES: WHITESPACE, "\t": TAB}.get(found.separator, found.separator)
    lines = [
        f"separator = {quote(separator)}",
        f"decimal = {quote(found.decimal)}",
        *(
            ["# QUESTION: numbers have points and commas; do points part the thousands?"]
            if found.mixed
            else []
        ),
        *(['thousands = "."'] if found.mixed else []),
        f"encoding = {quote(found.encoding)}",
        f"skip = {found.skip}  # lines before the header",
        f"header_rows = {found.header_rows}"
        + ("" if found.header_rows else "  # QUESTION: none was found; are the names right?"),
        f"units_row = {str(found.units_row).lower()}",
        *([f"comment = {quote(found.comment)}"] if found.comment else []),
        *([f"end = {quote(found.end)}  # what follows is no data"] if found.end else []),
        *_missing(found.missing),
    ]
    return _text(path, lines, header, _times(header, found.rows), found.rows, found.units)


def _missing(texts: Sequence[str]) -> Iterator[str]:
    if texts:
        yield "# QUESTION: these stand among numbers; do they mean that there is no value?"
        yield f"missing = [{', '.join(map(quote, texts))}]"


def _of_excel(path: Path) -> str:
    held = {name: rows for name, rows in excel_log.sheets(path).items() if rows}
    if not held:
        raise LogError(f"{path}: all its sheets are empty; it is no table")
    name, rows = max(held.items(), key=lambda one: len(one[1]))
    at = next((i for i, row in enumerate(rows) if _numbers(row) >= 0.5), len(rows) - 1)
    above = [i for i in range(at) if sum(cell != "" for cell in rows[i]) > 1]
    named = above[-1] if above else None
    width = max(i + 1 for row in rows for i in range(len(row)) if row[i] != "")
    texts = [str(cell).strip() for cell in rows[named]] if named is not None else [""] * width
    header = distinct([text or f"column {excel_log.letters(i)}" for i, text in enumerate(texts)])
    others = ", ".join(other for other in held if other != name)
    lines = [
        f"sheet = {quote(name)}"
        + (f"  # QUESTION: or one of {printable(others)}?" if others else ""),
        f"skip = {at if named is None else named}  # rows before the header",
        f"header_rows = {0 if named is None else 1}",
        f"skip_after = {0 if named is None else at - named - 1}  # rows between header and data",
    ]
    lines += ['decimal = ","'] if excel_log.has_commas(rows[at:]) else []
    shown = [tuple(str(cell) for cell in row) for row in rows[at : at + 50]]
    return _text(path, lines, header[:width], _times(header[:width], shown), shown)


def _numbers(row: Sequence[Any]) -> float:
    told = [cell for cell in row if cell != ""]
    return sum(is_data([cell]) for cell in told) / len(told) if told else 0.0


def _of_arrays(path: Path, found: Arrays) -> str:
    inside = mat_log.vectors(found, None)
    if not inside:
        raise LogError(f"{path}: holds no vectors of numbers; {mat_log.PLAIN}")
    groups = [one.head.name.rpartition(".")[0] for one in inside]
    group = max(set(groups), key=lambda one: (groups.count(one), one))
    held = [
        one for one in mat_log.vectors(found, group or None) if group or "." not in one.head.name
    ]
    timed = [one for one in held if _named(one.head.name)] or held
    lengths = [len(one.y) for one in held]
    length = len(timed[0].y) if timed is not held else max(lengths, key=lengths.count)
    header = [one.head.text for one in held if len(one.y) == length]
    whole = [one.y for one in held if len(one.y) == length]
    rows = [tuple(_shown(y[i]) for y in whole) for i in range(length)[:2]]
    lines = [f"group = {quote(group)}"] if group else []
    return _text(path, lines, header, _times(header, rows), rows)


def _shown(value: Any) -> str:
    """A number with all its digits, a date as it is written."""
    return str(value) if isinstance(value, np.datetime64) else f"{value:.17g}"


def _times(header: Sequence[str], rows: Sequence[Sequence[str]]) -> list[str]:
    """The `[time]` of the draft: which columns, and how they seem to be written."""
    named = [i for i, text in enumerate(header) if _named(head(text).name)]
    dates = [i for i in named if is_date(head(header[i]).name)]
    columns = (dates[:1] + [i for i in named if i not in dates][:1]) or [0]
    asked = [] if named else ["# QUESTION: no column is called time; is it this one?"]
    if len(named) > len(columns):
        others = ", ".join(repr(header[i]) for i in named if i not in columns)
        asked.append(f"# QUESTION: or is it {others}?")
    asked += _large_steps([row[columns[0]] for row in rows[:2]])
    shown = " ".join(rows[0][i] for i in columns) if rows else ""
    written = [quote(header[i]) for i in columns]
    return ["[time]", *asked, f"columns = [{', '.join(written)}]", *_kind(shown, len(columns))]


def _large_steps(shown: Sequence[str]) -> Iterator[str]:
    """Whole numbers that a table's clock asks the unit of."""
    whole = len(shown) == 2 and all(re.fullmatch(r"\d{1,18}", one) for one in shown)
    if whole and (step := int(shown[1]) - int(shown[0])) >= SLOWEST:
        yield f"# QUESTION: its numbers step by {step}: seconds, or is a unit to be stated below?"


def _named(name: str) -> bool:
    return is_time(name) or is_date(name) or name.lower() == "gps time"


def _kind(shown: str, columns: int) -> Iterator[str]:
    if re.fullmatch(r"\d{1,2}:\d\d.*", shown):
        yield 'kind = "time of day"'
        return
    if is_number(shown) and columns == 1:
        yield from _counted(float(shown.replace(",", ".") if shown.count(",") == 1 else "0"))
        return
    if not shown:
        yield "# QUESTION: seconds, datetime, excel days, matlab datenum, time of day or index?"
        yield 'kind = "seconds"'
        return
    yield 'kind = "datetime"'
    yield from _format(shown)
    yield "# QUESTION: which time zone? Without one it is taken as UTC."
    yield '# zone = "Europe/Oslo"'


def _counted(value: float) -> Iterator[str]:
    excel, matlab = (low < value < high for low, high in DAYS)
    if excel or matlab:
        yield f"# QUESTION: {value:.10g} may be days; are they, or seconds?"
    kind = "excel days" if excel else "matlab datenum" if matlab else "seconds"
    yield f"kind = {quote(kind)}"
    if kind == "seconds":
        yield '# unit = "ms"  # where neither the header nor a row of units says it'


def _format(shown: str) -> Iterator[str]:
    found = re.match(r"(\d{1,2})([./-])(\d{1,2})[./-](\d{2,4})", shown)
    if found is None:
        return
    mark, year = found[2], "%Y" if len(found[4]) == 4 else "%y"
    clock = re.search(r"(.)\d{1,2}:\d\d(:\d\d([.,]\d+)?)?(\s*[AaPp][Mm])?", shown)
    half = "" if clock is None or clock[4] is None else clock[4][:-2] + "%p"
    hour = "%I" if half else "%H"
    of_day = "" if clock is None else f"{clock[1]}{hour}:%M" + ("" if clock[2] is None else ":%S")
    fraction = ".%f" if clock is not None and clock[3] else ""
    order = f"%m{mark}%d" if int(found[3]) > 12 else f"%d{mark}%m"
    if int(found[1]) <= 12 and int(found[3]) <= 12:
        yield f"# QUESTION: {found[0]} may begin with the day (%d) or the month (%m); which?"
    yield f"format = {quote(f'{order}{mark}{year}{of_day}{fraction}{half}')}"


def _text(
    path: Path,
    layout: Sequence[str],
    header: Sequence[str],
    time: Sequence[str],
    rows: Sequence[Sequence[str]] = (),
    units: Sequence[str] = (),
) -> str:
    names = ", ".join(map(quote, header))
    top = [line.replace("{name}", printable(path.name)) for line in TOP]
    stated = [*units] + [""] * len(header)
    first = rows[0] if rows else [""] * len(header)
    columns = [_column(*one) for one in zip(header, stated, first, strict=False)]
    notes = [
        '# QUESTION: what units have the columns that state none? As in { unit = "deg" }.',
        "# A column may be renamed, best to the quantity it is (delta, r, p, phi, psi, u, v, n):",
        '# { rename = "delta", unit = "deg" }.',
        "[columns]",
    ]
    parts = [*top, *layout, f"header = [{names}]", "", *time, "", *notes, *columns, ""]
    return "\n".join(parts)


def _column(text: str, stated: str, first: str) -> str:
    one = head(text, stated.strip(" []()"))
    alias = re.sub(r"\W+", "_", one.name.lower())
    quantity = next((name for name, q in SIGNALS.items() if alias in q.aliases), None)
    inside = f" rename = {quote(quantity)} " if quantity else ""
    note = f"in {one.unit}" if one.unit else "states no unit"
    return f"{quote(text)} = {{{inside}}}  # {note}" + (f", first {first[:40]!r}" if first else "")
