"""The command that hands a fitted model over to other programs."""

import json
import sys
from pathlib import Path
from typing import Final

import click

from trialid import temporary
from trialid.cli.console import note, progress_bar, say
from trialid.errors import TrialidError

FILE = click.Path(path_type=Path)
KINDS: Final = {
    "ship": (".toml",),
    "json": (".json",),
    "python": (".py",),
    "c": (".c", ".h"),
    "fmu": (".fmu",),
    "nomoto": (".json",),
}
"""What a model can be written as, and how the files end; `hand_over` has what they hold."""


@click.command(short_help="Write the fitted model: ship file, JSON, NumPy, C, FMU.")
@click.argument("run", type=FILE, metavar="RUN_DIR", required=False)
@click.option(
    "--as",
    "kind",
    type=click.Choice([*KINDS]),
    help="ship: a ship file for a next pipeline; json: plain data; python: one file that needs "
    "NumPy alone; c: C99 with a header; fmu: FMI 2.0 for co-simulation; nomoto: K and T.",
)
@click.option(
    "--out",
    type=FILE,
    metavar="FILE",
    help="Where; by default the name of the run's folder and what it is, here.",
)
@click.option("--force", is_flag=True, help="Replace what is there.")
@click.option("--anyway", is_flag=True, help="Of a fit that carries no verdict, too.")
@click.option("--quiet", is_flag=True, help="No progress, and no words about what was written.")
@click.option("--schema", is_flag=True, help="Instead: print the JSON Schema of --as json.")
def export(
    run: Path | None,
    kind: str | None,
    out: Path | None,
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
    places = _places(run, kind, out, force)
    from trialid.workflow.use.finished_model import finished_model
    from trialid.workflow.use.hand_over import FORMATS

    with progress_bar(shown=not quiet and sys.stderr.isatty()) as progress:
        model = finished_model(run, progress, anyway=anyway)
        made = FORMATS[kind].write(model, places[0].stem)
    for place in places:
        try:
            with temporary.replace_whole(place) as ready:
                content = made[place.suffix]
                ready.write_bytes(content if isinstance(content, bytes) else content.encode())
        except OSError as error:
            raise TrialidError(
                f"--out {place}: {(error.strerror or str(error)).lower()}"
            ) from error
    if not quiet:
        for words in model.doubts:
            note(words)
        say(f"Written: {', '.join(map(str, places))}")


def _places(run: Path, kind: str, out: Path | None, force: bool) -> list[Path]:
    """Where the files go, checked before the work.

    Raises
    ------
    TrialidError
        One is there already, or cannot be written, or is called by another ending.
    """
    first = out or Path(f"{run.resolve().name}_{kind}{KINDS[kind][0]}")
    if first.suffix != KINDS[kind][0]:
        raise TrialidError(
            f"--out {first}: --as {kind} writes a file that ends in {KINDS[kind][0]}"
        )
    if not first.parent.is_dir():
        raise TrialidError(f"--out {first}: there is no folder {first.parent}; make it first")
    places = [first.with_suffix(suffix) for suffix in KINDS[kind]]
    for place in places:
        if place.is_dir():
            raise TrialidError(f"--out {first}: {place} is a folder; name a file")
        if (place.exists() or place.is_symlink()) and not force:
            raise TrialidError(f"--out {first}: {place} exists; name another, or add --force")
    temporary.check_writable(first.parent)
    return places
