"""What is to be known beside a fleet's changes: order, copies, models, and what is missing since.

None of it is a change of a ship's parameter, and each may stand behind one that is told.
"""

import re
from collections.abc import Callable, Hashable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, TypeVar

import numpy as np
from scipy.stats import fisher_exact

from trialid.fleet.changes.changes_of_ships import FEWEST, LEVEL, is_sound, with_a_say
from trialid.fleet.changes.courses import EITHER_SIDE
from trialid.fleet.plan import is_no_day
from trialid.names import wording
from trialid.result.fleet_rows import Remark, RunRow

SHORT: Final = 0.25
"""Share of the samples that the same log of her other voyages usually has below which one is told.
An outsider's, cut off after 19 of 321, was fitted among them without a word; half and twice tell
the same there."""

NAMED: Final = 3
"""Voyages or effects that a line names before it only counts them."""

Key = TypeVar("Key", bound=Hashable)
Names = tuple[str, ...]


def remarks(runs: Sequence[RunRow]) -> tuple[Remark, ...]:
    """Every line, ship by ship; a voyage done in several ways counts once."""
    voyages = {(row.ship, row.voyage): row for row in reversed(runs)}  # of each its first run
    ordered = [row for row in dict.fromkeys(runs) if voyages[row.ship, row.voyage] is row]
    ships = _grouped(ordered, lambda row: row.ship)
    told = (
        Remark(ship=ship, words=words)
        for ship, rows in ships.items()
        for tell in (_dates, _copies, _cut_short, _models, _no_fit_since, _missing_since)
        for words in tell(rows)
    )
    return *told, *_too_few(ships)


def _too_few(ships: Mapping[str, Sequence[RunRow]]) -> Iterator[Remark]:
    """The ships of several voyages in which no changes are sought."""
    short = [
        ship for ship, rows in ships.items() if len(rows) > 1 and len(with_a_say(rows)) < FEWEST
    ]
    if short:
        yield Remark(
            ship=_few(short),
            words=f"no changes are sought: it takes {FEWEST} voyages with a fit and, where any has "
            "a date, with one",
        )


def _grouped(rows: Sequence[RunRow], key: Callable[[RunRow], Key]) -> dict[Key, list[RunRow]]:
    found: dict[Key, list[RunRow]] = {}
    for row in rows:
        found.setdefault(key(row), []).append(row)
    return found


def _dates(rows: Sequence[RunRow]) -> Iterator[str]:
    """In which order the voyages are, and which of them have no place in it."""
    for row in rows:
        if row.date is None and is_no_day(row.voyage):
            yield f"{row.voyage} begins with no day of the calendar; write when it was into dates"
    sound = [row for row in rows if is_sound(row)]
    undated = [row.voyage for row in sound if row.date is None]
    if len(sound) < FEWEST or not undated:
        return
    if len(undated) == len(sound):
        yield (
            "no voyage has a date: they are in the order of their names, "
            f"{undated[0]} to {undated[-1]}"
        )
        return
    yield (
        f"{len(undated)} of {len(sound)} voyages have no date, and no say in her changes: "
        f"{_few(undated)}"
    )


def _few(names: Sequence[str], last: str = "and") -> str:
    """Some names in words.

    >>> _few(["a", "b"]), _few(["a", "b", "c", "d", "e"])
    ('a and b', 'a, b, c and 2 more')
    """
    more = [f"{len(names) - NAMED} more"] if len(names) > NAMED else []
    *first, end = [*names[:NAMED], *more]
    return f"{', '.join(first)} {last} {end}" if first else end


def _copies(rows: Sequence[RunRow]) -> Iterator[str]:
    """Voyages that hold the same log."""
    holders: dict[str, list[str]] = {}
    for row in rows:
        for log in dict.fromkeys((row.logs or "").split(", ")):
            holders.setdefault(log, []).append(row.voyage)
    holders.pop("", None)
    alike = {tuple(voyages) for voyages in holders.values() if len(voyages) > 1}
    if alike:
        told = _few([" = ".join(voyages) for voyages in sorted(alike)])
        yield f"voyages hold the same log, and count as if they were independent: {told}"


def _cut_short(rows: Sequence[RunRow]) -> Iterator[str]:
    """Voyages one of whose logs holds far less than it does in the others."""
    done = {row.voyage: row for row in rows if row.failure is None and _samples(row)}
    for own in _grouped(list(done.values()), lambda row: len(_samples(row))).values():
        for row in own:
            others = [_samples(other) for other in own if other is not row]
            usual = np.median(others, axis=0) if others else np.zeros(len(_samples(row)))
            for place, (found, most) in enumerate(zip(_samples(row), usual, strict=True), 1):
                if found <= SHORT * most:
                    yield (
                        f"{row.voyage}: log {place} of {len(usual)} has {found} samples, in her "
                        f"other voyages {most:.0f}: was it cut off?"
                    )


def _samples(row: RunRow) -> list[int]:
    """How many samples each of its trials has."""
    return [int(n) for n in re.findall(r":(\d+)(?:, |$)", row.logs or "")]


def _models(rows: Sequence[RunRow]) -> Iterator[str]:
    """How the models of her voyages differ."""
    (effects, free), *others = models = _grouped(
        [row for row in rows if is_sound(row)] or list(rows), lambda row: row.model
    )
    if not others:
        return
    own = models[effects, free]
    have = wording.count_of(len(own), "voyage has", "voyages have")
    told = [f"{have} that of {own[0].voyage}"]
    for other in others:
        differs = [
            *(f"with {name}" for name in sorted(other[0] - effects)),
            *(f"without {name}" for name in sorted(effects - other[0])),
            *(f"{name} free" for name in sorted(other[1] - free)),
            *(f"{name} not free" for name in sorted(free - other[1])),
        ]
        one = models[other]
        told.append(f"{len(one)} that of {one[0].voyage}, {', '.join(differs)}")
    yield f"her models differ, and changes are sought within each: {'; '.join(told)}"


@dataclass(frozen=True, kw_only=True)
class Since:
    """Effects that are missing from a voyage on, or no longer: in how many after it and before."""

    p_value: float
    effects: tuple[str, ...]
    first: int
    after: int
    before: int


def _no_fit_since(rows: Sequence[RunRow]) -> Iterator[str]:
    """That from some voyage on her runs have no fit, where they had, or the other way round."""
    dated = any(row.date is not None for row in rows)
    own = [row for row in rows if row.failure is None and (row.date is not None or not dated)]
    without = {tuple(row.verdict == "no fit" for row in own): ("no fit",)}
    since = _since(own, without)
    if since is not None and since.p_value <= LEVEL:
        yield (
            f"from {own[since.first].voyage} on {since.after} of {len(own) - since.first} runs "
            f"have no fit, before {since.before} of {since.first}: something is another since, a "
            "sensor, a unit or the ship; runs without a fit have no say in changes"
        )


def _missing_since(rows: Sequence[RunRow]) -> Iterator[str]:
    """An effect that is missing from some voyage on, or no longer, in each model."""
    for own in _grouped(with_a_say(rows), lambda row: row.model).values():
        since = _since(own, _patterns(own))
        if since is None or since.p_value > LEVEL:
            continue
        yield (
            f"from {own[since.first].voyage} on {_few(since.effects, 'or')} is missing in "
            f"{since.after} of {len(own) - since.first}, before in {since.before} of "
            f"{since.first}: a change of that may stand in the changes told"
        )


def _since(rows: Sequence[RunRow], patterns: Mapping[tuple[bool, ...], Names]) -> Since | None:
    """The pattern and voyage that part her record most; chance is that of all that were tried."""
    splits = range(EITHER_SIDE, len(rows) - EITHER_SIDE + 1)
    found = []
    for missing, effects in patterns.items():
        for first in splits:
            after, before = sum(missing[first:]), sum(missing[:first])
            table = [[after, len(rows) - first - after], [before, first - before]]
            p_value = float(fisher_exact(table).pvalue) * len(patterns) * len(splits)
            found.append(
                Since(p_value=p_value, effects=effects, first=first, after=after, before=before)
            )
    return min(found, key=lambda each: each.p_value, default=None)


def _patterns(rows: Sequence[RunRow]) -> dict[tuple[bool, ...], tuple[str, ...]]:
    """In which voyages effects are missing or not to be told from it, those alike together."""
    families = [row.family or "" if row.verdict == "missing" else "" for row in rows]
    held = [family.split(", ") for family in families]
    named = [row.effect for row in rows if row.verdict == "missing"]
    found: dict[tuple[bool, ...], tuple[str, ...]] = {}
    every = {name for family in held for name in family if name}
    for name in sorted(every, key=lambda name: (-named.count(name), name)):
        missing = tuple(name in family for family in held)
        found[missing] = (*found.get(missing, ()), name)
    return found
