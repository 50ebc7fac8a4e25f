"""`trialid run --auto`: the loop stage by stage, and in words why it ended."""

import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from trialid.cli.answering import answer, summary_of
from trialid.cli.console import Progress, progress_bar, render, say
from trialid.own_files import write_or_say_why

if TYPE_CHECKING:
    from trialid.pipeline_file import Pipeline
    from trialid.workflow.grow import Stage


def grow_and_answer(
    asked: "Pipeline", folder: Path, keep: bool, as_json: bool, quiet: bool
) -> None:
    """Add what is missing, one line for each step, and show the last model."""
    from trialid.pipeline_file.rewrite import check_is_no_copy
    from trialid.workflow.edit_model import commit
    from trialid.workflow.grow import conclude
    from trialid.workflow.write_run import write

    if keep:
        check_is_no_copy(asked.path)
    told = not (as_json or quiet)
    done = list(_stages(asked, told, shown=not quiet and sys.stderr.isatty()))
    last, steps = conclude(done)
    with write_or_say_why(folder):
        if keep and steps:
            commit(asked, done[-1].pipeline, last, steps, folder)
        else:
            write(last, folder)
    foot = _loop_ended(done, asked.path, keep)
    file = str(asked.path) if keep else ""  # to add to a file that lacks the rest is another model
    above = 2 + sum(stage.kept for stage in done)
    if told:
        say("")
    answer(last.result, folder, as_json, quiet, summary_of(file, above), foot)


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
    """Why no more was added, and what the file holds now, in lines of this terminal."""
    from trialid.diagnosis.search.backward import worth_naming
    from trialid.workflow.grow import survivors

    added = survivors(done)
    refused = (stage.refused for stage in done[:-1] if not stage.kept)  # the last is the end
    words = "".join(f"Tried and not kept: {why}.\n" for why in refused)
    words += f"Added no more: {done[-1].end}."
    if names := worth_naming(done[-1].worths):
        costed = {one.effect for one in done[-1].worths}
        rest = [n for n in added if n in costed and n not in names]
        there = done[-1].pipeline.model.effects
        placed = [n for n in added if n not in costed and n in there]
        corrected = (
            f"; each worth less than a tenth, which the shapes of others may be: {', '.join(rest)}"
            if rest
            else ""
        )
        instead = f"; in the place of what the file had: {', '.join(placed)}" if placed else ""
        listed = f"{', '.join(names)}{corrected}{instead}"
        words += f"\nWhat was added, the dearest to leave out first: {listed}."
    free = {*done[-1].pipeline.identify.free} - {one.effect for one in done[-1].worths}
    if freed := [n for n in added if n in free]:
        words += f"\nFree now, about her file's values: {', '.join(freed)}."
    if added and keep:
        words += f"\n{pipeline} now has {', '.join(added)}."
    elif added:
        words += f"\n{pipeline} is as it was; --write puts {', '.join(added)} into it."
    return render(words) + "\n"
