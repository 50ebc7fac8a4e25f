"""The messages of a dataflash log by kind: which columns to gather, their units and stamps."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trialid.ingest.adapter import Wanted
from trialid.ingest.mavlink import dataflash_layout, servo_deflection
from trialid.ingest.mavlink.dataflash_layout import Layout
from trialid.ingest.mavlink.dataflash_walk import Gathered

TABLES = frozenset({"FMT", "FMTU", "UNIT", "MULT", "PARM", "FILE"})
"""Messages that describe the log or the autopilot: their numbers are no measurements."""
READ_ALWAYS = {
    "FMTU": None, "UNIT": None, "MULT": None, "MODE": None, "ARM": None,
    "PARM": ("TimeUS", "TimeMS", "Name", "Value"),
    "MSG": ("TimeUS", "TimeMS", "Message"),
    "GPS": ("TimeUS", "Status", "GMS", "GWk"),
}  # fmt: skip
"""What remarks and units need, whatever is wanted; None for all columns."""
OUTPUTS = ("RCOU", "RCO2", "RCO3")
INSTANCES = ("I", "Instance", "C")
"""What the column that tells devices apart is called, in logs that do not say."""
Stamps = tuple[NDArray[np.int64], NDArray[np.bool_]]
LONGEST_US = 10 * 365 * 86_400 * 10**6
"""Ten years: no autopilot has been on for so long."""


@dataclass(frozen=True)
class Log:
    """Message types with their units, and the columns that were gathered."""

    known: Mapping[int, Layout]
    gathered: Gathered
    stamps: dict[int, Stamps] = field(default_factory=dict)

    def times(self, number: int) -> Stamps:
        """Stamps [ns] of a message type since boot, and which of them can be true; (N,) both."""
        if number not in self.stamps:
            raw = self.gathered.column(number, 0)
            del self.gathered.columns[number][0]
            self.stamps[number] = _stamps(self.known[number], raw)
        return self.stamps[number]

    def forget(self, number: int) -> None:
        """Give the memory of a message type free that nobody asks for again."""
        if self.known[number].name not in {*READ_ALWAYS, *OUTPUTS}:
            self.gathered.columns[number] = {}
            del self.stamps[number]

    def number(self, name: str) -> int | None:
        """Number of the message type that was logged under this name."""
        found = [n for n, one in self.known.items() if one.name == name]
        return max(found, key=lambda n: int(self.gathered.counts[n]), default=None)

    def table(self, name: str) -> dict[str, NDArray[Any]]:
        """The gathered columns of a message but its clock, by their names, raw; (N,) each."""
        number = self.number(name)
        if number is None:
            return {}
        columns = self.gathered.columns.get(number, {})
        one = self.known[number]
        held = [i for i in columns if i or not one.clock]
        return {one.columns[i]: self.gathered.column(number, i) for i in held}


def columns_to_gather(known: Mapping[int, Layout], wanted: Wanted) -> dict[int, list[int]]:
    """Columns to gather by message type; the clock and what may tell devices apart go with them."""
    found = {}
    for number, one in known.items():
        columns = [i for i in one.numbers if _maybe(one, i, wanted)]
        if one.name in TABLES:
            columns = []
        if one.name in OUTPUTS and _servo_asked(wanted):
            columns = list(one.numbers)
        if one.name in READ_ALWAYS:
            names = READ_ALWAYS[one.name] or one.columns
            columns = [*columns, *(i for i, c in enumerate(one.columns) if c in names)]
        if columns:
            found[number] = sorted({*columns, *narrow_columns(one), 0})
    return found


def narrow_columns(one: Layout) -> list[int]:
    """Columns that may tell devices apart."""
    return [i for i, code in enumerate(one.codes) if code in dataflash_layout.NARROW]


def _maybe(one: Layout, column: int, wanted: Wanted) -> bool:
    """True when a channel of this column may be wanted, of whichever device."""
    name = one.columns[column]
    for want in wanted if wanted is not None else ("",):
        message, colon, field = want.partition(":")
        of_device = message.startswith(f"{one.name}/") and (not colon or name.startswith(field))
        if of_device or f"{one.name}:{name}".startswith(want) or f"{one.name}/".startswith(want):
            return True
    return False


def _servo_asked(wanted: Wanted) -> bool:
    return wanted is None or any(w.startswith("servo"[: len(w)]) for w in wanted)


def with_units(known: Mapping[int, Layout], gathered: Gathered) -> dict[int, Layout]:
    """The message types with what UNIT, MULT and FMTU say of their columns."""
    log = Log(known, gathered)
    tables = dataflash_layout.unit_tables(log.table("UNIT"), log.table("MULT"))
    stated = log.table("FMTU")
    told = dict(known)
    ids = [stated.get(name, np.empty(0)) for name in ("FmtType", "UnitIds", "MultIds")]
    for number, units, factors in zip(*(one.tolist() for one in ids), strict=False):
        if number in known:
            told[number] = dataflash_layout.with_units(
                known[number], units.decode("latin-1"), factors.decode("latin-1"), tables
            )
    usual = dataflash_layout.with_usual_instance
    return {number: one if one.units else usual(one, INSTANCES) for number, one in told.items()}


def _stamps(one: Layout, raw: NDArray[Any]) -> Stamps:
    scale = 1_000 if one.clock == "TimeUS" else 1_000_000
    good = raw <= LONGEST_US * 1_000 // scale
    t = raw.view(np.int64) if raw.dtype.itemsize == 8 else raw.astype(np.int64)
    t[~good] = 0
    t *= scale
    return t, good


def parameters(log: Log) -> servo_deflection.Parameters:
    """Parameters of the autopilot, each with when it was set; none where they carry no time."""
    table = log.table("PARM")
    number = log.number("PARM")
    if number is None or not log.known[number].clock or not {"Name", "Value"} <= table.keys():
        return {}
    t, good = log.times(number)
    names = [name.decode("latin-1") for name in table["Name"][good].tolist()]
    return servo_deflection.parameters(names, t[good], table["Value"][good].astype(np.float64))
