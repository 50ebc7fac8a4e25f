"""The command that shows the manual."""

import re
import shutil
import sys
from typing import Final

import click

from trialid.cli.console import render, say
from trialid.guide import TOPICS, page

WIDEST: Final = 100
"""Letters a line of text may have: longer ones are hard to follow."""

LINK: Final = re.compile(r"\[([^\[\]]+)\]\(\w+\.md\)")
"""A link to another page, whose name is its text."""


@click.command(short_help="Show a page of the manual, or list its topics.")
@click.argument("topic", required=False)
def guide(topic: str | None) -> None:
    """Show the page of the manual on TOPIC, or list the topics.

    In a terminal the page is set to its width; into a file or a pipe it goes as Markdown.
    """
    if topic is None:
        say(_listing())
        return
    text = page(topic)
    say(_set(text) if sys.stdout.isatty() else text.rstrip())


def _listing() -> str:
    """Every topic with its line, on one line each."""
    widest = max(map(len, TOPICS))
    rows = [f"  {name:<{widest}}  {line}" for name, line in TOPICS.items()]
    return "\n".join(["The guide: `trialid guide TOPIC` shows a page.", *rows])


def _set(text: str) -> str:
    """The page as a terminal shows it."""
    from rich.markdown import Markdown

    width = min(shutil.get_terminal_size().columns, WIDEST)
    return render(Markdown(LINK.sub(r"*\1*", text), code_theme="ansi_dark"), width=width)
