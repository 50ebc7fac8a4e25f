"""How often the ranges of IMO's measures hold what the true ship does: by what is hidden, and more.

    PYTHONPATH=. python tests/likely/measures_coverage.py [--records 40] [--first 20000]

writes `tests/benchmarks/results/measures.md`. A record depends on its conditions and seed alone.
Seeds 1 to 60 were looked at while the ranges were built; those from 20000 on were not.
"""

import argparse
import sys
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
sys.path.insert(0, str(Path(__file__).parent))
sys.path.insert(0, str(Path(__file__).parents[2] / ".ci"))

from at_commit import commit_of
from coverage import EXACT, RESULTS, as_known
from hidden_truth import OUTPUTS
from sailed_records import NoPassage, record
from worlds import EVERY, Conditions, World, guessed, hidden_world

from trialid.design.following import standard_measures, vessel_of
from trialid.design.standard import Measure, predict
from trialid.diagnosis.may_be_off import doubts
from trialid.diagnosis.noise.split import split
from trialid.diagnosis.search.augment import augment
from trialid.diagnosis.trust import accuracy_of
from trialid.effects import CATALOGUE
from trialid.identification.fit import Fit, identify
from trialid.identification.problem import Settings
from trialid.ship.effect import Effect
from trialid.threads import one_thread

PAGE: Final = RESULTS.with_name("measures.md")
FIRST: Final = 20000

MEASURES: Final = {
    "advance": "advance",
    "tactical diameter": "tactical",
    "initial turning": "initial",
    "first overshoot 10/10": "10/10 1st",
    "second overshoot 10/10": "2nd",
    "first overshoot 20/20": "20/20 1st",
    "second overshoot 20/20": "2nd",
}
"""Names of the measures, and what the page calls them."""

WAVES, PROCESS = Conditions(), Conditions(noise="process")


@dataclass(frozen=True, kw_only=True)
class Case:
    """Conditions, what of the truth is hidden, and the coverage that is asked for.

    With `logged` the model does not simulate the speed but takes it from the log; `left_out` takes
    the hidden effect out of the catalogue too; `exact` says in the ship file that what is held
    fixed is right.
    """

    name: str
    conditions: Conditions = WAVES
    hides: bool = True
    logged: bool = False
    left_out: bool = False
    exact: bool = True
    asked: float = 0.90


ROUGH: Final = "the same, gusts and waves on the hull"
CASES: Final = (
    Case(name="an effect hidden"),
    Case(name=ROUGH, conditions=PROCESS),
    Case(name="an effect hidden, out of the catalogue too", left_out=True),
    Case(name="nothing hidden", hides=False),
    Case(name=ROUGH, conditions=PROCESS, hides=False),
    Case(
        name="held fixed up to 15 % off",
        conditions=Conditions(held_off=0.15),
        hides=False,
        exact=False,
    ),
    Case(name="an effect hidden, nothing said of what is held", exact=False),
    Case(name="an effect hidden, speed from the log", logged=True),
    Case(name="an effect hidden, trials of 5 min", conditions=Conditions(minutes=5.0)),
    Case(name="an effect hidden, one zig-zag alone", conditions=Conditions(single=True)),
    Case(name="an effect hidden, naval vessel", conditions=Conditions(ship="naval")),
    Case(name=ROUGH, conditions=replace(PROCESS, ship="naval")),
    Case(name="an effect hidden, model of 3.5 m", conditions=Conditions(ship="model")),
    Case(
        name="an effect hidden, boat of 10 m, gusts and waves",
        conditions=replace(PROCESS, ship="boat"),
    ),
)


@dataclass(frozen=True)
class Counted:
    """Of each measure of a record whether its range holds the truth; half the range over it."""

    holds: Mapping[str, bool]
    widths: Mapping[str, float]


def world_of(case: Case, seed: int) -> World:
    """The true ship of one record."""
    return hidden_world(case.conditions, seed, EVERY) if case.hides else as_known(case.conditions)


def sails(case: Case, seed: int) -> bool:
    """Whether she can be sailed at all: what is hidden may be of the size of a larger ship."""
    try:
        record(world_of(case, seed), seed)
    except NoPassage:
        return False
    return True


def fitted(case: Case, seed: int) -> tuple[World, Fit] | None:
    """The true ship and the fit of one record; None where she cannot be sailed, or no fit."""
    ship = world_of(case, seed)
    try:
        fit = fit_of(case, ship, seed)
    except NoPassage:
        return None
    return (ship, fit) if fit.converged else None


@one_thread
def count(case: Case, seed: int) -> Counted | None:
    """One record's ranges; None where she cannot be sailed or the fit did not converge."""
    found = fitted(case, seed)
    if found is None:
        return None
    ship, fit = found
    gone = {e.name for e in ship.effects} if case.left_out else set[str]()
    likely = ranges(fit, {n: e for n, e in CATALOGUE.items() if n not in gone})
    truth = {m.criterion.name: m.value for m in predict([vessel_of(fit, ship.true.model)])}
    return counted(likely, truth)


def fit_of(case: Case, ship: World, seed: int) -> Fit:
    """The fit of a record by the model of what is known of the ship."""
    model = guessed(ship, seed)
    if case.exact:
        model = replace(model, ship=replace(model.ship, uncertainty=EXACT))
    if case.logged:
        model = replace(model, states=tuple(s for s in model.states if s != "u"))
    settings = Settings(ship.free, OUTPUTS, nuisance=("initial_state",))
    return identify(record(ship, seed), model, settings)


def ranges(fit: Fit, catalogue: Mapping[str, Effect]) -> tuple[Measure, ...]:
    """The measures of a fit with their ranges."""
    augmented = augment(fit, catalogue)
    off = doubts(augmented)
    parts, _ = split(fit, augmented, {})
    covariance = accuracy_of(fit, parts, off.averaged).covariance
    return standard_measures(fit, covariance, off.standing, off.held, off.missing)


def counted(found: Sequence[Measure], truth: Mapping[str, float | None]) -> Counted:
    """Which ranges hold what the true ship does; what she does not come to, no range can hold."""
    holds, widths = dict[str, bool](), dict[str, float]()
    for m in found:
        name, true = m.criterion.name, truth[m.criterion.name]
        low, high = m.interval or (np.nan, np.nan)
        if m.value is None and true is None:
            continue
        holds[name] = true is not None and bool(low <= true <= high)
        widths[name] = (high - low) / 2.0 / true if true else np.nan
    return Counted(holds, widths)


def share(done: Sequence[Counted]) -> tuple[float, float, float]:
    """Share of ranges that hold the truth, and its 95 % interval; records, not ranges, count.

    The measures of one record go together, so the interval comes from draws of whole records.
    """
    each = np.array([np.mean(list(c.holds.values())) for c in done])
    rng = np.random.default_rng(1)
    drawn = each[rng.integers(len(each), size=(2000, len(each)))].mean(axis=1)
    low, high = np.quantile(drawn, (0.025, 0.975))
    return float(each.mean()), float(low), float(high)


def line(case: Case, done: Sequence[Counted], lost: int) -> str:
    """One row of the page."""
    cells = []
    for name in MEASURES:
        holds = [c.holds[name] for c in done if name in c.holds]
        widths = [c.widths[name] for c in done if name in c.widths]
        cells.append(f"{np.mean(holds):.0%}, {np.nanmedian(widths):.1%}")
    held, low, high = share(done)
    total = f"{held:.1%} ({low:.0%}-{high:.0%})"
    return f"| {case.name} | {len(done)} | {lost} | {' | '.join(cells)} | {total} |"


HEAD: Final = """\
# Ranges of IMO's measures, against the true ship

`python tests/likely/measures_coverage.py`, commit {commit}, seeds {first} to {last}, none of them
used while building. Hidden is any effect of the catalogue on this ship, on her rudder or her
sensors, at a random size. Zig-zags of 10 and 20 deg and a binary of 15 deg are fitted, 20 min
each at 2 Hz with waves in the sensors unless said; the turning circle of 35 deg lies beyond them.
Share of 95 % ranges that hold the true ship's measure, then the median half-width as a share of
it; `all` with its 95 % interval, from draws of whole records. Where nothing else is said the ship
file says that what is held fixed is exact. `lost`: fits that did not converge, ships that what is
hidden makes unsailable.

"""


def main() -> int:
    """Write the page; exit status 1 where less is held than asked for."""
    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("--records", type=int, default=40)
    asked.add_argument("--first", type=int, default=FIRST)
    asked.add_argument("--jobs", type=int, default=2)
    asked.add_argument("--cases", type=int, nargs="*", default=range(len(CASES)))
    said = asked.parse_args()
    seeds = range(said.first, said.first + said.records)
    missed, lines = 0, [*_headings()]
    for case, done, lost in _table([CASES[k] for k in said.cases], seeds, said.jobs):
        lines.append(line(case, done, lost))
        missed += share(done)[0] < case.asked
        print(lines[-1], flush=True)
    head = HEAD.format(commit=commit_of(Path(__file__).parent), first=seeds[0], last=seeds[-1])
    if len(said.cases) == len(CASES):
        PAGE.write_text(head + "\n".join(lines) + "\n", encoding="utf-8")
    return int(missed > 0)


def _headings() -> Iterator[str]:
    yield "| | records | lost | " + " | ".join(MEASURES.values()) + " | all |"
    yield "| :--- | ---: | ---: |" + " ---: |" * (len(MEASURES) + 1)


def _table(
    cases: Sequence[Case], seeds: Sequence[int], jobs: int
) -> Iterator[tuple[Case, list[Counted], int]]:
    """Every case with the records that could be counted, and how many could not."""
    with ProcessPoolExecutor(jobs) as pool:
        for case in cases:
            found = list(pool.map(count, [case] * len(seeds), seeds))
            done = [c for c in found if c is not None]
            yield case, done, len(seeds) - len(done)


if __name__ == "__main__":
    sys.exit(main())
