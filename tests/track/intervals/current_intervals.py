"""How often the 95 % interval of a steady current holds it, with and without noise of inputs.

    python tests/track/intervals/current_intervals.py [--records 300] [--write]

A turning circle and a 20/20 zig-zag with a current each, a receiver of 1 m, a compass and a gyro:
in calm air, and with the wind's forces fitted from an anemometer on board; and with one of the two
only to check, whose current is its own. Results stand in
`tests/benchmarks/results/currents.md` with `--write`. Exit status 1 below 93 or above 97 %, where
both have noise.
"""

import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np
from scipy.stats import t as student

sys.path.insert(0, str(Path(__file__).parents[2]))
sys.path.insert(0, str(Path(__file__).parents[1]))
sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
import sailed_wind
from counted import counted
from sailed_tracks import CURRENTS, SETTINGS, SHIP, accuracy, spread, trials

from trialid.accuracy.parameter_table import ParameterAccuracy
from trialid.design.imo.trial_measures import water_of
from trialid.effects.track import CURRENT
from trialid.identification.fit import Fit, identify
from trialid.threads import one_thread

Waters = dict[str, tuple[float, float]]
Told = Callable[[Fit], Iterator[tuple[bool, float]]]
"""Whether each interval of a fit held its current, and the standard error [m/s]."""


@dataclass(frozen=True)
class Case:
    """A way to log: which currents there are, and a fit by seed."""

    name: str
    waters: Waters
    fit: Callable[[int], Fit]
    judged: bool = True
    checked: str | None = None


def windy(seed: int, sensors: float = 1.0, air: float = 1.0, checked: str | None = None) -> Fit:
    """Both manoeuvres in the wind, fitted; one of them only to check, where it is named."""
    rng = np.random.default_rng([31, seed])
    waters = sailed_wind.WATERS
    logs = [sailed_wind.noisy(sailed_wind.blown(n), rng, sensors, air) for n in waters]
    logs = [replace(t, use="check") if t.name == checked else t for t in logs]
    return identify(logs, sailed_wind.WINDY, sailed_wind.SETTINGS)


def checked(name: str) -> Case:
    """Of a manoeuvre that is not fitted, by what the other tells of ship and wind."""
    water = {name: sailed_wind.WATERS[name]}
    return Case(
        f"wind by anemometer, {name} to check",
        water,
        lambda s: windy(s, checked=name),
        checked=name,
    )


CASES: Final = (
    Case("calm air", CURRENTS, lambda seed: identify(trials(seed), SHIP, SETTINGS)),
    Case("wind known exactly", sailed_wind.WATERS, lambda seed: windy(seed, air=0.0)),
    Case("wind by anemometer", sailed_wind.WATERS, windy),
    Case("anemometer three times as noisy", sailed_wind.WATERS, lambda s: windy(s, air=3.0)),
    Case("all noise the anemometer's", sailed_wind.WATERS, lambda s: windy(s, 0.0), judged=False),
    checked("circle"),
    checked("zigzag"),
)


def holds(row: ParameterAccuracy, truth: float) -> bool:
    """Whether a 95 % interval holds the truth."""
    return abs(row.value - truth) < student.ppf(0.975, row.freedom) * row.standard_error


@one_thread
def count(case: Case, seeds: Sequence[int]) -> tuple[list[bool], float]:
    """Which intervals held their current, and the median standard error [m/s]."""
    inside, errors = [], []
    for seed in seeds:
        told = to_check(case) if case.checked else fitted(case)
        for held, error in told(case.fit(seed)):
            inside.append(held)
            errors.append(error)
    return inside, float(np.median(errors))


def fitted(case: Case) -> Told:
    """Whether each current is held, and its error, by the table of parameters."""

    def told(fit: Fit) -> Iterator[tuple[bool, float]]:
        rows = {p.name: p for p in accuracy(fit).parameters}
        for name, water in case.waters.items():
            for column, truth in zip(CURRENT, water, strict=True):
                row = rows[f"{column} [{name}]"]
                yield holds(row, truth), row.standard_error

    return told


def to_check(case: Case) -> Told:
    """The same of a trial that is not fitted."""

    def told(fit: Fit) -> Iterator[tuple[bool, float]]:
        [trial] = [s.trial for s in fit.scores if s.trial.name == case.checked]
        water = water_of(fit, trial, {}, spread(fit, {}))
        assert water is not None
        assert water.error is not None
        of = zip(water.speed, case.waters[trial.name], water.error, strict=True)
        for speed, truth, error in of:
            yield abs(speed - truth) < 1.96 * error, error

    return told


def page(seeds: range) -> tuple[str, bool]:
    """The table, and whether every share that is judged is as it should be."""
    lines = [
        "| | records, intervals | held | median standard error |",
        "| :--- | ---: | ---: | ---: |",
    ]
    good = True
    for case in CASES:
        inside, error = count(case, seeds)
        share = float(np.mean(inside))
        lines.append(
            f"| {case.name} | {len(seeds)}, {len(inside)} | {share:.1%} "
            f"| {1000.0 * error:.2f} mm/s |"
        )
        print(lines[-1], flush=True)
        good = good and (not case.judged or 0.93 <= share <= 0.97)
    return "\n".join(lines) + "\n", good


if __name__ == "__main__":
    sys.exit(counted(__doc__, page, "currents", records=300, first=5000))
