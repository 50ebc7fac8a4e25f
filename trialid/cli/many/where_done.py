"""The options that say which workers do many runs or fits."""

from collections.abc import Callable
from typing import Any, TypeVar

import click

from trialid.cli.console import note

Command = TypeVar("Command", bound=Callable[..., Any])


def on_option(default: str | None, otherwise: str) -> Callable[[Command], Command]:
    """`--on`; `otherwise` says what is done without it."""
    return click.option(
        "--on",
        default=default,
        metavar="WHERE",
        help=f"local ({otherwise}), a Dask scheduler's address (tcp://HOST:PORT), or a YAML file "
        "that describes a cluster.",
    )


jobs_option = click.option(
    "--jobs",
    type=click.IntRange(1, 1024),
    metavar="N",
    help="Worker processes on this machine; by default a core each.",
)


def workers_of(on: str | None, jobs: int | None) -> str | None:
    """Where the workers are: on this machine, where only their number is said.

    Raises
    ------
    UsageError
        In one line: a number of workers that it is not for this command to say.
    """
    if jobs is None:
        return on
    from trialid.fleet.dask_workers import LOCAL

    if on not in (None, LOCAL):
        raise click.UsageError("--jobs goes with --on local; workers elsewhere are started there")
    return LOCAL


def teller(quiet: bool) -> Callable[[str], None]:
    """What tells the address of the dashboard, if anything is to be told."""

    def tell(words: str) -> None:
        if not quiet:
            note(words)

    return tell
