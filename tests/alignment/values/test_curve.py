import subprocess
import sys

import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator

from trialid.alignment.curve import curve


def samples(seed):
    """Stamps [s], uneven or even, of values of any size, some with plateaus, some monotone."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(2, 60))
    t = np.cumsum(rng.random(n) + 1e-9 if seed % 2 else np.full(n, 0.1)) + 1000 * (seed % 4)
    y = rng.normal(size=n) * 10.0 ** rng.integers(-3, 8)
    kinds = (y, np.round(y, 1), np.cumsum(np.abs(y)), np.full(n, y[0]))
    return t, kinds[seed % 5 % 4]


@pytest.mark.parametrize("seed", range(100))
def test_the_curve_is_that_of_scipy_to_the_last_bit(seed):
    t, y = samples(seed)
    at = np.concatenate([t, np.random.default_rng(seed).uniform(t[0] - 1, t[-1] + 1, 200)])
    assert np.array_equal(curve(t, y)(at), PchipInterpolator(t, y)(at))


@pytest.mark.parametrize(
    ("t", "y"),
    [([0.0, 1.0, 1.0], [0.0, 1.0, 2.0]), ([0.0, 1.0], [0.0, np.nan]), ([0.0, np.inf], [0.0, 1.0])],
)
def test_samples_of_no_curve_are_refused(t, y):
    with pytest.raises(ValueError, match="finite samples"):
        curve(np.array(t), np.array(y))


def test_steps_without_end_have_no_slope():
    with np.errstate(all="ignore"), pytest.raises(ValueError, match="too far apart"):
        curve(np.array([0.0, 1e-300, 2e-300]), np.array([0.0, 1e300, 2e307]))


def test_a_look_into_a_log_does_not_wait_for_scipy():
    looks = "trialid.inspection, trialid.report.terminal.log_contents"
    code = f"import sys, {looks}; print('scipy' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False"
