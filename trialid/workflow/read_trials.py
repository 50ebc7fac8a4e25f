"""Trials of a pipeline: logs read and brought onto one clock."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from trialid import ingest
from trialid.alignment import LogClock, SignalSource, align
from trialid.alignment.track.antenna import at_origin, check_stated_speed
from trialid.diagnosis.rudder_jumps import rudder_jump, said_of
from trialid.ingest import Aids, LogFile
from trialid.names.quantities import SIGNALS, Quantity
from trialid.pipeline_file import Pipeline, TrialSection
from trialid.pipeline_file.form import ClockSection
from trialid.progress import Progress
from trialid.ship.particulars import read_ship
from trialid.trial import Trial
from trialid.workflow.origin import relative_path
from trialid.workflow.quantities_read import quantities_of


def align_trials(pipeline: Pipeline, progress: Progress) -> tuple[Trial, ...]:
    """Logs of every trial, read and brought onto one clock."""
    done, known = [], quantities_of(pipeline)
    for i, trial in enumerate(pipeline.trials):
        progress(f"reading {trial.name}", 0.3 * i / len(pipeline.trials))
        done.append(align_trial(pipeline, trial, known))
    return _with_jumps(pipeline, done)


def _with_jumps(pipeline: Pipeline, trials: Sequence[Trial]) -> tuple[Trial, ...]:
    """The trials, with a remark where what is called the rudder is its order."""
    if pipeline.ship is None:
        return tuple(trials)
    L, U0 = (read_ship(pipeline.ship).particulars.get(n, 0.0) for n in ("L", "U0"))
    jump = rudder_jump(trials, L / U0) if L and U0 else None
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
    if pipeline.ship is None or not {"x", "y"} <= {*trial.signals}:
        return trial
    return at_origin(trial, read_ship(pipeline.ship).antenna)


def _log_clock(clock: ClockSection | None) -> LogClock | None:
    if clock is None:
        return None
    within = {} if clock.within is None else {"within": clock.within}
    return LogClock(clock.offset, clock.drift or 0.0, clock.events or (), clock.match, **within)
