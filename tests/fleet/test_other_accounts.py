"""A step beside voyages that lie off is found; a season and an alternation are told as neither."""

from collections.abc import Callable

import numpy as np
import pytest
from records_of_ships import estimates, rows_of

from trialid.fleet.changes.change_points import Explained, explain
from trialid.fleet.changes.changes_of_ships import changes

K = np.arange(16)
LEVEL = 0.05 / 16
SEEDS = range(7000, 7040)
STEP = 4.0 * (K >= 8)


def told(x: Callable[[np.random.Generator], np.ndarray]) -> list[Explained]:
    """What is told of forty records: their course drawn, and their scatter."""
    courses = [x(np.random.default_rng([seed, 1])) for seed in SEEDS]
    return [explain(estimates(c, s), LEVEL) for c, s in zip(courses, SEEDS, strict=True)]


def off(x: np.ndarray, at: np.ndarray | list[int]) -> np.ndarray:
    return x + 6.0 * np.isin(K, at)


def steps(one: Explained) -> list[int]:
    return [found.course[1] for found in one.changes if found.course[0] == "step"]


def test_two_voyages_that_lie_off_hide_no_step() -> None:
    """Eight times the scatter; wherever they lie apart from it, and which they were is told."""
    far = np.r_[0:6, 10:16]
    found = told(lambda rng: off(STEP, rng.choice(far, 2, replace=False)))
    assert sum(steps(one) == [8] and len(one.changes) == 1 for one in found) >= 28
    one = explain(estimates(off(STEP, [2, 11]), 7100), LEVEL)
    assert (steps(one), one.varies is not None and one.varies.voyage in (2, 11)) == ([8], True)
    assert one.changes[0].size == pytest.approx(4.0, abs=0.8)


def test_a_quarter_of_the_voyages_off_hides_no_step_far_beyond_the_scatter() -> None:
    x = off(STEP, [2, 5, 11, 14])
    assert [steps(explain(estimates(x, seed, 0.05), LEVEL)) for seed in SEEDS] == [[8]] * 40


def test_voyages_off_with_no_step_beside_them_are_none() -> None:
    """Three, four, five of sixteen; where they happen to lie together they are one."""
    for many in (3, 4, 5):
        found = told(lambda rng, n=many: off(0.0 * K, rng.choice(16, n, replace=False)))
        assert sum(not one.changes for one in found) >= 35, many
        assert all(one.varies is not None or one.changes for one in found)


@pytest.mark.parametrize("period", [2, 3, 4, 6, 8, 12, 16])
def test_what_comes_and_goes_varies(period: int) -> None:
    """As a season or another loading does, three times what the likely ranges stand for."""

    def course(rng: np.random.Generator) -> np.ndarray:
        turn = 0.5 if period == 2 else rng.uniform()
        return 3.0 * np.sin(2.0 * np.pi * (K / period + 0.5 * turn))

    found = told(course)
    assert sum(not one.changes and one.varies is not None for one in found) >= 38


def test_a_season_beside_a_step_is_no_drift() -> None:
    """Either the step is told, or that it varies."""
    found = told(lambda rng: 4.0 * np.sin(np.pi * K / 4.0) - 8.0 * (K >= 8))
    honest = [steps(one) == [8] or bool(not one.changes and one.varies) for one in found]
    assert sum(honest) >= 36


def test_a_plain_step_or_drift_is_told_as_such() -> None:
    """Whatever else it is compared with; there and back, too."""
    there = 4.0 * ((K >= 5) & (K < 11))
    drift = 5.0 * K / 15.0
    kinds = [told(lambda rng, x=x: x) for x in (STEP, drift, there)]
    assert [sum(bool(one.changes) for one in found) >= 37 for found in kinds] == [True] * 3
    assert sum(steps(one) == [5, 11] for one in kinds[2]) >= 34


def test_what_varies_is_a_row_with_the_voyage_furthest_off() -> None:
    x = np.where(K % 2, 0.72, 0.9)
    x[7] = 0.6
    (row,) = changes(*rows_of(x))
    assert (row.form, row.voyage, row.earliest, row.latest) == (
        *("varies", "trip 7"),
        *("trip 0", "trip 15"),
    )
    assert row.size == pytest.approx(0.6 - x.mean(), abs=0.02)
    assert (row.beyond_likely, row.p_value < 1e-6) == (True, True)


@pytest.mark.study(turn="each")
def test_what_the_likely_ranges_leave_open_does_not_vary() -> None:
    """Ranges as they should be: told of a fleet in twenty."""
    many = sum(
        explain(estimates(0.0 * K, seed, 1.0), 0.05).varies is not None for seed in range(400)
    )
    assert many <= 32
