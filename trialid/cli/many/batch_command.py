"""The command about many runs: a fleet's voyages, done by as many workers as there are."""

import sys
from pathlib import Path

import click

from trialid.cli.console import complain, progress_bar, say
from trialid.cli.many.where_done import jobs_option, on_option, teller, workers_of
from trialid.own_files import write_or_say_why


@click.command(short_help="Do the runs of a fleet on many cores; only what is new.")
@click.argument("fleet", type=click.Path(path_type=Path))
@on_option("local", "the default")
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar="DIR",
    help="Folder for runs, tables and report; by default fleets/ and the fleet file's name.",
)
@jobs_option
@click.option("--quiet", is_flag=True, help="No progress and no summary.")
def batch(fleet: Path, on: str, out: Path | None, jobs: int | None, quiet: bool) -> None:
    """Do every run that FLEET, a TOML file, names: ships, their voyages, and what varies.

    Each run is one task of one thread. Its folder appears when it is done; the same command again
    does only what is new, after an interruption too. A run that fails is a row with its reason, and
    stops no other. What comes out: a folder for each run, runs.parquet, parameters.parquet,
    changes.parquet, and fleet.html with parameters over voyages and ships.
    """
    on = workers_of(on, jobs) or on
    from trialid.fleet.parquet_tables import check_parquet
    from trialid.pipeline_file.fleet_file import load_fleet

    asked = load_fleet(fleet)
    folder = out or Path("fleets", asked.path.stem)
    check_parquet()
    from trialid.fleet.batch import batch as done_batch
    from trialid.fleet.batch import by_dask

    with (
        progress_bar(shown=not quiet and sys.stderr.isatty()) as progress,
        write_or_say_why(folder),
    ):
        try:
            done = done_batch(asked, folder, by_dask(on, jobs, teller(quiet)), progress)
        except KeyboardInterrupt:
            complain(f"{folder}: what is done is kept; the same command goes on")
            raise
    if not quiet:
        say(f"{done.sentence}\nReport: {folder / 'fleet.html'}")
