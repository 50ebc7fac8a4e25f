"""Trials of a pipeline: logs read and brought onto one clock."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import combinations
from typing import Final

import numpy as np

from trialid import ingest
from trialid.alignment import LogClock, SignalSource, align
from trialid.alignment.clocks import CALENDAR_NS
from trialid.alignment.held_roll import without_held_roll
from trialid.alignment.track.antenna import at_origin, check_stated_speed
from trialid.alignment.track.body_velocity import with_velocity
from trialid.diagnosis.records.one_speed import without_noise_of_speed
from trialid.diagnosis.records.rudder_jumps import rudder_jump, said_of
from trialid.errors import PipelineError
from trialid.ingest import Aids, LogFile
from trialid.names.quantities import SIGNALS, Quantity
from trialid.pipeline_file import Pipeline, TrialSection
from trialid.pipeline_file.form import ClockSection
from trialid.progress import Progress
from trialid.second_process import each
from trialid.ship.particulars import read_ship
from trialid.trial import Trial
from trialid.workflow.build_model import available
from trialid.workflow.origin import relative_path
from trialid.workflow.quantities_read import quantities_of
from trialid.workflow.steering_gaps import known_throughout, own_time

SHARED: Final = 0.1
"""Share of a trial's time that another may have of the same log: windows overlap at their ends."""

SAME: Final = 0.01
"""Variance of the difference over the variance below which signals of one time are one signal: put
on clocks that are up to a sample apart those of an outsider's overlapping files differ by 0.0003 at
most, and two runs by 1 and more: half and twice say the same."""


def align_trials(pipeline: Pipeline, progress: Progress) -> tuple[Trial, ...]:
    """Logs of every trial, read and brought onto one clock."""
    known = quantities_of(pipeline)

    def aligned(trial: TrialSection) -> Trial:
        progress(f"reading {trial.name}", 0.3 * pipeline.trials.index(trial) / len(pipeline.trials))
        return align_trial(pipeline, trial, known)

    done = each(aligned, pipeline.trials)
    return _with_jumps(pipeline, stretches_to_fit(pipeline, done))


def stretches_to_fit(pipeline: Pipeline, trials: Sequence[Trial]) -> tuple[Trial, ...]:
    """Trials of their own, each the stretch of it through which she can be simulated.

    Where she is held at a heel and let go that begins at the release. Where she goes at one speed
    in all, that is read without the noise of its log.

    Raises
    ------
    PipelineError
        Two are the same stretch of the same log.
    """
    check_own_stretches(pipeline, trials)
    trials = [without_held_roll(trial) for trial in trials]
    if pipeline.ship is None:
        return tuple(trials)
    particulars, catalogue = read_ship(pipeline.ship).particulars, available(pipeline)
    effects = [catalogue[name] for name in pipeline.model.effects if name in catalogue]
    known = tuple(known_throughout(trial, particulars, effects) for trial in trials)
    length = own_time(particulars)
    if length is None or "u" in (*pipeline.model.states, *pipeline.identify.outputs):
        return known
    return without_noise_of_speed(known, length)


def check_own_stretches(pipeline: Pipeline, trials: Sequence[Trial]) -> None:
    """Refuse trials that are the same stretch of the same log.

    Fitted twice it counts as twice as sure, and held out as well as fitted it foretells itself.

    Raises
    ------
    PipelineError
        Two trials share a log, or what dated logs hold, and more than `SHARED` of the shorter
        one's time, or are copies.
    """
    clocked = {t.name for t in pipeline.trials if any(log.clock for log in t.logs)}
    plain = [trial for trial in trials if trial.name not in clocked]  # others count as they state
    for one, other in combinations(plain, 2):
        if _hold_the_same(one, other):
            raise PipelineError(
                f"{pipeline.path}: trials {one.name!r} and {other.name!r} hold the same samples, "
                "whatever their stamps, and no two runs of a ship are alike to the last digit: "
                "leave one out"
            )
        files = [log.path for log in one.logs if log.sha256 in {x.sha256 for x in other.logs}]
        begin = max(one.start, other.start)
        end = min(t.start + t.duration * 1e9 for t in (one, other))
        shortest = min(one.duration, other.duration)
        if (end - begin) / 1e9 <= SHARED * shortest:
            continue
        if files or _overlap(one, other, begin, end):
            of = files[0] if files else "one record, in two logs"
            raise PipelineError(
                f"{pipeline.path}: trials {one.name!r} and {other.name!r} are the same "
                f"{(end - begin) / 1e9:.0f} s of {of}; a record cannot be held out that is "
                "fitted, nor count twice: leave one out, or give each a window of its own"
            )


def _hold_the_same(one: Trial, other: Trial) -> bool:
    """Whether all that moves in two trials of other logs is the same to the last digit."""
    shared = {x.sha256 for x in one.logs} & {x.sha256 for x in other.logs}
    if shared or one.signals.keys() != other.signals.keys():
        return False  # how much of one log they have in common is asked beside
    count = min(one.samples, other.samples)
    moves = [n for n, x in one.signals.items() if np.ptp(x[:count]) > 0.0]
    return bool(moves) and all(
        np.array_equal(one.signals[n][:count], other.signals[n][:count]) for n in moves
    )


def _overlap(one: Trial, other: Trial, begin: float, end: float) -> bool:
    """Whether all that moves in dated logs is the same from one stamp to another [ns]."""
    if begin < CALENDAR_NS:
        return False
    at = np.arange(begin, end, one.period * 1e9)
    shares = list[float]()
    for n in (n for n in one.signals if n in other.signals):
        a, b = (np.interp((at - x.start) / 1e9, x.t, x.signals[n]) for x in (one, other))
        shares += [float(np.var(a - b) / np.var(a))] if np.ptp(a) > 0.0 else []
    return bool(shares) and max(shares) < SAME


def _with_jumps(pipeline: Pipeline, trials: Sequence[Trial]) -> tuple[Trial, ...]:
    """The trials, with a remark where what is called the rudder is its order."""
    known = {} if pipeline.ship is None else read_ship(pipeline.ship).particulars
    time = own_time(known)
    jump = None if time is None else rudder_jump(trials, time)
    if jump is None:
        return tuple(trials)
    return tuple(
        replace(t, remarks=(*t.remarks, said_of(jump))) if "delta" in t.signals else t
        for t in trials
    )


def align_trial(
    pipeline: Pipeline, trial: TrialSection, known: Mapping[str, Quantity] | None = None
) -> Trial:
    """Logs of one trial, read and brought onto one clock; `known` what its signals may be."""
    known = quantities_of(pipeline) if known is None else known
    sources = _sources(trial, known)
    logs = [LogFile(g.path, Aids(g.template, g.dbc, g.zone)) for g in trial.logs]
    clocks = [_log_clock(g.clock) for g in trial.logs]
    matched = [name for clock in clocks if clock and clock.match for name in clock.match]
    recordings = ingest.read_together(logs, [s.channel for s in sources] + matched)
    recordings = tuple(replace(r, path=relative_path(pipeline, r.path)) for r in recordings)
    made = align(
        trial.name, trial.use, recordings, sources, pipeline.align.period, trial.window,
        repair=pipeline.align.clocks == "repair",
        log_clocks=[c for g, c in zip(logs, clocks, strict=True) for _ in ingest.files_of(g)],
        keep={q: s.keep for q, s in trial.signals.items() if s.keep},
    )  # fmt: skip
    made = _at_origin(pipeline, made)
    made = with_velocity(made) if trial.over_ground else made
    if trial.speed is None:
        return made
    if "u" in made.signals:
        remark = f"the stated speed {trial.speed:g} m/s is not used: u is recorded"
        return replace(made, remarks=(*made.remarks, remark))
    signals = {**made.signals, "u": np.full(made.samples, trial.speed)}
    valid = {**made.valid, "u": np.ones(made.samples, dtype=bool)}
    remark = f"u is the stated approach speed {trial.speed:g} m/s, not a record"
    remarks = (*made.remarks, remark, *check_stated_speed(made, trial.speed))
    return replace(made, signals=signals, valid=valid, remarks=remarks)


def _sources(trial: TrialSection, known: Mapping[str, Quantity]) -> list[SignalSource]:
    """What each signal is read from, one for each channel."""
    return [
        SignalSource(
            quantity=name,
            channel=channel,
            unit=s.unit,
            positive=s.positive,
            as_=s.angle,
            delay=s.delay,
            gain=s.gain,
            offset=s.offset,
            curve=s.curve,
            combine=s.combine,
            of=None if name in SIGNALS else known[name],
        )
        for name, s in trial.signals.items()
        for channel in s.names
    ]


def _at_origin(pipeline: Pipeline, trial: Trial) -> Trial:
    """The trial with the track of the ship's origin, where her file says where the antenna is."""
    if pipeline.ship is None or not {"x", "y", "sog", "cog"} & {*trial.signals}:
        return trial
    return at_origin(trial, read_ship(pipeline.ship).antenna)


def _log_clock(clock: ClockSection | None) -> LogClock | None:
    if clock is None:
        return None
    within = {} if clock.within is None else {"within": clock.within}
    return LogClock(clock.offset, clock.drift or 0.0, clock.events or (), clock.match, **within)
