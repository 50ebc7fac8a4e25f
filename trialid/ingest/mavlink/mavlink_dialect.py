"""What MAVLink messages are made of, as pymavlink's tables of the dialects say.

Fields travel in another order than they are named in, without gaps, little endian; MAVLink 2 cuts
the zeros off the end of a message. Source: mavlink.io, serialization; the definitions in XML say
besides which value of a field stands for `not known`.
"""

import functools
import math
import re
import xml.etree.ElementTree as ET
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

CODES = {
    "c": "S1", "b": "i1", "B": "u1", "h": "<i2", "H": "<u2", "i": "<i4", "I": "<u4",
    "q": "<i8", "Q": "<u8", "f": "<f4", "d": "<f8",
}  # fmt: skip
"""Character of pymavlink's format to numpy type."""
LIMIT = re.compile(r"(U?)INT(8|16|32|64)_MAX")

CLOCKS = ("time_boot_ms", "time_usec")
"""Fields that are the sender's own time, the surer one first."""


@dataclass(frozen=True)
class Field:
    """One field; `unknown` is the value that stands for `not known`, None where there is none."""

    name: str
    unit: str
    count: int
    text: bool
    unknown: float | None


@dataclass(frozen=True)
class Definition:
    """One message; `instance` is the field that tells devices apart, `clock` the sender's time."""

    number: int
    name: str
    check: int
    kind: np.dtype[Any]
    fields: tuple[Field, ...]
    instance: str | None
    clock: str | None

    @property
    def numbers(self) -> tuple[Field, ...]:
        """The fields that hold numbers, without the time and the instance."""
        left_out = (self.clock, self.instance)
        return tuple(one for one in self.fields if not one.text and one.name not in left_out)


@functools.cache
def definitions() -> Mapping[int, Definition]:
    """All messages of all dialects that can live together, by number."""
    from pymavlink.dialects.v20 import all as dialect

    unknown = _unknown(Path(dialect.__file__).with_name("all.xml"))
    return {number: _definition(one, unknown) for number, one in dialect.mavlink_map.items()}


def _definition(message: Any, unknown: Mapping[tuple[str, str], str]) -> Definition:
    codes = message.native_format.decode()[1:]
    counts = [max(1, n) for n in message.array_lengths]
    rows = list(zip(message.ordered_fieldnames, codes, counts, strict=True))
    name = message.msgname
    kind = np.dtype([_column(*row) for row in rows])
    fields = tuple(
        Field(
            field,
            message.fieldunits_by_name.get(field, ""),
            count,
            code == "c",
            _number(unknown.get((name, field), "")),
        )
        for field, code, count in rows
    )
    names = message.ordered_fieldnames
    clock = next((one for one in CLOCKS if one in names), None)
    return Definition(
        number=message.id,
        name=name,
        check=message.crc_extra,
        kind=kind,
        fields=fields,
        instance=message.instance_field,
        clock=clock,
    )


def _column(name: str, code: str, count: int) -> tuple[str, str] | tuple[str, str, tuple[int]]:
    if code == "c":
        return name, f"S{count}"
    return (name, CODES[code], (count,)) if count > 1 else (name, CODES[code])


def _unknown(path: Path) -> dict[tuple[str, str], str]:
    """Text of the attribute `invalid` by message and field, of a definition and all it includes."""
    found: dict[tuple[str, str], str] = {}
    left, seen = [path.name], set()
    while left:
        name = left.pop()
        file = path.with_name(name)
        if name in seen or not file.exists():
            continue
        seen.add(name)
        root = ET.parse(file).getroot()
        left += [include.text or "" for include in root.iter("include")]
        found.update(_of_file(root))
    return found


def _of_file(root: ET.Element) -> Iterator[tuple[tuple[str, str], str]]:
    for message in root.iter("message"):
        for field in message.iter("field"):
            if "invalid" in field.attrib:
                key = (message.attrib["name"], field.attrib["name"])
                yield key, field.attrib["invalid"]


def _number(text: str) -> float | None:
    """The value an attribute `invalid` means; None for none and for names of enumerations.

    >>> _number("UINT16_MAX"), _number("[INT16_MAX]"), _number("-1"), _number("")
    (65535.0, 32767.0, -1.0, None)
    """
    bare = text.strip("[]").rstrip(":,")
    limit = LIMIT.fullmatch(bare)
    if limit:
        bits = int(limit[2]) - (0 if limit[1] else 1)
        return float(2**bits - 1)
    try:
        value = float(int(bare, 16)) if bare.startswith("0x") else float(bare)
    except ValueError:
        return None
    return None if math.isnan(value) else value


def known_values(field: Field, y: NDArray[Any]) -> NDArray[np.float64]:
    """The numbers of a field, NaN where they stand for `not known`; (N,)."""
    numbers = y.astype(np.float64)
    return numbers if field.unknown is None else np.where(y == field.unknown, np.nan, numbers)
