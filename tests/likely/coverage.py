"""How often likely ranges hold the truth: by what is hidden, noise, length, rate and ship.

    PYTHONPATH=. python tests/likely/coverage.py [--records 40] [--first 5000] [--cases 12 13]

writes `tests/benchmarks/results/likely.md` unless only some cases were asked for, by their place. A
record depends on its conditions and seed alone. Seeds 1 to 250 were looked at while the ranges were
built; those from 5000 on were not. Tests count 9000 to 9023; the page had 9000 to 9039, then 42000
to 42019 and 43000 to 43029. Scales of logs were looked at on 50000 to 50029.
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
from hidden_truth import OUTPUTS
from sailed_records import NoPassage, record
from worlds import SCENARIOS, Conditions, World, guessed, hidden_world, world

from trialid.accuracy.parameter_table import ParameterAccuracy
from trialid.diagnosis.may_be_off import may_be_off
from trialid.diagnosis.noise.split import split
from trialid.diagnosis.search.augment import augment
from trialid.diagnosis.trust import accuracy_of
from trialid.effects import CATALOGUE
from trialid.identification.fit import Fit, identify
from trialid.identification.problem import Settings
from trialid.ship.effect import Effect
from trialid.threads import one_thread
from trialid.trial import Trial

RESULTS: Final = Path(__file__).parents[1] / "benchmarks" / "results" / "likely.md"
FIRST: Final = 5000

EXACT: Final = {"default": 0.0}
"""What is held fixed is right in these records, and the ship file says so."""


@dataclass(frozen=True, kw_only=True)
class Case:
    """Conditions, what of the truth is hidden, and the coverage that is asked for.

    `left_out` takes the hidden effect out of the catalogue too; `exact` says in the ship file that
    what is held fixed is right; `scaled` that each log reads by a factor of its own in all trials.
    """

    name: str
    conditions: Conditions
    hides: bool = True
    left_out: bool = False
    exact: bool = True
    scaled: bool = False
    asked: float = 0.90


WAVES, PROCESS = Conditions(), Conditions(noise="process")
ROUGH: Final = "the same, gusts and waves on the hull"
CASES: Final = (
    Case(name="an effect hidden", conditions=WAVES, asked=0.93),
    Case(name="the same, out of the catalogue too", conditions=WAVES, left_out=True),
    Case(name="the same, nothing said of what is held", conditions=WAVES, exact=False),
    Case(name="an effect hidden, gusts and waves on the hull", conditions=PROCESS),
    Case(name="nothing hidden", conditions=WAVES, hides=False, asked=0.93),
    Case(name=ROUGH, conditions=PROCESS, hides=False),
    Case(
        name="held fixed up to 15 % off",
        conditions=replace(WAVES, held_off=0.15),
        hides=False,
        exact=False,
    ),
    Case(name=ROUGH, conditions=replace(PROCESS, held_off=0.15), hides=False, exact=False),
    Case(name="trials of 5 min", conditions=replace(WAVES, minutes=5.0)),
    Case(name="trials of 60 min at 1 Hz", conditions=replace(WAVES, minutes=60.0, period=1.0)),
    Case(name="1 Hz", conditions=replace(WAVES, period=1.0)),
    Case(name="10 Hz, 10 min", conditions=replace(WAVES, period=0.1, minutes=10.0)),
    Case(name="one zig-zag alone", conditions=replace(WAVES, single=True)),
    Case(name=ROUGH, conditions=replace(PROCESS, single=True)),
    Case(name="naval vessel", conditions=replace(WAVES, ship="naval")),
    Case(name=ROUGH, conditions=replace(PROCESS, ship="naval")),
    Case(name="model of 3.5 m", conditions=replace(WAVES, ship="model")),
    Case(name="boat of 10 m, gusts and waves", conditions=replace(PROCESS, ship="boat")),
    Case(name="scales of the logs off", conditions=WAVES, hides=False, scaled=True),
    Case(name="the same, an effect hidden too", conditions=WAVES, scaled=True),
)


@dataclass(frozen=True)
class Counted:
    """Of each free parameter of a record whether an interval holds the truth; its half-width.

    By kind of interval; widths as shares of the true value.
    """

    holds: Mapping[str, tuple[bool, ...]]
    widths: Mapping[str, tuple[float, ...]]


KINDS: Final = ("likely", "1.96 +-", "Eq. 14")


@one_thread
def count(case: Case, seed: int) -> Counted | None:
    """One record's intervals; None where she cannot be sailed or the fit did not converge."""
    ship = hidden_world(case.conditions, seed) if case.hides else as_known(case.conditions)
    try:
        fit = fit_of(ship, seed, exact=case.exact, scaled=case.scaled)
    except NoPassage:
        return None
    if not fit.converged:
        return None
    gone = {e.name for e in SCENARIOS[ship.hidden].effects} if case.left_out else set[str]()
    return counted(fit, ship, {n: e for n, e in CATALOGUE.items() if n not in gone})


def as_known(conditions: Conditions) -> World:
    return world(conditions, SCENARIOS["nothing"])


def fit_of(ship: World, seed: int, *, exact: bool, scaled: bool = False) -> Fit:
    """The fit of a record by the model of what is known of the ship."""
    model = guessed(ship, seed)
    if exact:
        model = replace(model, ship=replace(model.ship, uncertainty=EXACT))
    settings = Settings(ship.free, OUTPUTS, nuisance=("initial_state",))
    trials = record(ship, seed)
    return identify(off_in_scale(trials, seed) if scaled else trials, model, settings)


def off_in_scale(trials: Sequence[Trial], seed: int) -> tuple[Trial, ...]:
    """The same logs, off by 2.5 % of a rate or an angle and 1 % of a speed, standard deviation."""
    rng = np.random.default_rng((seed, 1))
    off = {n: 0.5 * (0.02 if n == "u" else 0.05) for n in ("delta", "u", *OUTPUTS)}
    by = {n: 1.0 + x * rng.standard_normal() for n, x in off.items()}
    return tuple(
        replace(t, signals={n: x * by.get(n, 1.0) for n, x in t.signals.items()}) for t in trials
    )


def counted(fit: Fit, ship: World, catalogue: Mapping[str, Effect]) -> Counted:
    """Which intervals of a fit hold the truth."""
    augmented = augment(fit, catalogue)
    parts, _ = split(fit, augmented, {})
    rows = accuracy_of(fit, parts, may_be_off(augmented)).physical
    return Counted(
        {kind: tuple(_holds(r, kind, ship) for r in rows) for kind in KINDS},
        {kind: tuple(_width(r, kind, ship) for r in rows) for kind in KINDS},
    )


def _ends(row: ParameterAccuracy, kind: str) -> tuple[float, float]:
    """An interval of one parameter."""
    if kind == "likely":
        return row.likely or (np.nan, np.nan)
    half = 1.96 * row.standard_error
    if kind == "Eq. 14":
        known = row.noise_error is not None and row.undermodelling_error is not None
        half = 1.96 * row.noise_error + row.undermodelling_error if known else np.nan
    return row.value - half, row.value + half


def _holds(row: ParameterAccuracy, kind: str, ship: World) -> bool:
    low, high = _ends(row, kind)
    return bool(low <= ship.truth[row.name] <= high)


def _width(row: ParameterAccuracy, kind: str, ship: World) -> float:
    low, high = _ends(row, kind)
    return (high - low) / 2.0 / abs(ship.truth[row.name])


def share(done: Sequence[Counted], kind: str) -> tuple[float, float, float]:
    """Share of intervals that hold the truth, and its 95 % interval; records, not intervals, count.

    The parameters of one record go together, so the interval comes from draws of whole records.
    """
    each = np.array([np.mean(c.holds[kind]) for c in done])
    rng = np.random.default_rng(1)
    drawn = each[rng.integers(len(each), size=(2000, len(each)))].mean(axis=1)
    low, high = np.quantile(drawn, (0.025, 0.975))
    return float(each.mean()), float(low), float(high)


def table(
    cases: Sequence[Case], seeds: range, jobs: int
) -> Iterator[tuple[Case, list[Counted], int]]:
    """Each case with the records that could be counted, and how many did not converge."""
    with ProcessPoolExecutor(jobs) as pool:
        for case in cases:
            found = list(pool.map(count, [case] * len(seeds), seeds))
            done = [c for c in found if c is not None]
            yield case, done, len(seeds) - len(done)


def line(case: Case, done: Sequence[Counted], lost: int) -> str:
    """One row of the page."""
    cells = []
    for kind in KINDS:
        held, low, high = share(done, kind)
        width = float(np.nanmedian([w for c in done for w in c.widths[kind]]))
        cells.append(f"{held:.1%} ({low:.0%}-{high:.0%}) | {width:.1%}")
    total = sum(len(c.holds["likely"]) for c in done)
    return f"| {case.name} | {len(done)}, {total} | {lost} | {' | '.join(cells)} |"


HEAD: Final = """\
# Likely ranges, against a known truth

`python tests/likely/coverage.py`, commit {commit}, seeds {first} to {last}, none of them used while
building. Nine free parameters (eight of the naval vessel), three trials fitted, 20 min at 2 Hz with
waves in the sensors unless said. Share of intervals that hold the truth (95 % interval, from draws
of whole records), then `half`, the median half-width as a share of the true value. Where nothing
else is said the ship file says that what is held fixed is exact. `lost`: fits that did not
converge, ships that what is hidden makes unsailable.

| | records, intervals | lost | likely | half | 1.96 x `+-` | half | Eq. 14 | half |
| :--- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |
"""


def main() -> int:
    """Write the page; exit status 1 where less is held than asked for."""
    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("--records", type=int, default=40)
    asked.add_argument("--first", type=int, default=FIRST)
    asked.add_argument("--jobs", type=int, default=2)
    asked.add_argument("--cases", type=int, nargs="+", default=[], choices=range(len(CASES)))
    said = asked.parse_args()
    lines, missed = [], 0
    cases = [CASES[place] for place in said.cases] or CASES
    for case, done, lost in table(cases, range(said.first, said.first + said.records), said.jobs):
        lines.append(line(case, done, lost))
        missed += share(done, "likely")[0] < case.asked
        print(lines[-1], flush=True)
    last = said.first + said.records - 1
    head = HEAD.format(commit=commit_of(Path(__file__).parent), first=said.first, last=last)
    if not said.cases:
        RESULTS.write_text(head + "\n".join(lines) + "\n", encoding="utf-8")
    return int(missed > 0)


if __name__ == "__main__":
    sys.exit(main())
