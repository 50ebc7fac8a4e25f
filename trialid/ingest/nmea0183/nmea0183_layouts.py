"""How what a sentence of NMEA 0183 holds is written down: fields, units, sides, status."""

from dataclasses import dataclass
from typing import Literal

Side = Literal["starboard", "port"]
Letter = tuple[int, str]
"""Number of a field of one letter, and the letters it may be."""


@dataclass(frozen=True)
class Field:
    """One number of a sentence, in field `at`; the address is field 0.

    Parameters
    ----------
    status
        Field that says whether the number is valid, and the letters for valid; an empty one says
        nothing.
    mark
        Field that names the unit or the reference, and the letter it has to be when it is not
        empty; anything else is another layout, no value.
    only
        Field and letter of the sentences that hold this number; others hold another one.
    side
        Field whose letter gives the sign: the first of the two plus, the second minus.
    unit_at
        Field whose letter gives the unit, by `units`.
    fix
        Field that says how a position was found, and the letters for a fix by satellites; an empty
        one says nothing.
    minutes
        Whether the number is dddmm.mmmm, degrees and minutes.
    """

    name: str
    at: int
    unit: str | None
    words: str
    quantity: str | None = None
    positive: Side | None = None
    status: Letter | None = None
    mark: Letter | None = None
    only: Letter | None = None
    side: Letter | None = None
    unit_at: int | None = None
    units: tuple[tuple[str, str], ...] = ()
    fix: Letter | None = None
    minutes: bool = False


@dataclass(frozen=True)
class Layout:
    """A sentence: `kind` is the word in its second field where that says what it is.

    `instance` are fields that number the device; `fields` how many fields it must have at least,
    and `at_most` at most.
    """

    words: str
    fields: tuple[Field, ...]
    kind: str | None = None
    instance: tuple[int, ...] = ()
    at_most: int | None = None
