"""Tables and words for a terminal, as wide as it is."""

import textwrap
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, Literal

from trialid.names import wording

if TYPE_CHECKING:
    from rich.console import Console, ConsoleOptions, RenderableType, RenderResult
    from rich.table import Table
    from rich.text import Text

WIDTH: Final = 98
"""Columns beyond which words are hard to read."""

SCREEN: Final = (39, 80)
"""Lines and columns that the first screen may take: a terminal of 40 less the prompt below."""


@dataclass(frozen=True)
class Words:
    """A sentence in so many lines of `SCREEN`, and in more on a narrower terminal."""

    text: str
    lines: int
    style: str = ""

    def __rich_console__(self, console: "Console", options: "ConsoleOptions") -> "RenderResult":
        """Break it where this terminal ends."""
        from rich.text import Text

        width = min(options.max_width, WIDTH)
        lines = max(self.lines, -(-self.lines * SCREEN[1] // width))
        yield Text(cut(self.text, lines, width), style=self.style)


@dataclass(frozen=True)
class FirstThatFits:
    """The first of several forms of the same, longest first, that takes no more than so many lines.

    The last where none does.
    """

    forms: Sequence[Callable[[], "RenderableType"]]
    lines: int

    def __rich_console__(self, console: "Console", options: "ConsoleOptions") -> "RenderResult":
        """Try one form after the other at the width of this terminal."""
        for form in self.forms[:-1]:
            made = form()
            if len(console.render_lines(made, options, pad=False)) <= self.lines:
                yield made
                return
        yield self.forms[-1]()


def new_table(*headings: str, words: int) -> "Table":
    """A table without rules: so many columns of words, which give way, the rest of numbers."""
    from rich.table import Table

    table = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0), header_style="dim")
    for place, heading in enumerate(headings):
        side: Literal["left", "right"] = "left" if place < words else "right"
        # a column that may wrap gives way first; the cells cut their words and never wrap
        table.add_column(_uncut(heading), justify=side, no_wrap=place >= words, overflow="ellipsis")
    return table


def add_row(table: "Table", *cells: str, style: str | None = None) -> None:
    """One more row."""
    table.add_row(*map(_uncut, cells), style=style)


def _uncut(cell: str) -> "Text":
    """Words that stay on one line."""
    from rich.text import Text

    return Text(cell, no_wrap=True, overflow="ellipsis")


def cut(words: str, lines: int, width: int = WIDTH) -> str:
    """Words on so many lines; the page has the rest."""
    wrapped = textwrap.wrap(
        words, width, max_lines=lines, placeholder=" ...", break_on_hyphens=False
    )
    return "\n".join(wrapped)


def percents(values: Iterable[float | None]) -> list[str]:
    """Fractions as percentages."""
    return [percent(value) for value in values]


def percent(value: float | None) -> str:
    """A fraction as a percentage, a dash where it is not known."""
    return plain(wording.percent(value))


def number(value: float | None, digits: int) -> str:
    """A number as programs write it: it may be copied from here into a file."""
    return wording.DASH if value is None else f"{value:#.{digits}g}".rstrip(".")


def times(value: float | None, factor: float) -> float | None:
    """A value in another unit."""
    return None if value is None else value * factor


def plain(words: str) -> str:
    """Words with the spaces of a keyboard."""
    return words.replace(wording.THIN, " ")
