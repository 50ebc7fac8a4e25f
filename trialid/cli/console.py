"""What the commands share: words to a terminal, progress, one line for a mistake."""

import os
import shutil
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, Final, TextIO

import click

from trialid.errors import TrialidError, harmless
from trialid.second_process import tick_beside

TICK: Final = 0.1
"""Seconds between two pictures of a progress bar."""

NARROWEST: Final = 40
"""Letters of a line that tables are still set in, whatever `COLUMNS` says."""

OURS: Final = "\ue000"
"""Stands for the escape of a colour of ours until it is written: whatever a name or a file holds,
this letter of nobody's among it, is escaped before."""

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
    made = Bars(*columns, console=Console(stderr=True), transient=True, auto_refresh=False)
    with made as bars, tick_beside(TICK, bars.refresh):  # by a thread that lets work be shared
        task = bars.add_task("reading", total=None)

        def show(sentence: str, fraction: float | None) -> None:
            total = None if fraction is None else 1.0
            said = harmless(sentence)
            bars.update(task, description=said, total=total, completed=fraction or 0.0)

        yield show


def _silent(sentence: str, fraction: float | None) -> None:
    """Show nothing."""


def file_width() -> int | None:
    """Room for whole lines where no terminal cuts them: in a file or a pipe."""
    return None if sys.stdout.isatty() or "COLUMNS" in os.environ else 160


def render(*parts: Any, width: int | None = None) -> str:
    """Give what rich makes of them as text for this stdout, in colour where it is a terminal.

    What could steer the terminal is escaped; the colours are for `say`, which alone writes them.
    """
    from rich.console import Console

    console = Console(width=width or max(Console().width, NARROWEST))
    with console.capture() as capture:
        for part in parts:
            console.print(_harmless(console, part), markup=False, highlight=False)
    lines = capture.get().replace("\x1b", OURS).rstrip("\n").split("\n")
    return "\n".join(line.rstrip() for line in lines)


def _harmless(console: Any, part: Any) -> Any:
    """The part with all its texts escaped, its colours kept."""
    if isinstance(part, str):
        return harmless(part)
    from rich.segment import Segment, Segments

    return Segments(
        [
            one if one.control else Segment(harmless(one.text), one.style)
            for one in console.render(part)
        ]
    )


def screen_less(foot: str) -> int:
    """Lines of one screen that a text at its foot leaves, on a terminal of the width it has.

    >>> screen_less("Report: runs/a/report.html")
    38
    """
    from trialid.report.terminal.terminal import SCREEN

    width = max(shutil.get_terminal_size((SCREEN[1], 0)).columns, 1)
    return SCREEN[0] - sum(max(1, -(-len(line) // width)) for line in foot.splitlines())


def say(text: str) -> None:
    """Write to stdout, the one place that does.

    A reader that left early (`| head`) has what it wanted. TrialidError where there is no room.
    """
    lines = "\x1b".join(harmless(piece) for piece in text.split(OURS))
    try:
        _write(sys.stdout, lines)
    except BrokenPipeError:
        let_go(sys.stdout)
    except OSError as error:
        let_go(sys.stdout)
        raise TrialidError(no_room(error)) from error


def no_room(error: OSError) -> str:
    """Words for an output that takes no more."""
    reason = (error.strerror or str(error)).lower()
    return f"standard output: cannot be written ({reason}); send it where there is room"


def note(text: str) -> None:
    """Write to stderr, the one place that does; who hears nothing cannot be told so."""
    try:
        _write(sys.stderr, harmless(text))
    except OSError:
        let_go(sys.stderr)


def complain(message: str) -> None:
    """Write a message to stderr, on one line."""
    note("trialid: " + " ".join(line.strip() for line in message.splitlines()))


def _write(stream: TextIO, text: str) -> None:
    click.echo(text, file=stream)


def let_go(stream: TextIO) -> None:
    """Send the rest nowhere: Python flushes once more on leaving and would complain then."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def open_streams() -> None:
    """Give the process the streams that it was begun without (`>&-`): they lead nowhere.

    Else the first file that is opened would take their place, and be written into.
    """
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        try:
            os.fstat(number)
        except OSError:
            opened = os.open(os.devnull, os.O_RDWR)
            if opened != number:
                os.dup2(opened, number)
                os.close(opened)
        if getattr(sys, name) is None:
            stream = os.fdopen(number, "w" if number else "r", encoding="utf-8", closefd=False)
            setattr(sys, name, stream)
