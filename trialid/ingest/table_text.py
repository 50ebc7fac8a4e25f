"""Delimited text to columns: a quick way for tables without fault, a careful one for the others.

The quick way is pandas' reader, which pads short rows and cannot say where a field is. Whatever it
finds odd is therefore read again by the careful way, which knows the line of every field.
"""

import csv
import io
import itertools
import re
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from trialid.errors import LogError
from trialid.ingest.table import MISSING, Head, Table, head, reader_of_numbers
from trialid.ingest.template import TAB, WHITESPACE, Template, check_header, distinct

if TYPE_CHECKING:
    import pandas as pd

UTF_16 = (b"\xff\xfe", b"\xfe\xff")
SPACES = " "
"""The separator of fields that stand any number of blanks apart."""
JOINT = "\x1f"
"""What takes the place of a separator of several characters."""
BLOCK = 1 << 18
EXACT_SINCE = (3, 1)
"""Version of pandas from which every number is read to the last bit without being asked to."""


@dataclass(frozen=True)
class Layout:
    """How a text is laid out; the names as in a template. `decimal` None: as the text shows."""

    separator: str
    decimal: str | None = None
    thousands: str | None = None
    encoding: str | None = None
    skip: int = 0
    header_rows: int = 1
    units_row: bool = False
    skip_after: int = 0
    comment: str | None = None
    missing: frozenset[str] = field(default=frozenset())
    end: str | None = None
    texts: tuple[int, ...] = ()


def of_template(template: Template) -> Layout:
    """The layout a template describes."""
    separator = {WHITESPACE: SPACES, TAB: "\t"}.get(template.separator, template.separator)
    return Layout(
        separator,
        template.decimal,
        template.thousands,
        template.encoding,
        template.skip,
        template.header_rows,
        template.units_row,
        template.skip_after,
        template.comment,
        frozenset(template.missing),
        template.end,
        template.timed,
    )


def load(path: Path, layout: Layout, template: Template | None = None) -> Table:
    """The columns of a text; LogError for rows that are not of the header's length."""
    raw = unified(path, path.read_bytes(), layout.encoding)
    if len(layout.separator) > 1:
        raw = raw.replace(layout.separator.encode(_encoding(raw, layout)), JOINT.encode())
        layout = _joint(layout)
    top = _top(path, raw, layout, template)
    raw, remarks = _ended(path, raw, top, layout)
    if re.compile(rb"\S").search(raw, top.offset) is None:
        raise LogError(f"{path}: a header but no rows; check that the log was exported")
    columns = _quick(path, raw, top, layout)
    if columns is None:
        return _careful(path, raw, top, layout, remarks)
    number = reader_of_numbers(_decimal(raw, top, layout), layout.thousands, layout.missing)
    return Table(path, top.heads, columns, _line(top.lines), number, tuple(remarks))


def unified(path: Path, raw: bytes, encoding: str | None) -> bytes:
    """The text in UTF-8 or in a code page of one byte a character, without byte-order mark."""
    wide = raw.startswith(UTF_16) or (encoding or "").lower().replace("_", "-").startswith("utf-16")
    if not wide:
        raw = raw.removeprefix(b"\xef\xbb\xbf")
        return raw if b"\n" in raw else raw.replace(b"\r", b"\n")
    try:
        text = raw.decode("utf-16" if raw.startswith(UTF_16) else encoding or "utf-16")
    except UnicodeDecodeError as error:
        kept = raw[: error.start].decode("utf-16", "ignore")
        if not kept:
            raise LogError(f"{path}: is no UTF-16 text (byte {error.start})") from error
        text = kept  # damaged from here on: what stands before is text
    return text.encode("utf-8", "replace")


def decoded(raw: bytes, encoding: str | None = None) -> str:
    """UTF-8, else the Windows code page that yards' spreadsheets write."""
    try:
        return raw.decode(encoding or "utf-8")
    except UnicodeDecodeError:
        return raw.decode("cp1252", "replace")


def _encoding(raw: bytes, layout: Layout) -> str:
    named = (layout.encoding or "utf-8").lower()
    return "utf-8" if named.startswith("utf") else named


def _joint(layout: Layout) -> Layout:
    return Layout(**{**vars(layout), "separator": JOINT})


@dataclass(frozen=True)
class _Top:
    """What stands before the data: headers, bytes and lines taken up."""

    heads: tuple[Head, ...]
    offset: int
    lines: int


def _top(path: Path, raw: bytes, layout: Layout, template: Template | None) -> _Top:
    encoding = _encoding(raw, layout)
    lines = _counted(raw, layout)
    for _ in range(layout.skip):
        next(lines, None)
    reader = csv.reader((decoded(line, encoding) for line, _ in lines.each()), **_dialect(layout))
    try:
        rows = [next(reader, []) for _ in range(layout.header_rows)]
        stated = next(reader, []) if layout.units_row else []
        for _ in range(layout.skip_after):
            next(reader, [])
    except csv.Error as error:
        raise LogError(f"{path}, the header: {error}; look for a stray quote") from error
    texts = _header(rows) if layout.header_rows else list(template.header if template else ())
    texts = list(distinct(texts)) if template is not None else texts
    if template is not None:
        check_header(path, texts, template)
    unit = [_bare_unit(text) for text in stated] + [""] * len(texts)
    heads = tuple(head(text, one) for text, one in zip(texts, unit, strict=False))
    _agree(path, heads, unit)
    return _Top(heads, lines.offset, lines.number)


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


def _counted(raw: bytes, layout: Layout) -> _Lines:
    return _Lines(raw, (layout.comment or "").encode(_encoding(raw, layout), "replace"))


def _dialect(layout: Layout) -> dict[str, Any]:
    blanks = layout.separator == SPACES
    return {"delimiter": layout.separator, "skipinitialspace": blanks}


def _header(rows: list[list[str]]) -> list[str]:
    """Header texts; of several rows those that stand above each other, joined."""
    stacked = itertools.zip_longest(*rows, fillvalue="")
    return [" ".join(part.strip() for part in parts if part.strip()) for parts in stacked]


def _bare_unit(text: str) -> str:
    text = text.strip()
    found = re.fullmatch(r"[\[(](.*)[\])]", text)
    text = found[1].strip() if found else text
    return "" if text == "-" else text


def _agree(path: Path, heads: tuple[Head, ...], stated: list[str]) -> None:
    for one, unit in zip(heads, stated, strict=False):
        if unit and one.unit != unit:
            raise LogError(
                f"{path}: column {one.name!r}: the header says {one.unit!r} and the row of units "
                f"{unit!r}; say which by a template"
            )


def _ended(path: Path, raw: bytes, top: _Top, layout: Layout) -> tuple[bytes, list[str]]:
    """The text down to where the table ends, without a last line that was cut short."""
    if layout.end is not None:
        at = _end(raw, top.offset, layout.end.encode(_encoding(raw, layout), "replace"))
        if at is None:
            raise LogError(
                f"{path}: no line begins with {layout.end!r}, where the template has the table "
                "end; it is another export, or cut short"
            )
        raw = raw[:at]
    last = raw[raw.rfind(b"\n") + 1 :]
    fields = len(_fields(decoded(last), layout)) if last.strip() else len(top.heads)
    if fields >= len(top.heads) or len(raw) - len(last) < top.offset:
        return raw, []
    kept = raw[: len(raw) - len(last)]
    # Careful with quotes: a field may go on over several lines.
    if raw.find(b'"', top.offset) >= 0:
        return raw, []
    line = kept.count(b"\n") + 1
    return kept, [f"line {line}, the last, is cut short and left out"]


def _end(raw: bytes, start: int, text: bytes) -> int | None:
    """Where the first line starts that begins with the text, after blanks and quotes."""
    at = raw.find(text, start)
    while at >= 0:
        line = max(raw.rfind(b"\n", start, at) + 1, start)
        if not raw[line:at].strip(b' \t"'):
            return line
        at = raw.find(text, at + 1)
    return None


def _fields(line: str, layout: Layout) -> list[str]:
    return line.split() if layout.separator == SPACES else line.split(layout.separator)


def _line(before: int) -> Callable[[int], str]:
    return lambda row: f"line {before + row + 1}"


def _decimal(raw: bytes, top: _Top, layout: Layout) -> str:
    if layout.decimal is not None:
        return layout.decimal
    comma = layout.separator != "," and raw.find(b",", top.offset) >= 0
    return "," if comma else "."


def _quick(path: Path, raw: bytes, top: _Top, layout: Layout) -> tuple[NDArray[Any], ...] | None:
    """The columns by pandas; None when anything is odd."""
    comment = (layout.comment or "").encode()
    sure = len(top.heads) > 1 or layout.separator == SPACES
    odd = (b'"', b"\x00", *([comment] if comment else []))
    if not sure or any(raw.find(one, top.offset) >= 0 for one in odd):
        return None
    end = len(raw)
    while end > top.offset and raw[end - 1] in b"\r\n":
        end -= 1
    lines = _count(raw, b"\n", top.offset, end) + 1
    frame = _frame(path, raw, top, layout)
    if frame is None or frame.shape != (lines, len(top.heads)):
        return None
    if frame.iloc[:, -1].isna().any():  # a short row ends like an empty field
        separators = _count(raw, layout.separator.encode(), top.offset, len(raw))
        if layout.separator == SPACES or separators != lines * (len(top.heads) - 1):
            return None
    columns = tuple(_values(frame.iloc[:, i]) for i in range(frame.shape[1]))
    commas = layout.decimal is None and _decimal(raw, top, layout) == ","
    return columns if not commas or _clear(columns) else None


def _count(raw: bytes, byte: bytes, start: int, end: int) -> int:
    """As `raw.count`, three times as quick; block by block, within the processor's cache."""
    text = np.frombuffer(raw, np.uint8)[start:end]
    blocks = (text[i : i + BLOCK] for i in range(0, len(text), BLOCK))
    return sum(int(np.count_nonzero(block == byte[0])) for block in blocks)


def _frame(path: Path, raw: bytes, top: _Top, layout: Layout) -> "pd.DataFrame | None":
    import pandas as pd

    version = tuple(int(part) for part in pd.__version__.split(".")[:2])
    options: dict[str, Any] = {
        "header": None,
        "sep": r"\s+" if layout.separator == SPACES else layout.separator,
        "decimal": _decimal(raw, top, layout),
        "thousands": layout.thousands,
        "dtype": dict.fromkeys(layout.texts, "str"),
        "keep_default_na": False,
        "na_values": sorted(layout.missing | _MISSING),
        "encoding_errors": "replace",
        **({} if version >= EXACT_SINCE else {"float_precision": "round_trip"}),
    }
    # By its path a file is read in pieces on several threads; not so what was changed here.
    unchanged = len(raw) == path.stat().st_size and b'"' not in raw[: top.offset]
    for pieces in (True, False):
        source: Any = path if unchanged and pieces else io.BytesIO(raw)
        skip = top.lines if source is path else 0
        if not skip:
            source = io.BytesIO(raw)
            source.seek(top.offset)
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("error", pd.errors.DtypeWarning)  # pieces of two kinds
                return pd.read_csv(source, skiprows=skip, low_memory=pieces, **options)
        except (pd.errors.DtypeWarning, ValueError, OverflowError):  # a ParserError is a ValueError
            continue
    return None


def _every_case(word: str) -> set[str]:
    pairs = [sorted({letter.lower(), letter.upper()}) for letter in word]
    return {"".join(letters) for letters in itertools.product(*pairs)}


_MISSING = frozenset().union(*(_every_case(word) for word in MISSING))


def _values(column: "pd.Series[Any]") -> NDArray[Any]:
    if column.dtype.kind in "fiu":
        return column.to_numpy(np.float64)
    plain = (column.astype(str) if column.dtype.kind == "b" else column).astype(object)
    return np.array(plain.where(plain.notna(), None), dtype=object)


def _clear(columns: tuple[NDArray[Any], ...]) -> bool:
    """True unless a text among numbers with a comma is a number with a point."""
    point = reader_of_numbers(".", None, frozenset())
    texts = (set(column.tolist()) - {None} for column in columns if column.dtype.kind == "O")
    return not any("." in text and _is_number(text, point) for one in texts for text in one)


def _is_number(text: Any, number: Callable[[Any], float]) -> bool:
    try:
        number(text)
    except (ValueError, TypeError):
        return False
    return True


def _careful(path: Path, raw: bytes, top: _Top, layout: Layout, remarks: list[str]) -> Table:
    rows, lines = _rows(path, raw, top, layout)
    names = [one.name for one in top.heads]
    if rows and len(rows[-1]) < len(names) and not raw.endswith((b"\n", b"\r")):
        rows.pop()
        remarks = [*remarks, f"line {lines.pop()}, the last, is cut short and left out"]
    if not rows:
        raise LogError(f"{path}: a header but no rows; check that the log was exported")
    for line, row in zip(lines, rows, strict=True):
        if len(row) != len(names):
            raise LogError(
                f"{path}, line {line}: {len(row)} fields where the header has {len(names)}"
                f" ({', '.join(names)}); mend or delete the line"
            )
    decimal = _decimal(raw, top, layout)
    columns = tuple(np.array(column, dtype=object) for column in zip(*rows, strict=True))
    number = reader_of_numbers(decimal, layout.thousands, layout.missing)
    if layout.decimal is None and decimal == ",":
        number = _either(path, columns, lines, number)
    return Table(path, top.heads, columns, lambda row: f"line {lines[row]}", number, tuple(remarks))


def _rows(path: Path, raw: bytes, top: _Top, layout: Layout) -> tuple[list[list[str]], list[int]]:
    """Rows that are not empty, and the line each ended at."""
    comment = layout.comment
    text = decoded(raw[top.offset :], _encoding(raw, layout))
    numbers: list[int] = []

    def kept() -> Iterator[str]:
        for number, line in enumerate(io.StringIO(text, newline=""), top.lines + 1):
            if not (comment and line.lstrip().startswith(comment)):
                numbers.append(number)
                yield line.strip() if layout.separator == SPACES else line

    reader = csv.reader(kept(), **_dialect(layout))
    rows, lines = [], []
    try:
        for row in reader:
            if any(row):
                rows.append(row)
                lines.append(numbers[-1])
    except csv.Error as error:
        line = numbers[-1] if numbers else top.lines
        raise LogError(f"{path}, line {line}: {error}; look for a stray quote") from error
    return rows, lines


def _either(
    path: Path, columns: tuple[NDArray[Any], ...], lines: list[int], number: Callable[[Any], float]
) -> Callable[[Any], float]:
    """Numbers with a comma; LogError when others have a point, which may mark thousands."""
    point = reader_of_numbers(".", None, frozenset())
    commas = points = None
    for column in columns:
        for row, text in enumerate(column):
            if "," in text and _is_number(text, number):
                commas = text
            elif points is None and "." in text and _is_number(text, point):
                points = (row, text)
    if commas is not None and points is not None:
        row, text = points
        raise LogError(
            f"{path}, line {lines[row]}: {text!r} beside {commas!r}: a point may be the decimal "
            "mark or part the thousands; say which by a template"
        )
    return number if points is None else point
