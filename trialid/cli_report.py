"""The commands about finished runs: their report as files, and the same run once more."""

import json
import sys
from collections.abc import Sequence
from pathlib import Path

import click

from trialid.console import complain, progress_bar, say
from trialid.errors import TrialidError

DIFFERENT = 1
"""Exit status where a repeated run gives other numbers."""


@click.command()
@click.argument(
    "runs", type=click.Path(path_type=Path), nargs=-1, required=True, metavar="RUN_DIR..."
)
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar="DIR",
    help="Folder for what is written; by default the run's own, of several runs `comparison`.",
)
@click.option("--quiet", is_flag=True, help="Say nothing.")
def report(runs: tuple[Path, ...], out: Path | None, quiet: bool) -> None:
    """Write the report of one run, or of several side by side, from their folders.

    Nothing is computed anew. One run: report.html, its tables as CSV, Markdown and LaTeX
    (`pdflatex tables.tex` sets them all), its figures as SVG. Several: compare.html and its tables,
    and in a folder for each run its own report.
    """
    from trialid.repeat import result_of
    from trialid.report.folder import finished, write_one, write_several

    labels = labelled(runs)
    read = [
        finished(label, folder, result_of(folder))
        for label, folder in zip(labels, runs, strict=True)
    ]
    place = out or (runs[0] if len(runs) == 1 else Path("comparison"))
    _check_place(place, runs)
    try:
        if len(read) == 1:
            page, files = write_one(read[0], place, place / "tables", place / "figures")
        else:
            page, files = write_several(read, place)
            for each in read:
                own = place / each.label
                files += 1 + write_one(each, own, own / "tables", own / "figures")[1]
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        raise TrialidError(f"{place}: cannot be written ({reason}); choose --out") from error
    if not quiet:
        say(f"Report: {page}\n{files} tables, figures and pages beside it")


def labelled(runs: Sequence[Path]) -> list[str]:
    """A name for each run: its folder's, with a number where two are called alike.

    >>> labelled([Path("runs/a"), Path("b"), Path("old/a")])
    ['a', 'b', 'a-2']
    """
    taken: list[str] = []
    for folder in runs:
        stem = name = folder.resolve().name or "run"
        count = 1
        while name in taken:
            count += 1
            name = f"{stem}-{count}"
        taken.append(name)
    return taken


def _check_place(place: Path, runs: Sequence[Path]) -> None:
    """Refuse a file, and of several runs the folder of one: its own report stands there."""
    if place.exists() and not place.is_dir():
        raise TrialidError(f"{place}: is a file; --out takes a folder")
    own = [folder.resolve() for folder in runs]
    if len(runs) > 1 and place.resolve() in own:
        raise TrialidError(f"{place}: is the folder of one of the runs; choose another --out")
    if len(runs) == 1 and place.resolve() != own[0] and (place / "result.json").exists():
        raise TrialidError(f"{place}: is the folder of another run; choose another --out")


def repeated(folder: Path, as_json: bool, quiet: bool) -> bool:
    """Run what a folder holds once more and say whether the numbers are the same."""
    from trialid.repeat import again, earlier, told

    done = earlier(folder)
    with progress_bar(shown=not quiet and sys.stderr.isatty()) as progress:
        fresh, found = again(done, progress)
    words = told(found, done.result, fresh.result)
    if as_json:
        say(json.dumps(fresh.result, indent=2, allow_nan=False))
    if not quiet or not found.same:
        (complain if as_json or not found.same else say)(words)
    return found.same
