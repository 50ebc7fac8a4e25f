"""The clock of one log against the trial's: declared, by shared events, or by a shared motion.

The trial's clock is that of the logs without a `LogClock`. A log's own clock may be ahead of it and
run fast; it is never guessed: what is not declared is measured, with its interval, or refused.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime

import numpy as np
from numpy.typing import NDArray

from trialid.alignment import frames
from trialid.alignment.clock_match import Signal, match_clocks, refuse_few
from trialid.alignment.clocks import CALENDAR_NS, Series, moment
from trialid.alignment.sources import find
from trialid.alignment.stamps import clock_health, dejitter
from trialid.errors import AlignmentError
from trialid.names.quantities import SIGNALS
from trialid.recording import Channel, Recording

Instant = float | datetime
"""Seconds from the first stamp of a log, or a date; a date without a zone is UTC."""

LEAP_S = {18.0: "GPS time and UTC", 19.0: "TAI and GPS time", 37.0: "TAI and UTC"}
"""Leap seconds between two time scales, since 2017."""
LEAP_WITHIN = 0.5
FASTEST = 0.05
"""Drift above which two events are not of one clock: a watch keeps a thousand times better, and
rows that were counted at a nominal rate no better, for which `clock_drift` effects seek as much."""


@dataclass(frozen=True)
class LogClock:
    """What is known of a log's clock; one of `offset`, `events`, `match`.

    Parameters
    ----------
    offset
        How far it is ahead of the trial's clock [s] at its first stamp.
    drift
        How much too fast it runs [ppm].
    events
        Instants on this clock and on the trial's of the same events; two or more give the drift.
    match
        A channel of this log and one of another log that measure the same motion, or one the rate
        of the other; of any sign and size.
    within
        How far the clocks may be apart for a match [s]; where they count from different epochs, how
        far the first stamps of the two channels may be.
    """

    offset: float | None = None
    drift: float = 0.0
    events: tuple[tuple[Instant, Instant], ...] = ()
    match: tuple[str, str] | None = None
    within: float = 60.0


@dataclass(frozen=True)
class Line:
    """A log's clock: ahead by `offset` [s] at the stamp `start` [ns], `drift` too fast."""

    start: int
    offset: float
    drift: float
    words: str

    def trial_time(self, t: NDArray[np.int64]) -> NDArray[np.int64]:
        """Stamps of the log [ns] on the trial's clock [ns]."""
        whole = round(self.offset * 1e9)
        if not self.drift:
            return t - whole
        gained = (t - self.start) * (self.drift / (1.0 + self.drift))
        return t - whole - np.rint(gained).astype(np.int64)


def on_one_clock(
    recordings: Sequence[Recording],
    given: Sequence[LogClock | None],
    where: str,
    *,
    repair: bool,
) -> tuple[tuple[Recording, ...], tuple[str, ...]]:
    """The recordings on the trial's clock, and what was found.

    Files of one log have the very same LogClock. AlignmentError for a match that cannot be told,
    and where every log has a clock of its own.
    """
    if not any(given):
        return tuple(recordings), ()
    done = {i: r for i, (r, c) in enumerate(zip(recordings, given, strict=True)) if c is None}
    words = []
    for clock in sorted(_distinct(given), key=lambda one: one.match is not None):
        own = [i for i, other in enumerate(given) if other is clock]
        log = [recordings[i] for i in own]
        place = f"{where}, clock of {log[0].path.name}"
        line = _line(clock, log, list(done.values()), place, repair=repair)
        done |= {i: _moved(recordings[i], line) for i in own}
        words.append(f"{log[0].path.name}: {line.words}")
    return tuple(done[i] for i in range(len(recordings))), tuple(words)


def _distinct(given: Sequence[LogClock | None]) -> list[LogClock]:
    return list({id(clock): clock for clock in given if clock is not None}.values())


def _line(
    clock: LogClock, log: list[Recording], others: list[Recording], where: str, *, repair: bool
) -> Line:
    start = _start(log, where)
    if clock.offset is not None:
        drift = f", {clock.drift:g} ppm fast" if clock.drift else ""
        words = f"its clock is declared {clock.offset:.6g} s ahead of the trial's{drift}"
        return Line(start, clock.offset, clock.drift * 1e-6, words)
    if not others:
        raise AlignmentError(
            f"{where}: no other log to compare it with; leave the log whose clock is the trial's "
            "without one"
        )
    if clock.match is None:
        return _by_events(clock, start, _start(others, where), where)
    return _by_match(clock, clock.match, log, others, where, repair=repair)


def _start(log: Sequence[Recording], where: str) -> int:
    """The first stamp of a log [ns], of the channels that were read."""
    firsts = [int(c.t.min()) for r in log for c in r.channels.values() if len(c.t)]
    if not firsts:
        raise AlignmentError(
            f"{where}: the log holds no sample; there is nothing to set a clock by"
        )
    return min(firsts)


def _by_events(clock: LogClock, start: int, other_start: int, where: str) -> Line:
    here = np.array([_stamp(a, start) for a, _ in clock.events], np.int64)
    there = np.array([_stamp(b, other_start) for _, b in clock.events], np.int64)
    since = (here - start) / 1e9
    ahead = ((here - here[0]) - (there - there[0])) / 1e9
    first = (int(here[0]) - int(there[0])) / 1e9
    if len(here) == 1:
        return Line(
            start, first, 0.0, f"its clock is {_ahead(first)} ahead of the trial's by one event"
        )
    if np.ptp(since) == 0:
        raise AlignmentError(
            f"{where}: events all at one instant; give one, or some that lie apart"
        )
    design = np.column_stack([np.ones(len(since)), since])
    (offset, drift), *_ = np.linalg.lstsq(design, ahead, rcond=None)
    if abs(drift) > FASTEST:
        raise AlignmentError(
            f"{where}: by its events it gains {drift:.2%} on the trial's, which no clock does; "
            "check the instants"
        )
    left = float(np.sqrt(np.mean((ahead - design @ np.array([offset, drift])) ** 2)))
    fit = f", {left:.2g} s rms from a straight line" if len(here) > 2 else ""
    words = (
        f"its clock is {_ahead(first + offset)} ahead of the trial's at its first stamp and runs "
        f"{drift * 1e6:.4g} ppm fast by {len(here)} events{fit}"
    )
    return Line(start, first + float(offset), float(drift / (1.0 - drift)), words)


def _stamp(instant: Instant, start: int) -> int:
    if not isinstance(instant, datetime):
        return start + round(instant * 1e9)
    aware = instant if instant.tzinfo else instant.replace(tzinfo=UTC)
    since = aware - datetime(1970, 1, 1, tzinfo=UTC)
    return (since.days * 86400 + since.seconds) * 10**9 + since.microseconds * 1000


def _ahead(offset: float) -> str:
    """An offset [s] in words; between epochs it is a date, not a number anyone can read."""
    if abs(offset) * 1e9 < CALENDAR_NS:
        return f"{offset:.4f} s"
    return f"{offset:.4f} s (the other counts from 1970; its 0 is {moment(round(-offset * 1e9))})"


def _by_match(
    clock: LogClock,
    match: tuple[str, str],
    log: list[Recording],
    others: list[Recording],
    where: str,
    *,
    repair: bool,
) -> Line:
    here = _signal(find(match[0], log, where), repair=repair)
    there = _signal(find(match[1], others, where), repair=repair)
    place = f"{where}, match of {match[0]!r} here"
    for signal in (here, there):
        refuse_few(signal, place)
    epochs = (here.t[0] > CALENDAR_NS) != (there.t[0] > CALENDAR_NS)
    about = int(here.t[0] - there.t[0]) if epochs else 0
    found = match_clocks(here, there, about, clock.within, place)
    offset = about / 1e9 + found.offset
    words = (
        f"its clock is {_ahead(offset)} ahead of the trial's, 95 % interval "
        f"+- {found.reach:.2g} s, by {match[0]!r} and {match[1]!r} ({found.how})"
    )
    if found.drift:
        words += f"; it runs {found.drift * 1e6:.3g} +- {found.drift_reach * 1e6:.2g} ppm fast"
    if not epochs:
        words += "".join(_leap(offset))
    return Line(round(found.middle + offset * 1e9), offset, found.drift, words)


def _leap(offset: float) -> Iterator[str]:
    for size, scales in LEAP_S.items():
        if abs(abs(offset) - size) <= LEAP_WITHIN:
            yield f"; {size:g} s are the leap seconds between {scales}: each log keeps one of them"


def _signal(channel: Channel, *, repair: bool) -> Signal:
    """A channel's values that are available, in the order of time, on repaired stamps."""
    y = frames.sensor_values(channel.y)
    series = Series(SIGNALS["t"], channel.t, y, channel.clock, channel.received)
    if repair:
        series, _ = dejitter.repair_stamps(clock_health.set_right(series)[0])
    finite = np.isfinite(series.y)
    t, first = np.unique(series.t[finite], return_index=True)
    return Signal(channel.name, t, series.y[finite][first])


def _moved(recording: Recording, line: Line) -> Recording:
    channels = {
        name: replace(
            channel,
            t=line.trial_time(channel.t),
            received=None if channel.received is None else line.trial_time(channel.received),
        )
        for name, channel in recording.channels.items()
    }
    return replace(recording, channels=channels)
