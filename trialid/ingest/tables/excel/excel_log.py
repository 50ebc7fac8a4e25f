"""Excel logs: one sheet, a header row, a time column, one column a channel; others by a template.

Cells are read as Excel last showed them: a formula is never run. A date cell is a date without
time zone, a number is what it is.
"""

import pickle
import re
import subprocess
import sys
from datetime import date, datetime, time
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trialid.errors import LogError, reason_of
from trialid.ingest.adapter import NO_AIDS, Adapter, Aids, Wanted
from trialid.ingest.packages import require
from trialid.ingest.tables import table_header
from trialid.ingest.tables.excel import excel_guard, excel_sheets
from trialid.ingest.tables.excel.excel_sheets import Found
from trialid.ingest.tables.table import Head, Table, blank_out, head, reader_of_numbers
from trialid.ingest.tables.table_channels import recording
from trialid.ingest.tables.table_names import is_time
from trialid.ingest.tables.templates import template
from trialid.ingest.tables.templates.template import Template
from trialid.recording import Recording

FIRST_MEMBERS = (b"[Content_Types].xml", b"_rels/", b"docProps/", b"xl/")
COMMA = re.compile(r"[-+]?\d*,\d+([eE][-+]?\d+)?")
POINT = re.compile(r"[-+]?\d*\.\d+([eE][-+]?\d+)?")
Rows = list[list[Any]]


def recognises(start: bytes) -> bool:
    """A ZIP archive that begins as Office documents do."""
    return start.startswith(b"PK\x03\x04") and start[30:].startswith(FIRST_MEMBERS)


def read(path: Path, wanted: Wanted = None, aids: Aids = NO_AIDS) -> Recording:
    """Read the wanted columns; LogError names the sheet, row and column of what cannot be read."""
    told = None if aids.template is None else template.load(aids.template)
    return recording(_table(path, told), ADAPTER.name, wanted, aids, told)


def sheets(path: Path) -> dict[str, Rows]:
    """All sheets by name, as rows of cells from the first of each; LogError as `read`."""
    require("python_calamine", path, "Excel")
    excel_guard.check(path)
    found = _found(path)
    if found is None:
        raise LogError(
            f"{path}: takes more memory or time to read than a sheet of a million rows; delete "
            "stray cells, or export it as CSV"
        )
    wrong, rows = found
    if wrong is not None:
        raise LogError(
            f"{path}: is no Excel file that can be read ({reason_of(ValueError(wrong))}); save it "
            "as .xlsx, or export it as CSV"
        )
    return rows


def _found(path: Path) -> Found | None:
    """What a process of its own finds in the file; None when it died of it."""
    command = [sys.executable, "-P", excel_sheets.__file__, str(path)]
    with subprocess.Popen(
        command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL
    ) as process:
        assert process.stdout is not None
        try:
            found: Found = pickle.load(process.stdout)
        except (EOFError, pickle.UnpicklingError):
            found = None, {}
    return found if process.returncode == 0 else None


def _table(path: Path, told: Template | None) -> Table:
    found = sheets(path)
    name = _sheet(path, found, told)
    rows = found[name]
    skip, units_row = (told.skip, told.units_row) if told else _plain_top(rows)
    top = skip + (told.header_rows + told.units_row + told.skip_after if told else 1 + units_row)
    heads = _heads(rows[skip:], told, units_row)
    if told is not None:
        template.check_header(path, [one.text for one in heads], told)
    body = [(n, row) for n, row in enumerate(rows[top:], top + 1) if any(c != "" for c in row)]
    body = _ended(path, body, told)
    if not body:
        raise LogError(f"{path}, sheet {name!r}: a header but no rows; check the export")
    texts = frozenset(told.missing if told else ())
    cells = ([row[i] for _, row in body] for i in range(len(heads)))
    columns = tuple(blank_out(_column(one), texts) for one in cells)
    decimal = (told.decimal if told else None) or _decimal(path, body)
    thousands = told.thousands if told else None
    number = reader_of_numbers(decimal, thousands, texts)
    return Table(path, heads, columns, lambda row: f"sheet {name!r}, row {body[row][0]}", number)


def _sheet(path: Path, found: dict[str, Rows], told: Template | None) -> str:
    if told is not None and told.sheet is not None:
        if told.sheet not in found:
            raise LogError(
                f"{path}: has no sheet {told.sheet!r}, which the template names, but: "
                f"{', '.join(found)}"
            )
        return told.sheet
    held = [name for name, rows in found.items() if rows]
    timed = [name for name in held if _timed(found[name])]
    likely = timed if len(held) > 1 and told is None else held
    if len(likely) == 1:
        return likely[0]
    what = "several sheets hold a table" if likely else "no sheet begins with a table"
    raise LogError(
        f"{path}: {what}: {', '.join(likely or found)}; say which by a template with its `sheet`"
    )


def _timed(rows: Rows) -> bool:
    return any(is_time(head(str(cell)).name) for cell in rows[_plain_top(rows)[0]])


def _plain_top(rows: Rows) -> tuple[int, bool]:
    """The row of the header, below titles if there are any, and whether one of units follows."""
    return table_header.row_of(rows) or (0, False)


def has_commas(rows: Rows) -> bool:
    """Whether a text among the cells is a number with a decimal comma."""
    return any(isinstance(cell, str) and COMMA.fullmatch(cell.strip()) for r in rows for cell in r)


def _decimal(path: Path, body: list[tuple[int, list[Any]]]) -> str:
    """The decimal mark of numbers that stand in cells of text; LogError where they have both."""
    rows = [row for _, row in body]
    if not has_commas(rows):
        return "."
    points = (cell for row in rows for cell in row if isinstance(cell, str))
    point = next((cell for cell in points if POINT.fullmatch(cell.strip())), None)
    if point is not None:
        raise LogError(
            f"{path}: numbers in cells of text with a comma, and {point!r}: a point may be the "
            "decimal mark or part the thousands; say which by a template"
        )
    return ","


def _heads(rows: Rows, told: Template | None, units_row: bool) -> tuple[Head, ...]:
    """Headers of all columns that hold anything; one without a text is called by its letters."""
    count = told.header_rows if told else 1
    above = rows[:count]
    units = rows[count] if units_row and len(rows) > count else []
    width = max((i + 1 for row in rows for i in range(len(row)) if row[i] != ""), default=0)
    if told is not None and not count:
        return tuple(head(text) for text in told.header[:width])
    texts = [_stacked(above, i) or f"column {letters(i)}" for i in range(width)]
    names = template.distinct(texts) if told is not None else texts
    stated = [str(cell).strip(" []()") for cell in units] + [""] * width
    return tuple(head(text, unit) for text, unit in zip(names, stated, strict=False))


def _stacked(rows: Rows, column: int) -> str:
    return " ".join(text for row in rows if (text := str(row[column]).strip()))


def letters(column: int) -> str:
    """Give what Excel calls a column.

    >>> letters(0), letters(27)
    ('A', 'AB')
    """
    before, last = divmod(column, 26)
    return (letters(before - 1) if before else "") + chr(65 + last)


def _ended(path: Path, body: list[tuple[int, list[Any]]], told: Template | None) -> Any:
    end = told.end if told else None
    if end is None:
        return body
    for i, (_, row) in enumerate(body):
        if str(next(cell for cell in row if cell != "")).startswith(end):
            return body[:i]
    raise LogError(
        f"{path}: no row begins with {end!r}, where the template has the table end; it is another "
        "export, or cut short"
    )


def _column(cells: list[Any]) -> NDArray[Any]:
    """Numbers, dates, or the cells as they stand; (N,)."""
    kinds = {type(cell) for cell in cells if cell != ""}
    if kinds and kinds <= {float, int}:
        return np.array([np.nan if cell == "" else cell for cell in cells], np.float64)
    if kinds and kinds <= {datetime, date} and "" not in cells:
        days = [
            one if isinstance(one, datetime) else datetime.combine(one, time()) for one in cells
        ]
        return np.array(days, "datetime64[us]").astype("datetime64[ns]")
    plain = [str(cell) if isinstance(cell, bool) else cell for cell in cells]
    column = np.empty(len(plain), object)
    column[:] = plain
    return column


ADAPTER = Adapter(
    "excel", recognises, read, frozenset({"template", "zone"}), by_template=recognises
)
