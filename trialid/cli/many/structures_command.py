"""The command about the model as a whole: which structure this record asks for."""

import json
import sys
from pathlib import Path

import click

from trialid.cli.console import progress_bar, render, say
from trialid.cli.many.where_done import jobs_option, on_option, teller, workers_of


@click.command(short_help="Compare whole models; name the simplest that holds.")
@click.argument("pipeline", type=click.Path(path_type=Path), required=False)
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar="DIR",
    help="Folder for structures.json and the fits that are done, which are not done again; by "
    "default structures/ and the pipeline's name.",
)
@on_option(None, "a process for each core")
@jobs_option
@click.option("--quick", is_flag=True, help="Do not make the choice again without each trial.")
@click.option("--json", "as_json", is_flag=True, help="Print structures.json, nothing else.")
@click.option("--quiet", is_flag=True, help="No progress and no table.")
@click.option("--schema", is_flag=True, help="Instead: print the JSON Schema of structures.json.")
def structures(
    pipeline: Path | None,
    out: Path | None,
    on: str | None,
    jobs: int | None,
    quick: bool,
    as_json: bool,
    quiet: bool,
    schema: bool,
) -> None:
    """Compare whole model structures; name the simplest within one standard error of the best.

    The structures are the lists of [structures] in PIPELINE, or the usual ones: linear,
    second-order modulus, cubic and cross-flow, with the propeller's race and the speed lost in
    turns. Each trial is left out in turn, each structure fitted to the others and scored on that
    one; then once more without any use of each trial, which shows how stable the choice is. What
    is done is kept: after an interruption the same command goes on. PIPELINE is not changed. The
    fits are done one after the other, or with --on by as many workers as there are, with the same
    digits.
    """
    on = workers_of(on, jobs)
    if schema:
        from trialid.result.json_file import json_schema
        from trialid.result.structure_rows import Structures

        say(json.dumps(json_schema(Structures), indent=1))
        return
    if pipeline is None:
        raise click.UsageError("Missing argument 'PIPELINE'.")
    from trialid.pipeline_file import load

    asked = load(pipeline)
    folder = out or Path("structures", asked.path.stem)
    from trialid.fleet.structure_fits import compute_of
    from trialid.workflow.structures.compare_structures import compare_structures

    with (
        progress_bar(shown=not quiet and sys.stderr.isatty()) as progress,
        compute_of(asked, on, jobs, teller(quiet or as_json)) as compute,
    ):
        found = compare_structures(asked, progress, folder, not quick, compute)
    if as_json:
        from trialid.result.json_file import text_of

        say(text_of(found).rstrip())
    elif not quiet:
        from trialid.report.terminal.structure_table import structure_table

        say(render(*structure_table(found)))
        say(f"All figures: {folder / 'structures.json'}")
