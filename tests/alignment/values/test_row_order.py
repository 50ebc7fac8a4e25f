"""Rows in another order than that of their stamps are read by their stamps, as if in order."""

from collections.abc import Callable

import numpy as np
import pytest

from trialid.alignment.clocks import Series, in_time_order
from trialid.alignment.stamps.dejitter import repair_stamps
from trialid.alignment.stamps.row_order import is_out_of_order
from trialid.names.quantities import SIGNALS

PERIOD = 0.5
COUNT = 840
Rows = Callable[[np.random.Generator], np.ndarray]


def any_order(rng: np.random.Generator) -> np.ndarray:
    return rng.permutation(COUNT)


def twice_some(rng: np.random.Generator) -> np.ndarray:
    return rng.permutation(np.concatenate([np.arange(COUNT), rng.choice(COUNT, 60)]))


def near_their_place(rng: np.random.Generator) -> np.ndarray:
    return np.argsort(np.arange(COUNT) + rng.uniform(0.0, 6.0, COUNT), kind="stable")


def two_changed(rng: np.random.Generator) -> np.ndarray:
    rows, at = np.arange(COUNT), int(rng.integers(100, 700))
    rows[[at, at + 1]] = rows[[at + 1, at]]
    return rows


def halves_changed(rng: np.random.Generator) -> np.ndarray:
    return np.roll(np.arange(COUNT), int(rng.integers(100, 700)))


def blocks_changed(rng: np.random.Generator) -> np.ndarray:
    blocks = np.arange(COUNT).reshape(-1, 105)
    return np.roll(blocks, int(rng.integers(1, 7)), axis=0)[[2, 0, 1, 3, 5, 4, 7, 6]].ravel()


def reversed_rows(rng: np.random.Generator) -> np.ndarray:
    return np.arange(COUNT)[::-1]


ORDERS: tuple[Rows, ...] = (
    any_order,
    twice_some,
    near_their_place,
    two_changed,
    halves_changed,
    blocks_changed,
    reversed_rows,
)


def sailed(rng: np.random.Generator, jitter: float = 0.0) -> Series:
    """A roll in order, its stamps off by a share of the period."""
    t = PERIOD * (np.arange(COUNT) + jitter * rng.standard_normal(COUNT))
    y = np.sin(0.05 * t) + 0.01 * rng.standard_normal(COUNT)
    return Series(SIGNALS["phi"], 10**18 + np.rint(1e9 * t).astype(np.int64), y, "made")


def in_rows(series: Series, rows: np.ndarray) -> Series:
    return Series(series.quantity, series.t[rows], series.y[rows], series.clock)


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("seed", [51, 52, 53])
def test_even_stamps_stay_to_the_bit_whatever_the_order_of_rows(order: Rows, seed: int) -> None:
    """A circle of 420 s was read as one of 10 s, with an effect named of it."""
    rng = np.random.default_rng(seed)
    whole = sailed(rng)
    made, words = repair_stamps(in_rows(whole, order(rng)))
    ordered = in_time_order(made)
    assert np.array_equal(ordered.t, whole.t)
    assert np.array_equal(ordered.y, whole.y)
    assert words == ()


@pytest.mark.parametrize("order", [any_order, reversed_rows, halves_changed])
def test_stamps_that_jitter_are_repaired_as_they_are_of_rows_in_order(order: Rows) -> None:
    rng = np.random.default_rng(61)
    whole = sailed(rng, jitter=0.05)
    made, words = repair_stamps(in_rows(whole, order(rng)))
    expected, told = repair_stamps(whole)
    assert np.array_equal(in_time_order(made).t, expected.t)
    assert words == told
    assert "by regression on the sample index, 2 Hz" in words[0]


@pytest.mark.parametrize("jitter", [0.0, 0.02])
def test_of_a_clock_set_back_the_rows_are_in_order(jitter: float) -> None:
    """By a share of the period, by whole and by half ones, anywhere in the log."""
    rng = np.random.default_rng(62)
    for back in (0.3, 0.5, 2.3, 30.0, 250.0, 250.25, *rng.uniform(1.0, 400.0, 200)):
        whole = sailed(rng, jitter)
        late = np.arange(COUNT) >= rng.integers(COUNT // 10, COUNT - 10)
        reached = (whole.t[late][0] - whole.t[0]) / 1e9
        if not 0.0 < back - reached < 20.0 * PERIOD:  # else it goes on before the log's own start
            assert not is_out_of_order(whole.t - np.where(late, round(1e9 * back), 0)), back


@pytest.mark.parametrize(("turn", "count"), [(60, 840), (60, 120), (3600, 7200), (3600, 7150)])
def test_a_counter_that_began_again_is_in_order(turn: int, count: int) -> None:
    """Even where the log lasts a whole turn, so that what is sorted has no gap."""
    t = round(1e9 * PERIOD) * (np.arange(count) + count // 4)
    assert not is_out_of_order(t % (turn * 10**9))


def test_all_columns_of_a_table_are_read_in_one_order() -> None:
    """Two files that overlap, joined the wrong way round: one column is coarse, one has gaps."""
    whole = sailed(np.random.default_rng(65))
    rows = np.concatenate([np.arange(400, COUNT), np.arange(440)])
    rudder = np.where(np.sin(0.1 * np.arange(COUNT)) > 0.0, 0.17, -0.17)
    gaps = np.where(np.arange(COUNT) % 10, whole.y, np.nan)
    made = [
        repair_stamps(in_rows(Series(whole.quantity, whole.t, y, "made"), rows))[0].t
        for y in (whole.y, rudder, gaps)
    ]
    assert np.array_equal(made[0], made[1])
    assert np.array_equal(made[0], made[2])


def test_a_stretch_delivered_again_adds_nothing_by_either_rule() -> None:
    whole = sailed(np.random.default_rng(64))
    rows = np.concatenate([np.arange(600), np.arange(400, COUNT)])
    made, _ = repair_stamps(in_rows(whole, rows))
    assert np.array_equal(in_time_order(made).t, whole.t)
