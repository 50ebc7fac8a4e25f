"""The command that puts a fitted model under orders."""

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from trialid.cli.console import progress_bar, render, say
from trialid.errors import TrialidError
from trialid.version import VERSION

if TYPE_CHECKING:
    from trialid.workflow.use.finished_model import FinishedModel
    from trialid.workflow.use.predict import Prediction

FILE = click.Path(path_type=Path)


@click.command(short_help="What the fitted ship does under orders, with likely ranges.")
@click.argument("run", type=FILE, metavar="RUN_DIR")
@click.argument("orders", nargs=-1, required=True, metavar="ORDERS...")
@click.option(
    "--what-if",
    "changes",
    multiple=True,
    metavar="NAME=VALUE",
    help="Another number: a parameter (GM=0.8), `speed` [m/s], or an input that is held [SI].",
)
@click.option("--without", multiple=True, metavar="EFFECT", help="Leave an effect out.")
@click.option(
    "--out",
    type=FILE,
    metavar="FILE",
    help="Write every signal with the ends of its range: .csv, .parquet or .mcap.",
)
@click.option("--force", is_flag=True, help="With --out: replace what is there.")
@click.option("--anyway", is_flag=True, help="Of a fit that carries no verdict, too.")
@click.option("--quiet", is_flag=True, help="No progress and no table.")
def simulate(
    run: Path,
    orders: tuple[str, ...],
    changes: tuple[str, ...],
    without: tuple[str, ...],
    out: Path | None,
    force: bool,
    anyway: bool,
    quiet: bool,
) -> None:
    """Simulate the model of a finished run under ORDERS, and say how sure that is.

    ORDERS is a manoeuvre with its angles in degrees, as `zigzag 20 20` or `circle 35`, sailed in
    calm deep water as the run's standard measures are; `stop`, the engine stopped; or a CSV with a
    column t [s] and the model's inputs as delta[deg], positive to starboard, straight between rows.

    Every motion has a range that holds it 95 times of 100, whatever effect of the catalogue is
    missing; beyond speeds, angles and rates that the trials hold it is a guess, which is said.
    """
    from trialid import export
    from trialid.export.predicted_file import WRITERS, write_motion
    from trialid.workflow.use.finished_model import finished_model

    if out is not None:
        export.check_place(out, replace=force, formats=WRITERS)
    ready = _told(orders, changes, without)
    with progress_bar(shown=not quiet and sys.stderr.isatty()) as progress:
        model = finished_model(run, progress, anyway=anyway)
        if out is not None:
            logs = {log.sha256 for score in model.fit.scores for log in score.trial.logs}
            export.check_unread(out, [Path(orders[0])], logs)
        progress("simulating", 0.8)
        made = ready(model)
    if out is not None:
        write_motion(out, made.name, made.motion, _about(model, orders, made, changes, without))
    if not quiet:
        from trialid.report.terminal.prediction import prediction_table

        say(render(*prediction_table(made.name, made.motion, made.words)))
        if out is not None:
            say(f"Series: {out}")


def _told(orders: tuple[str, ...], changes: tuple[str, ...], without: tuple[str, ...]) -> Any:
    """What is to be done with the model; a mistake in ORDERS is told before it is made ready."""
    from trialid.workflow.use import orders as asked
    from trialid.workflow.use.predict import predict_manoeuvre, predict_orders
    from trialid.workflow.use.stop import predict_stop
    from trialid.workflow.use.what_if import read_changes

    what_if = read_changes(changes, without)
    first = Path(orders[0])
    if len(orders) == 1 and (first.exists() or first.suffix):
        return lambda model: predict_orders(
            model, asked.read_orders(first, model.quantities), first.stem, what_if
        )
    if first.exists():
        raise TrialidError(f"ORDERS {first}: a table of orders stands alone; leave out the rest")
    stop = asked.stop_order(orders)
    if stop is not None:
        return lambda model: predict_stop(model, stop, what_if)
    manoeuvre = asked.named_manoeuvre(orders)
    return lambda model: predict_manoeuvre(model, manoeuvre, what_if)


def _about(
    model: "FinishedModel",
    orders: tuple[str, ...],
    made: "Prediction",
    changes: tuple[str, ...],
    without: tuple[str, ...],
) -> dict[str, Any]:
    """What a file of a prediction is, and all that belongs beside its numbers."""
    numbers = {
        name: {"value": value, "likely": None if ends is None else [*ends]}
        for name, (value, ends) in made.motion.numbers.items()
    }
    return {
        "schema": "trialid-simulated/1",
        "version": VERSION,
        "run": model.where,
        "pipeline": model.result.file,
        "orders": " ".join(orders),
        "changes": [*changes, *(f"without {name}" for name in without)],
        "verdict": model.result.verdict.kind,
        "words": [*made.words],
        "numbers": numbers,
        "seen": {name: [r.low, r.high] for name, r in model.seen.items()},
        "logs": {g.path: g.sha256 for s in model.fit.scores for g in s.trial.logs},
    }
