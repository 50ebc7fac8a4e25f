"""The command that does a first trial in one: logs in; a pipeline, a ship and a first fit out."""

import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import click

from trialid.cli.answering import answer, open_pipeline, summary_of
from trialid.cli.console import note, progress_bar, render, say
from trialid.cli.log_commands import (
    FILE,
    OF_THE_SHIP,
    begin_pipeline,
    check_new_pipeline,
    look_into,
)
from trialid.cli.particulars_options import given_from, particulars_options
from trialid.names import wording
from trialid.own_files import write_or_say_why

if TYPE_CHECKING:
    from trialid.workflow.first_pipeline import Starter
    from trialid.workflow.first_pipeline.chosen import Signal

FIRST: Final = Path("first_trial.toml")

MOST_UNREAD: Final = 8
"""Channels that are listed of which nothing is known: an autopilot's log has hundreds."""


@click.command(short_help="Logs in, a first model out: inspect, begin, fit.")
@click.argument("logs", nargs=-1, required=True, type=FILE, metavar="LOG...")
@click.option(
    "--pipeline",
    type=FILE,
    default=FIRST,
    show_default=True,
    metavar="FILE.toml",
    help="The pipeline to write; none is replaced.",
)
@click.option("--ship", type=FILE, metavar="SHIP.toml", help="The ship's file, where there is one.")
@particulars_options(*OF_THE_SHIP, prefix="Where there is none: her ")
@click.option(
    "--speed",
    type=click.FloatRange(min=0, min_open=True),
    metavar="KNOTS",
    help="The approach speed, where no log tells it.",
)
@click.option(
    "--with-template",
    "layout",
    type=FILE,
    metavar="FILE",
    help="Read tables as this template says.",
)
@click.option("--zone", help="Time zone of stamps that state none, like Europe/Oslo.")
@click.option("--dbc", type=FILE, help="What the frames of a CAN bus mean.")
@click.option("--quiet", is_flag=True, help="No progress and no summary.")
def start(
    logs: tuple[Path, ...],
    pipeline: Path,
    ship: Path | None,
    speed: float | None,
    layout: Path | None,
    zone: str | None,
    dbc: Path | None,
    quiet: bool,
    **particulars: Any,
) -> None:
    """Look into each LOG, a file or a folder, write a pipeline and a ship to begin with, and fit.

    A folder of several trials is several trials, and so are the manoeuvres of a long log; the
    middle one of all is held out. Each choice stands in the pipeline with its reason; what only you
    can know is left open there, and then nothing is fitted yet. The same by hand: `trialid inspect
    LOG... --init`, then `trialid run`.
    """
    given = given_from(particulars)
    check_new_pipeline(pipeline, ship, speed, given, "--pipeline")
    begun = begin_pipeline(look_into(logs, layout, dbc, zone), pipeline, ship, speed, given)
    told = "" if quiet else "\n".join(map(render, _told(begun)))
    if told:
        say(told)
    if begun.to_fill:
        note(f"Not fitted yet. When that is filled in: trialid run {pipeline}")
        return
    _run(pipeline, quiet, told.count("\n") + 1)


def _told(begun: "Starter") -> Iterator[str]:
    """What was taken from the logs, and what was written, in a few lines."""
    from trialid.workflow.first_pipeline.held_out import held_out, why_held_out

    names = [one.path.name if one.window is None else one.name for one in begun.trials]
    place = held_out(begun.trials)
    why = why_held_out(begun.trials)
    held = "" if place is None else f"; {names[place]}, {why}, is held out"
    yield f"{wording.count_of(len(names), 'trial')}: {_few(names)}{held}."
    for signal in begun.trials[0].signals:
        yield f"{signal.quantity}: {signal.source.key}, {signal.why}{_left_out(signal)}."
    yield from _other_sides(begun)
    yield from _set_back(begun)
    if left := [*_left_to_user(begun)]:
        yield f"In the log too, commented out in the pipeline with why: {', '.join(left)}."
    if unread := _unread(begun):
        yield f"Not read, as their names say nothing that is known: {', '.join(unread)}."
    yield f"Written, each choice with its reason: {' and '.join(map(str, begun.files))}."
    for words in begun.left_out:
        yield f"Left out: {words}."
    for words in begun.to_fill:
        yield f"To fill in: {words}"


def _other_sides(begun: "Starter") -> Iterator[str]:
    """Signals that count to another side in other trials than in the first."""
    sides = {s.source.key: s.positive for s in begun.trials[0].signals}
    for one in begun.trials[1:]:
        for s in one.signals:
            if s.positive != sides.get(s.source.key, s.positive) and not s.open:
                yield f"{s.quantity} of {one.name}: {s.why}."


def _set_back(begun: "Starter") -> Iterator[str]:
    """Logs whose clock was set back by an hour as the day has it: two hours' samples are mixed."""
    for one in begun.trials:
        found = dict.fromkeys(words for words in one.survey.warnings if wording.SET_BACK in words)
        yield from (f"CAREFUL, in {one.name}: {words}." for words in found)


def _left_to_user(begun: "Starter") -> Iterator[str]:
    """Signals that the logs hold and that are left to the user, of some trials with which."""
    found: dict[str, list[str]] = {}
    for one in begun.trials:
        for signal, _ in one.beside:
            found.setdefault(f"{signal.quantity} ({signal.source.key})", []).append(one.name)
    for words, names in found.items():
        yield words if len(names) == len(begun.trials) else f"{words} of {_few(names)}"


def _unread(begun: "Starter") -> list[str]:
    """Channels that move and that nothing is known of, as a stabiliser's; of many none.

    Of an outsider's ship her fins were, and her damping was that with them, without a word.
    """
    from trialid.inspection.channel_names import is_course
    from trialid.inspection.positions import positions
    from trialid.workflow.first_pipeline.choice import speeds_of

    first = begun.trials[0]
    signals = (*first.signals, *(signal for signal, _ in first.beside))
    taken = {one.key for signal in signals for one in (signal.source, *signal.others)}
    channels = first.survey.channels.values()
    taken |= {one.key for one in positions(channels).values()}  # commented out in the pipeline
    taken |= {one.key for one in speeds_of(first.survey)}
    taken |= {c.key for c in channels if is_course(c.name, c.description, c.stated_unit)}
    moving = [c.key for c in channels if c.guess is None and not c.constant and c.key not in taken]
    return moving if len(moving) <= MOST_UNREAD else []


def _left_out(signal: "Signal") -> str:
    """Words on other rudders, which steer her too; one of two gyros is enough."""
    from trialid.workflow.first_pipeline.choice import RUDDERS

    if signal.quantity not in RUDDERS or not signal.others:
        return ""
    names = _few([one.key for one in signal.others])
    what = "another of them" if len(signal.others) == 1 else "others of them"
    return f"; CAREFUL: {names}, {what}, left out: commented out in the pipeline"


def _few(names: Sequence[str]) -> str:
    """The first names, and how many more.

    >>> _few(["a", "b", "c", "d", "e"])
    'a, b, c and 2 more'
    """
    more = len(names) - 3
    return ", ".join(names[:3]) + (f" and {more} more" if more > 0 else "")


def _run(pipeline: Path, quiet: bool, above: int) -> None:
    """The run, its folder and its screen, below so many lines."""
    asked, folder = open_pipeline(pipeline, None)
    from trialid.workflow.run import run
    from trialid.workflow.write_run import write

    with progress_bar(shown=not quiet and sys.stderr.isatty()) as progress:
        done = run(asked, progress)
        with write_or_say_why(folder, "--pipeline"):
            write(done, folder)
    answer(done.result, folder, False, quiet, summary_of(str(pipeline), above))
