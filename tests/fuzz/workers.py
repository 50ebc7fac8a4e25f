"""Processes that judge damaged logs, and somebody who notices when one of them dies or hangs."""

import multiprocessing
import resource
import shutil
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from pathlib import Path
from typing import Any

from judge import Verdict, harmed, judged, truth
from limits import LONGEST_WAIT, MOST_SECONDS
from seed_logs import SeedLog

PATIENCE = 1.5 * LONGEST_WAIT * MOST_SECONDS
"""Seconds after which a process is stopped; code that is not Python hears no alarm."""
MOST_ADDRESSES = 6_000_000_000
"""Bytes a process may ask for, so that the machine survives what the test finds."""


@dataclass(frozen=True)
class Case:
    """The `number`-th damage of the log `place`."""

    place: int
    number: int


@dataclass
class Worker:
    """A process, what it still has to do, and where it hears."""

    process: Any
    pipe: Connection
    todo: list[Case]


def results(
    seeds: Sequence[SeedLog], counts: Sequence[int], start: int, jobs: int, keep: Path
) -> Iterator[tuple[Case, Verdict]]:
    """Verdicts of `counts` damages of each log; what offends is kept in the folder `keep`."""
    cases = [Case(i, n) for i, count in enumerate(counts) for n in range(count)]
    shares = [cases[k::jobs] for k in range(jobs)]
    with tempfile.TemporaryDirectory() as folder:
        workers = [_begun(seeds, share, start, Path(folder)) for share in shares if share]
        while workers:
            ready = wait([one.pipe for one in workers], PATIENCE)
            for worker in [one for one in workers if one.pipe in ready or not ready]:
                found = _heard(worker) if worker.pipe in ready else None
                case = worker.todo.pop(0)
                if found is None:
                    found = _dead(worker)
                    workers.remove(worker)
                    if worker.todo:
                        workers.append(_begun(seeds, worker.todo, start, Path(folder)))
                elif not worker.todo:
                    worker.process.join()
                    workers.remove(worker)
                if found.complaints:
                    _kept(seeds, case, start, found, keep)
                yield case, found


def _begun(seeds: Sequence[SeedLog], todo: list[Case], start: int, folder: Path) -> Worker:
    context = multiprocessing.get_context("spawn")
    ours, theirs = context.Pipe(duplex=False)
    place = Path(tempfile.mkdtemp(dir=folder))
    process = context.Process(target=_work, args=(theirs, seeds, todo, start, place))
    process.start()
    theirs.close()
    return Worker(process, ours, todo)


def _heard(worker: Worker) -> Verdict | None:
    """What it says; None when it died."""
    with suppress(EOFError, OSError):
        verdict = worker.pipe.recv()
        assert isinstance(verdict, Verdict)
        return verdict
    return None


def _dead(worker: Worker) -> Verdict:
    """The verdict about a log that killed its reader, or held it for too long."""
    worker.process.join(0.5)
    held = worker.process.is_alive()
    worker.process.kill()
    worker.process.join()
    words = f"held for more than {PATIENCE:g} s" if held else f"died, {worker.process.exitcode}"
    return Verdict(outcome="none", complaints=[f"the process {words}"])


def _work(
    pipe: Connection, seeds: Sequence[SeedLog], todo: Sequence[Case], start: int, folder: Path
) -> None:
    resource.setrlimit(resource.RLIMIT_AS, (MOST_ADDRESSES, MOST_ADDRESSES))
    logs = tuple(one.log for one in seeds)
    known: dict[int, Any] = {}
    for case in todo:
        seed = seeds[case.place]
        if case.place not in known:
            known[case.place] = truth(seed, folder / "sound")
        content = harmed(seed, logs, (start, case.place, case.number))
        pipe.send(judged(seed, known[case.place], content, folder, case.number))
    shutil.rmtree(folder)


def _kept(seeds: Sequence[SeedLog], case: Case, start: int, found: Verdict, keep: Path) -> None:
    """The log that offends, and why, beside it."""
    keep.mkdir(parents=True, exist_ok=True)
    content = harmed(
        seeds[case.place], tuple(one.log for one in seeds), (start, case.place, case.number)
    )
    name = "".join(c if c.isalnum() else "_" for c in seeds[case.place].name)
    path = keep / f"{name}-{start}-{case.number}"
    path.write_bytes(content)
    path.with_name(path.name + ".txt").write_text("\n".join(found.complaints), encoding="utf-8")
