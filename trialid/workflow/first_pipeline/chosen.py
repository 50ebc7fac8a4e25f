"""A signal of a starter pipeline with its reasons, and a trial of such signals."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final, Literal

from trialid.errors import printable
from trialid.inspection.inspected import ChannelInspection, Inspection
from trialid.workflow.first_pipeline.long_log import Window

FIGURES: Final = re.compile(r"\d[\d.e+-]*+")
"""Numbers in a question, which differ from log to log."""

OPEN: Final = "?"
"""Stands where only the user knows; the pipeline does not run until it is replaced."""

Basis = Literal[
    "size", "small", "counts", "measured", "convention", "alike", "denied", "unshown", "asked"
]
"""What a unit or a side rests on, where another log may tell more or be told by it.

`size`: only this unit has such numbers; `small`: so small a rudder may be in another; `counts`: no
unit has, and only the user knows the scale; `measured`: the motion shows it; `convention`: the
format says so, the motion does not; `alike`: little hangs on it; `denied`: the motion denies it;
`unshown`: nothing shows it; `asked`: only the user knows.
"""


@dataclass(frozen=True)
class Reason:
    """Words for a signal's unit or side."""

    words: str
    basis: Basis | None = None

    def rests_on(self, *those: Basis) -> bool:
        """Whether it rests on one of those."""
        return self.basis in those


UNSAID: Final = Reason("")
ASK_UNIT: Final = Reason("FILL IN the unit, the log states none", "asked")
AS_RADIANS: Final = Reason(
    "CAREFUL: no unit is stated: so small a rudder is read in radians; a share of full, with unit "
    '= "deg" and gain = the degrees at full, looks the same',
    "small",
)
OF_FULL: Final = "share of the full deflection"  # as a format says it
ASK_FULL: Final = Reason(
    'FILL IN unit = "deg" and gain = the degrees at full, of which it is a share', "asked"
)
ASK_PERCENT: Final = Reason(
    'FILL IN unit = "deg" and gain = the degrees at full / 100, for it is in %', "asked"
)
ASK_STEERING: Final = Reason(
    'FILL IN unit = "deg", and where it is a share of full or in % gain = the degrees at full, or '
    "those / 100",
    "counts",
)
ASK_COUNTS: Final = (
    'FILL IN unit = "deg", gain = degrees of one count, offset = less what it shows amidships '
    "times gain"
)
ASK_SIDE: Final = Reason(
    "FILL IN starboard or port: the side the ship turns to when it is positive", "asked"
)
CONVENTION: Final = Reason(
    "CAREFUL: side by the format's convention, the motion does not confirm it", "convention"
)
BY_NAME: Final = Reason("unit by its name")


@dataclass(frozen=True, kw_only=True)
class Signal:
    """One line of `[trial.signals]` and its comment; a value may be `OPEN`.

    `taken` says why it is this channel. A speed `over_ground` has drift and current in it.
    """

    quantity: str
    source: ChannelInspection
    unit: str | None
    positive: str | None = None
    taken: str = ""
    of_unit: Reason = UNSAID
    of_side: Reason = UNSAID
    further: tuple[str, ...] = ()
    others: tuple[ChannelInspection, ...] = ()
    over_ground: bool = False

    @property
    def open(self) -> bool:
        """Whether something is left for the user to fill in."""
        return OPEN in (self.unit, self.positive)

    @property
    def why(self) -> str:
        """Its comment."""
        parts = (self.taken, self.of_unit.words, self.of_side.words, *self.further)
        return "; ".join(part for part in parts if part)


@dataclass(frozen=True, kw_only=True)
class Chosen:
    """One trial: its log and signals, and its speed [m/s] with the words for where it is from.

    `made_over_ground` are `u` and `v`, where they are made of what is recorded over the ground.
    `beside` are signals that the log holds and that are left to the user, each with why; `window`
    is the manoeuvre alone, where a log is cut.
    """

    survey: Inspection
    path: Path
    signals: tuple[Signal, ...]
    speed: float | None
    speed_words: str
    beside: tuple[tuple[Signal, str], ...] = ()
    window: Window | None = None
    made_over_ground: frozenset[str] = frozenset()

    @property
    def quantities(self) -> frozenset[str]:
        """Quantities that the log holds, or that are made of what it holds."""
        return self.made_over_ground | {one.quantity for one in self.signals}

    @property
    def name(self) -> str:
        """Its file's, and where it is one manoeuvre of it, that one's."""
        stem = self.path.stem or "trial"
        return stem if self.window is None else f"{stem} {self.window.kind}".rstrip()

    @property
    def over_ground(self) -> bool:
        """Whether the speed is one over ground."""
        return any(one.over_ground for one in self.signals)

    @property
    def states_speed(self) -> bool:
        """Whether no channel is the speed, so that the pipeline must state it."""
        return "u" not in self.quantities

    @property
    def left_beside(self) -> str:
        """Which manoeuvres of its log are no trials, and why; told by the first that is."""
        told = self.window.beside if self.window else ""
        return f"{self.path.name}: {told}" if told else ""


def open_questions(trials: Sequence[Chosen]) -> list[str]:
    """What stays open, each question once, with the log where it stands first and how many have it.

    Of the same channel in several logs the numbers in a question differ, and nothing else.
    """
    asked: dict[tuple[str, str, str], list[str]] = {}
    for one in trials:
        for s in (s for s in one.signals if s.open):
            question = FIGURES.sub("", s.why.partition("FILL IN")[2].partition(";")[0])
            same = asked.setdefault((s.quantity, s.source.name, question), [])
            same += (one.path.name, f": {s.quantity}, {printable(s.why)}")
    return [
        first + (f" and {len(more) // 2} more" if more else "") + words
        for first, words, *more in asked.values()
    ]
