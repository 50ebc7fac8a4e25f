"""The commands about finished runs: their report as files, and the same run once more."""

import json
import sys
from collections.abc import Sequence
from pathlib import Path

import click

from trialid import own_files, temporary
from trialid.cli.console import complain, progress_bar, say
from trialid.errors import TrialidError

DIFFERENT = 1
"""Exit status where a repeated run gives other numbers."""


@click.command(short_help="Write the report of a run, or of several side by side.")
@click.argument("runs", type=click.Path(path_type=Path), nargs=-1, metavar="RUN_DIR...")
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar="DIR",
    help="Folder for what is written; by default the run's own, of several runs `comparison`.",
)
@click.option("--imo", is_flag=True, help="Instead: the form that is handed in, imo.html.")
@click.option("--quiet", is_flag=True, help="Say nothing.")
@click.option("--schema", is_flag=True, help="Instead: print the JSON Schema of result.json.")
def report(runs: tuple[Path, ...], out: Path | None, imo: bool, quiet: bool, schema: bool) -> None:
    """Write the report of one run, or of several side by side, from their folders.

    Nothing is computed anew. One run: report.html, its tables as CSV, Markdown and LaTeX
    (`pdflatex tables.tex` sets them all), its figures as SVG. Several: compare.html and its tables,
    and in a folder for each run its own report. --imo, of one run: imo.html to print, its tables in
    imo/.
    """
    if schema:
        from trialid.result.json_file import json_schema

        say(json.dumps(json_schema(), indent=1))
        return
    if not runs:
        raise click.UsageError("Missing argument 'RUN_DIR...'.")
    if imo and len(runs) > 1:
        raise click.UsageError("--imo is of one run; give one RUN_DIR.")
    from trialid.report.pages.folder import read_run, write_one, write_several
    from trialid.report.pages.imo_form import write_form
    from trialid.result import json_file

    labels = run_labels(runs)
    read = [
        read_run(label, folder, json_file.read(folder / json_file.NAME))
        for label, folder in zip(labels, runs, strict=True)
    ]
    place = out or (runs[0] if len(runs) == 1 else Path("comparison"))
    _check_place(place, runs)
    with own_files.write_or_say_why(place):
        if len(read) == 1:
            page, files = (write_form if imo else write_one)(read[0], place)
        else:
            page, files = write_several(read, place)
            for each in read:
                own = place / each.label
                files += 1 + write_one(each, own)[1]
    if not quiet:
        say(f"Report: {page}\n{files} tables, figures and pages beside it")


def run_labels(runs: Sequence[Path]) -> list[str]:
    """A name for each run: its folder's, with a number where two are called alike.

    >>> run_labels([Path("runs/a"), Path("b"), Path("old/a")])
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
    temporary.check_writable(place)
    own = [folder.resolve() for folder in runs]
    if len(runs) > 1 and place.resolve() in own:
        raise TrialidError(f"{place}: is the folder of one of the runs; choose another --out")
    if len(runs) == 1 and place.resolve() != own[0] and (place / "run.json").exists():
        raise TrialidError(f"{place}: is the folder of another run; choose another --out")


def repeat_run(folder: Path, as_json: bool, quiet: bool) -> bool:
    """Run what a folder holds once more and say whether the numbers are the same."""
    from trialid.result.json_file import plain
    from trialid.workflow.repeat import comparison_words, earlier, repeat

    done = earlier(folder)
    with progress_bar(shown=not quiet and sys.stderr.isatty()) as progress:
        fresh, found = repeat(done, progress)
    words = comparison_words(found, done.result, fresh.result)
    if as_json:
        say(json.dumps(plain(fresh.result), indent=2, allow_nan=False))
    if not quiet or not found.same:
        (complain if as_json or not found.same else say)(words)
    return found.same
