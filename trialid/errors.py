"""The error tree: everything the user can cause is a `TrialidError` with one clear line."""

import difflib
from collections.abc import Iterable, Sequence
from typing import Final

LISTED: Final = 30
"""Names that an error lists before it only counts them."""

LONGEST = 200
"""Letters of a library's message that are passed on."""


class TrialidError(Exception):
    """The input is wrong: what, where, what was expected, what to do. The CLI prints one line.

    Messages quote what files hold, which anybody may have written: they are made `printable`.
    """

    def __init__(self, message: str) -> None:
        super().__init__(printable(_folded(message)))


class LogError(TrialidError):
    """A log file is missing, damaged, of no known format, or lacks a channel."""


class UnitError(TrialidError):
    """A unit text is unknown or does not fit the quantity."""


class AlignmentError(TrialidError):
    """Channels cannot be brought onto one clock, or contradict each other."""


class EffectError(TrialidError):
    """An effect's declaration is incomplete or asks for something unknown."""


class ShipError(TrialidError):
    """A ship file is incomplete or physically impossible."""


class RecipeError(TrialidError):
    """A pipeline file has a wrong key, a wrong value or a contradiction."""


class SimulationError(TrialidError):
    """A simulation left the domain of the model; the message says when and how."""


class NotIdentifiable(TrialidError):
    """The record cannot carry the question: no excitation, too few samples, nothing to compare."""


class DesignError(TrialidError):
    """A test cannot be run as wished, or cannot show what is asked of it."""


def printable(text: str) -> str:
    r"""Text of a file with what could steer a terminal or end a line escaped.

    >>> printable("roll\x1b[31m\n")
    'roll\\x1b[31m\\n'
    """
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in text)


def said(error: Exception) -> str:
    r"""What a library says of a file, for a message of ours: on one line, and not too long of it.

    >>> said(ValueError("bad byte \x0f,\n  at 7")), len(said(ValueError("a" * 5000)))
    ('bad byte \\x0f, at 7', 200)
    """
    return printable(_folded(str(error)))[:LONGEST]


def _folded(text: str) -> str:
    return " ".join(line.strip() for line in text.splitlines())


def nearest(name: str, known: Iterable[str]) -> str:
    """Words for an error about an unknown name: the nearest known ones, else all of them.

    >>> nearest("delat", ["delta", "phi", "r"])
    "did you mean 'delta'?"
    >>> nearest("zz", ["delta", "phi"])
    'known: delta, phi'
    """
    names = sorted(known)
    close = difflib.get_close_matches(name, names, n=3, cutoff=0.6)
    if close:
        return "did you mean " + " or ".join(repr(c) for c in close) + "?"
    return "known: " + listed(names)


def listed(names: Sequence[str]) -> str:
    """Names as words of an error, no more than a line or two of them.

    >>> listed(["delta", "phi"])
    'delta, phi'
    >>> listed([f"column {i}" for i in range(85)]).partition(", column 29")[2]
    ' and 55 more'
    """
    more = f" and {len(names) - LISTED} more" if len(names) > LISTED else ""
    return ", ".join(names[:LISTED]) + more
