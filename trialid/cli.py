"""The command `trialid`: files in, a report out, one line for every mistake.

Everything heavy is imported inside the commands, so that `trialid --help` answers at once.
"""

import io
import json
import os
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Final

import click

import trialid
from trialid.errors import TrialidError

if TYPE_CHECKING:
    from trialid.pipeline import Run
    from trialid.recipe import Recipe

WRONG_INPUT: Final = 2
STOPPED: Final = 130
"""128 + SIGINT, as shells report a command stopped by the keyboard."""

Progress = Callable[[str, float | None], None]
"""Takes a short sentence and the fraction done, None where nobody knows it."""


class OneLineErrors(click.Group):
    """A group whose commands answer the user's mistakes with one line and an exit status."""

    def invoke(self, ctx: click.Context) -> Any:
        """Run a command; status 2 for wrong input, 130 when stopped by the keyboard."""
        try:
            return super().invoke(ctx)
        except TrialidError as error:
            _complain(str(error))
            ctx.exit(WRONG_INPUT)
        except KeyboardInterrupt:
            _complain("stopped; no half-written results are left")
            ctx.exit(STOPPED)


@click.group(cls=OneLineErrors, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(trialid.__version__, prog_name="trialid")
def commands() -> None:
    """Turn a sea trial into a ship model you can trust."""


@commands.command()
@click.argument("pipeline", type=click.Path(path_type=Path))
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    help="Folder for the results; by default runs/ and the pipeline's name. "
    "An earlier run in it is replaced.",
)
@click.option("--json", "as_json", is_flag=True, help="Print result.json, and nothing else.")
@click.option("--quiet", is_flag=True, help="No progress and no summary.")
@click.option(
    "--draft",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Where something is missing that no known effect makes: write it as a .py file to edit.",
)
def run(pipeline: Path, out: Path | None, as_json: bool, quiet: bool, draft: Path | None) -> None:
    """Fit a ship model to the logs of PIPELINE, a TOML file, and report what it is worth.

    Logs are aligned, the free parameters fitted and rated, the misfit located, the missing effect
    sought; report, tables and data go to a folder.
    """
    from trialid.recipe import load

    recipe = load(pipeline)
    folder = out or Path("runs", pipeline.stem)
    try:
        _check_replaceable(folder, recipe)
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        raise TrialidError(f"{_short(folder)}: {reason}; choose another --out") from error
    _check_draft(draft)
    # The chain takes a second to import: a misspelt key is answered before.
    from trialid.pipeline import run as identify_from
    from trialid.pipeline import write

    with _progress(shown=not quiet and sys.stderr.isatty()) as progress:
        done = identify_from(recipe, progress, force=draft is not None)
        try:
            write(done, folder)
        except OSError as error:
            raise TrialidError(
                f"{folder}: cannot be written ({error.strerror or error})"
            ) from error
    if as_json:
        _print(json.dumps(done.result, indent=2, allow_nan=False))
    elif not quiet:
        _print(f"{_summary(done.result)}\nReport: {folder / 'report.html'}")
    if draft is not None:
        said = _write_draft(draft, done)
        if not quiet:
            click.echo(said, err=as_json)


@commands.command()
@click.argument("name", required=False)
@click.option(
    "--from",
    "own_files",
    type=click.Path(path_type=Path),
    multiple=True,
    help="A file of your own with effects in it; may be given again.",
)
@click.option("--json", "as_json", is_flag=True, help="Print plain data, and nothing else.")
def effects(name: str | None, own_files: tuple[Path, ...], as_json: bool) -> None:
    """List the effects a model can be made of, or tell all about the one called NAME."""
    from trialid.effects import CATALOGUE, find, from_file
    from trialid.report.catalogue import listing, plain, sheet

    own = {n: e for path in own_files for n, e in from_file(path).items()}
    chosen = {name: find(name, own)} if name else {**CATALOGUE, **own}
    if as_json:
        _print(json.dumps([plain(e) for e in chosen.values()], indent=2, allow_nan=False))
    elif name:
        _print(_rendered(*sheet(chosen[name])))
    else:
        _print(_rendered(listing(chosen)))


def main() -> None:
    """Run the command line and leave with its exit status."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")  # a terminal without Greek is no reason to fail
    sys.excepthook = _report_bug
    commands(prog_name="trialid")


def _check_replaceable(folder: Path, recipe: "Recipe") -> None:
    """Refuse, before the work, to replace a folder that holds anything but an earlier run."""
    from trialid.recipe import sources

    if folder.exists() and not folder.is_dir():
        raise TrialidError(f"{folder}: is a file; --out takes a folder")
    inside = [path for path in sources(recipe) if path.resolve().is_relative_to(folder.resolve())]
    if folder.is_dir() and inside:
        raise TrialidError(
            f"{folder}: holds {inside[0]}, which this run reads; choose another --out"
        )
    if folder.is_dir() and any(folder.iterdir()) and not (folder / "result.json").is_file():
        raise TrialidError(f"{folder}: holds other files and no earlier run; choose another --out")


def _check_draft(draft: Path | None) -> None:
    """Refuse, before the work, a place where no new effect file can be."""
    if draft is None:
        return
    if draft.exists():
        raise TrialidError(f"--draft {draft}: exists; name another file, or move it away")
    if draft.suffix != ".py":
        raise TrialidError(f"--draft {draft}: an effect file ends in .py")
    if not draft.parent.is_dir():
        raise TrialidError(f"--draft {draft}: there is no folder {draft.parent}; make it first")


def _write_draft(draft: Path, done: "Run") -> str:
    """Write the effect file; what was written or why nothing, in one line."""
    from trialid.diagnosis.draft import draft as drafted
    from trialid.diagnosis.draft import why_none

    found = done.findings.force
    assert found is not None
    text = drafted(found, done.recipe.name)
    if text is None:
        return why_none(found)
    try:
        with draft.open("x", encoding="utf-8") as stream:
            stream.write(text)
    except OSError as error:
        raise TrialidError(f"--draft {draft}: {(error.strerror or str(error)).lower()}") from error
    return f"Draft: {draft}"


def _short(folder: Path) -> str:
    """A path short enough for one line."""
    text = str(folder)
    return text if len(text) <= 80 else f"{text[:40]}...{text[-37:]}"


@contextmanager
def _progress(*, shown: bool) -> Iterator[Progress]:
    """Give the function that shows progress on stderr, or one that keeps silent."""
    if not shown:
        yield lambda sentence, fraction: None
        return
    from rich.console import Console
    from rich.progress import BarColumn, SpinnerColumn, TextColumn, TimeElapsedColumn
    from rich.progress import Progress as Bars

    sentence = TextColumn("{task.description}", markup=False)
    columns = (SpinnerColumn(), TimeElapsedColumn(), BarColumn(bar_width=20), sentence)
    with Bars(*columns, console=Console(stderr=True), transient=True) as bars:
        task = bars.add_task("reading", total=None)

        def show(sentence: str, fraction: float | None) -> None:
            total = None if fraction is None else 1.0
            bars.update(task, description=sentence, total=total, completed=fraction or 0.0)

        yield show


def _summary(result: Mapping[str, Any]) -> str:
    """Give the one-screen summary."""
    from trialid.report.summary import summary

    return _rendered(summary(result))


def _rendered(*parts: Any) -> str:
    """Give what rich makes of them as text for this stdout, in colour where it is a terminal."""
    from rich.console import Console

    console = Console()
    with console.capture() as capture:
        for part in parts:
            console.print(part, markup=False, highlight=False)
    return capture.get().rstrip("\n")


def _print(text: str) -> None:
    """Write to stdout; a reader that left early (`| head`) has what it wanted."""
    try:
        click.echo(text)
    except BrokenPipeError:
        # Python flushes stdout once more on leaving and would complain into the closed pipe.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _complain(message: str) -> None:
    folded = " ".join(line.strip() for line in message.splitlines())
    click.echo(f"trialid: {folded}", err=True)


def _report_bug(
    kind: type[BaseException], error: BaseException, trace: TracebackType | None
) -> None:
    """Show the traceback and say whose fault it is; Python then leaves with status 1."""
    sys.__excepthook__(kind, error, trace)
    _complain(f"this is a bug in trialid, not a mistake of yours: {kind.__name__}: {error}")
