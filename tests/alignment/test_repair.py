"""Faulty clocks and what they do to a fit whose truth is known; the table is in the benchmarks."""

import pytest
from repair_table import RESULTS, rows, table

HALF = 0.5  # standard errors
CONSTANT = "stamps in whole seconds"
"""What stays of it is a constant, which only a delay takes: `whole seconds, delay fitted`."""


def test_a_clock_set_back_moves_the_fit_and_its_repair_does_not():
    (row,) = rows(("clock set back 2.3 s",))
    print(row)
    assert row.moved < 0.1
    assert row.unrepaired > 10.0


@pytest.mark.study(turn=12)
def test_no_fault_of_a_clock_moves_a_parameter_by_half_a_standard_error_when_repaired():
    done = list(rows())
    print(table(done))
    worst = {row.fault: row.moved for row in done if row.fault != CONSTANT}
    held = worst.pop("rudder 1 s late, delay fitted")
    assert held < 0.6  # a second is far from likely, and the fit holds delays weakly: 0.53
    assert max(worst.values()) < HALF
    left = [row.fault for row in done if row.unrepaired < HALF]
    assert left == ["28 ms jitter"]  # the low-pass of the grid takes most of it already
    shown = RESULTS.read_text(encoding="utf-8")  # last digits may differ on another processor
    assert all(f"| {row.fault} | {row.repair} |" in shown for row in done)
