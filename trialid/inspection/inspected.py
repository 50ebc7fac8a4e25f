"""What a survey of a log gives: facts about each channel, of its samples no more than a sketch."""

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

from trialid.alignment.clocks import CALENDAR_NS
from trialid.ingest.adapter import NO_AIDS, Aids
from trialid.inspection.sketch import EMPTY, Sketch

How = Literal["format", "exact name", "name", "relation"]


@dataclass(frozen=True)
class Guess:
    """Which quantity a channel is, and how that is known.

    Parameters
    ----------
    quantity
        Name in the dictionary of quantities.
    how
        `format`: the log's format defines it; `exact name`: a column is called as the quantity is;
        `name`: the channel is called so, in other words; `relation`: it moves as the quantity must,
        given another channel.
    words
        The same for a person: `by its name`, `by its relation to psi (correlation 0.98)`.
    positive
        Side the format's own convention counts as positive, where it has one.
    """

    quantity: str
    how: How
    words: str
    positive: Literal["starboard", "port"] | None = None


@dataclass(frozen=True)
class Gaps:
    """Holes in a channel: how many, their sum and the longest [s]."""

    count: int = 0
    total: float = 0.0
    longest: float = 0.0


@dataclass(frozen=True)
class Received:
    """The recorder's clock against the channel's own.

    `offset` is how much later the recorder got a sample than its stamp says, in the median [s],
    `drift` by how much it grows a second, `jitter` what remains (rms) [s].
    """

    offset: float
    drift: float
    jitter: float


@dataclass(frozen=True)
class Clock:
    """The stamps of a channel: which clock in words, how even, how often they step back.

    `jitter` is the spread (rms) of the time between samples, gaps left out [s]; `same` counts
    samples with the stamp of another one.
    """

    words: str
    jitter: float
    steps_back: int
    furthest_back: float
    same: int
    received: Received | None = None


@dataclass(frozen=True)
class ChannelInspection:
    """One channel.

    Parameters
    ----------
    name
        What a pipeline writes as `channel`.
    angle
        Key `as` of the pipeline, where the channel is a quaternion or a velocity; None for a plain
        number.
    start, end
        First and last stamp [ns].
    samples, missing
        How many samples, and which share of them is not available.
    rate
        Samples a second in the median; 0 where there are fewer than two.
    low, high
        Range of the values, in the channel's own unit; NaN where none is available.
    unit, description, positive
        As the log states them.
    unit_in_name
        The unit that the channel's name ends with, where the log states none: `heading_deg`.
    unit_by_size
        The one unit that its numbers leave, where neither says: a heading up to 359.
    guess
        Which quantity it looks like; None where that cannot be told.
    sketch
        Its course in few points, to relate it to others.
    """

    name: str
    start: int
    end: int
    samples: int
    missing: float
    rate: float
    gaps: Gaps
    low: float
    high: float
    clock: Clock
    unit: str | None = None
    unit_in_name: str | None = None
    unit_by_size: str | None = None
    description: str = ""
    angle: Literal["roll", "yaw", "speed", "course"] | None = None
    guess: Guess | None = None
    sketch: Sketch = field(default=EMPTY, repr=False, compare=False)

    @property
    def stated_unit(self) -> str | None:
        """The unit that the log states, or else the channel's name."""
        return self.unit or self.unit_in_name

    @property
    def mostly_there(self) -> bool:
        """Whether half of its samples are, or come evenly: some rows are of other clocks."""
        return self.missing < 0.5 or (self.rate > 0.0 and not self.gaps.count)

    @property
    def key(self) -> str:
        """Its name, with the angle that is taken out of it."""
        return f"{self.name} ({self.angle})" if self.angle else self.name

    @property
    def message(self) -> str:
        """What it was sent in; empty for a column of a table."""
        return self.name.rpartition(":")[0]

    @property
    def same_epoch(self) -> bool:
        """Whether the recorder's clock and the channel's own count from about the same time."""
        late = self.clock.received
        return late is not None and abs(late.offset) < 1e7

    @property
    def constant(self) -> bool:
        """Whether it never moves, or holds no value at all."""
        return not self.low < self.high


@dataclass(frozen=True)
class LogFileInspection:
    """One file: its hash, and what was noticed while reading it."""

    path: Path
    format: str
    sha256: str
    remarks: tuple[str, ...] = ()


@dataclass(frozen=True)
class Inspection:
    """What a log, or a folder of logs that are one, holds.

    `start` and `end` are the first and last stamp of any channel [ns]; `warnings` what a person
    should know before using it, `aids` what the user added to it.
    """

    path: Path
    files: tuple[LogFileInspection, ...]
    channels: Mapping[str, ChannelInspection]
    warnings: tuple[str, ...] = ()
    aids: Aids = NO_AIDS

    @property
    def format(self) -> str:
        """The formats of its files, each once."""
        return ", ".join(dict.fromkeys(file.format for file in self.files))

    @property
    def start(self) -> int:
        """First stamp of any channel [ns]."""
        return min(one.start for one in self.channels.values())

    @property
    def end(self) -> int:
        """Last stamp of any channel [ns]."""
        return max(one.end for one in self.channels.values())

    @property
    def duration(self) -> float:
        """From the first stamp of any channel to the last, of two clocks on the longer one [s]."""
        return max(last - first for first, last in self.spans) / 1e9

    @property
    def spans(self) -> tuple[tuple[int, int], ...]:
        """First and last stamp of the channels that are dated, and of those that are not [ns]."""
        both = (
            [c for c in self.channels.values() if c.start > CALENDAR_NS],
            [c for c in self.channels.values() if c.start <= CALENDAR_NS],
        )
        return tuple(
            (min(c.start for c in some), max(c.end for c in some)) for some in both if some
        )

    def sources(self, quantity: str) -> tuple[ChannelInspection, ...]:
        """Channels that look like a quantity, the likeliest to serve first.

        Those that move come first; of these those the format defines before those found by name or
        relation; then those with more values over more time, the fastest, those that do not count
        from magnetic north, and those whose message gives the most others, which share its clock.
        """
        known = [c for c in self.channels.values() if c.guess]
        beside = Counter(c.message for c in known)
        found = [c for c in known if c.guess and c.guess.quantity == quantity]
        return tuple(sorted(found, key=lambda one: (*_worth(one), -beside[one.message])))


_TRUST = {"format": 0, "exact name": 0, "name": 1, "relation": 2}


def _worth(one: ChannelInspection) -> tuple[bool, int, float, float, bool]:
    """Sorts the better source of a quantity first."""
    assert one.guess is not None
    covered = max(one.end - one.start, 1) / 1e9 - one.gaps.total
    return (
        one.constant or one.missing > 0.9,
        _TRUST[one.guess.how],
        -round(covered * (1 - one.missing), -1),
        -float(f"{one.rate:.2g}"),
        "magnetic" in one.name.lower(),
    )
