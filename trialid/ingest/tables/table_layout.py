"""How a delimited text is laid out, and the text below its header in blocks."""

import dataclasses
import itertools
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from trialid.ingest.bytes.encoded_text import OddTextError, text_blocks, wide_codec
from trialid.ingest.tables.table import Head
from trialid.ingest.tables.templates.template import TAB, WHITESPACE, Template

PART = 1 << 18
"""Bytes that lie in the processor's cache."""
JOINT = "\x1f"
"""What takes the place of a separator of several characters."""
SPACES = " "
"""The separator of fields that stand any number of blanks apart."""


@dataclass(frozen=True)
class Layout:
    """How a text is laid out; what is called as in a template means the same.

    `decimal` None: as the text shows. `names` are of columns that no row names, `texts` the columns
    to be left as texts, `dated` those that may hold whole dates, `form` how these are written.
    """

    separator: str
    decimal: str | None = None
    thousands: str | None = None
    encoding: str | None = None
    skip: int = 0
    header_rows: int = 1
    names: tuple[str, ...] = ()
    units_row: bool = False
    skip_after: int = 0
    comment: str | None = None
    missing: frozenset[str] = field(default=frozenset())
    end: str | None = None
    texts: tuple[int, ...] = ()
    dated: tuple[int, ...] = ()
    form: str | None = None


def of_template(template: Template) -> Layout:
    """The layout a template describes."""
    separator = {WHITESPACE: SPACES, TAB: "\t"}.get(template.separator, template.separator)
    return Layout(
        separator=separator,
        decimal=template.decimal,
        thousands=template.thousands,
        encoding=template.encoding,
        skip=template.skip,
        header_rows=template.header_rows,
        names=() if template.header_rows else tuple(template.header),
        units_row=template.units_row,
        skip_after=template.skip_after,
        comment=template.comment,
        missing=frozenset(template.missing),
        end=template.end,
        texts=template.timed,
        dated=template.timed if template.time.kind == "datetime" else (),
        form=template.time.format,
    )


@dataclass(frozen=True)
class Top:
    """What stands before the data: headers, bytes and lines taken up."""

    heads: tuple[Head, ...]
    offset: int
    lines: int


def decode_text(raw: bytes, encoding: str | None = None) -> str:
    """UTF-8, else the Windows code page that yards' spreadsheets write."""
    try:
        return raw.decode(encoding or "utf-8")
    except UnicodeDecodeError:
        return raw.decode("cp1252", "replace")


def encode_text(text: str, layout: Layout) -> bytes:
    """A text of the template as it stands in the file."""
    return text.encode(layout.encoding or "utf-8", "replace")


def decimal(raw: bytes, layout: Layout, start: int = 0) -> str:
    """The decimal mark: the one told, else a comma where one stands and parts no fields."""
    if layout.decimal is not None:
        return layout.decimal
    comma = layout.separator != "," and raw.find(b",", start) >= 0
    return "," if comma else "."


def in_one(layout: Layout, path: Path) -> Layout:
    """The layout of the text in UTF-8 or a code page, with one character as its separator."""
    with path.open("rb") as file:
        wide = wide_codec(file.read(4), layout.encoding)
    separator = layout.separator if len(layout.separator) == 1 else JOINT
    encoding = "utf-8" if wide else layout.encoding
    return dataclasses.replace(layout, encoding=encoding, separator=separator)


def join_separators(raw: bytes, layout: Layout, told: Layout) -> bytes:
    """The text with one character as its separator."""
    if layout.separator == told.separator:
        return raw
    return raw.replace(encode_text(layout.separator, told), JOINT.encode())


def blocks_below(
    path: Path, layout: Layout, told: Layout, top: Top, remarks: list[str]
) -> Iterator[tuple[bytes, int]]:
    """The text below the header, down to where the table ends, in blocks: each, and its lines."""
    blocks = (join_separators(one, layout, told) for one in text_blocks(path, layout.encoding))
    start, above = top.offset, top.lines
    for whole, following in itertools.pairwise(itertools.chain(blocks, [b""])):
        here = Top(top.heads, 0, above)
        block, ended, said = _down_to_end(whole[start:], not following, here, told)
        remarks += said
        lines = count_bytes(block, b"\n") + (not block.endswith(b"\n"))
        if block:
            yield block, lines
        if ended:
            return
        start, above = 0, above + lines


def _down_to_end(
    block: bytes, last: bool, top: Top, layout: Layout
) -> tuple[bytes, bool, list[str]]:
    """The block down to where the table ends, whether it does, and remarks."""
    at = None if layout.end is None else find_end(block, 0, encode_text(layout.end, layout))
    if at is None and not last:
        return block, False, []
    if at is None and layout.end is not None:
        raise OddTextError
    kept, said = without_cut_line(block[:at], top, layout)
    return kept.rstrip(b"\r\n"), True, said


def without_cut_line(raw: bytes, top: Top, layout: Layout) -> tuple[bytes, list[str]]:
    """The text without a last line that was cut short; the header ends at the offset."""
    last = raw[raw.rfind(b"\n") + 1 :]
    fields = _fields(decode_text(last), layout, len(top.heads)) if last.strip() else len(top.heads)
    if fields >= len(top.heads) or len(raw) - len(last) < top.offset:
        return raw, []
    kept = raw[: len(raw) - len(last)]
    # Careful with quotes: a field may go on over several lines.
    if raw.find(b'"', top.offset) >= 0:
        return raw, []
    line = top.lines + kept.count(b"\n", top.offset) + 1
    return kept, [f"line {line}, the last, is cut short and left out"]


def find_end(raw: bytes, start: int, text: bytes) -> int | None:
    """Where the first line starts that begins with the text, after blanks and quotes."""
    at = raw.find(text, start)
    while at >= 0:
        line = max(raw.rfind(b"\n", start, at) + 1, start)
        if not raw[line:at].strip(b' \t"'):
            return line
        at = raw.find(text, at + 1)
    return None


def _fields(line: str, layout: Layout, most: int) -> int:
    """How many fields a line has; it is not counted on beyond `most`."""
    separator = None if layout.separator == SPACES else layout.separator
    return len(line.split(separator, most))


def count_bytes(text: bytes, byte: bytes) -> int:
    """As `text.count`, three times as quick; part by part, within the processor's cache."""
    whole = np.frombuffer(text, np.uint8)
    parts = (whole[i : i + PART] for i in range(0, len(whole), PART))
    return sum(int(np.count_nonzero(part == byte[0])) for part in parts)
