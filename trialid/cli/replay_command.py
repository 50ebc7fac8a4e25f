"""The command that plays a recorded log through the model, at its own pace or faster."""

import math
import sys
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import click

from trialid import own_files
from trialid.cli.answering import check_trial_names
from trialid.cli.console import complain, progress_bar, say
from trialid.cli.replay_source import Following, source_of
from trialid.errors import TrialidError
from trialid.version import VERSION

if TYPE_CHECKING:
    from trialid.identification.fit import Fit
    from trialid.pipeline_file import Pipeline, TrialSection
    from trialid.replay.alarm import Bands
    from trialid.replay.follow import Follower
    from trialid.replay.live_bus import LiveBus
    from trialid.replay.playback import Playback
    from trialid.replay.session import Wishes
    from trialid.replay.view import Show
    from trialid.result.schema import Result
    from trialid.trial import Trial

FILE: Final = click.Path(path_type=Path)
POSITIVE: Final = click.FloatRange(min=0, min_open=True)
IDLE: Final = 30.0
"""Without growth for so long [s] a followed log is taken to be whole."""


@click.command(cls=Following, short_help="Play a trial through its model as a stream, with alarms.")
@click.argument("pipeline", type=FILE)
@click.option(
    "--run",
    "folder",
    type=FILE,
    metavar="DIR",
    help="Take the parameters from this finished run of PIPELINE; else fit first.",
)
@click.option("--trial", "name", metavar="NAME", help="Which trial; by default the last.")
@click.option("--speed", type=POSITIVE, metavar="X", help="Seconds of record in a second; else 1.")
@click.option("--fast", is_flag=True, help="As fast as possible.")
@click.option(
    "--from",
    "start",
    type=click.FloatRange(min=0),
    metavar="T",
    help="Where in the trial to begin [s].",
)
@click.option("--loop", is_flag=True, help="Again and again, until q or Ctrl-C.")
@click.option(
    "--follow",
    metavar="[can:INTERFACE:CHANNEL]",
    help="The log is still being written: read on as it grows. With a bus as python-can names it "
    "(can:socketcan:can0), its frames are the log of the trial; nothing is sent.",
)
@click.option(
    "--record",
    type=FILE,
    metavar="FILE.log",
    help="With --follow can:...: keep the frames as a candump log.",
)
@click.option(
    "--idle",
    type=POSITIVE,
    default=IDLE,
    metavar="S",
    show_default=True,
    help="With --follow: without growth for so long [s] the log is whole.",
)
@click.option(
    "--out",
    type=FILE,
    metavar="FILE.mcap",
    help="Write measured, predicted, residual, band and events for plot tools, with "
    "layouts for Foxglove and PlotJuggler beside it.",
)
@click.option("--force", is_flag=True, help="With --out: replace what is there.")
@click.option("--quiet", is_flag=True, help="No picture, and no summary.")  # fmt: skip
def replay(
    pipeline: Path, folder: Path | None, name: str | None, speed: float | None, fast: bool,
    start: float | None, loop: bool, follow: str | None, record: Path | None, idle: float,
    out: Path | None, force: bool, quiet: bool,
) -> None:  # fmt: skip
    """Play a trial of PIPELINE through its model as a stream, and say where the model fails.

    The model runs in step with the log, by the same numbers as `trialid run`. Each residual is held
    against its noise band; where the model leaves it there is an alarm, with the time and what the
    ship was doing. In the terminal: space pauses, arrows seek 10 s, q ends.
    """
    if fast and speed is not None:
        raise click.UsageError("--fast and --speed exclude each other")
    if loop and (follow or fast):
        raise click.UsageError("--loop goes with a pace and a whole log: not --fast or --follow")
    from trialid.pipeline_file import load
    from trialid.replay.session import Wishes

    asked = load(pipeline)
    _check_out(out, force, asked)
    chosen = _chosen(asked, name, pipeline)
    result = None if folder is None else _finished(folder)
    with source_of(chosen, follow, record, force) as (playing, bus):
        with progress_bar(shown=not quiet and sys.stderr.isatty()) as progress:
            follower = _follower(asked, playing, idle, bus) if follow else None
            playback = _ready(
                asked=asked,
                chosen=playing,
                folder=folder,
                result=result,
                follower=follower,
                live=bus is not None,
                progress=progress,
            )
        if start is not None and start > playback.trial.duration and not follow:
            raise TrialidError(
                f"--from {start:g}: trial {chosen.name!r} lasts {playback.trial.duration:g} s"
            )
        pace = math.inf if fast or (follow and speed is None) else speed or 1.0
        played = _play(playback, Wishes(pace, start or 0.0, loop), follower, quiet)
        files = [] if out is None else _written(out, played, start or 0.0)
        if bus is not None and bus.trouble:
            complain(f"--follow {bus.at}: the bus fell silent after {bus.frames} frames: "
                     f"{bus.trouble}")  # fmt: skip
    if not quiet:
        say(_summary(played, start or 0.0, files))


def _check_out(out: Path | None, force: bool, asked: "Pipeline") -> None:
    """Refuse, before the work, a place that no recording can be written to."""
    if out is None:
        return
    from trialid.export import check_place, check_unread
    from trialid.pipeline_file import sources
    from trialid.replay.record import layout_paths

    check_place(out, replace=force, formats=(".mcap",), more=layout_paths(out))
    check_unread(out, sources(asked))


def _chosen(asked: "Pipeline", name: str | None, pipeline: Path) -> "TrialSection":
    if name is None:
        return asked.trials[-1]
    check_trial_names([name], [one.name for one in asked.trials], pipeline)
    return next(one for one in asked.trials if one.name == name)


def _finished(folder: Path) -> "Result":
    from trialid.result import json_file

    try:
        return json_file.read(folder / json_file.NAME, "name the folder of a finished run")
    except TrialidError as error:
        said = str(error).removeprefix(f"{folder}/").removeprefix(f"{json_file.NAME}: ")
        raise TrialidError(f"--run {folder}: {json_file.NAME} {said}") from error


def _ready(
    asked: "Pipeline", chosen: "TrialSection", folder: Path | None,
    result: "Result | None", follower: "Follower | None", live: bool,
    progress: Callable[[str, float | None], None],
) -> "Playback":  # fmt: skip
    """The trial, the fitted model and the noise bands, before the first sample."""
    from trialid.diagnosis.examine import examine_fit
    from trialid.replay.alarm import bands
    from trialid.replay.playback import Playback
    from trialid.threads import one_thread
    from trialid.workflow.build_model import available
    from trialid.workflow.findings import diagnose_settings
    from trialid.workflow.fit_model import fit_of
    from trialid.workflow.read_trials import align_trial
    from trialid.workflow.use.finished_model import revived_fit

    def made() -> "tuple[Fit, Trial, Bands, Mapping[str, float]]":
        catalogue = available(asked)
        progress("reading", 0.1)
        own = align_trial(asked, chosen) if follower is None else follower.first(time.sleep)
        known = None if result is None else {t.name: t.use for t in result.trials}
        if known is not None and known.get(chosen.name) != "fit":
            own = replace(own, use="check")
        others = [t for t in asked.trials if _beside(t, chosen, live)
                  and (known is None or t.name in known)]  # fmt: skip
        trials = [align_trial(asked, t) for t in others]
        trials = _in_order(asked, trials if live else [*trials, own])
        if folder is None or result is None:
            fit = fit_of(asked, tuple(trials), catalogue, progress)
        else:
            fit = revived_fit(asked, trials, result, f"--run {folder}")
        how = diagnose_settings(asked, catalogue)
        found, augmented = examine_fit(fit, how, progress)
        about = found.band if result is None else result.fit.band
        return fit, own, bands(fit, found.split, augmented), about

    fit, own, noise, about = one_thread(made)()
    return Playback(fit, own, noise, growing=follower is not None, prediction_band=about)


def _beside(one: "TrialSection", played: "TrialSection", live: bool) -> bool:
    """Whether a trial is read beside the one that is played.

    What comes over a bus is no trial of the fit: the record of that name still is, if it was one.
    """
    return one.name != played.name or (live and one.use == "fit")


def _in_order(asked: "Pipeline", trials: "Sequence[Trial]") -> "list[Trial]":
    """As the pipeline has them: sums over trials are then those of the run, bit for bit."""
    place = {t.name: i for i, t in enumerate(asked.trials)}
    return sorted(trials, key=lambda trial: place[trial.name])


def _follower(
    asked: "Pipeline", chosen: "TrialSection", idle: float, bus: "LiveBus | None"
) -> "Follower":
    from trialid.replay.follow import Follower
    from trialid.workflow.read_trials import align_trial

    def read() -> "Trial":
        if bus is not None and not bus.frames:
            raise TrialidError(
                f"--follow {bus.at}: no frame came within {idle:g} s; look at the bus, its bit "
                "rate and the name of the channel"
            )
        return align_trial(asked, chosen)

    return Follower([log.path for log in chosen.logs], read, idle, time.monotonic)


def _play(
    playback: "Playback", wishes: "Wishes", follower: "Follower | None", quiet: bool
) -> "Playback":
    """Play; Ctrl-C ends it like q, and what was played is kept."""
    from trialid.replay.keys import keyboard
    from trialid.replay.session import WallClock, play

    last = playback
    with _showing(quiet) as show, keyboard() as keys:

        def seen(now_playing: "Playback", pace: Any, now: float) -> None:
            nonlocal last
            last = now_playing
            show(now_playing, pace, now)

        try:
            return play(playback, wishes, WallClock(), seen, keys, follower)
        except KeyboardInterrupt:
            return last


@contextmanager
def _showing(quiet: bool) -> "Iterator[Show]":
    """A picture in a terminal, a line for each event elsewhere."""
    if quiet:
        yield lambda playback, pace, now: None
    elif sys.stdout.isatty():
        from rich.console import Console

        from trialid.replay.view import live

        with live(Console()) as show:
            yield show
    else:
        told: set[str] = set()

        def tell(playback: "Playback", pace: Any, now: float) -> None:
            for event in playback.events():
                if event.warning and event.words not in told:
                    told.add(event.words)
                    say(f"{event.t:.1f} s: {event.words}")

        yield tell


def _written(out: Path, playback: "Playback", start: float) -> list[Path]:
    from trialid.replay.record import write

    if playback.furthest <= round(start / playback.trial.period):
        complain(f"--out {out}: nothing was played, nothing is written")
        return []
    with own_files.write_or_say_why(out):
        return write(out, playback, VERSION, start)


def _summary(playback: "Playback", start: float, files: Sequence[Path]) -> str:
    from trialid.replay.closing_words import summary

    return summary(playback, start, files)
