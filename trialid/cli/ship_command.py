"""The command that begins with a ship: her file from her particulars."""

from pathlib import Path
from typing import Any

import click

from trialid import temporary
from trialid.cli.console import note, say
from trialid.cli.particulars_options import given_from, particulars_options
from trialid.errors import ShipError, TrialidError


@click.command(short_help="Write a ship file from her particulars.")
@click.argument("out", type=click.Path(path_type=Path), metavar="OUT.toml")
@particulars_options()
@click.option("--name", default="", help="What reports call her.")
@click.option("--quiet", is_flag=True, help="Do not say what was written and assumed.")
def ship(out: Path, name: str, quiet: bool, **particulars: Any) -> None:
    """Write a ship file from particulars: every number with its source and its scatter.

    Hull derivatives by Clarke (1983), Kijima (1990) and Yoshimura (2012), rudder by Fujii, roll by
    the 2008 IS Code. The length alone is needed: what else is not stated is assumed of ordinary
    ships, widely, and said. All that is missing, impossible or contradictory is told at once, and
    then nothing is written.
    """
    from trialid.ship.estimate import estimate
    from trialid.ship.estimate.all_numbers import refusal
    from trialid.ship.estimate.impossible import complaints
    from trialid.ship.estimate.ship_text import assumption_words, ship_text

    given = given_from(particulars)
    if wrong := (*_place(out), *complaints(given)):
        raise ShipError(f"{out}: {refusal(wrong)}")
    made = estimate(given, name)
    try:
        temporary.write_new(out, ship_text(made))
    except OSError as error:
        raise TrialidError(f"{out}: {(error.strerror or str(error)).lower()}") from error
    if not quiet:
        for words in assumption_words(made):
            note(words)
        say(f"Written: {out}")


def _place(out: Path) -> tuple[str, ...]:
    """Why the file cannot be there; nothing is ever replaced."""
    if out.suffix != ".toml":
        return (f"{out.name} does not end in .toml, as a ship file does",)
    if out.exists() or out.is_symlink():
        return (f"{out.name} exists, and is not replaced; name another file",)
    if not out.parent.is_dir():
        return (f"there is no folder {out.parent}; make it first",)
    try:
        temporary.check_writable(out.parent, "file")
    except TrialidError as error:
        return (str(error),)
    return ()
