"""Tables and words for a terminal, as wide as it is."""

import textwrap
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from trialid.names import wording

if TYPE_CHECKING:
    from rich.console import Console, ConsoleOptions, RenderResult
    from rich.table import Table

WIDTH = 98
"""Columns beyond which words are hard to read."""


@dataclass(frozen=True)
class Words:
    """A sentence in so many lines of the full width, and in more on a narrower terminal."""

    text: str
    lines: int
    style: str = ""

    def __rich_console__(self, console: "Console", options: "ConsoleOptions") -> "RenderResult":
        """Break it where this terminal ends."""
        from rich.text import Text

        width = min(options.max_width, WIDTH)
        lines = -(-self.lines * WIDTH // width)
        yield Text(cut(self.text, lines, width), style=self.style)


def new_table(*headings: str, words: int) -> "Table":
    """A table without rules: so many columns of words, the rest of numbers."""
    from rich.table import Table
    from rich.text import Text

    table = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0), header_style="dim")
    for place, heading in enumerate(headings):
        side: Literal["left", "right"] = "left" if place < words else "right"
        table.add_column(Text(heading), justify=side, no_wrap=True, overflow="ellipsis")
    return table


def add_row(table: "Table", *cells: str, style: str | None = None) -> None:
    """One more row."""
    from rich.text import Text

    table.add_row(*(Text(cell) for cell in cells), style=style)


def cut(words: str, lines: int, width: int = WIDTH) -> str:
    """Words on so many lines; the page has the rest."""
    return "\n".join(textwrap.wrap(words, width, max_lines=lines, placeholder=" ..."))


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
