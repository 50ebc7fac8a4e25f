"""The command `trialid`: files in, a report out, one line for every mistake.

Everything heavy is imported inside the commands, so that `trialid --help` answers at once.
"""

import errno
import io
import sys
import warnings
from collections.abc import Callable
from functools import partial
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Final

import click

from trialid import temporary
from trialid.cli.answering import answer, check_draft, open_pipeline, summary_of, write_draft
from trialid.cli.console import (
    complain,
    let_go,
    no_room,
    note,
    open_streams,
    progress_bar,
    render,
    say,
)
from trialid.cli.demo_command import demo
from trialid.cli.design_command import design
from trialid.cli.effects_command import effects
from trialid.cli.export_command import export
from trialid.cli.grow_loop import grow_and_answer
from trialid.cli.guide_command import guide
from trialid.cli.log_commands import align, inspect
from trialid.cli.many import batch, structures
from trialid.cli.one_line_errors import WRONG_INPUT, OneLineErrors
from trialid.cli.replay_command import replay
from trialid.cli.report_commands import DIFFERENT, repeat_run, report
from trialid.cli.ship_command import ship
from trialid.cli.simulate_command import simulate
from trialid.cli.start_command import start
from trialid.cli.workbench_command import workbench
from trialid.own_files import write_or_say_why
from trialid.version import VERSION

if TYPE_CHECKING:
    from trialid.result.schema import Result

FULL: Final = (errno.ENOSPC, errno.EDQUOT, errno.EIO, errno.EBADF)
"""What a stream says that takes no more."""


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


@commands.command(short_help="Fit a model to the logs of a pipeline; what is missing?")
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
    asked, folder = open_pipeline(pipeline, out)
    check_draft(draft)
    if auto:
        grow_and_answer(asked, folder, keep, as_json, quiet)
        return
    # The chain takes a second to import: a misspelt key is answered before.
    from trialid.workflow.run import run as identify_from
    from trialid.workflow.write_run import write

    with progress_bar(shown=not quiet and sys.stderr.isatty()) as progress:
        done = identify_from(asked, progress, force=draft is not None)
        with write_or_say_why(folder):
            write(done, folder)
    answer(
        done.result,
        folder,
        as_json,
        quiet,
        summary_of(str(asked.path), above=2 * (draft is not None)),
    )
    if draft is not None:
        said = write_draft(draft, done)
        if not quiet:
            note(said) if as_json else say(render(said))


@commands.command(short_help="Write an effect into a pipeline and fit again.")
@_of_a_run
@click.argument("effect")
def add(pipeline: Path, effect: str, out: Path | None, as_json: bool, quiet: bool) -> None:
    """Write EFFECT into PIPELINE, fit again, and show the model before and after.

    Its parameters become free; comments and form of the file are kept. The error, what it is made
    of and every parameter that moved stand side by side, and the step goes into the history beside
    the pipeline. `trialid drop` undoes it.
    """
    _change("added", pipeline, effect, out, as_json, quiet)


@commands.command(short_help="Take an effect out of a pipeline and fit again.")
@_of_a_run
@click.argument("effect")
def drop(pipeline: Path, effect: str, out: Path | None, as_json: bool, quiet: bool) -> None:
    """Take EFFECT out of PIPELINE, fit again, and show the model before and after.

    After `trialid add` the file is as it was, byte for byte.
    """
    _change("dropped", pipeline, effect, out, as_json, quiet)


OF_LOGS = (inspect, align, start, ship, replay)
OF_MODELS = (effects, design, report, simulate, export, structures, batch)
for command in (*OF_LOGS, *OF_MODELS, demo, workbench, guide):
    commands.add_command(command)


def main() -> None:
    """Run the command line and leave with its exit status."""
    open_streams()
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")  # a terminal without Greek is no reason to fail
    sys.excepthook = _report_bug
    # NumPy's, of numbers far out in a log: what comes of them is checked, and told in our words
    warnings.filterwarnings("ignore", category=RuntimeWarning)
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


def _change(
    step: str, pipeline: Path, effect: str, out: Path | None, as_json: bool, quiet: bool
) -> None:
    """Add or drop an effect, and show what it changed."""
    asked, folder = open_pipeline(pipeline, out)
    from trialid.pipeline_file.rewrite import check_is_no_copy

    check_is_no_copy(pipeline)
    temporary.check_writable(pipeline.parent, "place for the pipeline")
    from trialid.workflow.edit_model import carry_out, commit
    from trialid.workflow.edit_pipeline import add_to_pipeline, difference_words, drop_from_pipeline

    edit = (add_to_pipeline if step == "added" else drop_from_pipeline)(asked, effect)
    with progress_bar(shown=not quiet and sys.stderr.isatty()) as progress:
        done = carry_out(edit, folder, progress)
        with write_or_say_why(folder):
            commit(asked, done.edit.after, done.run, done.steps, folder)
    for words in edit.taken_out:
        complain(f"{pipeline}: taken out with {effect}: {words}")
    back = f"trialid {'drop' if step == 'added' else 'add'} {pipeline} {effect}"
    foot = f"{pipeline}: {difference_words(done.edit)}\nUndo: {back}\n"
    answer(done.run.result, folder, as_json, quiet, partial(_beside, str(pipeline)), foot)


def _beside(file: str, result: "Result", lines: int) -> str:
    """The model before and after."""
    from trialid.report.terminal.before_after import before_after

    return render(before_after(result, file, lines))


def _report_bug(
    kind: type[BaseException], error: BaseException, trace: TracebackType | None
) -> None:
    """Show the traceback and say whose fault it is; Python then leaves with status 1."""
    sys.__excepthook__(kind, error, trace)
    complain(f"this is a bug in trialid, not a mistake of yours: {kind.__name__}: {error}")
