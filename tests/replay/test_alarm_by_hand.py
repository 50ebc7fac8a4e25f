"""Alarms where everything about them is known: how rare, to which side, of what noise."""

from types import SimpleNamespace

import numpy as np
import pytest

from trialid.diagnosis.noise.error_parts import Split
from trialid.replay.alarm import Band, Monitor, bands

WHITE = Band("r", 1.0, np.array([1.0]))


@pytest.mark.parametrize("outputs", [1, 2])
def test_unless_said_one_alarm_a_day_is_expected_of_noise(outputs):
    """Siegmund's formula for a sum that lets half a deviation pass, over outputs and both sides."""
    b = Monitor((WHITE,) * outputs, 0.5, 10).threshold + 1.166
    samples = (np.exp(b) - b - 1.0) / 0.5
    assert samples * 0.5 / (2 * outputs) == pytest.approx(24 * 3600.0, rel=1e-6)


@pytest.mark.parametrize(("shift", "side"), [(2.0, 1), (-2.0, -1)])
def test_more_than_predicted_is_above_and_less_below(shift, side):
    """Without noise the sum grows by one and a half at each sample."""
    residual = np.where(np.arange(60) >= 20, shift, 0.0)[:, None]
    monitor = Monitor((WHITE,), 0.5, 60)
    monitor.advance(residual, np.ones((60, 1), dtype=bool), 60)
    [alarm] = monitor.alarms
    assert (alarm.output, alarm.side, alarm.since) == ("r", side, 10.0)
    steps = int(np.floor(monitor.threshold / 1.5)) + 1
    assert alarm.raised == pytest.approx(10.0 + 0.5 * (steps - 1))


def test_the_filter_takes_what_was_before_from_what_is_now():
    """A wild value that half stays the next time is one drive, and no second one."""
    band = Band("r", 1.0, np.array([1.0, -0.5]))
    residual = np.array([0.0, 0.0, 3.0, 1.5, 0.75, 0.375])[:, None]
    monitor = Monitor((band,), 0.5, 6)
    monitor.advance(residual, np.ones((6, 1), dtype=bool), 6)
    expected = np.array([0.0, 0.0, 2.5, 2.0, 1.5, 1.0]) / monitor.threshold
    assert monitor.score[:, 0] == pytest.approx(expected)


def test_a_band_is_of_the_noise_alone_in_the_outputs_unit():
    mask = np.ones((50, 1), dtype=bool)
    problem = SimpleNamespace(
        outputs=("r",), y_rms=np.array([0.01]), compared=(mask,), weights=np.ones(1)
    )
    fit = SimpleNamespace(problem=problem, residual=np.zeros(50), eps_by_output={"r": 0.3})
    split = Split("quiet stretch", "", noise=0.1, undermodelling=0.28, by_output={"r": (0.1, 0.28)})
    augmented = SimpleNamespace(
        fit=fit, traces=(1,), stretches=(), evidence=SimpleNamespace(colour=[np.array([1.0, -0.5])])
    )
    found = bands(fit, split, augmented)
    assert found.of[0].sigma == pytest.approx(0.001)
    assert found.separated
    whitening = np.array([1.0, -0.5]) / (0.01 * np.sqrt(50.0))
    assert found.of[0].whitening == pytest.approx(whitening)
