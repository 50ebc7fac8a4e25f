"""Changes by the calendar; which voyages and which models have a say in them."""

from dataclasses import replace

import numpy as np
import pytest
from records_of_ships import FIRST, rows_of

from trialid.fleet.changes.changes_of_ships import changes

CAMPAIGNS = [365 * year + 3 * k for year in range(3) for k in range(5)]
"""Days of five voyages within two weeks, a year apart."""


@pytest.mark.parametrize("seed", range(20, 30))
def test_a_drift_is_linear_in_time(seed: int) -> None:
    """Three campaigns of an even loss are one drift, and no two steps."""
    days = np.array(CAMPAIGNS)
    (row,) = changes(*rows_of(0.8 - 0.064 * days / 365.0, CAMPAIGNS, seed))
    assert row.form == "drift"
    assert row.size == pytest.approx(-0.064 * days[-1] / 365.0, abs=0.02)


@pytest.mark.parametrize("seed", range(20, 30))
def test_what_three_campaigns_show_is_two_changes(seed: int) -> None:
    """Steps, or drifts from the first campaign on: nobody saw what lay between."""
    heights = np.repeat([0.8, 0.6, 0.7], 5)
    found = list(changes(*rows_of(heights, CAMPAIGNS, seed)))
    assert [row.form != "varies" for row in found] == [True, True]


def test_a_step_may_have_been_any_day_after_the_voyage_before_it() -> None:
    for days in (CAMPAIGNS, None):
        (row,) = changes(*rows_of(np.repeat([0.8, 0.6, 0.6], 5), days))
        assert (row.earliest, row.voyage, row.latest) == ("trip 4", "trip 5", "trip 5")


def test_voyages_on_one_day_take_no_part_from_a_drift() -> None:
    days = [30 * (k // 2) for k in range(16)]
    (row,) = changes(*rows_of(0.8 - 0.01 * np.maximum(np.array(days) / 30.0 - 2.0, 0.0) * 4, days))
    assert (row.form, row.voyage) == ("drift", "trip 6")


def test_of_a_ship_with_dates_a_voyage_without_one_has_no_say() -> None:
    """Whatever it shows."""
    runs, fitted = rows_of(np.where(np.arange(16) < 8, 0.8, 0.6), range(0, 480, 30))
    plain = list(changes(runs, fitted))
    strange = {3: 0.2, 11: 0.3, 12: 0.1}
    runs = [replace(row, date=None) if k in strange else row for k, row in enumerate(runs)]
    fitted = [
        replace(row, value=strange[k], date=None) if k in strange else row
        for k, row in enumerate(fitted)
    ]
    (row,) = changes(runs, fitted)
    assert (row.form, row.voyage, row.date) == (plain[0].form, "trip 8", plain[0].date)
    assert row.date is not None
    assert (row.date - FIRST).days == 240


def test_estimates_of_unlike_models_are_no_record() -> None:
    """A parameter that leaps as another effect takes its part is no change of the ship."""
    x = np.where(np.arange(16) < 8, 0.8, 0.6)
    runs, fitted = rows_of(x, range(0, 480, 30), effects="linear_hull", free="GM, Nr")
    assert len(list(changes(runs, fitted))) == 1
    for other in ({"effects": "linear_hull, heel_yaw"}, {"free": "GM"}):
        mixed = [replace(row, **other) if k >= 8 else row for k, row in enumerate(runs)]
        assert list(changes(mixed, fitted)) == []
    order = [replace(row, free="Nr, GM") if k >= 8 else row for k, row in enumerate(runs)]
    assert len(list(changes(order, fitted))) == 1
