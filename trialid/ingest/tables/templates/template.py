"""A table's template: how an export is laid out, reviewed by whoever knows the instrument.

An export is read through its template exactly or not at all: a header that differs is refused. The
idea is that of the equipment templates of marinerg-data.
"""

import re
import time
from collections import Counter
from collections.abc import Mapping, Sequence
from itertools import zip_longest
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Field,
    Strict,
    ValidationError,
    model_validator,
)

from trialid import user_files
from trialid.errors import LogError, nearest, reason_of
from trialid.ingest.times.local_time import known_zone
from trialid.names import units
from trialid.toml_text import quote

WHITESPACE, TAB = "whitespace", "tab"


def _unit(unit: str) -> str:
    if units.TEXT.fullmatch(unit) is None:
        raise ValueError(f"{unit!r} is not a unit; write it like deg/s, m/s or kg*m^2")
    return unit


def _encoding(name: str) -> str:
    try:
        "a".encode(name)
    except LookupError as error:
        known = ("utf-8", "utf-16", "cp1252", "latin-1")
        raise ValueError(f"{name!r} is no encoding of text; {nearest(name, known)}") from error
    return name


def _format(text: str) -> str:
    try:
        time.strptime("", text)
    except re.error as error:
        raise ValueError(f"{text!r} holds a code twice, or one that is no code") from error
    except ValueError:  # nothing is no date of this form
        return text
    return text


def _no_number(text: str) -> str:
    if text not in (WHITESPACE, TAB) and re.search(r"[\w.+\-\n\r\"]", text):
        raise ValueError(f"{text!r} cannot separate fields, for it stands in numbers")
    return text


MOST_LINES = 100_000
"""Lines before the data; none has so many, and each is gone through."""
Count = Annotated[int, Strict(), Field(ge=0, le=MOST_LINES)]
Text = Annotated[str, Field(min_length=1)]
Texts = tuple[str, ...]


class Section(BaseModel):
    """A table of the template: frozen, finite numbers, no key it does not know."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class Time(Section):
    """What the time is written in.

    `columns` are header texts: one, two where date and time stand apart, none for an index of the
    rows. `kind` is how they are written; `unit` is that of `seconds`, `format` that of `datetime`
    and `time of day` (as Python's strptime; none: ISO-8601, 14:30:05.25), `zone` that of dates
    that state none, `rate` the rows of an index in a second.
    """

    columns: Texts = ()
    kind: Literal["seconds", "index", "datetime", "excel days", "matlab datenum", "time of day"] = (
        "datetime"
    )
    unit: Annotated[str, AfterValidator(_unit)] | None = None
    format: Annotated[Text, AfterValidator(_format)] | None = None
    zone: Annotated[str, AfterValidator(known_zone)] | None = None
    rate: Annotated[float, Strict(), Field(gt=0)] | None = None

    @model_validator(mode="after")
    def _whole(self) -> "Time":
        most = {"datetime": 2}.get(self.kind, 1)
        least = 0 if self.kind == "index" else 1
        if not least <= len(self.columns) <= most:
            raise ValueError(f"{self.kind} takes {least} to {most} columns, got {self.columns}")
        if self.kind == "index" and self.rate is None:
            raise ValueError("an index needs its rate [1/s]")
        return self


class Column(Section):
    """What is known of a column beyond its header: its unit, and what to call it."""

    unit: Annotated[str, AfterValidator(_unit)] | None = None
    rename: Text | None = None


class Template(Section):
    """How a table is laid out. Header texts are compared with the file's, in order.

    Text: `separator` (a text, "tab", "whitespace" for any number of blanks), `decimal`,
    `thousands`, `encoding` (none: UTF-8,
    else the Windows code page), `comment` begins lines to leave out, `skip` lines stand before the
    header of `header_rows` rows (0: `header` names the columns), then a `units_row`, `skip_after`
    more lines, and the data down to a line that begins with `end`. Excel: `sheet` and the same
    rows. MATLAB and HDF5: `group`, the struct or group the columns lie in. `missing` are texts
    (or numbers) for no value; `columns` says of a header its unit, and what to call it. Nothing is
    read before `reviewed` is true.
    """

    reviewed: Annotated[bool, Strict()]
    header: Annotated[Texts, Field(min_length=1)]
    time: Time
    columns: Mapping[str, Column] = {}
    separator: Annotated[Text, AfterValidator(_no_number)] = ","
    decimal: Literal[".", ","] = "."
    thousands: Literal[".", ",", " ", "'", "\u00a0", "\u202f"] | None = None
    encoding: Annotated[str, AfterValidator(_encoding)] | None = None
    comment: Text | None = None
    skip: Count = 0
    header_rows: Count = 1
    units_row: Annotated[bool, Strict()] = False
    skip_after: Count = 0
    missing: Texts = ()
    end: Text | None = None
    sheet: Text | None = None
    group: Text | None = None

    @model_validator(mode="after")
    def _whole(self) -> "Template":
        twice = next((name for name, n in Counter(self.header).items() if n > 1), None)
        if twice is not None:
            raise ValueError(f"{twice!r} stands twice in header; the second is {twice + '#2'!r}")
        for key, names in (("time.columns", self.time.columns), ("columns", self.columns)):
            strange = next((name for name in names if name not in self.header), None)
            if strange is not None:
                hint = nearest(strange, self.header)
                raise ValueError(f"{key}: {strange!r} is not in header; {hint}")
        if self.decimal in {self.separator, self.thousands}:
            raise ValueError(f"decimal {self.decimal!r} also separates fields or thousands")
        return self

    @property
    def timed(self) -> tuple[int, ...]:
        """Places of the columns the time is in, where they are texts rather than numbers."""
        texts = self.time.kind in ("datetime", "time of day")
        return tuple(self.header.index(name) for name in self.time.columns if texts)


def load(path: Path) -> Template:
    """The reviewed template in a TOML file.

    Raises LogError in one line, with the key's full path, for what is no template, and for one
    that nobody has reviewed.
    """
    template = parse(_content(path), path)
    if not template.reviewed:
        raise LogError(
            f"{path}: reviewed: false; read through the template, answer its questions, correct "
            "what was guessed, and write reviewed = true"
        )
    return template


def parse(text: str, path: Path) -> Template:
    """The template in a text that stands, or is to stand, in a file; reviewed or not."""
    try:
        return Template.model_validate(user_files.toml(text))
    except ValidationError as error:
        raise LogError(_complaint(path, error)) from error
    except ValueError as error:
        raise LogError(f"{path}: not TOML: {reason_of(error)}") from error


def check_header(path: Path, found: Sequence[str], template: Template) -> None:
    """LogError with the first difference unless the file's header is the template's."""
    for place, (there, told) in enumerate(zip_longest(found, template.header), 1):
        if there != told:
            has = "no such column" if there is None else repr(there)
            expected = "none" if told is None else repr(told)
            raise LogError(
                f"{path}: column {place} of {len(found)}: the file has {has} where the template "
                f"has {expected} of {len(template.header)}; it is another export: give it a "
                "template of its own"
            )


def distinct(texts: Sequence[str]) -> tuple[str, ...]:
    """Header texts with the later ones of a name numbered.

    >>> distinct(["t", "roll", "roll"])
    ('t', 'roll', 'roll#2')
    """
    seen: dict[str, int] = {}
    names = []
    for text in texts:
        seen[text] = seen.get(text, 0) + 1
        names.append(text if seen[text] == 1 else f"{text}#{seen[text]}")
    return tuple(names)


def _content(path: Path) -> str:
    try:
        return user_files.text(path)
    except OSError as error:
        raise LogError(f"{path}: the template cannot be read ({error.strerror})") from error
    except UnicodeDecodeError as error:
        raise LogError(f"{path}: not TOML: not UTF-8 text (byte {error.start})") from error


def _complaint(path: Path, error: ValidationError) -> str:
    """The first mistake, a misspelt key before what it leaves missing."""
    wrong = sorted(error.errors(), key=lambda one: one["type"] != "extra_forbidden")
    first = wrong[0]
    key = ".".join(_key(step) for step in first["loc"]) or "template"
    more = f" (and {len(wrong) - 1} more)" if len(wrong) > 1 else ""
    return " ".join(f"{path}: {key}: {_sentence(first)}{more}".split())


def _sentence(one: Any) -> str:
    if one["type"] == "extra_forbidden":
        *parents, key = one["loc"]
        return f"unknown key; {nearest(str(key), _keys(parents))}"
    if one["type"] == "missing":
        return "missing; a template needs it"
    if one["type"] == "value_error":
        return str(one["ctx"]["error"])
    return f"{one['msg'].replace('Input should be', 'must be')}, got {one['input']!r:.60}"


def _keys(parents: Sequence[str | int]) -> list[str]:
    inside: Mapping[str, type[Section]] = {"time": Time, "columns": Column}
    section = inside.get(str(parents[0]) if parents else "", Template)
    return list(section.model_fields)


def _key(step: str | int) -> str:
    text = str(step)
    return text if re.fullmatch(r"[\w-]+", text, re.ASCII) else quote(text)
