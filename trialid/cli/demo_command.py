"""The command that writes the sample: something to try when there is only the wheel."""

import shlex
from importlib.util import find_spec
from pathlib import Path
from typing import Final

import click

from trialid.cli.console import say

PLACE: Final = Path("trialid-demo")
PIPELINE: Final = "pipelines/hidden_effect.toml"
TO_TRY: Final = (
    (f"trialid run {PIPELINE}", "fit; what is missing?"),
    (f"trialid add {PIPELINE} righting_arm_cubic", "add what it names"),
    (f"trialid workbench {PIPELINE}", "the same by hand"),
)
"""Commands, each with what it does."""


@click.command(short_help="Write pipelines and sea trials to try everything on.")
@click.argument("folder", type=click.Path(path_type=Path), default=PLACE, metavar="[DIR]")
def demo(folder: Path) -> None:
    """Write the sample into DIR: pipelines, ships and sea trials to try everything on.

    Without DIR it goes to ./trialid-demo. The logs are made by the simulator, the same bytes as
    those of the project. A file that is not ours is never replaced.
    """
    from trialid.sample import write

    names = write(folder)
    say(_words(folder, names))


def _words(folder: Path, names: tuple[str, ...]) -> str:
    """What was written, and what to try."""
    widest = max(len(command) for command, _ in TO_TRY)
    lines = [
        f"{folder}: {len(names)} files, four sea trials of a container ship among them. Try:",
        "",
        f"  cd {shlex.quote(str(folder))}",
        *(f"  {command:<{widest}}  # {words}" for command, words in TO_TRY),
        "",
        "`trialid guide first_trial` goes through them.",
    ]
    if find_spec("starlette") is None or find_spec("uvicorn") is None:
        lines.append("The workbench needs two packages more: pip install 'trialid[workbench]'")
    return "\n".join(lines)
