"""The error tree: everything the user can cause is a `TrialidError` with one clear line."""

import difflib
import re
from collections.abc import Iterable, Sequence
from typing import Final
from unicodedata import category

LISTED: Final = 30
"""Names that an error lists before it only counts them."""

NEAREST: Final = 3
"""Names that an error proposes."""

ALIKE: Final = 0.6
"""Likeness from which on a name may be the one that was meant; difflib's own limit."""

PART: Final = 0.9
"""What a part of a name counts for beside the whole."""

SHORTEST_PART: Final = 3
"""Letters of a part that can be meant: an `x` is in no name's stead."""

LONGEST = 200
"""Letters of a library's message that are passed on."""


PLAIN: Final = frozenset("\n\t")
SPACING: Final = ("Zs",)
"""Spaces, which Python counts as not printable: thin ones stand before percent signs."""

LONGEST_WORD: Final = 300
"""Letters of a path or a name that a message quotes; a longer one is not read to its end."""

LONGEST_MESSAGE: Final = 1500
"""Letters of a whole message: ten lines of a wide terminal."""


class TrialidError(Exception):
    """The input is wrong: what, where, what was expected, what to do. The CLI prints one line.

    Messages quote what files hold, which anybody may have written: they are made `printable`.
    """

    def __init__(self, message: str) -> None:
        super().__init__(shorten(printable(_folded(message))))


class LogError(TrialidError):
    """A log file is missing, damaged, of no known format, or lacks a channel."""


class UnitError(TrialidError):
    """A unit text is unknown or does not fit the quantity."""


class AlignmentError(TrialidError):
    """Channels cannot be brought onto one clock, or contradict each other."""


class EffectError(TrialidError):
    """An effect's declaration is incomplete or asks for something unknown."""


class PluginError(TrialidError):
    """An installed package adds what cannot be loaded, or what is there already."""


class ShipError(TrialidError):
    """A ship file is incomplete or physically impossible."""


class PipelineError(TrialidError):
    """A pipeline file has a wrong key, a wrong value or a contradiction."""


class SimulationError(TrialidError):
    """A simulation left the domain of the model; the message says when and how."""


class StepsTooLong(SimulationError):
    """Integration left a domain that it stays in with finer steps."""


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


def shorten(text: str) -> str:
    """A message that fits a screen: the middle is left out of what no reader needs whole.

    >>> shorten(f"{'a' * 5000}: no such file") == f"{'a' * 240}...{'a' * 57}: no such file"
    True
    """
    words = [word if len(word) <= LONGEST_WORD else _ends(word, 60) for word in text.split(" ")]
    return _ends(" ".join(words), LONGEST_MESSAGE // 3, LONGEST_MESSAGE)


def _ends(text: str, last: int, most: int = LONGEST_WORD) -> str:
    """The text, its beginning and end alone where it is longer than so many letters."""
    return text if len(text) <= most else f"{text[: most - last]}...{text[len(text) - last + 2 :]}"


def harmless(text: str) -> str:
    r"""A text of several lines with what could steer a terminal escaped; spaces of any width stay.

    >>> harmless("a\x1b[31m\nb\t\u202ec"), harmless("3\u2009%") == "3\u2009%"
    ('a\\x1b[31m\nb\t\\u202ec', True)
    """
    if all(c.isprintable() or c in PLAIN for c in text):
        return text
    return "".join(c if c in PLAIN or category(c) in SPACING else printable(c) for c in text)


def reason_of(error: Exception) -> str:
    r"""What a library says of a file, for a message of ours: on one line, and not too long of it.

    >>> reason_of(ValueError("bad byte \x0f,\n  at 7")), len(reason_of(ValueError("a" * 5000)))
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
    >>> nearest("ferst", ["first_trial", "trust"])
    "did you mean 'first_trial' or 'trust'?"
    >>> nearest("zz", [f"column {i}" for i in range(85)])
    'of 85 known the nearest are column 0, column 1, column 10'
    """
    names = sorted(known)
    likeness = _likenesses(name, names)
    ordered = sorted(names, key=lambda other: -likeness[other])
    if close := [other for other in ordered[:NEAREST] if likeness[other] >= ALIKE]:
        return "did you mean " + " or ".join(repr(c) for c in close) + "?"
    if len(names) > LISTED:
        return f"of {len(names)} known the nearest are {', '.join(ordered[:NEAREST])}"
    return "known: " + list_names(names)


def _likenesses(name: str, names: Sequence[str]) -> dict[str, float]:
    """How alike names are, 0 to 1; one whose part is meant, where no other is as alike in whole."""
    whole = {other: _likeness(name, other) for other in names}
    best = max(whole.values(), default=0.0)
    for other in names:
        parts = [part for part in re.split(r"[_\W]+", other) if len(part) >= SHORTEST_PART]
        alike = max((PART * _likeness(name, part) for part in parts), default=0.0)
        if alike > best:
            whole[other] = alike
    return whole


def _likeness(name: str, other: str) -> float:
    return difflib.SequenceMatcher(None, other.lower(), name.lower()).ratio()


def list_names(names: Sequence[str]) -> str:
    """Names as words of an error, no more than a line or two of them.

    >>> list_names(["delta", "phi"])
    'delta, phi'
    >>> list_names([f"column {i}" for i in range(85)]).partition(", column 29")[2]
    ' and 55 more'
    """
    more = f" and {len(names) - LISTED} more" if len(names) > LISTED else ""
    return ", ".join(names[:LISTED]) + more
