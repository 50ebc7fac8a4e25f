"""Recording to Trial: channels on their own clocks to signals in SI on one clock.

`align` is the whole of it: bring the logs onto one clock (`log_clock`, `clock_match`), find each
channel and bring it to SI and to our positive direction (`sources`, `frames`), repair its stamps
(`stamps`), put them in order and choose the common clock (`clocks`), mask what is surely no
measurement (`faults`), resample with one and the same filter (`resample`), and say what was noticed
on the way (`quality`) and whether the signals agree (`agreement`).
"""

import dataclasses
from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Literal

from trialid.alignment import clocks, combine, faults, frames, log_clock, quality, resample
from trialid.alignment.agreement import (
    channel_finding,
    checks,
    duplicate_channels,
    signs,
    slopes,
)
from trialid.alignment.clocks import Grid, Series
from trialid.alignment.log_clock import LogClock
from trialid.alignment.sources import SignalSource, log_with, seams
from trialid.alignment.stamps import clock_health, dejitter
from trialid.alignment.track import antenna, astern, position
from trialid.errors import AlignmentError
from trialid.names.quantities import is_input
from trialid.recording import Recording
from trialid.trial import Contradiction, LogSource, Trial

__all__ = ["LogClock", "SignalSource", "align"]


def align(
    name: str,
    use: Literal["fit", "check"],
    recordings: Sequence[Recording],
    sources: Sequence[SignalSource],
    period: float,
    window: tuple[float, float] | None = None,
    *,
    repair: bool = True,
    log_clocks: Sequence[LogClock | None] = (),
    keep: Mapping[str, Collection[str]] | None = None,
) -> Trial:
    """The trial in `recordings`, its signals in SI on one clock.

    Parameters
    ----------
    name, use
        As in the pipeline.
    recordings
        The logs of this trial; a signal may come from any of them.
    sources
        One for each signal, or several to combine: which channel it is and how to read it.
    period
        Time between samples of the trial [s].
    window
        Part of the trial to use [s], from the first instant all channels cover; None for all.
    repair
        Put the stamps of evenly paced sensors on a line through their count of samples (`dejitter`)
        and undo steps of a sensor's clock; else every stamp counts as logged.
    log_clocks
        For each recording how its clock lies to the trial's, None where it is; empty: all are.
    keep
        Quantity to the kinds of `faults.KINDS` that are remarked but not masked.

    Raises LogError for a channel in no log, UnitError for a unit, AlignmentError for all that would
    have to be guessed: a missing sign or unit, signals that contradict one another or never meet.
    """
    where = f"trial {name!r}"
    _check_sources(sources, where)
    recordings, of_clocks = log_clock.on_one_clock(recordings, log_clocks, where, repair=repair)
    at = [f"{where}, signal {source.name}" for source in sources]
    logged = [frames.series(s, recordings, w) for s, w in zip(sources, at, strict=True)]
    repairs = [_repaired(one) if repair else (one, ()) for one in logged]
    logged = [one for one, _ in repairs]
    series = _in_order(logged, at)
    _check_epochs(series, sources, recordings, where)
    grid = clocks.common(series, period, window, where)
    series, found = _without_faults(series, sources, grid, keep or {}, at)
    signals = _on_grid(series, sources, grid, where)
    trial = _trial(name, use, recordings, signals, series, grid)
    agreement, apart = _agreement(trial, sources, recordings, where)
    remarks = (
        *_of_logs(recordings, sources),
        *of_clocks,
        *(word for _, words in repairs for word in words),
        *_of_signals(logged, series, sources, grid),
        *found,
        *trial.remarks,
        *quality.of_trial(series, grid, window),
        *agreement,
    )
    stated = frozenset(s.quantity for s in sources if s.positive is not None)
    return dataclasses.replace(
        trial, remarks=remarks, opening=(window or (0.0,))[0], sided=stated, contradictions=apart
    )


def _paces(series: Series) -> bool:
    """Whether it is an order or a motion that has to be followed from sample to sample."""
    return is_input(series.quantity) or series.quantity.name in ("p", "r", "phi")


def _agreement(
    trial: Trial, sources: Sequence[SignalSource], recordings: Sequence[Recording], where: str
) -> tuple[tuple[str, ...], tuple[Contradiction, ...]]:
    """Whether the signals agree: with each other, with the track, with channels not chosen.

    In words; and where a rate and its angle do not.
    """
    findings = checks.of_trial(trial, {s.quantity: s.unit for s in sources if s.unit})
    channel_finding.refuse(findings, where)
    twins = duplicate_channels.compare_duplicates(sources, recordings)
    words = (
        *antenna.check_track(trial),
        *signs.check(trial, {source.quantity: source for source in sources}, where),
        *(finding.words for finding in (*findings, *twins)),
    )
    return words, tuple(c for f in findings if (c := slopes.contradiction(f)) is not None)


def _without_faults(
    series: Sequence[Series],
    sources: Sequence[SignalSource],
    grid: Grid,
    keep: Mapping[str, Collection[str]],
    places: Sequence[str],
) -> tuple[list[Series], list[str]]:
    """All series without what is surely no measurement, positions in a plane, and remarks."""
    tracked, of_track = position.to_plane(series, grid, places[0].partition(",")[0])
    left, found = faults.mask_all(tracked, sources, grid, keep, places)
    return left, [*of_track, *found]


def _repaired(logged: Series) -> tuple[Series, tuple[str, ...]]:
    stepless, of_clock = clock_health.set_right(logged)
    even, of_stamps = dejitter.repair_stamps(stepless)
    return even, (*of_clock, *of_stamps)


def _in_order(logged: Sequence[Series], places: Sequence[str]) -> list[Series]:
    series = [clocks.in_time_order(one) for one in logged]
    for one, place in zip(series, places, strict=True):
        clocks.check(one, place)
    return series


def _check_sources(sources: Sequence[SignalSource], where: str) -> None:
    combine.check_once(sources, where)
    if not sources:
        raise AlignmentError(f"{where}: no signals; name at least a rudder and a motion")


def _check_epochs(
    series: Sequence[Series],
    sources: Sequence[SignalSource],
    recordings: Sequence[Recording],
    where: str,
) -> None:
    """AlignmentError when one log counts from 1970 and another from its own start."""
    own = [i for i, one in enumerate(series) if one.t[0] < clocks.CALENDAR_NS]
    if not own or len(own) == len(series):
        return
    dated = next(i for i in range(len(series)) if i not in own)
    of, other = (log_with(sources[i], recordings) for i in (own[0], dated))
    if of == other:
        return  # one log of two clocks; that they do not overlap is said below
    raise AlignmentError(
        f"{where}: {of} counts {sources[own[0]].quantity} from its own start, {other} "
        f"{sources[dated].quantity} from 1970; say how the clocks lie to each other: logs = [{{ "
        f'path = "{of}", clock = {{ match = ["channel here", "channel there"] }} }}], or by events '
        "or offset"
    )


def _of_logs(recordings: Sequence[Recording], sources: Sequence[SignalSource]) -> Iterator[str]:
    for recording in recordings:
        for remark in recording.remarks:
            yield f"{recording.path.name}: {remark}"
    for source in sources:
        yield from seams(source.channel, recordings)
        yield from frames.counted_round(source, recordings)


def _of_signals(
    logged: Sequence[Series], series: Sequence[Series], sources: Sequence[SignalSource], grid: Grid
) -> Iterator[str]:
    for raw, one in zip(logged, series, strict=True):
        yield from quality.of_clock(raw, one)
        yield from quality.of_values(one, grid)
    yield from combine.remarks(series, sources)


def _on_grid(
    series: Sequence[Series], sources: Sequence[SignalSource], grid: Grid, where: str
) -> dict[str, combine.Sampled]:
    """Every quantity on the clock of the trial, made of one channel or of several."""
    smooth = resample.any_faster(series, grid.period)
    sampled = [resample.resample(one, grid, smooth=smooth) for one in series]
    for one, (_, known) in zip(series, sampled, strict=True):
        quality.check_valid(one, known, grid, where)
    signals = {}
    for quantity in dict.fromkeys(one.quantity for one in series):
        at = [i for i, one in enumerate(series) if one.quantity == quantity]
        parts = [sampled[i] for i in at]
        combine.check_sides(parts, [sources[i] for i in at], grid.period, where)
        signals[quantity.name] = combine.mean(parts, quantity)
    return signals


def _trial(
    name: str,
    use: Literal["fit", "check"],
    recordings: Sequence[Recording],
    signals: Mapping[str, combine.Sampled],
    series: Sequence[Series],
    grid: Grid,
) -> Trial:
    logs = tuple(LogSource(str(r.path), r.sha256, r.adapter) for r in recordings)
    values = {quantity: sampled[0] for quantity, sampled in signals.items()}
    valid = {quantity: sampled[1] for quantity, sampled in signals.items()}
    every = max((one.period for one in series if _paces(one)), default=0.0)
    made = Trial(name, use, grid.period, values, valid, logs=logs, start=grid.start)
    made = dataclasses.replace(made, logged_every=every)
    return astern.with_sign(antenna.with_course(made))
