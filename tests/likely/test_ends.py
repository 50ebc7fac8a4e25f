"""A likely range ends where the parameter does: a GM is not negative."""

from dataclasses import replace

import numpy as np
import pytest
from s175q import MODEL, white, with_noise, zigzag

from trialid.accuracy.likely import Averaged
from trialid.accuracy.widened import with_ranges, with_rivals
from trialid.diagnosis.diagnose import diagnose
from trialid.identification.fit import identify
from trialid.identification.problem import Settings


@pytest.fixture(scope="module")
def accuracy():
    trial = zigzag(10)
    trial = with_noise(trial, *white(np.random.default_rng(4), trial.samples))
    free = ("Nv", "Nr", "Ndelta", "Kv", "Kr", "Kdelta", "Kp", "GM")
    settings = Settings(free, ("r", "phi"), nuisance=("initial_state",))
    return diagnose(identify([trial], MODEL, settings)).before.accuracy


def far_off(accuracy):
    """What may be missing moves every parameter by ten times its value, either way."""
    count = len(accuracy.parameters)
    sizes = np.array([abs(p.value) for p in accuracy.parameters])
    return Averaged(np.zeros((2, count)), np.tile((10.0 * sizes) ** 2, (2, 1)), ("",) * count)


def by_name(accuracy):
    return {p.name: p for p in accuracy.physical}


def test_no_range_goes_beyond_the_ends(accuracy):
    found = by_name(with_ranges(accuracy, far_off(accuracy)))
    assert found["GM"].likely[0] == 0.0
    assert found["Kp"].likely[1] == 0.0
    assert found["Kp"].likely[0] < 5.0 * found["Kp"].value
    assert found["Nv"].likely[1] > 0.0 > found["Nv"].likely[0]  # a hull may have either


def test_nor_does_one_about_another_gm(accuracy):
    row = by_name(accuracy)["GM"]
    wide = replace(row, likely=(0.05 * row.value, 2.0 * row.value))
    only = replace(accuracy, parameters=(wide,))
    [found] = with_rivals(only, [{"GM": 0.2 * row.value}]).parameters
    assert found.likely[0] == 0.0


def test_a_range_goes_as_far_out_as_slopes_that_grow_with_the_parameter(accuracy):
    """Off by 30 % of the fit is off by 35 % outward, and by 30 % inward."""
    count = len(accuracy.parameters)
    sizes = np.array([abs(p.value) for p in accuracy.parameters])
    errors = np.array([p.standard_error for p in accuracy.parameters])
    variances = np.maximum((0.3 * sizes / 1.96) ** 2 - errors**2, 0.0)
    off = Averaged(np.zeros((2, count)), np.tile(variances, (2, 1)), ("",) * count)
    row = by_name(with_ranges(accuracy, off))["Ndelta"]
    inward, outward = sorted(np.array(row.likely) / row.value - 1.0)
    assert inward == pytest.approx(-0.30, abs=0.003)
    assert outward == pytest.approx(0.35, abs=0.004)
