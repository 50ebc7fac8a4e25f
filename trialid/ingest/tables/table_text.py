"""Delimited text to columns: a quick way for tables without fault, a careful one for the others.

The quick way is pandas' reader over one block after the other, which pads short rows and cannot say
where a field is. Whatever it finds odd is therefore read again, whole, by the careful way, which
knows the line of every field. A short text is read with care at once: it is there before pandas is.
"""

import contextlib
import csv
import dataclasses
import io
import itertools
import re
from collections.abc import Callable, Collection, Iterator, Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from trialid.errors import LogError
from trialid.ingest.bytes.encoded_text import (
    LONGEST_LINE,
    OddTextError,
    first_long_line,
    text_blocks,
    unify_text,
)
from trialid.ingest.tables import table_quick
from trialid.ingest.tables.clock import table_clock
from trialid.ingest.tables.table import (
    Head,
    Table,
    check_width,
    head,
    reader_of_numbers,
    stated_unit,
)
from trialid.ingest.tables.table_layout import (
    SPACES,
    Layout,
    Top,
    blocks_below,
    decimal,
    decode_text,
    encode_text,
    find_end,
    in_one,
    join_separators,
    without_cut_line,
)
from trialid.ingest.tables.table_quick import is_number
from trialid.ingest.tables.table_tidy import cut, even
from trialid.ingest.tables.templates.template import Template, check_header, distinct

MOST_BYTES = 2_000_000_000
"""Of a table as text that is read whole."""
SHORT: Final = 1 << 19
"""Bytes of a text that the careful way reads in 80 ms, a third of what importing pandas takes: with
twice as many it is hardly quicker, with half as many a trial of 20 minutes waits for pandas."""
Needed = Callable[[Sequence[Head]], Collection[int]]
"""Which columns somebody wants, by their headers."""


def load(path: Path, layout: Layout, needed: Needed, template: Template | None = None) -> Table:
    """The columns of a text; LogError for rows that are not of the header's length.

    Columns that are not needed may hold nothing but NaN.
    """
    size = path.stat().st_size
    if size > SHORT:
        with contextlib.suppress(OddTextError):
            return _quick(path, layout, needed, template)
    if size > MOST_BYTES:
        raise LogError(
            f"{path}: {size / 1e9:.0f} GB of text; tables of up to {MOST_BYTES / 1e9:.0f} GB are "
            "read: split it, or save it as Parquet"
        )
    return _whole(path, layout, template)


def _quick(path: Path, layout: Layout, needed: Needed, template: Template | None) -> Table:
    """The table by blocks; OddTextError where anything is odd."""
    remarks: list[str] = []
    first = next(text_blocks(path, layout.encoding), b"")
    told = in_one(layout, path)
    top = _top(path, join_separators(first, layout, told), told, template)
    check_width(path, len(top.heads))
    if template is None:
        told = dataclasses.replace(told, dated=table_clock.columns_of_time(top.heads))

    def blocks() -> Iterator[tuple[bytes, int]]:
        remarks.clear()
        return blocks_below(path, layout, told, top, remarks)

    found = table_quick.columns(blocks, top, told, needed(top.heads))
    if found is None:
        raise OddTextError
    number = reader_of_numbers(found.mark, layout.thousands, layout.missing)
    return Table(
        path=path,
        heads=top.heads,
        columns=found.columns,
        place=_line(top.lines),
        number=number,
        remarks=tuple(remarks),
        utc=found.utc,
        own=True,
    )


def _whole(path: Path, layout: Layout, template: Template | None) -> Table:
    """The table read at once, with care."""
    told = in_one(layout, path)
    raw = join_separators(unify_text(path.read_bytes(), layout.encoding), layout, told)
    if (at := first_long_line(raw)) is not None:
        line = raw.count(b"\n", 0, at) + 1
        raise LogError(
            f"{path}, line {line}: more than {LONGEST_LINE / 1e6:.0f} MB "
            "without an end of line; it is no table, or damaged: mend or delete the line"
        )
    top = _top(path, raw, told, template)
    check_width(path, len(top.heads))
    raw, remarks = _ended(path, raw, top, told)
    if re.compile(rb"\S").search(raw, top.offset) is None:
        raise LogError(f"{path}: a header but no rows; check that the log was exported")
    return _careful(path, raw, top, told, remarks)


def _top(path: Path, raw: bytes, layout: Layout, template: Template | None) -> Top:
    lines = _Lines(raw, encode_text(layout.comment or "", layout))
    for _ in range(layout.skip):
        next(lines, None)
    reader = csv.reader(
        (_ends_bare(decode_text(line, layout.encoding), layout) for line, _ in lines.each()),
        **_dialect(layout),
    )
    try:
        rows = [next(reader, []) for _ in range(layout.header_rows)]
        stated = next(reader, []) if layout.units_row else []
        for _ in range(layout.skip_after):
            next(reader, [])
    except csv.Error as error:
        raise LogError(f"{path}, the header: {error}; look for a stray quote") from error
    texts = _header(rows) if layout.header_rows else list(layout.names)
    texts = list(distinct(texts)) if template is not None else texts
    if template is not None:
        check_header(path, texts, template)
    unit = [stated_unit(text) for text in stated] + [""] * len(texts)
    heads = tuple(head(text, one) for text, one in zip(texts, unit, strict=False))
    _agree(path, heads, unit)
    return Top(heads, lines.offset, lines.number)


class _Lines:
    """Lines of a text one by one, without comments; knows how far it has come."""

    def __init__(self, raw: bytes, comment: bytes) -> None:
        self.raw = raw
        self.comment = comment
        self.offset = 0
        self.number = 0

    def __next__(self) -> tuple[bytes, int]:
        while self.offset < len(self.raw):
            end = self.raw.find(b"\n", self.offset)
            end = len(self.raw) if end < 0 else end + 1
            line = self.raw[self.offset : end]
            self.offset, self.number = end, self.number + 1
            if not (self.comment and line.lstrip().startswith(self.comment)):
                return line, self.number
        raise StopIteration

    def each(self) -> Iterator[tuple[bytes, int]]:
        """All lines that are left."""
        while self.offset < len(self.raw):
            try:
                yield next(self)
            except StopIteration:
                return


def _ends_bare(line: str, layout: Layout) -> str:
    """The line without blanks at its ends, where blanks part fields."""
    return line.strip() if layout.separator == SPACES else line


def _dialect(layout: Layout) -> dict[str, Any]:
    blanks = layout.separator == SPACES
    return {"delimiter": layout.separator, "skipinitialspace": blanks}


def _header(rows: list[list[str]]) -> list[str]:
    """Header texts; of several rows those that stand above each other, joined."""
    stacked = itertools.zip_longest(*rows, fillvalue="")
    return [" ".join(part.strip() for part in parts if part.strip()) for parts in stacked]


def _agree(path: Path, heads: tuple[Head, ...], stated: list[str]) -> None:
    for one, unit in zip(heads, stated, strict=False):
        if unit and one.unit != unit:
            raise LogError(
                f"{path}: column {one.name!r}: the header says {one.unit!r} and the row of units "
                f"{unit!r}; say which by a template"
            )


def _ended(path: Path, raw: bytes, top: Top, layout: Layout) -> tuple[bytes, list[str]]:
    """The text down to where the table ends, without a last line that was cut short."""
    if layout.end is not None:
        at = find_end(raw, top.offset, encode_text(layout.end, layout))
        if at is None:
            raise LogError(
                f"{path}: no line begins with {layout.end!r}, where the template has the table "
                "end; it is another export, or cut short"
            )
        raw = raw[:at]
    return without_cut_line(raw, top, layout)


def _line(before: int) -> Callable[[int], str]:
    return lambda row: f"line {before + row + 1}"


def _careful(path: Path, raw: bytes, top: Top, layout: Layout, remarks: list[str]) -> Table:
    rows, lines, left_out = _rows(path, raw, top, layout)
    rows, remarks = list(cut(rows, len(top.heads))), [*remarks, *left_out]
    names = [one.name for one in top.heads]
    if rows and len(rows[-1]) < len(names) and not raw.endswith((b"\n", b"\r")):
        rows.pop()
        remarks = [*remarks, f"line {lines.pop()}, the last, is cut short and left out"]
    if not rows:
        raise LogError(f"{path}: a header but no rows; check that the log was exported")
    rows, lines, torn = even(path, rows, lines, top.heads)
    mark = decimal(raw, layout, top.offset)
    columns = tuple(np.array(column, dtype=object) for column in zip(*rows, strict=True))
    number = reader_of_numbers(mark, layout.thousands, layout.missing)
    if layout.decimal is None and mark == ",":
        number = _either(path, columns, lines, number)
    told = (*remarks, *torn)
    return Table(path, top.heads, columns, lambda row: f"line {lines[row]}", number, told)


def _rows(
    path: Path, raw: bytes, top: Top, layout: Layout
) -> tuple[list[list[str]], list[int], list[str]]:
    """Rows that are not empty, the line each ended at, and what of the others is left out."""
    comment = layout.comment
    text = decode_text(raw[top.offset :], layout.encoding)
    numbers, torn = list[int](), list[int]()

    def kept() -> Iterator[str]:
        for number, line in enumerate(io.StringIO(text, newline=""), top.lines + 1):
            if "\0" in line:
                torn.append(number)
            elif not (comment and line.lstrip().startswith(comment)):
                numbers.append(number)
                yield _ends_bare(line, layout)

    reader = csv.reader(kept(), **_dialect(layout))
    rows, lines, blank = [], [], 0
    try:
        for row in reader:
            if any(row):
                rows.append(row)
                lines.append(numbers[-1])
            else:
                blank += len(row) > 1
    except csv.Error as error:
        line = numbers[-1] if numbers else top.lines
        raise LogError(f"{path}, line {line}: {error}; look for a stray quote") from error
    told = [f"{blank} rows without any value, left out"] if blank else []
    told += [f"line {n} holds bytes of zero, left out" for n in torn]
    return rows, lines, told


def _either(
    path: Path, columns: tuple[NDArray[Any], ...], lines: list[int], number: Callable[[Any], float]
) -> Callable[[Any], float]:
    """Numbers with a comma; LogError when others have a point, which may mark thousands."""
    point = reader_of_numbers(".", None, frozenset())
    commas = points = None
    for column in columns:
        for row, text in enumerate(column):
            if "," in text and is_number(text, number):
                commas = text
            elif points is None and "." in text and is_number(text, point):
                points = (row, text)
    if commas is not None and points is not None:
        row, text = points
        raise LogError(
            f"{path}, line {lines[row]}: {text!r} beside {commas!r}: a point may be the decimal "
            "mark or part the thousands; say which by a template"
        )
    return number if points is None else point
