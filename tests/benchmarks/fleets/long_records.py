r"""What long records take: trials of 100 000 samples read, fitted and judged; a long text read.

    PYTHONPATH=. python tests/benchmarks/fleets/long_records.py --against ../earlier --out long.md

The records are simulated, by seed; each measurement is a process of its own: its processor seconds,
those of the clock, and the most memory it held by then. `--against` is the folder of an earlier
state of the repository: both are measured in turn, and every estimate and standard error compared.
"""

import argparse
import json
import os
import resource
import subprocess
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final

import numpy as np

ROOT: Final = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "tests" / "benchmarks"), str(ROOT / ".ci")]

from at_commit import commit_of  # noqa: E402

SIGNALS: Final = {"rudder": "deg", "rate": "deg/s", "roll": "deg", "speed": "m/s"}
Stages = dict[str, list[float]]


class Clock:
    """Seconds of processor and clock of each stage, and the memory it ended with at most [MB]."""

    def __init__(self) -> None:
        self.stages: Stages = {}
        self.begun = (time.process_time(), time.perf_counter())

    def passed(self, name: str) -> None:
        now = (time.process_time(), time.perf_counter())
        memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
        self.stages[name] = [*(b - a for a, b in zip(self.begun, now, strict=True)), memory]
        self.begun = now


def judged(pipeline: Path) -> dict[str, Any]:
    """The stages of a run, and what it found."""
    from trialid.pipeline_file import load
    from trialid.workflow.build_model import available
    from trialid.workflow.findings import find_out
    from trialid.workflow.fit_model import fit_of
    from trialid.workflow.read_trials import align_trials

    asked = load(pipeline)
    catalogue, clock = available(asked), Clock()
    trials = align_trials(asked, silent)
    clock.passed("read and aligned")
    fit = fit_of(asked, trials, catalogue, silent)
    clock.passed("fitted")
    found = find_out(asked, fit, catalogue, silent, force=False, grown=False)
    rows = found.before.accuracy.physical
    clock.passed("judged")
    numbers = {p.name: [p.value, p.standard_error, *(p.likely or ())] for p in rows}
    return {"stages": clock.stages, "found": found.verdict.sentence, "numbers": numbers}


def text_read(log: Path) -> dict[str, Any]:
    """A text log read as one trial's."""
    from trialid import ingest
    from trialid.ingest import Aids, LogFile

    clock = Clock()
    [recording] = ingest.read_together([LogFile(log, Aids(None, None, None))], [*SIGNALS])
    clock.passed(f"text of {log.stat().st_size / 1e6:.0f} MB read")
    sums = {name: [float(np.sum(s.y))] for name, s in recording.channels.items()}
    return {"stages": clock.stages, "found": "", "numbers": sums}


def silent(words: str, share: float | None) -> None:
    """Progress that nobody looks at."""


def measured(tree: Path, kind: str, place: Path) -> dict[str, Any]:
    """What a process of its own finds, with the package of that folder."""
    command = [sys.executable, __file__, "--child", kind, str(place)]
    environment = {**os.environ, "PYTHONPATH": str(tree), "PYTHONWARNINGS": "ignore"}
    for library in ("OPENBLAS", "MKL"):
        environment[f"{library}_NUM_THREADS"] = "1"
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def write_text(place: Path, megabytes: int) -> None:
    """A text log of so many megabytes: an hour's lines again and again, each with its own time."""
    rng = np.random.default_rng(3)
    count = 36_000
    noise = rng.standard_normal((count, len(SIGNALS)))
    lines = [",".join(f"{x:.6f}" for x in row) for row in noise]
    with place.open("w", encoding="ascii") as stream:
        stream.write(",".join(["time", *SIGNALS]) + "\n")
        hour = 0
        while stream.tell() < megabytes * 1_000_000:
            begin = hour * 3600.0
            stream.writelines(f"{begin + 0.1 * k:.1f},{line}\n" for k, line in enumerate(lines))
            hour += 1


def largest(one: dict[str, list[float]], other: dict[str, list[float]]) -> float:
    """The largest relative difference of two sets of numbers, each against its own row's size."""
    off = 0.0
    for name, row in one.items():
        a, b = np.array(row), np.array(other[name])
        off = max(off, float(np.max(np.abs(a - b)) / max(float(np.max(np.abs(a))), 1e-300)))
    return off


def table(found: list[dict[str, Any]]) -> list[str]:
    """A row a stage: seconds and memory, before and after where both are known."""
    lines = []
    for stage, now in found[-1]["stages"].items():
        cells = []
        for k, form in enumerate(("{:.1f} s", "{:.1f} s", "{:.0f} MB")):
            was = found[0]["stages"][stage][k]
            said = form.format(now[k])
            if len(found) > 1:
                said = f"{form.format(was)} to {said} ({now[k] / max(was, 1e-9):.2f})"
            cells.append(said)
        lines.append(f"| {stage} | {' | '.join(cells)} |")
    return lines


def report(asked: argparse.Namespace, folder: Path) -> str:
    """All measurements as a page."""
    import workbench_trials

    trees = [*([asked.against.resolve()] if asked.against else []), ROOT]
    lines = [heading(asked), "| | processor | clock | memory |", "| :--- | ---: | ---: | ---: |"]
    said = []
    if asked.samples:
        pipeline = workbench_trials.written(folder, asked.trials, asked.samples)
        found = [measured(tree, "judged", pipeline) for tree in trees]
        lines += table(found)
        same = len({each["found"] for each in found}) == 1
        said.append(f"{found[-1]['found']}.")
        if len(found) > 1:
            off = largest(found[0]["numbers"], found[1]["numbers"])
            said.append(
                f"The verdict is {'the same' if same else 'ANOTHER'}; the ship's estimates, "
                f"standard errors and likely ranges differ by at most {off:.1e} of their size."
            )
    if asked.text:
        log = folder / "long-text.csv"
        write_text(log, asked.text)
        lines += table([measured(tree, "text", log) for tree in trees])
    return "\n".join([*lines, "", *said, ""])


def heading(asked: argparse.Namespace) -> str:
    """What was run, where."""
    trees = [*([asked.against] if asked.against else []), ROOT]
    commits = [commit_of(tree) for tree in trees]
    return (
        f"# Long records\n\n`python tests/benchmarks/fleets/long_records.py --trials "
        f"{asked.trials} --samples {asked.samples} --text {asked.text}`,\ncommit {commits[-1]}"
        f"{f' against {commits[0]}' if asked.against else ''}, {os.cpu_count()} cores, load "
        f"{os.getloadavg()[1]:.1f} (others share them).\n"
    )


def main() -> None:
    """Measure, print, write."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--trials", type=int, default=5)
    parser.add_argument("--samples", type=int, default=100_000, help="a trial; 0 for none")
    parser.add_argument("--text", type=int, default=0, metavar="MB", help="a text log so large")
    parser.add_argument("--against", type=Path, metavar="FOLDER")
    parser.add_argument("--out", type=Path)
    parser.add_argument("--child", nargs=2, metavar=("KIND", "PLACE"))
    asked = parser.parse_args()
    np.seterr(all="ignore")
    if asked.child:
        kind, place = asked.child
        print(json.dumps((judged if kind == "judged" else text_read)(Path(place))))
        return
    with TemporaryDirectory() as folder:
        text = report(asked, Path(folder))
    print(text)
    if asked.out is not None:
        asked.out.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
