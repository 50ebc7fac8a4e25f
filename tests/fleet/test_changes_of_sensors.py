"""Changes of a rudder's zero and of delays, which each trial of a voyage has for itself."""

from dataclasses import replace

import numpy as np
import pytest
from records_of_ships import rows_of

from trialid.fleet.changes import changes

DAYS = range(0, 480, 30)
TRIALS = ("zz10", "zz20")


def voyages(name, of_voyage, seed):
    """Runs, and rows of one number of each of two trials about that of each voyage."""
    rng = np.random.default_rng([seed, 83])
    runs, fitted = rows_of(np.ones(len(DAYS)), DAYS)
    rows = [
        replace(
            row,
            parameter=f"{name} [{trial}]",
            kind="nuisance",
            value=float(x + 0.1 * rng.standard_normal()),
            standard_error=0.1,
            likely_low=None,
            likely_high=None,
        )
        for row, x in zip(fitted, of_voyage, strict=True)
        for trial in TRIALS
    ]
    return runs, rows


@pytest.mark.parametrize("name", ["delta_0", "tau_r"])
@pytest.mark.parametrize("size", [-0.6, 0.6])
def test_a_step_in_all_trials_is_dated(name, size):
    """Of an outsider's fleet a trim of 1.5 deg from the ninth voyage on was no change."""
    [found] = changes(*voyages(name, size * (np.arange(16) >= 9), 1))
    assert (found.parameter, found.form, found.voyage) == (name, "step", "trip 9")
    assert found.size == pytest.approx(size, abs=0.15)


@pytest.mark.parametrize("name", ["b_phi", "phi(0)"])
def test_what_goes_with_wind_and_weather_is_no_change(name):
    assert [*changes(*voyages(name, 0.6 * (np.arange(16) >= 9), 2))] == []


def test_a_delay_that_varies_with_the_weather_is_not_told():
    weather = 0.5 * np.random.default_rng(3).standard_normal(16)
    assert [*changes(*voyages("tau_phi", weather, 3))] == []


def test_without_a_change_one_is_found_in_hardly_any():
    found = [any(True for _ in changes(*voyages("tau_r", np.zeros(16), s))) for s in range(100)]
    print(sum(found))
    assert sum(found) <= 10
