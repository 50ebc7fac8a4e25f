"""CSV logs: a header row, a time column, one column a channel; any other text by a template.

A column is `name`, `name[unit]` or `name (unit)`, or a second row gives the units. Separator:
comma, semicolon or tab; with the last two the decimals may stand behind a comma. The time column is
called `t`, `time`, `timestamp` or `Zeit` and holds seconds from any origin, another stated unit of
time, or ISO-8601 dates. Whatever could be read in two ways is refused: a template says which.
"""

import re
from pathlib import Path

from trialid import units
from trialid.errors import UnitError
from trialid.ingest import table_text, template
from trialid.ingest.adapter import NO_AIDS, Adapter, Aids, Wanted
from trialid.ingest.table_channels import recording
from trialid.ingest.table_layout import UTF_16, Layout, decoded, of_template
from trialid.ingest.table_time import TIME_NAMES
from trialid.recording import Recording

SEPARATORS = ",;\t"
TOP = 65_536
"""Bytes in which the first two lines are looked for."""
NO_TEXT = re.compile(rb"[\x00-\x08\x0e-\x1a]")


def recognises(head: bytes) -> bool:
    """A first line of two or more fields that all begin like names."""
    line, end, _ = _text(head).partition("\n")
    fields = [field.strip(' "') for field in line.strip().split(_separator(line))]
    if not end and len(fields) > 2:
        fields.pop()  # of a header longer than the head, cut anywhere
    return len(fields) > 1 and all(re.match(r"[^\W\d]", field) for field in fields)


def is_text(head: bytes) -> bool:
    """True for a text of any kind, which a template may lay out."""
    return bool(_text(head).strip())


def read(path: Path, wanted: Wanted = None, aids: Aids = NO_AIDS) -> Recording:
    """Read the wanted columns; LogError names the line and column of what cannot be read."""
    if aids.template is None:
        table = table_text.load(path, _layout(path))
        return recording(table, ADAPTER.name, wanted, aids)
    told = template.load(aids.template)
    table = table_text.load(path, of_template(told), told)
    return recording(table, ADAPTER.name, wanted, aids, told)


def _text(head: bytes) -> str:
    """The beginning as text, empty when it is none."""
    if head.startswith(UTF_16):
        return head[: len(head) // 2 * 2].decode("utf-16", "replace")
    if NO_TEXT.search(head):
        return ""
    return decoded(head.removeprefix(b"\xef\xbb\xbf"))


def _separator(line: str) -> str:
    return max(SEPARATORS, key=line.count)


def _layout(path: Path) -> Layout:
    with path.open("rb") as file:
        lines = _text(file.read(TOP)).splitlines()
    separator = _separator(lines[0]) if lines else ","
    units_row = len(lines) > 1 and _are_units(lines[0].split(separator), lines[1].split(separator))
    return Layout(separator, units_row=units_row)


def _are_units(names: list[str], fields: list[str]) -> bool:
    """True for a second row that can be nothing but units: in brackets, or a unit of time first.

    >>> _are_units(["t", "roll", "mode"], ["[s]", "[deg]", ""])
    True
    >>> _are_units(["t", "roll", "mode"], ["s", "deg", "-"])
    True
    >>> _are_units(["t", "roll", "mode"], ["0.0", "", "AUTO"])
    False
    """
    stated = [field.strip(' "') for field in fields]
    told = [field for field in stated if field not in ("", "-")]
    if len(names) != len(fields) or not told:
        return False
    if all(re.fullmatch(r"\[\D*\]|\(\D*\)|\[\w.*/.*\]", field) for field in told):
        return True
    times = [i for i, name in enumerate(names) if name.strip(' "').lower() in TIME_NAMES]
    return any(_counts_time(stated[i]) for i in times) and all(
        units.TEXT.fullmatch(field) for field in told
    )


def _counts_time(text: str) -> bool:
    try:
        return bool(re.fullmatch(r"[A-Za-z]{1,12}", text)) and units.factor(text, "s") > 0.0
    except UnitError:
        return False


ADAPTER = Adapter(
    "csv", recognises, read, frozenset({"template", "zone"}), general=True, by_template=is_text
)
