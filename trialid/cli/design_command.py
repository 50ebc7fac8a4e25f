"""The command about the next trial: which test to run, and the papers for the bridge."""

import json
import sys
from pathlib import Path

import click

from trialid import own_files
from trialid.cli.console import file_width, progress_bar, render, say


@click.command(short_help="Rate tests and choose the next one; papers for the bridge.")
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
    from trialid.pipeline_file.design_file import load_design

    pipeline = load_design(design)
    folder = out or Path("designs", design.stem)
    own_files.check_folder(folder, ("design.json", "bridge.html"), "design")
    from trialid.report.tables.design_tables import tables
    from trialid.workflow.design.design_folder import write
    from trialid.workflow.design.design_run import plan

    with progress_bar(shown=not quiet and sys.stderr.isatty()) as progress:
        made = plan(pipeline, progress)
        with own_files.write_or_say_why(folder):
            data = write(made, folder)
    if as_json:
        say(json.dumps(data, indent=2, allow_nan=False))
    elif not quiet:
        say(render(*tables(data), width=file_width()))
        say(f"For the bridge: {folder / 'bridge.html'}")
