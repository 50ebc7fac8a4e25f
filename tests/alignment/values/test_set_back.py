"""A clock that was set back is set back for every column, whatever values come again by chance."""

import numpy as np
import pytest

from trialid.alignment.clocks import Series
from trialid.alignment.stamps.dejitter import repair_stamps
from trialid.names.quantities import SIGNALS

PERIOD = 2.0


def logged(seed: int, back: float, step: float) -> Series:
    """700 samples, each a whole number of steps, of a clock that is set back after 400 s."""
    rng = np.random.default_rng(seed)
    t = PERIOD * np.arange(700)
    y = step * np.rint((np.sin(0.02 * t) + 0.3 * rng.standard_normal(len(t))) / step)
    stamps = np.where(t < 400.0, t, t - back)
    return Series(SIGNALS["phi"], np.rint(1e9 * stamps).astype(np.int64), y, "made")


@pytest.mark.parametrize("step", [1e-6, 0.2, 0.5])
@pytest.mark.parametrize("back", [30.0, 100.0, 250.0])
def test_it_runs_on_for_every_resolution(step: float, back: float) -> None:
    for seed in range(8):
        made, words = repair_stamps(logged(seed, back, step))
        assert np.allclose(np.diff(made.t), 1e9 * PERIOD)
        assert f"the clock went back {back:.4g} s" in words[0]
