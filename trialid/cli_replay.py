"""The command that plays a recorded log through the model, at its own pace or faster."""

import json
import math
import sys
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import click

import trialid
from trialid.console import complain, progress_bar, say
from trialid.errors import LogError, NotIdentifiable, RecipeError, TrialidError, nearest

if TYPE_CHECKING:
    from trialid.identification.fit import Fit
    from trialid.recipe import Recipe, TrialRecipe
    from trialid.replay.alarm import Bands
    from trialid.replay.follow import Follower
    from trialid.replay.playback import Playback
    from trialid.replay.session import Wishes
    from trialid.replay.view import Show
    from trialid.trial import Trial

FILE: Final = click.Path(path_type=Path)
POSITIVE: Final = click.FloatRange(min=0, min_open=True)
IDLE: Final = 30.0
"""Without growth for so long [s] a followed log is taken to be whole."""


class _WallClock:
    def now(self) -> float:
        return time.monotonic()

    def wait(self, seconds: float) -> None:
        time.sleep(seconds)


@click.command()
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
@click.option("--follow", is_flag=True, help="The log is still being written: read on as it grows.")
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
@click.option("--quiet", is_flag=True, help="No picture, and no summary.")  # fmt: skip
def replay(
    pipeline: Path, folder: Path | None, name: str | None, speed: float | None, fast: bool,
    start: float | None, loop: bool, follow: bool, idle: float, out: Path | None, quiet: bool,
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
    _check_out(out)
    from trialid.recipe import load

    recipe = load(pipeline)
    chosen = _chosen(recipe, name, pipeline)
    result = None if folder is None else _finished(folder)
    from trialid.replay.session import Wishes

    with progress_bar(shown=not quiet and sys.stderr.isatty()) as progress:
        follower = _follower(recipe, chosen, idle) if follow else None
        playback = _ready(recipe, chosen, folder, result, follower, progress)
    if start is not None and start > playback.trial.duration and not follow:
        raise TrialidError(
            f"--from {start:g}: trial {chosen.name!r} lasts {playback.trial.duration:g} s"
        )
    pace = math.inf if fast or (follow and speed is None) else speed or 1.0
    played = _play(playback, Wishes(pace, start or 0.0, loop), follower, quiet)
    files = [] if out is None else _written(out, played, start or 0.0)
    if not quiet:
        say(_summary(played, start or 0.0, files))


def _check_out(out: Path | None) -> None:
    """Refuse, before the work, a place that no recording can be written to."""
    if out is not None and out.suffix != ".mcap":
        raise TrialidError(f"--out {out}: a recording ends in .mcap")
    if out is not None and not out.parent.is_dir():
        raise TrialidError(f"--out {out}: there is no folder {out.parent}; make it first")


def _chosen(recipe: "Recipe", name: str | None, pipeline: Path) -> "TrialRecipe":
    if name is None:
        return recipe.trials[-1]
    for one in recipe.trials:
        if one.name == name:
            return one
    known = nearest(name, [t.name for t in recipe.trials])
    raise TrialidError(f"{pipeline}: no trial {name!r}; {known}")


def _finished(folder: Path) -> Mapping[str, Any]:
    path = folder / "result.json"
    try:
        result = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise LogError(f"--run {folder}: {path.name} cannot be read ({error})") from error
    if not isinstance(result, dict) or "accuracy" not in result or "fit" not in result:
        raise LogError(f"--run {folder}: {path.name} is not of a run of trialid")
    return result


def _ready(
    recipe: "Recipe", chosen: "TrialRecipe", folder: Path | None,
    result: Mapping[str, Any] | None, follower: "Follower | None",
    progress: Callable[[str, float | None], None],
) -> "Playback":  # fmt: skip
    """The trial, the fitted model and the noise bands, before the first sample."""
    from trialid.assembly import available
    from trialid.pipeline import align_trial, diagnose, fit_of
    from trialid.replay.alarm import bands
    from trialid.replay.playback import Playback
    from trialid.threads import one_thread

    def made() -> "tuple[Fit, Trial, Bands]":
        catalogue = available(recipe)
        progress("reading", 0.1)
        own = align_trial(recipe, chosen) if follower is None else follower.first(time.sleep)
        known = None if result is None else {t["name"]: t["use"] for t in result["trials"]}
        if known is not None and known.get(chosen.name) != "fit":
            own = replace(own, use="check")
        others = [t for t in recipe.trials if t.name != chosen.name
                  and (known is None or t.name in known)]  # fmt: skip
        trials = [align_trial(recipe, t) for t in others]
        trials = _in_order(recipe, [*trials, own])
        if folder is None or result is None:
            fit = fit_of(recipe, tuple(trials), catalogue, progress)
        else:
            fit = _revived(recipe, trials, folder, result)
        found, _, augmented = diagnose(recipe, fit, catalogue, progress)
        return fit, own, bands(fit, found.split, augmented)

    fit, own, noise = one_thread(made)()
    return Playback(fit, own, noise, growing=follower is not None)


def _in_order(recipe: "Recipe", trials: "Sequence[Trial]") -> "list[Trial]":
    """As the pipeline has them: sums over trials are then those of the run, bit for bit."""
    place = {t.name: i for i, t in enumerate(recipe.trials)}
    return sorted(trials, key=lambda trial: place[trial.name])


def _revived(
    recipe: "Recipe", trials: "Sequence[Trial]", folder: Path, result: Mapping[str, Any]
) -> "Fit":
    """The fit of a finished run, its values taken as they are written."""
    from trialid.assembly import available, build_model, settings_of
    from trialid.identification.fit import revived

    model = build_model(recipe, available(recipe))
    kept, here = result["model"]["effects"], [e.name for e in model.effects]
    if kept != here:
        apart = sorted({*kept} ^ {*here}) or ["their order"]
        raise RecipeError(
            f"--run {folder}: is of another model than {recipe.path.name} (apart in "
            f"{', '.join(apart)}); name a run of this pipeline, or leave --run out to fit again"
        )
    settings = replace(settings_of(recipe), substeps=result["fit"]["substeps"])
    values = {p["name"]: p["value"] for p in result["accuracy"]["parameters"]}
    try:
        return revived(trials, model, settings, values)
    except NotIdentifiable as error:
        raise RecipeError(
            f"--run {folder}: does not fit {recipe.path.name}: {error}; leave --run out to fit"
        ) from error


def _follower(recipe: "Recipe", chosen: "TrialRecipe", idle: float) -> "Follower":
    from trialid.pipeline import align_trial
    from trialid.replay.follow import Follower

    def read() -> "Trial":
        return align_trial(recipe, chosen)

    return Follower([log.path for log in chosen.logs], read, idle, time.monotonic)


def _play(
    playback: "Playback", wishes: "Wishes", follower: "Follower | None", quiet: bool
) -> "Playback":
    """Play; Ctrl-C ends it like q, and what was played is kept."""
    from trialid.replay.keys import keyboard
    from trialid.replay.session import play

    last = playback
    with _showing(quiet) as show, keyboard() as keys:

        def seen(now_playing: "Playback", pace: Any, now: float) -> None:
            nonlocal last
            last = now_playing
            show(now_playing, pace, now)

        try:
            return play(playback, wishes, _WallClock(), seen, keys, follower)
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
    try:
        return write(out, playback, trialid.__version__, start)
    except OSError as error:
        raise TrialidError(f"{out}: cannot be written ({error.strerror or error})") from error


def _summary(playback: "Playback", start: float, files: Sequence[Path]) -> str:
    trial = playback.trial
    end = max(playback.furthest - 1, 0) * trial.period
    lines = [f"{trial.name}: played from {start:g} to {end:g} s; band: {playback.bands.source}"]
    events = [e for e in playback.events(start) if e.warning]
    lines += [f"  {event.words}" for event in events] or ["  no alarm"]
    if playback.revised:
        moved = f"{playback.revised:.2g} sigma"
        lines.append(f"  what was shown as the log grew moved by up to {moved} once more was there")
    lines += [f"Written: {path}" for path in files]
    return "\n".join(lines)
