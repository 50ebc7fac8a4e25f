"""What the messages of an ArduPilot dataflash log are made of, as its own FMT messages say.

A message is `A3 95`, its type, and columns without gaps, little endian. FMT (type 128) gives type,
length, name, one character a column, and the columns' names. FMTU gives one unit and one multiplier
a column, as characters that UNIT and MULT explain. Source: AP_Logger, LogStructure.h.
"""

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

HEADER = 3
FMT = 128
FMT_LENGTH = 89
FMT_START = b"\xa3\x95\x80"

CODES = {
    "a": "V64", "b": "i1", "B": "u1", "g": "<f2", "h": "<i2", "H": "<u2", "i": "<i4", "I": "<u4",
    "f": "<f4", "d": "<f8", "n": "S4", "N": "S16", "Z": "S64", "c": "<i2", "C": "<u2", "e": "<i4",
    "E": "<u4", "L": "<i4", "M": "u1", "q": "<i8", "Q": "<u8",
}  # fmt: skip
"""Column character to numpy type; `a` is an array of 32 numbers, `n`, `N` and `Z` are texts."""
DIVISORS = {"c": 1e2, "C": 1e2, "e": 1e2, "E": 1e2, "L": 1e7}
"""What a column of these characters is to be divided by."""
NOT_NUMBERS = frozenset("anNZ")

NARROW = frozenset("bBM")
"""Characters of columns of one byte, which may hold the number of a device."""

NAME = re.compile(r"[A-Z][A-Z0-9_]{0,3}")
INSTANCE = "#"
"""Unit character of the column that says which of several devices a message is from."""


@dataclass(frozen=True)
class Layout:
    """One message type; `units` and `factors` are by column, empty where the log states none."""

    number: int
    length: int
    name: str
    codes: str
    columns: tuple[str, ...]
    units: tuple[str, ...] = ()
    factors: tuple[float, ...] = ()
    instance: int | None = None

    @property
    def offsets(self) -> tuple[int, ...]:
        """Where each column begins in a message [bytes]."""
        sizes = [np.dtype(CODES[code]).itemsize for code in self.codes[:-1]]
        return tuple(int(at) for at in np.cumsum([HEADER, *sizes]))

    @property
    def clock(self) -> str | None:
        """The column that is the time since boot, if the first one is."""
        first = (self.columns[0], self.codes[0])
        return self.columns[0] if first in {("TimeUS", "Q"), ("TimeMS", "I")} else None

    @property
    def numbers(self) -> tuple[int, ...]:
        """The columns that hold one number, without the time and the instance."""
        left_out = {self.instance} | ({0} if self.clock else set())
        whole = enumerate(self.codes)
        return tuple(i for i, code in whole if code not in NOT_NUMBERS and i not in left_out)


FMT_LAYOUT = Layout(
    FMT, FMT_LENGTH, "FMT", "BBnNZ", ("Type", "Length", "Name", "Format", "Columns")
)


def layout(message: bytes) -> Layout | None:
    r"""What an FMT message says; None when it cannot be one.

    >>> row = b"B" + bytes([12]) + b"EV\0\0" + b"QB".ljust(16, b"\0")
    >>> layout(FMT_START + row + b"TimeUS,Id".ljust(64, b"\0")).columns
    ('TimeUS', 'Id')
    >>> layout(FMT_START + row + b"TimeUS".ljust(64, b"\0")) is None
    True
    """
    if len(message) < FMT_LENGTH:
        return None
    number, length = message[3], message[4]
    name, codes, columns = (_text(message[a:b]) for a, b in ((5, 9), (9, 25), (25, 89)))
    names = tuple(columns.split(","))
    if not NAME.fullmatch(name) or not codes or not set(codes) <= CODES.keys():
        return None
    size = HEADER + sum(np.dtype(CODES[code]).itemsize for code in codes)
    whole = len(names) == len(set(names)) == len(codes) and all(names)
    return Layout(number, length, name, codes, names) if whole and size == length else None


def _text(raw: bytes) -> str:
    return raw.split(b"\0")[0].decode("latin-1")


@dataclass(frozen=True)
class Unit:
    """Meaning of the unit and multiplier characters, by the log's UNIT and MULT messages."""

    labels: Mapping[str, str]
    factors: Mapping[str, float]


def unit_tables(unit: Mapping[str, NDArray[Any]], mult: Mapping[str, NDArray[Any]]) -> Unit:
    """From the columns Id and Label of UNIT, Id and Mult of MULT."""
    labels = {chr(i % 256): _text(bytes(text)) for i, text in _pairs(unit, "Label")}
    factors = {chr(i % 256): float(f"{mult:.7g}") for i, mult in _pairs(mult, "Mult")}
    return Unit(labels, factors)


def _pairs(columns: Mapping[str, NDArray[Any]], value: str) -> Iterable[tuple[int, Any]]:
    if not {"Id", value} <= columns.keys():
        return ()
    return zip(columns["Id"].tolist(), columns[value].tolist(), strict=True)


def with_units(one: Layout, unit_ids: str, factor_ids: str, tables: Unit) -> Layout:
    """The layout with the units FMTU gives it.

    A column whose character has a divisor of its own is scaled by that, not twice.
    """
    columns = range(len(one.columns))
    units = [tables.labels.get(unit_ids[i : i + 1], "") for i in columns]
    factors = [_factor(one.codes[i], factor_ids[i : i + 1], tables) for i in columns]
    found = unit_ids.find(INSTANCE)
    narrow = 0 <= found < len(one.columns) and one.codes[found] in NARROW
    instance = found if narrow else None
    return replace(one, units=tuple(units), factors=tuple(factors), instance=instance)


def _factor(code: str, factor_id: str, tables: Unit) -> float:
    """The multiplier; zero and what is not listed mean that there is none."""
    return 1.0 if code in DIVISORS else tables.factors.get(factor_id, 1.0) or 1.0


def with_usual_instance(one: Layout, names: Sequence[str]) -> Layout:
    """The layout of a log that does not say which column tells devices apart."""
    columns = zip(one.columns, one.codes, strict=True)
    usual = (i for i, (name, code) in enumerate(columns) if name in names and code in NARROW)
    return replace(one, instance=next(usual, None))


def scale_column(one: Layout, column: int, raw: NDArray[Any]) -> NDArray[np.float64]:
    """A column as physical numbers in its unit; (N,)."""
    y = raw.astype(np.float64)
    divisor = DIVISORS.get(one.codes[column])
    if divisor:
        return y / divisor
    factor = one.factors[column] if one.factors else 1.0
    return y if factor == 1.0 else y * factor
