"""Plant errors into a copy of the package, one after another, and tell which no test notices.

    PYTHONPATH=. python tests/planted/plant.py [--jobs 2] [--only NAME ...]

The errors are those of `tests/planted/*.toml`: a sign, a factor, a swapped column, a dropped term,
a guard that is off. Each goes alone into a copy of the repository in a temporary folder; the tests
nearest to it are run there, and one of them has to fail. Writes
`tests/benchmarks/results/planted.md` unless only some were asked for; exit status 1 where an error
survives that nobody has explained, or tests fail without any.
"""

import argparse
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from queue import SimpleQueue
from typing import Final, TypeVar

sys.path.insert(0, str(Path(__file__).parent))
sys.path.insert(0, str(Path(__file__).parents[2] / ".ci"))

from at_commit import commit_of
from planted_errors import ROOT, Planted, chosen, planted_errors

RESULTS: Final = ROOT / "tests" / "benchmarks" / "results" / "planted.md"
LIMIT: Final = 300.0
"""[s] that tests may take; an error on which they never end is noticed too."""

LEFT_BEHIND: Final = (
    ".git",
    "__pycache__",
    ".*_cache",
    ".hypothesis",
    ".venv",
    "runs",
    "designs",
    "dist",
)
Targets = tuple[str, ...]
Job = TypeVar("Job")
Done = TypeVar("Done")


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """What the tests said: whether all passed, the first that did not, and how long it took [s]."""

    passed: bool
    failed: str
    seconds: float


@dataclass(frozen=True, kw_only=True)
class Bed:
    """A copy of the repository that errors are planted into."""

    root: Path

    def plant(self, error: Planted) -> Outcome:
        """The outcome of its tests with the error in place; the copy is put back."""
        path = error.path(self.root)
        text = path.read_text(encoding="utf-8")
        path.write_text(error.planted(text), encoding="utf-8")
        try:
            return self.run(error.tests)
        finally:
            path.write_text(text, encoding="utf-8")

    def run(self, targets: Targets, limit: float = LIMIT) -> Outcome:
        """The outcome of these tests in this copy, by this interpreter, in so many seconds."""
        began = time.monotonic()
        command = [sys.executable, "-m", "pytest", "-q", "-x", "-n0", "-p", "no:cacheprovider"]
        command += ["-m", "study or not study"]
        process = subprocess.Popen(
            [*command, *targets],
            cwd=self.root,
            env=self._environment(),
            text=True,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )
        try:
            said, _ = process.communicate(timeout=limit)
            failed = _first_failure(said)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)  # what the tests have started, too
            process.communicate()
            failed = "does not end"
        seconds = time.monotonic() - began
        passed = process.returncode == 0
        return Outcome(passed=passed, failed="" if passed else failed, seconds=seconds)

    def _environment(self) -> dict[str, str]:
        """The copy before any installed package, and kernels that nobody else may have built."""
        return {
            **os.environ,
            "PYTHONPATH": str(self.root),
            "TRIALID_CACHE": str(self.root / ".kernels"),
            "OMP_NUM_THREADS": "1",
            "TRIALID_STUDIES": "short",  # what CI runs at every turn
        }


def _first_failure(said: str) -> str:
    """The first test that pytest says has failed, without what it said."""
    for line in said.splitlines():
        if line.startswith(("FAILED ", "ERROR ")):
            return line.split(" - ")[0].partition(" ")[2]
    return "the tests cannot be collected"


def _copied(folder: Path) -> Bed:
    """A copy whose byte code goes by the content of its source.

    An error planted within a second may leave size and time of a file as they were.
    """
    root = folder / "trialid"
    shutil.copytree(ROOT, root, ignore=shutil.ignore_patterns(*LEFT_BEHIND))
    compiled = [sys.executable, "-m", "compileall", "-q", "--invalidation-mode", "checked-hash"]
    subprocess.run([*compiled, "trialid"], cwd=root, check=True)
    return Bed(root=root)


def _each(
    beds: Sequence[Bed], jobs: Sequence[Job], do: Callable[[Bed, Job], Done]
) -> Iterator[tuple[Job, Done]]:
    """Every job done in whichever copy is free, in the order of the jobs."""
    free = SimpleQueue[Bed]()
    for bed in beds:
        free.put(bed)

    def work(job: Job) -> Done:
        bed = free.get()
        try:
            return do(bed, job)
        finally:
            free.put(bed)

    with ThreadPoolExecutor(len(beds)) as pool:
        yield from zip(jobs, pool.map(work, jobs), strict=True)


def failing(beds: Sequence[Bed], errors: Sequence[Planted]) -> dict[str, str]:
    """Tests that fail without any error, by what pytest is given: they would notice anything.

    All at once, and each by itself only where one of them fails.
    """
    targets = list(dict.fromkeys(target for one in errors for target in one.tests))
    if beds[0].run(tuple(targets), LIMIT * len(targets)).passed:
        return {}
    done = _each(beds, targets, lambda bed, target: bed.run((target,)))
    return {target: out.failed for target, out in done if not out.passed}


def verdict(error: Planted, out: Outcome) -> str:
    """`noticed`, `explained` or `survived`."""
    if not out.passed:
        return "noticed"
    return "explained" if error.explained else "survived"


HEAD: Final = """\
# Errors planted into the package, and the tests that notice them

`python tests/planted/plant.py`, commit {commit}: {planted} planted, {noticed} noticed, {survived}
survived, {explained} explained; {minutes:.0f} min in all. Each was planted alone into a copy of the
repository, and the tests nearest to it were run there. The errors are those of
`tests/planted/*.toml`.

| package | error | |
| :--- | :--- | :--- |
"""


def page(done: Sequence[tuple[Planted, Outcome]], seconds: float, commit: str) -> str:
    """The table as Markdown; the commit is that of the copies."""
    said = [verdict(error, out) for error, out in done]
    count = {word: said.count(word) for word in ("noticed", "survived", "explained")}
    head = HEAD.format(commit=commit, planted=len(done), minutes=seconds / 60.0, **count)
    rows = [
        f"| {error.package} | {_cell(error.name)} | {_cell(_told(error, out))} |\n"
        for error, out in sorted(done, key=lambda one: one[0].package)
    ]
    return head + "".join(rows)


def _told(error: Planted, out: Outcome) -> str:
    if not out.passed:
        return f"`{out.failed}`"
    return f"explained: {error.explained}" if error.explained else "**survived**"


def _cell(text: str) -> str:
    return text.replace("|", "\\|")


def main() -> int:
    """Plant, say what became of each, and write the page; 1 where an error survives."""
    asked = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    asked.add_argument("--jobs", type=int, default=2)
    asked.add_argument("--only", nargs="+", default=[], metavar="NAME")
    said = asked.parse_args()
    errors, began = chosen(planted_errors(), said.only), time.monotonic()
    commit = commit_of(ROOT)  # which may be another one when they are done
    with tempfile.TemporaryDirectory(prefix="planted-") as folder:
        beds = [_copied(Path(folder) / str(k)) for k in range(said.jobs)]
        wrong = failing(beds, errors)
        for target, test in wrong.items():
            print(f"left out, fails without any error: {target}: {test}", flush=True)
        able = [one for one in errors if not {*one.tests} & {*wrong}]
        done = []
        for error, out in _each(beds, able, Bed.plant):
            done.append((error, out))
            word = verdict(error, out)
            print(f"{word:9} {out.seconds:4.0f} s  {error.name}: {out.failed}", flush=True)
    if not said.only:
        RESULTS.write_text(page(done, time.monotonic() - began, commit), encoding="utf-8")
    lost = [error.name for error, out in done if verdict(error, out) == "survived"]
    print(f"{len(done)} planted, {len(lost)} survived: {'; '.join(lost) or 'none'}")
    return int(bool(lost or wrong))


if __name__ == "__main__":
    sys.exit(main())
