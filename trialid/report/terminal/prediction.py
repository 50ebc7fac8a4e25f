"""A predicted manoeuvre for a terminal: its numbers, how far motions go, what to know of it."""

from collections.abc import Iterator, Sequence
from typing import Any, Final

import numpy as np

from trialid.design.prediction.ranged_motion import TRACK, PredictedMotion
from trialid.names import labels
from trialid.report.terminal.terminal import Words, add_row, new_table, number

DIGITS: Final = 4
ROUNDED: Final = 1e-9
"""Less of the width of its range is what rounding left of 0: a drift of -4e-16 m of a stop."""

LINES: Final = 6
"""Lines that a sentence may take."""


def prediction_table(name: str, made: PredictedMotion, words: Sequence[str]) -> Iterator[Any]:
    """What was predicted, and every sentence that belongs beside it."""
    for sentence in words:
        yield Words(sentence, LINES)
    yield f"{name}, {made.t[-1]:.0f} s: what she does, delays and offsets of sensors apart"
    if made.numbers:
        table = new_table("", "value", "likely from", "to", words=1)
        for label, (value, ends) in made.numbers.items():
            add_row(table, label, *_ranged(value, ends))
        yield table
    if made.remark:
        yield Words(f"Not come to: {made.remark}.", LINES)
    table = new_table("farthest from its beginning", "unit", "value", "likely from", "to", words=2)
    for signal in (s for s in made.motion if s not in TRACK and s != "psi"):
        add_row(table, *_largest(made, signal))
    yield table


def _ranged(value: float, ends: tuple[float, float] | None) -> tuple[str, ...]:
    """A number with its range, which may not be known."""
    if ends is None:
        return number(value, DIGITS), number(None, DIGITS), number(None, DIGITS)
    shown = 0.0 if abs(value) < ROUNDED * (ends[1] - ends[0]) else value
    return tuple(number(x, DIGITS) for x in (shown, *ends))


def _largest(made: PredictedMotion, signal: str) -> tuple[str, ...]:
    """A motion where it is farthest from where it begins, and how far its ends go to that side.

    Not its range at that time: it may be farthest at another.
    """
    motion = made.motion[signal]
    there, away = np.isfinite(motion), motion - motion[0]
    most = np.max if away[np.nanargmax(np.abs(away))] >= 0.0 else np.min
    factor = labels.shown_factor(signal)
    known = [factor * float(most(x[there])) for x in (motion, *made.ranges[signal])]
    shown = (number(x if np.isfinite(x) else None, DIGITS) for x in known)
    return (labels.label(signal), labels.shown_unit(signal), *shown)
