"""The command about the next trial: which test to run, and the papers for the bridge."""

import json
import sys
from pathlib import Path

import click

from trialid.console import file_width, progress_bar, rendered, say
from trialid.errors import TrialidError


@click.command()
@click.argument("design", type=click.Path(path_type=Path))
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar="DIR",
    help="Folder for the papers; by default designs/ and the design's name.",
)
@click.option("--json", "as_json", is_flag=True, help="Print design.json, nothing else.")
@click.option("--quiet", is_flag=True, help="No progress and no tables.")
def design(design: Path, out: Path | None, as_json: bool, quiet: bool) -> None:
    """Rate the tests of DESIGN, a TOML file, choose what it leaves open, write the papers.

    Each test is sailed by simulation, held against the limits, and rated by how well a fit of its
    record would find the parameters (Blanke & Knudsen 1999, Eq. 8 to 14). The folder gets a page
    for the bridge, the orders as CSV, and a pipeline for the log that comes back.
    """
    from trialid.recipe.design import load_design

    recipe = load_design(design)
    folder = out or Path("designs", design.stem)
    _check_folder(folder)
    from trialid.hand_over import write
    from trialid.plan import plan
    from trialid.report.design_tables import tables

    with progress_bar(shown=not quiet and sys.stderr.isatty()) as progress:
        made = plan(recipe, progress)
        try:
            data = write(made, folder)
        except OSError as error:
            reason = (error.strerror or str(error)).lower()
            raise TrialidError(f"{folder}: cannot be written ({reason})") from error
    if as_json:
        say(json.dumps(data, indent=2, allow_nan=False))
    elif not quiet:
        say(rendered(*tables(data), width=file_width()))
        say(f"For the bridge: {folder / 'bridge.html'}")


def _check_folder(folder: Path) -> None:
    """Refuse, before the work, a folder that holds anything but an earlier design."""
    if folder.exists() and not folder.is_dir():
        raise TrialidError(f"{folder}: is a file; --out takes a folder")
    if folder.is_dir() and any(folder.iterdir()) and not (folder / "design.json").is_file():
        raise TrialidError(
            f"{folder}: holds other files and no earlier design; choose another --out"
        )
