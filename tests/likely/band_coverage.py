"""How much of a replayed trial lies in the band about its prediction: simulated records.

    PYTHONPATH=. python tests/likely/band_coverage.py [--records 40] [--first 20000]

writes `tests/benchmarks/results/bands.md`. Three trials are fitted, the fourth is replayed as
`trialid replay` does; a record depends on its conditions and seed alone. Seeds 1 to 60 were looked
at while this was built; those from 20000 on were not. The page had 20000 to 20039, then 45000 to
45029; tests count 30000 to 30023.
"""

import argparse
import sys
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
sys.path.insert(0, str(Path(__file__).parent))
sys.path.insert(0, str(Path(__file__).parents[2] / ".ci"))

from at_commit import commit_of
from coverage import RESULTS, as_known, fit_of
from sailed_records import NoPassage
from worlds import Conditions, hidden_world

from trialid.diagnosis.prediction_band import prediction_band
from trialid.identification.fit import Fit
from trialid.replay.alarm import Band, Bands
from trialid.replay.playback import Playback
from trialid.threads import one_thread

PAGE: Final = RESULTS.with_name("bands.md")
FIRST: Final = 20000
ASKED: Final = (0.90, 0.97)
"""Shares of samples between which a 95 % band is asked to hold."""

WAVES, PROCESS = Conditions(), Conditions(noise="process")


@dataclass(frozen=True, kw_only=True)
class Case:
    """Conditions, and whether something of the truth is hidden from the fit."""

    name: str
    conditions: Conditions
    hides: bool = True


ROUGH: Final = "the same, gusts and waves on the hull"
CASES: Final = (
    Case(name="nothing hidden", conditions=WAVES, hides=False),
    Case(name=ROUGH, conditions=PROCESS, hides=False),
    Case(name="an effect hidden", conditions=WAVES),
    Case(name=ROUGH, conditions=PROCESS),
    Case(name="an effect hidden, trials of 5 min", conditions=replace(WAVES, minutes=5.0)),
    Case(name="an effect hidden, naval vessel", conditions=replace(WAVES, ship="naval")),
    Case(name="an effect hidden, boat of 10 m, rough", conditions=replace(PROCESS, ship="boat")),
)


@one_thread
def count(case: Case, seed: int) -> dict[str, float] | None:
    """Share of the replayed trial in the band, by output; None where nothing could be fitted."""
    known = as_known(case.conditions)
    ship = hidden_world(case.conditions, seed) if case.hides else known
    try:
        fit = fit_of(ship, seed, exact=True)
    except NoPassage:
        return None
    return inside(fit) if fit.converged else None


def inside(fit: Fit) -> dict[str, float]:
    """Share of the held-out trial that a replay counts within the band of the fit."""
    trial = next(s.trial for s in fit.scores if s.trial.use == "check")
    quiet = Bands(tuple(Band(c, 1.0, np.ones(1)) for c in fit.problem.outputs), "", False)
    playback = Playback(fit, trial, quiet, prediction_band=prediction_band(fit))
    playback.go_to(trial.samples)
    return playback.inside()


def share(done: Sequence[float]) -> tuple[float, float, float]:
    """Mean share, and its 95 % interval from draws of whole records: samples go together."""
    rng, each = np.random.default_rng(1), np.asarray(done)
    drawn = each[rng.integers(len(each), size=(2000, len(each)))].mean(axis=1)
    low, high = np.quantile(drawn, (0.025, 0.975))
    return float(each.mean()), float(low), float(high)


def line(case: Case, done: Sequence[dict[str, float]], lost: int) -> str:
    """One row of the page."""
    cells = []
    for names in (("r",), ("phi",), ("r", "phi")):
        held, low, high = share([float(np.mean([one[n] for n in names])) for one in done])
        cells.append(f"{held:.1%} ({low:.0%}-{high:.0%})")
    return f"| {case.name} | {len(done)} | {lost} | {' | '.join(cells)} |"


HEAD: Final = """\
# The band of a prediction, replayed

`python tests/likely/band_coverage.py`, commit {commit}, seeds {first} to {last}, none of them used
while building. Two zig-zags and a binary are fitted, 20 min each at 2 Hz with waves in the sensors
unless said; a zig-zag of another angle is replayed, and its samples within the 95 % band are
counted. Mean share over the records, with its 95 % interval from draws of whole records.

| | records | lost | r | phi | both |
| :--- | ---: | ---: | ---: | ---: | ---: |
"""


def main() -> int:
    """Write the page; exit status 1 where the share is surely not what is asked for."""
    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("--records", type=int, default=40)
    asked.add_argument("--first", type=int, default=FIRST)
    asked.add_argument("--jobs", type=int, default=2)
    asked.add_argument("--dry", action="store_true", help="write no page")
    said = asked.parse_args()
    seeds = range(said.first, said.first + said.records)
    lines, missed = [], 0
    for case, done, lost in _table(seeds, said.jobs):
        lines.append(line(case, done, lost))
        missed += not calibrated(done)
        print(lines[-1], flush=True)
    head = HEAD.format(commit=commit_of(Path(__file__).parent), first=seeds[0], last=seeds[-1])
    if not said.dry:
        PAGE.write_text(head + "\n".join(lines) + "\n", encoding="utf-8")
    return int(missed > 0)


def calibrated(done: Sequence[dict[str, float]]) -> bool:
    """Whether the interval of the mean share reaches into what is asked for."""
    _, low, high = share([float(np.mean(list(one.values()))) for one in done])
    return low <= ASKED[1] and high >= ASKED[0]


def _table(seeds: Sequence[int], jobs: int) -> Iterator[tuple[Case, list[dict[str, float]], int]]:
    with ProcessPoolExecutor(jobs) as pool:
        for case in CASES:
            found = list(pool.map(count, [case] * len(seeds), seeds))
            done = [c for c in found if c]
            yield case, done, len(seeds) - len(done)


if __name__ == "__main__":
    sys.exit(main())
