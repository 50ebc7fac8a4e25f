"""A speed far from that of her file in all trials is asked about: knots that are called m/s."""

from dataclasses import replace

import numpy as np
import pytest
import s175q

from trialid.identification.approach import approach_speed
from trialid.identification.fit import identify
from trialid.identification.remarks import remarks


@pytest.mark.parametrize(
    ("speeds", "said"),
    [
        ((14.25, 14.25), "she sails at 14.2 m/s, 1.94 times the U0 of her file"),
        ((3.77, 3.77), "she sails at 3.77 m/s, 0.514 times the U0 of her file"),
        ((7.33, 14.25), ""),
        ((8.5, 8.5), ""),
    ],
)
def test_a_speed_that_is_far_from_her_files(speeds, said) -> None:
    fit = identify([s175q.zigzag(5), s175q.zigzag(10)], s175q.MODEL, s175q.SETTINGS)
    made = []
    for score, speed in zip(fit.scores, speeds, strict=True):
        signals = {**score.trial.signals, "u": np.full(score.trial.samples, speed)}
        made.append(replace(score, trial=replace(score.trial, signals=signals)))
    told = [one for one in remarks(replace(fit, scores=tuple(made))) if "U0 of her file" in one]
    assert len(told) == bool(said)
    assert all(one.startswith(said) for one in told)


def test_her_approach_is_before_turns_cost_speed() -> None:
    """And not what she lies still with; below zero where she goes astern."""
    trial = s175q.zigzag(5)
    u = np.where(np.arange(trial.samples) < 0.3 * trial.samples, 7.33, 0.05)
    for sign in (1.0, -1.0):
        sailed = replace(trial, signals={**trial.signals, "u": sign * u})
        speed = approach_speed(sailed)
        assert speed == pytest.approx(7.33 if sign > 0.0 else -0.05)
    assert approach_speed(trial) is None
