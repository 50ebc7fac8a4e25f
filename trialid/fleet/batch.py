"""A batch: what is planned is done where it is new, kept as it is done, and told as tables."""

import time
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

from trialid import own_files
from trialid.errors import TrialidError
from trialid.fleet.changes import changes, remarks, told_from
from trialid.fleet.dask_workers import Pack, check_threads, connect, results
from trialid.fleet.do_run import Done, failure_row
from trialid.fleet.finished_runs import (
    Kept,
    keep_run,
    kept_of,
    kept_run,
    put_back,
    set_aside,
    write_pipelines,
)
from trialid.fleet.parcels import pack
from trialid.fleet.parquet_tables import CHANGES, PARAMETERS, RUNS_TABLE, write_tables
from trialid.fleet.plan import plan
from trialid.fleet.task import PIPELINES, RUNS, Task
from trialid.names import wording
from trialid.pipeline_file.fleet_file import FleetFile
from trialid.progress import Progress, silent
from trialid.report.pages.fleet_page import fleet_page
from trialid.result.fleet_rows import ChangeRow, FittedRow, Remark, RunRow

COPY: Final = "fleet.toml"
ASIDE: Final = "set_aside"
"""Where the folders of runs lie that were done and cannot be done now."""
PAGE: Final = "fleet.html"
FILES: Final = (COPY, RUNS_TABLE, PARAMETERS, CHANGES, PAGE)
"""What lies in a batch's folder beside `pipelines/` and `runs/`."""

Compute = Callable[[Sequence[Task], Pack], Iterator[tuple[Task, Done]]]
"""What does runs and gives each back with what came of it, in any order."""


@dataclass(frozen=True, kw_only=True)
class Batch:
    """A finished batch: its rows, in the order of the plan, and how many were done anew."""

    name: str
    folder: Path
    runs: tuple[RunRow, ...]
    fitted: tuple[FittedRow, ...]
    changes: tuple[ChangeRow, ...]
    remarks: tuple[Remark, ...]
    anew: int

    @property
    def sentence(self) -> str:
        """What was done, and what came of it."""
        failed = sum(row.failure is not None for row in self.runs)
        verdicts = Counter(row.verdict for row in self.runs if row.verdict)
        told = "; ".join(f"{word}: {number}" for word, number in verdicts.most_common())
        varies = sum(row.form == "varies" for row in self.changes)
        also = f"; parameters that vary as neither a step nor a drift: {varies}" if varies else ""
        runs = wording.count_of(len(self.runs), "run")
        lines = (
            f"{self.name}: {runs}, {self.anew} done now, {failed} failed",
            told or "no verdicts",
            f"changes found: {len(self.changes) - varies}{also}",
            *(f"{each.ship}: {each.words}" for each in self.remarks),
        )
        return "\n".join(lines)


def by_dask(on: str, jobs: int | None, tell: Callable[[str], None]) -> Compute:
    """Runs done by Dask; `tell` is given the address of its dashboard."""

    def compute(tasks: Sequence[Task], packed: Pack) -> Iterator[tuple[Task, Done]]:
        with connect(on, jobs, len(tasks)) as client:
            check_threads(client)
            tell(f"Dask: {client.dashboard_link}")
            yield from results(client, tasks, packed)

    return compute


def batch(fleet: FleetFile, folder: Path, compute: Compute, progress: Progress = silent) -> Batch:
    """Do what is new of a fleet's runs; write its tables and its report.

    Raises
    ------
    TrialidError
        The fleet file or its template is wrong, the folder holds what is not ours, or there are no
        workers; what was done is kept. What is wrong with one run is its row, and stops no other.
    """
    own_files.check_folder(folder, FILES, "batch")
    progress("planning", None)
    tasks = plan(fleet, folder)
    with own_files.replacing(folder, below=(COPY,)) as work:
        (work / COPY).write_bytes(fleet.content)
    tasks = _with_pipelines(tasks, folder)
    found = {task.label.run: _begin(task, folder) for task in tasks}
    todo = [task for task in tasks if found[task.label.run] is None]
    for task, done in _timed(compute, todo, fleet, folder, progress):
        place, aside = _places(task, folder)
        if done.kept:
            keep_run(done, place)
        else:
            set_aside(place, aside)
        found[task.label.run] = kept_of(done)
    kept = [each.under(task.label) for task in tasks if (each := found[task.label.run]) is not None]
    return _write(fleet, folder, kept, len(todo))


def _with_pipelines(tasks: Sequence[Task], folder: Path) -> tuple[Task, ...]:
    """The tasks, the pipelines that are made for them written; a problem where one is not."""
    made = {task.pipeline.name: task.content for task in tasks if task.made}
    refused = write_pipelines(made, folder / PIPELINES) if made else {}
    return tuple(
        replace(task, made=False, problem=_below(folder, refused[task.pipeline.name]))
        if task.made and task.pipeline.name in refused
        else task
        for task in tasks
    )


def _begin(task: Task, folder: Path) -> Kept | None:
    """What is known of a run before the work; None where it is to be done."""
    place, aside = _places(task, folder)
    if task.problem:
        set_aside(place, aside)
        return Kept(row=failure_row(task.label, task.key, task.problem))
    try:
        kept = kept_run(place, task.key) or put_back(aside, place, task.key)
    except TrialidError as error:
        return Kept(row=failure_row(task.label, task.key, _below(folder, str(error))))
    if kept is None and place.exists():
        own_files.check_all_ours(place)
    return kept


def _places(task: Task, folder: Path) -> tuple[Path, Path]:
    """The folder of a run, and where one is that was done but cannot be now."""
    return folder / RUNS / task.label.run, folder / ASIDE / task.label.run


def _below(folder: Path, said: str) -> str:
    """What is said of a file of the batch, without the path of the batch."""
    return said.removeprefix(f"{folder}/")


def _timed(
    compute: Compute, todo: Sequence[Task], fleet: FleetFile, folder: Path, progress: Progress
) -> Iterator[tuple[Task, Done]]:
    """The runs as they are done, with how many there are and the time left."""
    if not todo:
        return
    begun, failed = time.monotonic(), 0
    progress(f"0 of {len(todo)} runs done", 0.0)
    work = compute(todo, lambda task: pack(task, folder / RUNS / task.label.run, fleet.logs))
    for number, (task, done) in enumerate(work, 1):
        yield task, done
        failed += done.row.failure is not None
        left = (time.monotonic() - begun) / number * (len(todo) - number)
        words = f"{number} of {len(todo)} runs done"
        words += f", {failed} failed" if failed else ""
        progress(f"{words}, about {_duration(left)} left", number / len(todo))


def _duration(seconds: float) -> str:
    """A time as one says it.

    >>> _duration(42.0), _duration(600.0), _duration(9000.0)
    ('42 s', '10 min', '2.5 h')
    """
    if seconds < 100.0:
        return f"{seconds:.0f} s"
    return f"{seconds / 60.0:.0f} min" if seconds < 6000.0 else f"{seconds / 3600.0:.1f} h"


def _write(fleet: FleetFile, folder: Path, kept: Sequence[Kept], anew: int) -> Batch:
    """The tables and the report of all runs, those done earlier among them."""
    runs = tuple(each.row for each in kept)
    fitted = tuple(row for each in kept for row in each.fitted)
    found = tuple(changes(runs, fitted))
    known = (*remarks(runs), *told_from(runs, fitted, found))
    made = Batch(
        name=fleet.name,
        folder=folder,
        runs=runs,
        fitted=fitted,
        changes=found,
        remarks=known,
        anew=anew,
    )
    with own_files.replacing(folder, below=(RUNS_TABLE, PARAMETERS, CHANGES, PAGE)) as work:
        write_tables(work, runs, fitted, found)
        page = fleet_page(fleet.name, runs, fitted, found, known)
        (work / PAGE).write_text(page, encoding="utf-8")
    return made
