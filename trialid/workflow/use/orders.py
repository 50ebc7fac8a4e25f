"""What a ship is told: a manoeuvre by name and numbers, or a table of orders."""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from trialid import ingest
from trialid.arrays import Vector
from trialid.design import manoeuvres
from trialid.design.helm import Passage
from trialid.design.imo import measures
from trialid.design.prediction.predicted_motion import Manoeuvre
from trialid.design.standard import DEGREES, Reading
from trialid.errors import TrialidError, nearest
from trialid.export.predicted_file import ENDS
from trialid.names import units
from trialid.names.quantities import SIGNALS, Quantity

REVERSALS: Final = 4
LARGEST: Final = 90.0
"""deg beyond which no rudder goes."""
SLOW: Final = 50.0
"""Per cent of the approach speed at which a ship that is stopped counts as slow."""
ASTERN: Final = "astern"
STOPS: Final = "stop [PER CENT of the speed left] [astern]"
FEWEST: Final = 2
TIME: Final = "t"
ORDINALS: Final = ("first", "second", "third")


@dataclass(frozen=True)
class OrderTable:
    """Inputs over time in SI, straight between the times; (N,) each.

    `unknown`: columns beside them whose names no signal has.
    """

    t: Vector
    signals: Mapping[str, Vector]
    unknown: tuple[str, ...] = ()


@dataclass(frozen=True)
class Stop:
    """The engine stopped on a straight course, until the speed has fallen to a share of itself.

    `astern`: ordered astern instead, as a crash stop is.
    """

    share: float
    astern: bool = False

    @property
    def name(self) -> str:
        """As tables call it."""
        return f"stop {100.0 * self.share:g}{f' {ASTERN}' if self.astern else ''}"


def stop_order(words: Sequence[str]) -> Stop | None:
    """`stop` or `stop 20`: until 50, or 20 % of the speed are left; `stop astern`: until none is.

    None for another manoeuvre.

    Raises
    ------
    TrialidError
        Its number is none.
    """
    if words[0] != "stop":
        return None
    astern = words[-1] == ASTERN
    numbers = words[1:-1] if astern else words[1:]
    try:
        left = float(numbers[0]) if len(numbers) == 1 else (0.0 if astern else SLOW)
    except ValueError as error:
        raise TrialidError(f"ORDERS: {STOPS}: {error}") from error
    if len(numbers) > 1 or not (0.0 < left < 100.0 or (astern and left == 0.0)):
        raise TrialidError(f"ORDERS: {' '.join(words)!r}: expected {STOPS}, more than 0, below 100")
    return Stop(left / 100.0, astern)


def named_manoeuvre(words: Sequence[str]) -> Manoeuvre:
    """A manoeuvre from its name and numbers [deg]: `zigzag 20 20`, `circle 35`.

    Raises
    ------
    TrialidError
        There is no such manoeuvre, or its numbers are none.
    """
    name, *numbers = words
    if name not in BY_NAME:
        raise TrialidError(
            f"ORDERS {name!r}: is no file and no manoeuvre; give a CSV of orders, or one of "
            f"{'; '.join(one.usage for one in BY_NAME.values())}; {STOPS} "
            f"({nearest(name, [*BY_NAME, 'stop'])})"
        )
    known = BY_NAME[name]
    try:
        angles = [float(number) for number in numbers]
    except ValueError as error:
        raise TrialidError(f"ORDERS: {known.usage}: {error}") from error
    if not known.fewest <= len(angles) <= known.most:
        raise TrialidError(f"ORDERS: {' '.join(words)!r}: expected {known.usage}, angles in deg")
    wrong = [a for a in angles if not 0.0 < a <= LARGEST]
    if wrong:
        raise TrialidError(
            f"ORDERS: {' '.join(words)!r}: {wrong[0]:g} is no angle of a manoeuvre; expected more "
            f"than 0 and at most {LARGEST:g} deg"
        )
    return known.make(angles)


def _zigzag(angles: Sequence[float]) -> Manoeuvre:
    rudder, heading = angles[0], angles[-1]
    kind = f"{rudder:g}/{heading:g}"
    a, h = float(np.deg2rad(rudder)), float(np.deg2rad(heading))
    overshoots = tuple(f"{n} overshoot {kind} [deg]" for n in ORDINALS)
    names = (f"track to {heading:g} deg of heading [m]", *overshoots)

    def read(passage: Passage, headings: Vector | None) -> list[float]:
        found = [x * DEGREES for x in measures.overshoots(passage, headings)]
        return [measures.initial_turning(passage, h), *found[: len(ORDINALS)]]

    reading = Reading(names, f"zig-zag {kind}", read)
    return Manoeuvre(reading.manoeuvre, lambda: manoeuvres.zigzag(a, h, REVERSALS), reading)


def _circle(angles: Sequence[float]) -> Manoeuvre:
    name = f"turning circle {angles[0]:g}"

    def read(passage: Passage, headings: Vector | None) -> list[float]:
        del headings
        return [*measures.turning(passage).values()]

    names = ("advance [m]", "transfer [m]", "tactical diameter [m]")
    angle = float(np.deg2rad(angles[0]))
    reading = Reading(names, name, read)
    return Manoeuvre(name, lambda: manoeuvres.turning_circle(angle), reading)


@dataclass(frozen=True)
class _Named:
    usage: str
    fewest: int
    most: int
    make: Callable[[Sequence[float]], Manoeuvre]


BY_NAME: Final = {
    "zigzag": _Named("zigzag RUDDER [HEADING]", 1, 2, _zigzag),
    "circle": _Named("circle RUDDER", 1, 1, _circle),
}
"""Manoeuvres that can be asked for by a word."""


def read_orders(path: Path, known: Mapping[str, Quantity] = SIGNALS) -> OrderTable:
    """The orders in a table: a column t, and inputs by their names with their units.

    Names and signs are those of the dictionary, as `delta[deg]`: positive turns the ship to
    starboard; `known` has those of the ship's actuators, too.

    Raises
    ------
    TrialidError
        A column of a known name has no unit, there is no such column, or the times do not rise.
    """
    recording = ingest.read(path)
    signals, t = dict[str, Vector](), None
    for name, channel in recording.channels.items():
        if name not in known or name == TIME:
            continue
        if channel.unit is None:
            raise TrialidError(
                f"{path}: column {name}: no unit; write its header as {name}[{known[name].shown}]"
            )
        signals[name] = channel.y * units.factor(channel.unit, known[name].unit)
        t = channel.t
    if t is None or len(t) < FEWEST:
        raise TrialidError(
            f"{path}: no orders; expected a column t [s] and inputs such as delta[deg], of at "
            f"least {FEWEST} rows; its columns: {', '.join(recording.channels) or 'none'}"
        )
    if not (np.diff(t) > 0).all():
        row = int(np.flatnonzero(np.diff(t) <= 0)[0]) + 2
        raise TrialidError(f"{path}: t does not rise at row {row}; give one manoeuvre in a file")
    unknown = tuple(name for name in recording.channels if _is_unknown(name, known))
    return OrderTable((t - t[0]) / 1e9, signals, unknown)


def _is_unknown(column: str, known: Collection[str]) -> bool:
    """Whether no signal has the name; an end of one's range, as `simulate` writes it, is known."""
    ends = (column.removesuffix(f"_{end}") for end in ENDS)
    return not {column, *ends} & {TIME, *known}


def complete_rows(table: OrderTable, inputs: Collection[str], where: str) -> OrderTable:
    """The rows from the first to the last that has a number of every input; time begins there.

    Of other signals, motions that say how she begins, only the first number counts.

    Raises
    ------
    TrialidError
        A number is missing between them: no gap is bridged.
    """
    needed = [n for n in table.signals if n in inputs]
    full = np.all([np.isfinite(table.signals[n]) for n in needed], axis=0)
    rows = np.flatnonzero(full)
    if len(rows) < FEWEST:
        raise TrialidError(f"{where}: fewer than {FEWEST} rows have a number of {needed}")
    kept = slice(int(rows[0]), int(rows[-1]) + 1)
    if not full[kept].all():
        gap = int(rows[0]) + int(np.flatnonzero(~full[kept])[0])
        name = next(n for n in needed if not np.isfinite(table.signals[n][gap]))
        raise TrialidError(
            f"{where}: column {name}: row {gap + 1} of the orders has no number; fill it, or give "
            "the part before or behind it"
        )
    cut = {n: x[kept] for n, x in table.signals.items()}
    begun = {n: x for n, x in cut.items() if n in needed or np.isfinite(x[0])}
    t = table.t[kept]
    return OrderTable(t - t[0], {n: np.nan_to_num(x) for n, x in begun.items()}, table.unknown)
