"""What a newcomer gets who begins with the logs of a ship of another structure, and lets it grow.

    PYTHONPATH=. python tests/benchmarks/growth/mmg_ships.py --first-seed 300 --records 20

Ships, sizes and three to five manoeuvres are drawn by seed (`tests/grow/mmg.py`: the MMG method,
which no model here has), logged by a simple recorder without any fault, begun as `trialid start`
begins them and grown by `--auto`; with `--heading` the recorder has a compass and a speed log, and
the rudder's zero is another in each trial. Errors are multiples of the sensors' noise. Results
stand in `results/mmg_ships.md` or `mmg_by_heading.md` with `--write`. Exit status 1 where a sensor,
a clock, or wind or current is named, or a held-out error rises.
"""

import argparse
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Final

import numpy as np

ROOT: Final = Path(__file__).resolve().parents[3]
sys.path[:0] = [
    str(ROOT / "tests" / "grow"),
    str(ROOT / ".ci"),
    str(ROOT / "tests/benchmarks/fleets"),
]
import mmg  # noqa: E402
from at_commit import commit_of  # noqa: E402
from begun import begun  # noqa: E402
from spread import add_options, spread  # noqa: E402

from trialid.diagnosis.found_values import her_own  # noqa: E402
from trialid.diagnosis.search.backward import worth_naming  # noqa: E402
from trialid.effects import CATALOGUE  # noqa: E402
from trialid.errors import TrialidError  # noqa: E402
from trialid.progress import silent  # noqa: E402
from trialid.result.schema import Result  # noqa: E402
from trialid.threads import one_thread  # noqa: E402
from trialid.workflow import grow  # noqa: E402

RESULTS: Final = ROOT / "tests/benchmarks/results"
MANOEUVRES: Final[dict[str, tuple[float, ...]]] = {
    "zz10": (10.0, 10.0),
    "zz20": (20.0, 20.0),
    "zz15": (15.0, 15.0),
    "zz20-10": (20.0, 10.0),
    "turn35": (35.0,),
    "turn20": (20.0,),
}


@dataclass(frozen=True, kw_only=True)
class Grown:
    """What became of one ship; errors of the trial held out as multiples of the noise."""

    seed: int
    trials: tuple[str, ...]
    first: str
    steps: tuple[str, ...] = ()
    named: tuple[str, ...] = ()
    errors: tuple[float, ...] = ()
    end: str = ""

    @property
    def blamed(self) -> list[str]:
        """Sensors, clocks, wind and current with a name, of which none is at fault or there."""
        return [n for n in self.named if n in CATALOGUE and not her_own(CATALOGUE[n])]

    @property
    def rises(self) -> bool:
        """Whether a step made the trial held out worse."""
        return list(self.errors) != sorted(self.errors, reverse=True)

    def row(self) -> str:
        """One line of the table."""
        errors = " ".join(f"{x:.1f}" for x in self.errors)
        return (
            f"| {self.seed} | {' '.join(self.trials)} | {self.first} | {' '.join(self.steps)} "
            f"| {', '.join(self.named)} | {errors} | {self.end} |"
        )


@one_thread
def grown(seed: int, heading: bool = False) -> Grown:
    """One drawn ship from her logs to the loop's end."""
    rng, ship = np.random.default_rng([seed, 7]), mmg.drawn(seed)
    count = int(rng.integers(3, 6))
    trials = tuple(np.array([*MANOEUVRES])[rng.permutation(len(MANOEUVRES))[:count]])
    with tempfile.TemporaryDirectory() as place:
        try:
            pipeline = begun(Path(place), ship, rng, {n: MANOEUVRES[n] for n in trials}, heading)
            done = [stage for stage in grow.stages(pipeline, silent) if stage.kept]
        except TrialidError as error:
            return Grown(seed=seed, trials=trials, first=str(error).rpartition("/")[2])
    found = _told(seed, trials, ship, done)
    print(found.row(), flush=True)
    return found


def _told(seed: int, trials: tuple[str, ...], ship: mmg.Ship, done: Sequence[grow.Stage]) -> Grown:
    runs = [stage.run.result for stage in done]
    first = {run.verdict.effect for run in runs} - {None}
    return Grown(
        seed=seed,
        trials=trials,
        first=runs[0].verdict.effect or " and ".join(runs[0].verdict.together) or "none",
        steps=tuple(f"+{s.added}" if s.added else f"-{s.dropped}" for s in done[1:]),
        named=tuple(sorted({*first, *worth_naming(done[-1].worths)})),
        errors=tuple(map(partial(_in_noise, ship=ship), runs)),
        end=runs[-1].verdict.kind or "",
    )


def _in_noise(run: Result, ship: mmg.Ship) -> float:
    """The error held out as a multiple of what the recorder's noise would leave."""
    noise = mmg.noise_of(ship)
    shares = [(noise[n] / rms) ** 2 for n, rms in run.fit.y_rms.items()]
    return float((run.fit.eps_rmsn_check or np.nan) / np.sqrt(np.mean(shares)))


def page(found: Sequence[Grown]) -> str:
    """The counts and the table."""
    begun = [x for x in found if x.errors]
    first, last = (np.array([x.errors[k] for x in begun]) for k in (0, -1))
    two = sum(any("," in step for step in x.steps) for x in begun)
    counts = (
        f"Of {len(found)}: begun {len(begun)}; a step in {sum(bool(x.steps) for x in begun)}, two "
        f"effects at once in {two}; a sensor, a clock, wind or current named in "
        f"{sum(bool(x.blamed) for x in begun)}"
        f"; held out worse in {sum(x.rises for x in begun)}; held out {np.median(first):.1f} to "
        f"{np.median(last):.1f} times the noise (medians).\n"
    )
    heads = "| seed | trials | first | steps | named | held out, times the noise | end |"
    rows = [x.row() for x in found]
    return "\n".join([counts, heads, "|---" * 7 + "|", *rows]) + "\n"


def main() -> int:
    """Draw, grow, count."""
    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("--first-seed", type=int, default=300)
    asked.add_argument("--records", type=int, default=20)
    asked.add_argument("--write", action="store_true")
    asked.add_argument("--heading", action="store_true", help="of compass and speed log alone")
    add_options(asked, jobs=2)
    options = asked.parse_args()
    seeds = range(options.first_seed, options.first_seed + options.records)
    found = list(
        spread(partial(grown, heading=options.heading), [*seeds], options.jobs, options.on)
    )
    text = page(found)
    print(text)
    if options.write:
        said = f"seeds {seeds[0]} to {seeds[-1]}, commit {commit_of(RESULTS)}"
        more = " --heading" if options.heading else ""
        begins = f"`python {Path(__file__).relative_to(ROOT)}{more}`, {said}"
        name = "mmg_by_heading.md" if options.heading else "mmg_ships.md"
        head = f"# Ships of another structure\n\n{begins}"
        (RESULTS / name).write_text(f"{head}\n\n{text}", encoding="utf-8")
    return int(any(x.blamed or x.rises for x in found))


if __name__ == "__main__":
    sys.exit(main())
