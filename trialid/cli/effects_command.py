"""The command that shows what a model can be made of."""

import json
import shutil
from pathlib import Path

import click

from trialid.cli.console import file_width, render, say


@click.command(short_help="List the effects a model can be made of, or tell of one.")
@click.argument("name", required=False)
@click.option(
    "--from",
    "own_files",
    type=click.Path(path_type=Path),
    multiple=True,
    help="A file of your own with effects in it; may be given again.",
)
@click.option(
    "--ship",
    type=click.Path(path_type=Path),
    metavar="SHIP.toml",
    help="A ship whose actuators bring effects of their own.",
)
@click.option("--json", "as_json", is_flag=True, help="Print plain data, and nothing else.")
def effects(
    name: str | None, own_files: tuple[Path, ...], ship: Path | None, as_json: bool
) -> None:
    """List the effects a model can be made of, or tell all about the one called NAME."""
    from trialid.effects import CATALOGUE, find, from_file
    from trialid.effects.actuators import actuator_effects
    from trialid.effects.actuators.standstill import EFFECTS as AT_REST
    from trialid.errors import EffectError
    from trialid.report.terminal.catalogue import list_effects, plain, plain_list, sheet
    from trialid.ship.particulars import read_ship

    own = {} if ship is None else actuator_effects(read_ship(ship))
    own |= {n: e for path in own_files for n, e in from_file(path).items()}
    everything = {**CATALOGUE, **own}
    if name in {e.name for e in AT_REST} - everything.keys():
        raise EffectError(f"{name} comes with a boat's own actuators: add --ship SHIP.toml")
    if as_json:
        data = plain(find(name, own)) if name else plain_list(everything)
        say(json.dumps(data, indent=2, allow_nan=False))
    else:
        width = file_width() or shutil.get_terminal_size().columns
        shown = sheet(find(name, own)) if name else list_effects(everything, width)
        say(render(*shown, width=None if name else file_width()))
