"""The command `trialid`: files in, a report out, one line for every mistake.

Everything heavy is imported inside the commands, so that `trialid --help` answers at once.
"""

import errno
import io
import json
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Final

import click

from trialid import temporary
from trialid.cli.console import (
    Progress,
    complain,
    file_width,
    let_go,
    no_room,
    note,
    open_streams,
    progress_bar,
    render,
    say,
)
from trialid.cli.design_command import design
from trialid.cli.guide_command import guide
from trialid.cli.log_commands import align, inspect
from trialid.cli.replay_command import replay
from trialid.cli.report_commands import DIFFERENT, repeat_run, report
from trialid.cli.structures_command import structures
from trialid.cli.workbench_command import workbench
from trialid.errors import TrialidError
from trialid.version import VERSION

if TYPE_CHECKING:
    from trialid.pipeline_file import Pipeline
    from trialid.result.schema import Result
    from trialid.workflow.grow import Stage
    from trialid.workflow.outcome import Run

WRONG_INPUT: Final = 2
FULL: Final = (errno.ENOSPC, errno.EDQUOT, errno.EIO, errno.EBADF)
"""What a stream says that takes no more."""
STOPPED: Final = 130
"""128 + SIGINT, as shells report a command stopped by the keyboard."""


class OneLineErrors(click.Group):
    """A group whose commands answer the user's mistakes with one line and an exit status."""

    def invoke(self, ctx: click.Context) -> Any:
        """Run a command; status 2 for wrong input, 130 when stopped by the keyboard."""
        try:
            return super().invoke(ctx)
        except TrialidError as error:
            complain(str(error))
            ctx.exit(WRONG_INPUT)
        except OSError as error:
            if error.filename is None:  # no file of the user's: ours to mend
                raise
            complain(str(TrialidError(f"{error.filename}: {(error.strerror or '').lower()}")))
            ctx.exit(WRONG_INPUT)
        except KeyboardInterrupt:
            complain("stopped; no half-written results are left")
            ctx.exit(STOPPED)


@click.group(cls=OneLineErrors, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(VERSION, prog_name="trialid")
def commands() -> None:
    """Turn a sea trial into a ship model you can trust."""


def _of_a_run(command: Callable[..., None]) -> Callable[..., None]:
    """What every command that changes a pipeline takes: it, and where and how to answer."""
    return _answering(click.argument("pipeline", type=click.Path(path_type=Path))(command))


def _answering(command: Callable[..., None]) -> Callable[..., None]:
    """What every command that fits takes: where and how to answer."""
    for option in (
        click.option("--quiet", is_flag=True, help="No progress and no summary."),
        click.option("--json", "as_json", is_flag=True, help="Print result.json, nothing else."),
        click.option(
            "--out",
            type=click.Path(path_type=Path),
            help="Folder for the results; by default runs/ and the pipeline's name. "
            "An earlier run in it is replaced.",
        ),
    ):
        command = option(command)
    return command


@commands.command()
@_answering
@click.argument("pipeline", type=click.Path(path_type=Path), required=False)
@click.option("--auto", is_flag=True, help="Add what is missing until nothing more is named.")
@click.option("--write", "keep", is_flag=True, help="With --auto: write the effects into PIPELINE.")
@click.option(
    "--draft",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Where something is missing that no known effect makes: write it as a .py file to edit.",
)
@click.option(
    "--repeat",
    type=click.Path(path_type=Path),
    metavar="RUN_DIR",
    help="Instead of PIPELINE: do the run of this folder again, and compare; nothing is written.",
)
def run(
    pipeline: Path | None, out: Path | None, as_json: bool, quiet: bool, auto: bool, keep: bool,
    draft: Path | None, repeat: Path | None,
) -> None:  # fmt: skip
    """Fit a ship model to the logs of PIPELINE, a TOML file, and report what it is worth.

    Logs are aligned, the free parameters fitted and rated, the misfit located, the missing effect
    sought; report, tables and data go to a folder.

    With --auto the effect that is named is added, in memory, and all is done again, until no effect
    is named or what is added makes it no better; the results are of the last model.

    With --repeat the logs are held against their hashes; exit status 1 if the numbers are others.
    """
    if repeat is not None:
        if any((pipeline, out, auto, keep, draft)):
            raise click.UsageError("--repeat takes its pipeline from RUN_DIR and writes nothing")
        sys.exit(0 if repeat_run(repeat, as_json, quiet) else DIFFERENT)
    _check_options(auto, keep, draft)
    if pipeline is None:
        raise click.UsageError("Missing argument 'PIPELINE'.")
    asked, folder = _opened(pipeline, out)
    _check_draft(draft)
    if auto:
        _grow(asked, folder, keep, as_json, quiet)
        return
    # The chain takes a second to import: a misspelt key is answered before.
    from trialid.workflow.run import run as identify_from
    from trialid.workflow.write_run import write

    with progress_bar(shown=not quiet and sys.stderr.isatty()) as progress:
        done = identify_from(asked, progress, force=draft is not None)
        with _writing(folder):
            write(done, folder)
    _answer(done.result, folder, as_json, quiet, _summary)
    if draft is not None:
        said = _write_draft(draft, done)
        if not quiet:
            (note if as_json else say)(said)


@commands.command()
@_of_a_run
@click.argument("effect")
def add(pipeline: Path, effect: str, out: Path | None, as_json: bool, quiet: bool) -> None:
    """Write EFFECT into PIPELINE, fit again, and show the model before and after.

    Its parameters become free; comments and form of the file are kept. The error, what it is made
    of and every parameter that moved stand side by side, and the step goes into the history beside
    the pipeline. `trialid drop` undoes it.
    """
    _change("added", pipeline, effect, out, as_json, quiet)


@commands.command()
@_of_a_run
@click.argument("effect")
def drop(pipeline: Path, effect: str, out: Path | None, as_json: bool, quiet: bool) -> None:
    """Take EFFECT out of PIPELINE, fit again, and show the model before and after.

    After `trialid add` the file is as it was, byte for byte.
    """
    _change("dropped", pipeline, effect, out, as_json, quiet)


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
    from trialid.report.terminal.catalogue import list_effects, plain, plain_list, sheet

    own = {n: e for path in own_files for n, e in from_file(path).items()}
    everything = {**CATALOGUE, **own}
    if as_json:
        data = plain(find(name, own)) if name else plain_list(everything)
        say(json.dumps(data, indent=2, allow_nan=False))
    else:
        shown = sheet(find(name, own)) if name else list_effects(everything)
        say(render(*shown, width=None if name else file_width()))


for command in (inspect, align, design, report, replay, structures, workbench, guide):
    commands.add_command(command)


def main() -> None:
    """Run the command line and leave with its exit status."""
    open_streams()
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")  # a terminal without Greek is no reason to fail
    sys.excepthook = _report_bug
    try:
        commands(prog_name="trialid")
    except OSError as error:  # of click's own texts, as --help; those of ours go through `say`
        if error.filename is not None or error.errno not in FULL:
            raise
        complain(no_room(error))
        let_go(sys.stdout)
        sys.exit(WRONG_INPUT)


def _check_options(auto: bool, keep: bool, draft: Path | None) -> None:
    """Refuse what makes no sense together."""
    if keep and not auto:
        raise click.UsageError("--write goes with --auto: a plain run changes no file")
    if draft is not None and auto:
        raise click.UsageError("--draft goes with a plain run: add what is known first")


def _opened(pipeline: Path, out: Path | None) -> tuple["Pipeline", Path]:
    """The pipeline, and the folder for its results, which may be replaced."""
    from trialid.pipeline_file import load
    from trialid.workflow.run_folder import check_replaceable, folder_of

    asked = load(pipeline)
    folder = out or folder_of(asked)
    try:
        check_replaceable(folder, asked)
        temporary.check_writable(folder)
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        raise TrialidError(f"{_short(folder)}: {reason}; choose another --out") from error
    return asked, folder


def _change(
    step: str, pipeline: Path, effect: str, out: Path | None, as_json: bool, quiet: bool
) -> None:
    """Add or drop an effect, and show what it changed."""
    asked, folder = _opened(pipeline, out)
    temporary.check_writable(pipeline.parent, "place for the pipeline")
    from trialid.workflow.edit_model import (
        add_to_pipeline,
        carry_out,
        commit,
        difference_words,
        drop_from_pipeline,
    )

    edit = (add_to_pipeline if step == "added" else drop_from_pipeline)(asked, effect)
    with progress_bar(shown=not quiet and sys.stderr.isatty()) as progress:
        done = carry_out(edit, folder, progress)
        with _writing(folder):
            commit(asked, done.edit.after, done.run, done.steps, folder)
    for words in edit.taken_out:
        complain(f"{pipeline}: taken out with {effect}: {words}")
    back = f"trialid {'drop' if step == 'added' else 'add'} {pipeline} {effect}"
    foot = f"{pipeline}: {difference_words(done.edit)}\nUndo: {back}"
    _answer(done.run.result, folder, as_json, quiet, lambda result: f"{_beside(result)}\n{foot}")


def _grow(asked: "Pipeline", folder: Path, keep: bool, as_json: bool, quiet: bool) -> None:
    """Add what is missing, one line for each step, and show the last model."""
    from trialid.workflow.edit_model import commit
    from trialid.workflow.grow import conclude
    from trialid.workflow.write_run import write

    told = not (as_json or quiet)
    done = list(_stages(asked, told, shown=not quiet and sys.stderr.isatty()))
    last, steps = conclude(done)
    with _writing(folder):
        if keep and steps:
            commit(asked, done[-1].pipeline, last, steps, folder)
        else:
            write(last, folder)
    if told:
        say(_loop_ended(done, asked.path, keep))
    _answer(last.result, folder, as_json, quiet, _summary)


def _stages(asked: "Pipeline", told: bool, shown: bool) -> "Iterator[Stage]":
    """The loop's stages; the bar is gone while a line is printed."""
    from trialid.report.terminal import steps
    from trialid.workflow.grow import stage_row, stages

    bars: list[Progress] = []

    def show(sentence: str, fraction: float | None) -> None:
        bars[-1](sentence, fraction)

    loop = stages(asked, show)
    if told:
        say(steps.heading())
    while True:
        with progress_bar(shown=shown) as progress:
            bars.append(progress)
            stage = next(loop, None)
        if stage is None:
            return
        if told and stage.kept:
            present = stage.run.result.present
            say(steps.line(stage_row(stage, present)))
        yield stage


def _loop_ended(done: "Sequence[Stage]", pipeline: Path, keep: bool) -> str:
    """Why no more was added, and what the file holds now."""
    from trialid.diagnosis.search.backward import worth_naming
    from trialid.workflow.grow import survivors

    added = survivors(done)
    words = f"Added no more: {done[-1].end}."
    if names := worth_naming(done[-1].worths):
        rest = [n for n in added if n not in names]
        corrected = f"; a correction of shape without a name: {', '.join(rest)}" if rest else ""
        words += (
            f"\nWhat was missing, the dearest to leave out first: {', '.join(names)}{corrected}."
        )
    if not added:
        return f"{words}\n"
    if keep:
        return f"{words}\n{pipeline} now has {', '.join(added)}.\n"
    return f"{words}\n{pipeline} is as it was; --write puts {', '.join(added)} into it.\n"


def _answer(
    result: "Result",
    folder: Path,
    as_json: bool,
    quiet: bool,
    show: "Callable[[Result], str]",
) -> None:
    """Print a result the way that was asked for."""
    if result.history_remark:
        complain(result.history_remark)
    if as_json:
        from trialid.result.json_file import plain

        say(json.dumps(plain(result), indent=2, allow_nan=False))
    elif not quiet:
        say(f"{show(result)}\nReport: {folder / 'report.html'}")


def _beside(result: "Result") -> str:
    """The model before and after."""
    from trialid.report.terminal.before_after import before_after

    return render(before_after(result))


@contextmanager
def _writing(folder: Path) -> Iterator[None]:
    """A place that cannot be written is the user's to mend."""
    try:
        yield
    except OSError as error:
        raise TrialidError(f"{folder}: cannot be written ({error.strerror or error})") from error


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
    temporary.check_writable(draft.parent, "--draft")


def _write_draft(draft: Path, done: "Run") -> str:
    """Write the effect file; what was written or why nothing, in one line."""
    from trialid.diagnosis.force.draft import draft as drafted
    from trialid.diagnosis.force.draft import why_none

    found = done.findings.force
    if found is None:
        return "No draft: nothing is simulated, so that no force can be missing."
    text = drafted(found, done.pipeline.name)
    if text is None:
        return why_none(found)
    try:
        temporary.write_new(draft, text)
    except OSError as error:
        raise TrialidError(f"--draft {draft}: {(error.strerror or str(error)).lower()}") from error
    return f"Draft: {draft}"


def _short(folder: Path) -> str:
    """A path short enough for one line."""
    text = str(folder)
    return text if len(text) <= 80 else f"{text[:40]}...{text[-37:]}"


def _summary(result: "Result") -> str:
    """Give the one-screen summary."""
    from trialid.report.terminal.summary import summary

    return render(summary(result))


def _report_bug(
    kind: type[BaseException], error: BaseException, trace: TracebackType | None
) -> None:
    """Show the traceback and say whose fault it is; Python then leaves with status 1."""
    sys.__excepthook__(kind, error, trace)
    complain(f"this is a bug in trialid, not a mistake of yours: {kind.__name__}: {error}")
