"""A table's columns as channels on the clock the table states."""

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from trialid.arrays import Vector
from trialid.errors import LogError, UnitError
from trialid.ingest.adapter import Aids, Wanted, is_wanted, sha256
from trialid.ingest.tables.clock import table_clock
from trialid.ingest.tables.clock.table_time import Clock
from trialid.ingest.tables.long_table import (
    LongColumns,
    columns_by_name,
    key_columns,
    one_value_a_row,
    values_of,
)
from trialid.ingest.tables.table import Head, Table, check_width, numbers
from trialid.ingest.tables.templates.template import Template
from trialid.ingest.tables.written.hemispheres import beside_position, hemispheres
from trialid.ingest.tables.written.written_angles import written_angles
from trialid.ingest.tables.written.written_sides import written_sides
from trialid.names import units
from trialid.names.quantities import SIGNALS
from trialid.recording import OF_TEXT, Channel, Recording

LONGEST_UNIT = 16
"""Characters; what is longer is a remark and no unit to look up."""


def recording(
    table: Table, adapter: str, wanted: Wanted, aids: Aids, template: Template | None = None
) -> Recording:
    """The wanted columns as channels; LogError names the place of what cannot be read."""
    renamed = table if template is None else _by_template(table, template)
    _once(renamed)
    spec = None if template is None else template.time
    clock = table_clock.clock(renamed, spec, aids.zone)
    remarks = [*table.remarks, *clock.remarks]
    if template is None and (found := one_value_a_row(table.heads)) is not None:
        return _by_name(table, found, clock, adapter, wanted)
    channels: dict[str, Channel] = {}
    named = _quantities(renamed.heads)
    data = [i for i in range(len(renamed.heads)) if i not in clock.columns]
    sided = hemispheres(renamed, data)
    for i in data:
        one = renamed.heads[i]
        if not is_wanted(one.name, wanted):
            continue
        channel = _of_earth(one, clock, *sided[i]) if i in sided else _channel(renamed, i, clock)
        if channel is None:
            told = () if i - 1 in sided else (f"column {one.name!r} {OF_TEXT}",)
            remarks.extend(told)
            continue
        if channel.description:
            remarks.append(f"column {one.name!r}: {channel.description}")
        channels[one.name] = replace(channel, quantity=named.get(one.name))
    return Recording(table.path, adapter, sha256(table.path), channels, tuple(remarks))


def _by_name(
    table: Table, of: LongColumns, clock: Clock, adapter: str, wanted: Wanted
) -> Recording:
    """One value a row: each name a channel, with the stamps of its rows."""
    remarks = [*table.remarks, *clock.remarks]
    made: dict[str, tuple[Head, Channel]] = {}
    for one, alone, rows in columns_by_name(table, of):
        if not is_wanted(one.name, wanted):
            continue
        y = values_of(alone, of)
        if y is None:
            remarks.append(f"{one.name!r} {OF_TEXT}")
            continue
        made[one.name] = one, Channel(one.name, clock.t[rows], y, one.unit, clock.words)
    named = _quantities(tuple(one for one, _ in made.values()))
    channels = {name: replace(one, quantity=named.get(name)) for name, (_, one) in made.items()}
    check_width(table.path, len(channels))
    return Recording(table.path, adapter, sha256(table.path), channels, tuple(remarks))


def _channel(table: Table, place: int, clock: Clock) -> Channel | None:
    """A column as a channel, its quantity left open; None where it is text."""
    one, y = table.heads[place], numbers(table, place)
    if y is not None:
        return Channel(one.name, clock.t, y, one.unit, clock.words)
    cells = table.columns[place].tolist()
    if (sided := written_sides(cells, _has_side(one))) is not None:
        words = "numbers with their side as text, positive to starboard"
        return Channel(
            one.name, clock.t, sided, one.unit, clock.words, description=words, positive="starboard"
        )
    if (angles := written_angles(cells)) is None:
        return None
    words = f"{angles[1]}, its degrees and minutes as text"
    return Channel(one.name, clock.t, angles[0], "deg", clock.words, description=words)


def _of_earth(one: Head, clock: Clock, angles: Vector, axis: str) -> Channel:
    words = f"{axis}, its side in the next column"
    return Channel(one.name, clock.t, angles, "deg", clock.words, description=words)


def columns_to_read(heads: Sequence[Head], wanted: Wanted, template: Template | None) -> set[int]:
    """The columns whose values are looked at: those wanted, and any that may tell the time."""
    if template is None:
        named = heads
        timed = {*table_clock.columns_of_time(heads)}
        timed |= {i for i, one in enumerate(heads) if one.name in table_clock.UNNAMED}
        timed |= key_columns(heads)
    else:
        named = [_as_told(one, template) for one in heads]
        timed = {i for i, one in enumerate(heads) if one.text in template.time.columns}
    asked = {i for i, one in enumerate(named) if is_wanted(one.name, wanted)}
    sides = {i for i in beside_position(named) if i - 1 in asked}
    return timed | asked | sides


def _by_template(table: Table, template: Template) -> Table:
    heads = tuple(_as_told(one, template) for one in table.heads)
    return replace(table, heads=heads)


def _as_told(one: Head, template: Template) -> Head:
    told = template.columns.get(one.text)
    if told is None:
        return one
    return Head(one.text, told.rename or one.name, told.unit or one.unit)


def _once(table: Table) -> None:
    check_width(table.path, len(table.heads))
    counts = Counter(one.name for one in table.heads)
    twice = next((name for name, count in counts.items() if count > 1), None)
    if twice is not None:
        raise LogError(
            f"{table.path}: column {twice!r} stands twice in the header; rename one, here or by a "
            "template"
        )


def _quantities(heads: tuple[Head, ...]) -> Mapping[str, str]:
    """Which quantity of the dictionary a column is, where its name says so and no other's does."""
    found = [(one.name, quantity) for one in heads for quantity in _quantity(one)]
    counts = Counter(quantity for _, quantity in found)
    return {name: quantity for name, quantity in found if counts[quantity] == 1}


def _quantity(one: Head) -> Iterator[str]:
    """A name of one letter may mean anything: only with a unit that fits."""
    bare = one.name.rpartition(".")[2]
    alias = re.sub(r"\W+", "_", bare.lower())
    for name, quantity in SIGNALS.items():
        known = bare == name or alias in quantity.aliases
        if name != "t" and known and _fits(one.unit, quantity.unit, surely=len(bare) == 1):
            yield name


def _has_side(one: Head) -> bool:
    return any(SIGNALS[name].mirror < 0 for name in _quantity(one))


def _fits(unit: str | None, si: str, surely: bool) -> bool:
    if unit is None:
        return not surely
    if len(unit) > LONGEST_UNIT or re.search(r"\d\d", unit):
        return False
    try:
        units.factor(unit, si)
    except UnitError:
        return False
    return True
