"""CSV logs: a header row, a time column, one column a channel; any other text by a template.

A column is `name`, `name[unit]` or `name (unit)`, or a second row gives the units; titles may stand
above the header, and this behind a comment sign or in Tecplot's `VARIABLES`. Separator: comma,
semicolon or tab, or blanks where each row has as many numbers as the header has words; but with the
first the decimals may stand behind a comma. The time column is called `t`, `time_utc`, `elapsed_s`,
`Uhrzeit` or the like and holds seconds from any origin, another stated unit of time, dates, or
times of day. Whatever could be read in two ways is refused: a template says which.
"""

import re
from collections.abc import Sequence
from pathlib import Path

from trialid.ingest.adapter import NO_AIDS, Adapter, Aids, Wanted
from trialid.ingest.bytes.encoded_text import UTF_16
from trialid.ingest.tables import stated_names, table_blanks, table_header, table_text
from trialid.ingest.tables.table import Head
from trialid.ingest.tables.table import head as head_of
from trialid.ingest.tables.table_channels import columns_to_read, recording
from trialid.ingest.tables.table_layout import SPACES, Layout, decode_text, of_template
from trialid.ingest.tables.table_names import is_time
from trialid.ingest.tables.table_tidy import tidy
from trialid.ingest.tables.templates import template
from trialid.recording import Recording

SEPARATORS = ",;\t"
TOP = 65_536
"""Bytes in which the first two lines are looked for."""
NO_TEXT = re.compile(rb"[\x00-\x08\x0e-\x1a]")


def recognises(head: bytes) -> bool:
    """A first line of names, or one below titles; a single line names a time."""
    lines = _text(head).splitlines(keepends=True)
    if not lines:
        return False
    if _sure_layout(lines) is not None:
        return True
    first = _fields(lines[0], _separator(lines[0]))
    if not lines[0].endswith(("\n", "\r")) and len(first) > 2:
        first.pop()  # of a header longer than the head, cut anywhere
        return table_header.names(first) > 1
    if table_header.names(first) < 2:
        return False
    told = [line for line in lines[1:] if line.strip()]
    timed = any(is_time(head_of(text).name) for text in first)
    return timed or any(_is_row(line, lines[0]) for line in told[:2])


def nearly(head: bytes) -> str | None:
    """What a table whose columns stand blanks apart lacks to be read."""
    return table_blanks.doubt(_whole(_text(head).splitlines(keepends=True)))


def _whole(lines: Sequence[str]) -> Sequence[str]:
    """The lines of a beginning without a last one that may be cut anywhere."""
    return lines if not lines or lines[-1].endswith(("\n", "\r")) else lines[:-1]


def _is_row(line: str, above: str) -> bool:
    """Whether a line has a value among fields of the header's separator."""
    fields = _fields(line, _separator(above))
    return len(fields) > 1 and any(table_header.is_data([one]) for one in fields)


def is_text(head: bytes) -> bool:
    """True for a text of any kind, which a template may lay out."""
    return bool(_text(head).strip())


def read(path: Path, wanted: Wanted = None, aids: Aids = NO_AIDS) -> Recording:
    """Read the wanted columns; LogError names the line and column of what cannot be read."""
    told = None if aids.template is None else template.load(aids.template)

    def wanted_of(heads: Sequence[Head]) -> set[int]:
        return columns_to_read(heads, wanted, told)

    if told is None:
        table = tidy(table_text.load(path, _layout(path), wanted_of))
    else:
        table = table_text.load(path, of_template(told), wanted_of, told)
    return recording(table, ADAPTER.name, wanted, aids, told)


def _text(head: bytes) -> str:
    """The beginning as text, empty when it is none."""
    if head.startswith(UTF_16):
        return head[: len(head) // 2 * 2].decode("utf-16", "replace")
    if NO_TEXT.search(head):
        return ""
    return decode_text(head.removeprefix(b"\xef\xbb\xbf"))


def _separator(line: str) -> str:
    return max(SEPARATORS, key=line.count)


def _fields(line: str, separator: str) -> list[str]:
    return [field.strip(' "') for field in line.strip("\r\n").split(separator)]


def _header(lines: Sequence[str]) -> tuple[str, int, bool] | None:
    """Separator, line of the header, and whether units follow, where the lines leave no doubt."""
    for separator in sorted(SEPARATORS, key=lambda one: -sum(line.count(one) for line in lines)):
        rows = [_fields(line, separator) for line in lines]
        if (found := table_header.row_of(rows)) is not None:
            return separator, *found
    return None


def _sure_layout(lines: Sequence[str]) -> Layout | None:
    """The layout of a table of which the first lines leave no doubt."""
    spaced = table_blanks.header_of(_whole(lines))
    if spaced is not None:
        return Layout(SPACES, skip=spaced[0], units_row=spaced[1])
    top = [line.rstrip("\r\n") for line in lines[: table_header.DEEPEST + 8]]
    if (found := _header(top)) is not None:
        separator, skip, units_row = found
        return Layout(separator, skip=skip, units_row=units_row)
    return stated_names.layout_of(_whole(lines))


def _layout(path: Path) -> Layout:
    with path.open("rb") as file:
        lines = _text(file.read(TOP)).splitlines(keepends=True)
    if (sure := _sure_layout(lines)) is not None:
        return sure
    separator = _separator(lines[0]) if lines else ","
    units_row = len(lines) > 1 and table_header.are_units(
        lines[0].split(separator), lines[1].split(separator)
    )
    return Layout(separator, units_row=units_row)


ADAPTER = Adapter(
    "csv",
    recognises,
    read,
    frozenset({"template", "zone"}),
    general=True,
    by_template=is_text,
    nearly=nearly,
)
