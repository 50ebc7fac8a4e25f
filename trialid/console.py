"""What the commands share: words to a terminal, progress, one line for a mistake."""

import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import click

Progress = Callable[[str, float | None], None]
"""Takes a short sentence and the fraction done, None where nobody knows it."""


@contextmanager
def progress_bar(*, shown: bool) -> Iterator[Progress]:
    """Give the function that shows progress on stderr, or one that keeps silent."""
    if not shown:
        yield _silent
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


def _silent(sentence: str, fraction: float | None) -> None:
    """Show nothing."""


def file_width() -> int | None:
    """Room for whole lines where no terminal cuts them: in a file or a pipe."""
    return None if sys.stdout.isatty() or "COLUMNS" in os.environ else 160


def rendered(*parts: Any, width: int | None = None) -> str:
    """Give what rich makes of them as text for this stdout, in colour where it is a terminal."""
    from rich.console import Console

    console = Console(width=width)
    with console.capture() as capture:
        for part in parts:
            console.print(part, markup=False, highlight=False)
    return "\n".join(line.rstrip() for line in capture.get().rstrip("\n").split("\n"))


def say(text: str) -> None:
    """Write to stdout; a reader that left early (`| head`) has what it wanted."""
    try:
        click.echo(text)
    except BrokenPipeError:
        # Python flushes stdout once more on leaving and would complain into the closed pipe.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def complain(message: str) -> None:
    """Write a message to stderr, on one line."""
    folded = " ".join(line.strip() for line in message.splitlines())
    click.echo(f"trialid: {folded}", err=True)
