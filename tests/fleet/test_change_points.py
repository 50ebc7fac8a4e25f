"""Changes of parameters: fouling and a step dated, and hardly any where there is none."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
import pytest

from trialid.fleet.changes.change_points import Found, explain
from trialid.fleet.changes.changes_of_ships import changes
from trialid.fleet.changes.courses import Estimates, courses_of
from trialid.result.fleet_rows import ChangeRow, FittedRow, RunRow

WIDE = {"Xuu": 0.06, "GM": 0.08, "Nr": 0.05, "Yv": 0.1}
"""Half of each parameter's likely range, a share of its value."""


def fleet(
    seed: int,
    drift: float = 0.0,
    step: float = 0.0,
    *,
    voyages: int = 40,
    ships: int = 1,
    scatter: float = 0.5,
) -> tuple[list[RunRow], list[FittedRow]]:
    """Rows of a fleet whose estimates scatter by a share of what the likely ranges allow.

    The drag drifts from the first voyage to the last, GM steps at the 25th.
    """
    rng = np.random.default_rng(seed)
    runs, fitted = [], []
    for ship in (f"ship {n}" for n in range(ships)):
        for k in range(voyages):
            own = {"run": f"{ship} {k}", "ship": ship, "voyage": f"voyage {k + 1}"}
            runs.append(RunRow(**own, verdict="nothing missing"))
            for name, wide in WIDE.items():
                level = {"Xuu": 1.0 + drift * k / (voyages - 1), "GM": 1.0 + step * (k >= 24)}
                x = level.get(name, 1.0) + scatter * wide / 1.96 * rng.standard_normal()
                fitted.append(
                    FittedRow(
                        **own,
                        parameter=name,
                        kind="physical",
                        unit="1",
                        value=x,
                        standard_error=0.1 * wide,
                        likely_low=x - wide,
                        likely_high=x + wide,
                    )
                )
    return runs, fitted


def find_changes(y: Estimates, level: float) -> tuple[Found, ...]:
    return explain(y, level).changes


def changes_alone(runs: list[RunRow], fitted: list[FittedRow]) -> list[ChangeRow]:
    return [row for row in changes(runs, fitted) if row.form != "varies"]


def voyage(name: str) -> int:
    return int(name.split(" ")[1])


def dated(found: Sequence[ChangeRow], parameter: str, form: str) -> Iterator[int]:
    return (voyage(row.voyage) for row in found if (row.parameter, row.form) == (parameter, form))


@pytest.mark.parametrize("seed", range(40, 50))
def test_fouling_and_a_step_of_gm_are_found_and_dated(seed: int) -> None:
    found = list(changes(*fleet(seed, drift=0.2, step=-0.1)))
    assert sorted({row.parameter for row in found}) == ["GM", "Xuu"]
    (step,) = [row for row in found if row.parameter == "GM"]
    assert step.form == "step"
    assert abs(voyage(step.voyage) - 25) <= 2
    assert voyage(step.earliest) <= voyage(step.voyage) <= voyage(step.latest)
    assert step.size == pytest.approx(-0.1, abs=0.02)
    assert step.relative == pytest.approx(step.size, rel=0.02)
    drag = [row for row in found if row.parameter == "Xuu"]
    assert sum(row.size for row in drag) == pytest.approx(0.2, abs=0.04)


def test_a_resistance_that_grows_is_more_of_what_it_was() -> None:
    """Below zero as its letter is: of -1.0 that becomes -1.2 it is a fifth, not less a fifth."""
    runs, fitted = fleet(41, drift=0.2)
    below = [
        replace(x, value=-x.value, likely_low=-x.likely_high, likely_high=-x.likely_low)
        for x in fitted
    ]
    drag = [row for row in changes_alone(runs, below) if row.parameter == "Xuu"]
    assert sum(row.size for row in drag) == pytest.approx(-0.2, abs=0.04)
    assert sum(row.relative or 0.0 for row in drag) == pytest.approx(0.2, abs=0.04)


def test_a_drift_that_begins_is_dated() -> None:
    """From the 15th voyage on, the estimates scattering by a tenth of what they come to."""
    misses = []
    for seed in range(60, 80):
        rng = np.random.default_rng(seed)
        x = 1.0 + 0.2 * np.clip((np.arange(40) - 13) / 26.0, 0.0, None)
        y = Estimates(x + 0.01 * rng.standard_normal(40), np.full(40, 0.02))
        (found,) = find_changes(y, 0.05 / 12)
        assert found.course[0] == "drift"
        misses.append(abs(found.course[1] - 14))
    assert np.mean(np.array(misses) <= 2) >= 0.9


def test_a_drift_and_a_step_the_other_way_in_one_parameter() -> None:
    """Neither stands alone: only both at once are plainly there."""
    found = 0
    for seed in range(10):
        rng = np.random.default_rng(seed)
        x = 1.0 + 0.2 * np.arange(40) / 39.0 - 0.1 * (np.arange(40) >= 24)
        y = Estimates(x + 0.01 * rng.standard_normal(40), np.full(40, 0.01))
        courses = [each.course for each in find_changes(y, 0.05 / 12)]
        found += ("step", 24) in courses
    assert found >= 9


@pytest.mark.study(turn="each")
def test_when_a_change_began_lies_within_its_range() -> None:
    """A step of twice the scatter is dated to a voyage or three: the range says so."""
    held, alone = [], []
    for seed in range(300, 360):
        x = np.random.default_rng(seed).standard_normal(40) + 2.0 * (np.arange(40) >= 20)
        for found in find_changes(Estimates(x, np.ones(40)), 0.05):
            if found.course[0] == "step":
                held.append(found.ends[0] <= 20 <= found.ends[1])
                alone.append(found.course[1] == 20)
    assert len(held) >= 40
    assert np.mean(held) >= 0.9
    assert np.mean(alone) <= 0.8


@pytest.mark.study(turn=1)
def test_no_change_is_found_where_there_is_none() -> None:
    """A hundred fleets: a false alarm in five of them at most.

    Without the bound one record in twenty has one; most of what chance makes is as much a wave.
    """
    alarms, loose = 0, 0
    for seed in range(100):
        runs, fitted = fleet(1000 + seed, voyages=8 + seed % 33, ships=1 + seed % 3)
        alarms += bool(changes_alone(runs, fitted))
        y = Estimates(np.random.default_rng(seed).standard_normal(20), np.ones(20))
        loose += bool(find_changes(y, 0.05 * len(courses_of(np.arange(20.0))) * 2))
    assert alarms <= 5
    assert loose >= 6


@pytest.mark.study(turn="each")
def test_what_a_fleet_without_a_change_shows_as_often_is_not_told() -> None:
    """Steps that just show: what counts is how many parameters and ships were looked at."""
    found = [
        row
        for seed in range(20)
        for row in changes(*fleet(3000 + seed, step=-0.004 * seed, voyages=30, ships=2))
    ]
    assert len(found) >= 8
    assert max(row.p_value for row in found) <= 0.05


@pytest.mark.study(turn="each")
def test_scatter_beyond_the_likely_ranges_is_no_change() -> None:
    """It is told that they vary by more than these."""
    told = [list(changes(*fleet(2000 + seed, scatter=4.0))) for seed in range(50)]
    assert sum(any(row.form != "varies" for row in rows) for rows in told) <= 2
    assert all(any(row.form == "varies" for row in rows) for rows in told)


def test_what_noise_leaves_open_is_no_change() -> None:
    """Estimates that scatter less than their own noise can, by chance or because they share it."""
    x = np.array([1.0] * 10 + [1.01] * 10)
    y = Estimates(x, np.full(20, 0.05), least=1.0)
    assert find_changes(y, 0.05) == ()
    assert find_changes(Estimates(x, np.full(20, 0.05)), 0.05)[0].course == ("step", 10)


@pytest.mark.parametrize("at", [0, 20, 38, 39])
def test_a_single_voyage_that_lies_off_is_no_change(at: int) -> None:
    """Sixteen times the scatter off: no step there and back, and a step beside it is found."""
    single = 0
    for seed in range(300, 310):
        x = 0.5 * np.random.default_rng(seed).standard_normal(40)
        x[at] += 8.0
        flat, level = np.ones(40), 0.05 / 4
        assert find_changes(Estimates(x, flat), level) == ()
        found = find_changes(Estimates(x + 3.0 * (np.arange(40) >= 24), flat), level)
        single += [(one.course, abs(one.size - 3.0) < 1.0) for one in found] == [(("step", 24), 1)]
    assert single >= 9


def test_a_change_within_the_likely_ranges_says_so() -> None:
    small = list(changes(*fleet(3, step=-0.05, scatter=0.1)))
    large = list(changes(*fleet(3, step=-0.2, scatter=0.1)))
    assert [row.beyond_likely for row in small] == [False]
    assert [row.beyond_likely for row in large] == [True]
    assert list(dated(large, "GM", "step")) == [25]


@pytest.mark.parametrize("unit", [1e-9, 1e9])
def test_the_unit_of_a_parameter_makes_no_difference(unit: float) -> None:
    runs, fitted = fleet(3, drift=0.2, step=-0.2)
    keys = ("value", "standard_error", "likely_low", "likely_high")
    scaled = [
        FittedRow(**{**vars(row), **{key: unit * getattr(row, key) for key in keys}})
        for row in fitted
    ]
    for one, other in zip(changes(runs, fitted), changes(runs, scaled), strict=True):
        assert (one.parameter, one.form, one.voyage) == (other.parameter, other.form, other.voyage)
        assert other.size == pytest.approx(unit * one.size)


def test_runs_without_a_fit_have_no_say() -> None:
    runs, fitted = fleet(3, step=-0.2)
    poor = [RunRow(**{**vars(row), "verdict": "no fit"}) for row in runs]
    assert [row.parameter for row in changes(runs, fitted)] == ["GM"]
    assert list(changes(poor, fitted)) == []


def test_few_voyages_say_nothing() -> None:
    assert list(changes(*fleet(3, step=-0.2, voyages=5))) == []
