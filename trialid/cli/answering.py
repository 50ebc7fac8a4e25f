"""From a pipeline file to its answer on a screen: the folder, the summary, or plain data."""

import json
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from trialid import temporary
from trialid.cli.console import complain, render, say, screen_less
from trialid.errors import TrialidError, nearest

if TYPE_CHECKING:
    from trialid.pipeline_file import Pipeline
    from trialid.result.schema import Result
    from trialid.workflow.outcome import Run


def open_pipeline(pipeline: Path, out: Path | None) -> tuple["Pipeline", Path]:
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


def answer(
    result: "Result",
    folder: Path,
    as_json: bool,
    quiet: bool,
    show: "Callable[[Result, int], str]",
    foot: str = "",
) -> None:
    """Print a result the way that was asked for.

    `show` gives it in so many lines; with what stands at its foot it fits one screen.
    """
    if result.history_remark:
        complain(result.history_remark)
    if as_json:
        from trialid.result.json_file import plain

        say(json.dumps(plain(result), indent=2, allow_nan=False))
    elif not quiet:
        foot += f"Report: {folder / 'report.html'}"
        say(f"{show(result, screen_less(foot))}\n{foot}")


def summary_of(pipeline: str, above: int = 0) -> "Callable[[Result, int], str]":
    """Give what shows the summary of a run of a pipeline, below so many lines of the screen."""

    def show(result: "Result", lines: int) -> str:
        from trialid.report.terminal.summary import summary

        return render(summary(result, pipeline, lines - above))

    return show


def _short(folder: Path) -> str:
    """A path short enough for one line."""
    text = str(folder)
    return text if len(text) <= 80 else f"{text[:40]}...{text[-37:]}"


def check_draft(draft: Path | None) -> None:
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


def write_draft(draft: Path, done: "Run") -> str:
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


def check_trial_names(asked: Sequence[str], known: Sequence[str], pipeline: Path) -> None:
    """TrialidError for a name that no trial of the pipeline has."""
    for name in asked:
        if name not in known:
            raise TrialidError(f"{pipeline}: no trial {name!r}; {nearest(name, known)}")
