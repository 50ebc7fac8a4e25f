r"""How a batch scales: generated ships by Dask on the cores of this machine, against one process.

    PYTHONPATH=. python tests/benchmarks/fleets/batch_scaling.py --ships 60 --out fleet.md

Ships of drawn sizes, a third each logged as CSV, MCAP and Parquet; two thirds have an effect that
the fitted model lacks, and the names given are counted. The same runs, or the first `--alone` of
them, are done in this process one after another; both must give the same bytes. Processor seconds
are told beside those of the clock: where others share the machine, only they compare.
"""

import argparse
import multiprocessing
import os
import resource
import sys
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final
from unittest.mock import patch

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "fleet"))
sys.path.insert(0, str(Path(__file__).resolve().parents[3] / ".ci"))

from at_commit import commit_of
from generated_fleet import (
    FORMATS,
    ROOT,
    contents,
    drawn_ship,
    one_by_one,
    template,
    write_voyage,
)

from trialid.fleet import dask_workers as workers
from trialid.fleet.batch import Batch, batch
from trialid.fleet.dask_workers import connect, results
from trialid.fleet.do_run import Done
from trialid.fleet.rows_of_run import run_row
from trialid.pipeline_file.fleet_file import load_fleet

HIDDEN: Final = {
    None: {},
    "righting_arm_cubic": {"GM3": 3.2},
    "quadratic_roll_damping": {"Kpap": -2e-5},
}
"""What the ships have in turn, and how much of it."""
FEW: Final = 60
"""Ships whose runs do nothing."""
MANY: Final = 5
"""Seeds a ship, where runs do nothing."""
FREE: Final = '["Nr", "Ndelta", "Kp", "GM", "Xuu"]'


@dataclass(frozen=True, kw_only=True)
class Taken:
    """One way of doing the runs: seconds of clock and of this process, and its memory [MB]."""

    seconds: float
    cpu: float
    batch: Batch
    memory: list[float]


def generated(folder: Path, ships: int, alone: int) -> dict[str, str | None]:
    """The fleet's files, one of all and one of the first; what each ship hides, by her name."""
    entries, hides = [], {}
    for n in range(ships):
        ship = drawn_ship(folder, n)
        form, hidden = FORMATS[n % 3], list(HIDDEN)[(n // 3) % 3]
        place = folder / form / f"ship-{n}"
        write_voyage(place, ship, n, form, values=HIDDEN[hidden], hidden=hidden)
        path = template(folder, ship.name, f"{form}/ship-{n}", form, free=FREE, candidates='"all"')
        path.rename(folder / f"pipeline-{n}.toml")
        entries.append(f'[fleet.ship-{n}]\npipelines = "pipeline-{n}.toml"\n')
        hides[f"ship-{n}"] = hidden
    (folder / "dask.toml").write_text("".join(entries), encoding="utf-8")
    (folder / "alone.toml").write_text("".join(entries[:alone]), encoding="utf-8")
    return hides


def taken(folder: Path, name: str, compute: Callable[..., object]) -> Taken:
    """A batch with its time and its memory."""
    memory: list[float] = []

    def measured(tasks, packed):
        for task, done in compute(tasks, packed):
            memory.append(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0)
            yield task, done

    begun, before = time.perf_counter(), time.process_time()
    done = batch(load_fleet(folder / f"{name}.toml"), folder / name, measured)
    seconds, cpu = time.perf_counter() - begun, time.process_time() - before
    return Taken(seconds=seconds, cpu=cpu, batch=done, memory=memory)


class Workers:
    """Warm workers: when they were ready, their processor seconds, their memory as they go [MB]."""

    def __init__(self, jobs: int) -> None:
        self.jobs, self.ready, self.cpu = jobs, 0.0, 0.0
        self.memory: list[int] = []

    def compute(self, tasks, packed):
        """Runs by Dask."""
        with connect("local", self.jobs, len(tasks)) as client:
            client.run(import_all)
            before = sum(client.run(time.process_time).values())
            self.ready = time.perf_counter()
            for place, (task, done) in enumerate(results(client, tasks, packed)):
                if place % max(len(tasks) // 8, 1) == 0:
                    self.memory.append(max(client.run(rss).values()))
                yield task, done
            self.cpu = sum(client.run(time.process_time).values()) - before


def beside_each_other(folder: Path, jobs: int) -> float:
    """Mean seconds of as many processes as workers, each doing the first runs, without Dask.

    What the machine gives each of its cores when all are busy: more nobody can hand on.
    """
    places = [f"beside-{i}" for i in range(jobs)]
    for name in places:
        (folder / f"{name}.toml").write_bytes((folder / "alone.toml").read_bytes())
    with multiprocessing.get_context("spawn").Pool(jobs) as pool:
        pool.map(_imported, places, chunksize=1)
        return float(np.mean(pool.map(partial(_seconds, folder), places, chunksize=1)))


def _imported(place: str) -> None:
    import_all()


def _seconds(folder: Path, name: str) -> float:
    np.seterr(all="ignore")
    return taken(folder, name, one_by_one).seconds


def import_all() -> None:
    """Import what a run needs, so that a worker is warm."""
    import trialid.workflow.write_run  # noqa: F401


def rss() -> int:
    """The memory of this process [MB]."""
    pages = int(Path("/proc/self/statm").read_text(encoding="utf-8").split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") // 10**6


def overhead(folder: Path) -> tuple[float, float]:
    """Processor seconds beside the runs: of a batch once, and of each of its runs.

    Planned, sent, brought back, kept, told: the line through two batches whose runs do nothing.
    """
    ships = [path.stem.removeprefix("pipeline-") for path in folder.glob("pipeline-*.toml")]
    ships = ships[:FEW]
    few, many = ((len(ships) * each, _of_nothing(folder, ships, each)) for each in (1, MANY))
    run = (many[1] - few[1]) / (many[0] - few[0])
    return few[1] - run * few[0], run


def _of_nothing(folder: Path, ships: list[str], each: int) -> float:
    """Processor seconds of a batch of so many runs a ship that do nothing."""
    text = f"[vary]\nseed = {list(range(each))}\n"
    text += "".join(f'[fleet.ship-{n}]\npipelines = "pipeline-{n}.toml"\n' for n in ships)
    file = folder / f"nothing-{each}.toml"
    file.write_text(text, encoding="utf-8")

    def compute(tasks, packed):
        with connect("local", 1, len(tasks)) as client, patch.object(workers, "do_run", nothing):
            client.run(import_all)
            yield from results(client, tasks, packed)
            beside.append(sum(client.run(time.process_time).values()))

    beside: list[float] = []
    before = time.process_time()
    batch(load_fleet(file), folder / file.stem, compute)
    return time.process_time() - before + beside[0]


def nothing(parcel) -> Done:
    """A run that does nothing, with the files of one: a megabyte."""
    from trialid.result.schema import Result

    return Done(row=run_row(parcel.label, parcel.key, Result()), files={"series.csv": bytes(10**6)})


def names(done: Batch, hides: dict[str, str | None]) -> str:
    """What was named, for ships that hide something and for those that hide nothing."""
    counted: Counter[str] = Counter()
    for row in done.runs:
        hidden = hides[row.ship]
        family = (row.family or "").split(", ")
        if row.verdict != "missing":
            counted["none named, " + ("something hidden" if hidden else "nothing hidden")] += 1
        else:
            counted["named right" if hidden in family else "named wrong"] += 1
    return ", ".join(f"{words}: {number}" for words, number in sorted(counted.items()))


def report(ships: int, alone_of: int, jobs: int, folder: Path) -> str:
    """The table of a fleet of so many ships, the first of them by one process too."""
    hides = generated(folder, ships, alone_of)
    each = alone_of / ships
    warmed = Workers(jobs)
    dask = taken(folder, "dask", warmed.compute)
    warm = time.perf_counter() - warmed.ready
    alone = taken(folder, "alone", one_by_one)
    beside = beside_each_other(folder, jobs)
    kept = {n: x for n, x in contents(folder / "alone").items() if "/" in n}  # of runs
    different = [n for n, x in kept.items() if (folder / "dask" / n).read_bytes() != x]
    failed = sum(r.failure is not None for r in dask.batch.runs)
    once, over = overhead(folder)
    rows = [
        ("runs", f"{ships}, {failed} failed"),
        (f"one process, {alone_of} runs", _seconds_of(alone.seconds, alone.cpu)),
        (f"{jobs} such processes at once, no Dask", f"{beside:.1f} s of clock each"),
        (
            f"Dask, {jobs} warm workers",
            f"{_seconds_of(warm, warmed.cpu)} in them, {dask.cpu:.1f} s in scheduler and client "
            "together",
        ),
        (
            "throughput over workers times one process, by the clock",
            f"{alone.seconds / (each * warm) / jobs:.2f}",
        ),
        ("the same by processor seconds", f"{alone.cpu / (each * (warmed.cpu + dask.cpu)):.2f}"),
        (
            "throughput over that of as many processes without Dask",
            f"{beside / (each * warm) / jobs:.2f}",
        ),
        ("overhead, processor", f"{1e3 * over:.0f} ms a run, {once:.1f} s a batch"),
        ("largest worker as they go [MB]", ", ".join(map(str, warmed.memory))),
        (
            "memory of this process, first and last run [MB]",
            f"{dask.memory[0]:.0f}, {dask.memory[-1]:.0f}",
        ),
        ("files that differ", ", ".join(different[:5]) or f"none of {len(kept)}"),
        ("names", names(dask.batch, hides)),
    ]
    return heading(ships, alone_of) + "".join(f"| {a} | {b} |\n" for a, b in rows)


def _seconds_of(clock: float, processor: float) -> str:
    return f"{clock:.1f} s of clock, {processor:.1f} s of processor"


def heading(ships: int, alone_of: int) -> str:
    """What was run, where."""
    asked = f"--ships {ships} --alone {alone_of}"
    command = f"python tests/benchmarks/fleets/batch_scaling.py {asked}"
    return (
        f"# Batches\n\n`{command}`, commit {commit_of(ROOT)},\n{os.cpu_count()} cores, load "
        f"{os.getloadavg()[1]:.1f} (others share them).\n\n| | |\n| :--- | :--- |\n"
    )


def main() -> None:
    """Run, print, write."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--ships", type=int, default=60)
    parser.add_argument("--alone", type=int, help="ships that one process does too, else all")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--out", type=Path)
    asked = parser.parse_args()
    np.seterr(all="ignore")
    with TemporaryDirectory() as place:
        text = report(asked.ships, asked.alone or asked.ships, asked.jobs, Path(place))
    print(text)
    if asked.out is not None:
        asked.out.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
