"""How a delimited text is laid out, and its bytes brought to one encoding."""

import re
from dataclasses import dataclass, field

from trialid.ingest.tables.table import Head
from trialid.ingest.tables.template import TAB, WHITESPACE, Template

UTF_16 = (b"\xff\xfe", b"\xfe\xff")
SPACES = " "
"""The separator of fields that stand any number of blanks apart."""
ONE_BYTE = re.compile(r"ascii|us-ascii|(windows|cp|iso|latin|mac)[-_]?[\w-]+", re.IGNORECASE)
"""Names of encodings in which separators and digits are the bytes they are in ASCII."""


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
        separator=separator,
        decimal=template.decimal,
        thousands=template.thousands,
        encoding=template.encoding,
        skip=template.skip,
        header_rows=template.header_rows,
        units_row=template.units_row,
        skip_after=template.skip_after,
        comment=template.comment,
        missing=frozenset(template.missing),
        end=template.end,
        texts=template.timed,
    )


@dataclass(frozen=True)
class Top:
    """What stands before the data: headers, bytes and lines taken up."""

    heads: tuple[Head, ...]
    offset: int
    lines: int


def unify_text(raw: bytes, encoding: str | None) -> tuple[bytes, str | None]:
    """The text in UTF-8 or a code page, without byte-order mark; and which, None: either."""
    if raw.startswith(UTF_16):
        encoding = "utf-16"
    named = (encoding or "utf-8").lower().replace("_", "-")
    if named not in ("utf-8", "utf8", "utf-8-sig") and not ONE_BYTE.fullmatch(named):
        whole = raw[: len(raw) // 2 * 2] if named.startswith("utf-16") else raw
        text = whole.decode(named, "replace").removeprefix("\ufeff")
        raw, encoding = text.encode("utf-8", "replace"), "utf-8"
    raw = raw.removeprefix(b"\xef\xbb\xbf")
    return (raw if b"\n" in raw else raw.replace(b"\r", b"\n")), encoding


def decode_text(raw: bytes, encoding: str | None = None) -> str:
    """UTF-8, else the Windows code page that yards' spreadsheets write."""
    try:
        return raw.decode(encoding or "utf-8")
    except UnicodeDecodeError:
        return raw.decode("cp1252", "replace")


def encode_text(text: str, layout: Layout) -> bytes:
    """A text of the template as it stands in the file."""
    return text.encode(layout.encoding or "utf-8", "replace")


def decimal(raw: bytes, top: Top, layout: Layout) -> str:
    """The decimal mark: the one told, else a comma where one stands and parts no fields."""
    if layout.decimal is not None:
        return layout.decimal
    comma = layout.separator != "," and raw.find(b",", top.offset) >= 0
    return "," if comma else "."
