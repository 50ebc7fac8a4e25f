"""How much of the processor a command takes whose parts are warm: run, add, the workbench's curves.

    python tests/benchmarks/commands/command_seconds.py [--against CHECKOUT] [--repeats N] [--where]

Processor seconds (user and system) of the least disturbed of a few runs of the shipped sample, each
a new process. With `--against` those of another checkout too, in turn with these, so that both meet
the same machine, and their ratio; exit status 1 where a command here takes more than `SLOWER` times
as long. `--where` tells where the time of `trialid run` goes, by stage.
"""

import argparse
import os
import resource
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Final

ROOT: Final = Path(__file__).resolve().parents[3]
ADDED: Final = "righting_arm_cubic"
SLOWER: Final = 1.1
"""Two rounds of the same commit differ by up to 7 % beside other work."""

CURVES: Final = """
import os, sys, time
from pathlib import Path
import trialid.cli.main, trialid.cli.workbench_command
from trialid.workbench.desk import Desk
desk, told = Desk(Path(sys.argv[1])), []
import trialid.workbench.server
for known in ("series", "fit"):
    while not getattr(desk.shown, known):
        time.sleep(0.01)
    told.append(time.process_time())
print(*told, flush=True)
os._exit(0)
"""
"""What `trialid workbench` does until measured curves are known, and until there is a fit."""

STAGES: Final = """
import sys, time
from pathlib import Path
began = time.process_time()
from trialid import pipeline_file
from trialid.workflow import build_model, findings, fit_model, read_trials, run, write_run
def passed(name):
    global began
    now = time.process_time()
    print(f"{name}: {now - began:.2f}")
    began = now
passed("modules of the package and others")
asked = pipeline_file.load(Path(sys.argv[1]))
silent = lambda words, share: None
trials = read_trials.align_trials(asked, silent)
passed("logs read and aligned")
fit = fit_model.fit_of(asked, trials, build_model.available(asked), silent)
passed("fit")
done = run.examine(asked, trials, silent, fit)
passed("diagnosis, refits, next trial, result")
write_run.write(done, Path(sys.argv[2]))
passed("folder written")
"""


class Place:
    """A checkout with a copy of its sample, in which commands are timed."""

    def __init__(self, checkout: Path, folder: Path) -> None:
        self.folder = folder
        for part in ("pipelines", "sample_data"):
            shutil.copytree(checkout / part, folder / part)
        self.asked = str(folder / "pipelines" / "hidden_effect.toml")
        self.out = str(folder / "run")
        self.environment = {**os.environ, "PYTHONPATH": str(checkout)}

    def python(self, *told: str) -> str:
        """What a new process prints."""
        command = [sys.executable, *told]
        return subprocess.check_output(command, cwd=self.folder, env=self.environment, text=True)

    def trialid(self, *told: str) -> float:
        """Processor seconds of a command."""
        before = _of_children()
        self.python("-m", "trialid", *told, "--out", self.out, "--quiet")
        return _of_children() - before

    def measure(self) -> dict[str, float]:
        """Processor seconds of everything once; the pipeline is as it was at the end."""
        found = {"trialid run": self.trialid("run", self.asked)}
        found[f"trialid add, {ADDED}"] = self.trialid("add", self.asked, ADDED)
        self.trialid("drop", self.asked, ADDED)
        measured, fitted = map(float, self.python("-c", CURVES, self.asked).split())
        found |= {"workbench, measured curves": measured, "workbench, predicted": fitted}
        return found


def _of_children() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


@contextmanager
def places(checkouts: list[Path]) -> Iterator[list[Place]]:
    """A place for each checkout, each run once: kernels and templates are compiled then."""
    with tempfile.TemporaryDirectory() as folder:
        made = [Place(one, Path(folder) / str(i)) for i, one in enumerate(checkouts)]
        for place in made:
            place.measure()
        yield made


def least(rounds: list[dict[str, float]]) -> dict[str, float]:
    """The smallest of every command."""
    return {name: min(one[name] for one in rounds) for name in rounds[0]}


def main() -> int:
    """Measure, print, and hold against the other checkout."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--against", type=Path, help="a checkout of another commit")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--where", action="store_true", help="where the time of a run goes")
    asked = parser.parse_args()
    checkouts = [ROOT, *([asked.against.resolve()] if asked.against else [])]
    with places(checkouts) as made:
        rounds = [[place.measure() for place in made] for _ in range(asked.repeats)]
        where = [place.python("-c", STAGES, place.asked, place.out) for place in made]
    here, *other = (least([one[i] for one in rounds]) for i in range(len(made)))
    for name, seconds in here.items():
        beside = f", there {other[0][name]:.2f} s: {seconds / other[0][name]:.2f}" if other else ""
        print(f"{name}: {seconds:.2f} s{beside}")
    if asked.where:
        print(*where, sep="\nthere:\n", end="")
    return int(any(seconds > SLOWER * one[name] for one in other for name, seconds in here.items()))


if __name__ == "__main__":
    sys.exit(main())
