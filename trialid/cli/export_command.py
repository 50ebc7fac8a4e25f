"""The command that hands a fitted model over to other programs."""

import json
import sys
from pathlib import Path

import click

from trialid.cli.console import note, progress_bar, say
from trialid.names.model_kinds import KINDS

FILE = click.Path(path_type=Path)


@click.command(short_help="Write the fitted model: ship file, JSON, NumPy, C, FMU.")
@click.argument("run", type=FILE, metavar="RUN_DIR", required=False)
@click.option(
    "--as",
    "kind",
    type=click.Choice([*KINDS]),
    help="; ".join(f"{name}: {kind.words}" for name, kind in KINDS.items()) + ".",
)
@click.option(
    "--out",
    type=FILE,
    metavar="FILE",
    help="Where; by default the name of the run's folder and what it is, here.",
)
@click.option(
    "--bandwidth",
    type=float,
    metavar="RAD/S",
    help="Of gains: how fast; by default as fast as the ship (pid), or twice that (ardupilot).",
)
@click.option(
    "--full-rudder", type=float, metavar="DEG", help="Of ardupilot: rudder at full output."
)
@click.option(
    "--full-command",
    type=float,
    metavar="NUMBER",
    help="Of ardupilot and pid, two thrusters: command at full output [rpm, N or share].",
)
@click.option("--force", is_flag=True, help="Replace what is there.")
@click.option("--anyway", is_flag=True, help="Of a fit that carries no verdict, too.")
@click.option("--quiet", is_flag=True, help="No progress, and no words about what was written.")
@click.option("--schema", is_flag=True, help="Instead: print the JSON Schema of --as json.")
def export(
    run: Path | None,
    kind: str | None,
    out: Path | None,
    bandwidth: float | None,
    full_rudder: float | None,
    full_command: float | None,
    force: bool,
    anyway: bool,
    quiet: bool,
    schema: bool,
) -> None:
    """Write the model of a finished run for other programs, with how sure its numbers are.

    Each file holds the fitted values, where each is likely to lie, what the trials held of speeds
    and angles, and which logs it was fitted to; beyond what was seen the model says so itself.
    """
    if schema:
        from trialid.export.model.json_model import model_schema

        say(json.dumps(model_schema(), indent=1))
        return
    if run is None or kind is None:
        missing = "argument 'RUN_DIR'" if run is None else f"option '--as' ({', '.join(KINDS)})"
        raise click.UsageError(f"Missing {missing}.")
    from trialid.workflow.use.export_model import export_model, export_places, wishes_of
    from trialid.workflow.use.finished_model import finished_model
    from trialid.workflow.use.hand_over import beside_words

    places = export_places(run.resolve().name, kind, out, force=force, by_command=True)
    wishes = wishes_of(bandwidth, full_rudder, full_command, by_command=True)
    with progress_bar(shown=not quiet and sys.stderr.isatty()) as progress:
        model = finished_model(run, progress, anyway=anyway)
        made = export_model(model, kind, places, wishes)
    if not quiet:
        for words in filter(None, (*model.doubts, beside_words(made))):
            note(words)
        say(f"Written: {', '.join(map(str, places))}")
