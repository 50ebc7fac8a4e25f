"""The command that hands a fitted model over to other programs."""

import json
import sys
from collections.abc import Mapping
from math import inf, radians
from pathlib import Path
from typing import Final

import click

from trialid import temporary
from trialid.cli.console import note, progress_bar, say
from trialid.errors import TrialidError
from trialid.names.model_kinds import KINDS

FILE = click.Path(path_type=Path)
FULL: Final = 90.0
"""deg beyond which no rudder goes."""


@click.command(short_help="Write the fitted model: ship file, JSON, NumPy, C, FMU.")
@click.argument("run", type=FILE, metavar="RUN_DIR", required=False)
@click.option(
    "--as",
    "kind",
    type=click.Choice([*KINDS]),
    help="; ".join(f"{name}: {kind.words}" for name, kind in KINDS.items()) + ".",
)
@click.option(
    "--out",
    type=FILE,
    metavar="FILE",
    help="Where; by default the name of the run's folder and what it is, here.",
)
@click.option(
    "--bandwidth",
    type=float,
    metavar="RAD/S",
    help="Of gains: how fast; by default as fast as the ship (pid), or twice that (ardupilot).",
)
@click.option(
    "--full-rudder", type=float, metavar="DEG", help="Of ardupilot: rudder at full output."
)
@click.option(
    "--full-command",
    type=float,
    metavar="NUMBER",
    help="Of ardupilot and pid, two thrusters: command at full output [rpm, N or share].",
)
@click.option("--force", is_flag=True, help="Replace what is there.")
@click.option("--anyway", is_flag=True, help="Of a fit that carries no verdict, too.")
@click.option("--quiet", is_flag=True, help="No progress, and no words about what was written.")
@click.option("--schema", is_flag=True, help="Instead: print the JSON Schema of --as json.")
def export(
    run: Path | None,
    kind: str | None,
    out: Path | None,
    bandwidth: float | None,
    full_rudder: float | None,
    full_command: float | None,
    force: bool,
    anyway: bool,
    quiet: bool,
    schema: bool,
) -> None:
    """Write the model of a finished run for other programs, with how sure its numbers are.

    Each file holds the fitted values, where each is likely to lie, what the trials held of speeds
    and angles, and which logs it was fitted to; beyond what was seen the model says so itself.
    """
    if schema:
        from trialid.export.model.json_model import model_schema

        say(json.dumps(model_schema(), indent=1))
        return
    if run is None or kind is None:
        missing = "argument 'RUN_DIR'" if run is None else f"option '--as' ({', '.join(KINDS)})"
        raise click.UsageError(f"Missing {missing}.")
    places = _places(run, kind, out, force=force)
    from trialid.workflow.use.finished_model import finished_model
    from trialid.workflow.use.hand_over import WRITERS, beside_words
    from trialid.workflow.use.steering import Wishes

    rudder = None if full_rudder is None else radians(_rudder(full_rudder))
    wishes = Wishes(bandwidth, rudder, _command(full_command))

    with progress_bar(shown=not quiet and sys.stderr.isatty()) as progress:
        model = finished_model(run, progress, anyway=anyway)
        made = WRITERS[kind](model, places[0].stem, wishes)
    _write({place: _bytes(made[place.suffix]) for place in places})
    if not quiet:
        for words in filter(None, (*model.doubts, beside_words(made))):
            note(words)
        say(f"Written: {', '.join(map(str, places))}")


def _write(contents: Mapping[Path, bytes]) -> None:
    """Write the files together.

    Raises
    ------
    TrialidError
        One of them cannot be written.
    """
    try:
        temporary.replace_all(contents)
    except OSError as error:
        why = (error.strerror or str(error)).lower()
        raise TrialidError(f"--out {next(iter(contents))}: {why}") from error


def _bytes(content: str | bytes) -> bytes:
    return content if isinstance(content, bytes) else content.encode()


def _rudder(full: float) -> float:
    """The angle of a full rudder [deg].

    Raises
    ------
    TrialidError
        It is none.
    """
    if not 0.0 < full <= FULL:
        raise TrialidError(
            f"--full-rudder {full:g}: expected an angle above 0 and at most {FULL:g} deg"
        )
    return full


def _command(full: float | None) -> float | None:
    """The command of a thruster at full output.

    Raises
    ------
    TrialidError
        It is none.
    """
    if full is not None and not 0.0 < full < inf:
        raise TrialidError(f"--full-command {full:g}: expected a number above 0")
    return full


def _places(run: Path, kind: str, out: Path | None, *, force: bool) -> list[Path]:
    """Where the files go, checked before the work.

    Raises
    ------
    TrialidError
        One is there already, or cannot be written, or is called by another ending.
    """
    from trialid.export import check_place

    first = out or Path(f"{run.resolve().name}_{kind}{KINDS[kind].suffixes[0]}")
    places = [first.with_suffix(suffix) for suffix in KINDS[kind].suffixes]
    check_place(first, replace=force, formats=KINDS[kind].suffixes[:1], more=places[1:])
    return places
