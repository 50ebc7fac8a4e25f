"""A resonance amid a roll that nothing in the model makes tells neither GM nor her damping."""

from dataclasses import replace

import numpy as np
import pytest
import s175q

from trialid.identification.fit import Fit, identify
from trialid.identification.remarks import remarks
from trialid.identification.roll.own_roll import is_a_ships, is_rolled_by_others

FREE = ("Nv", "Nr", "Ndelta", "Kv", "Kr", "Kdelta", "Kp", "GM")
SETTINGS = replace(s175q.SETTINGS, free=FREE)
GM = s175q.MODEL.value("GM")
PERIOD = 13.0  # s; she rolls in 33 s


def in_swell(size: float, seed: int) -> Fit:
    """Two zig-zags amid a roll of this size [deg] that is of a swell of many components."""
    trials = []
    for i, angle in enumerate((10, 20)):
        calm, rng = s175q.zigzag(angle), np.random.default_rng([seed, i])
        time, components = np.arange(calm.samples) * calm.period, 25
        omega = 2.0 * np.pi / PERIOD * (1.0 + 0.1 * rng.standard_normal(components))
        heights = rng.rayleigh(1.0, components) / np.sqrt(components)
        waves = np.cos(np.outer(time, omega) + 2.0 * np.pi * rng.random(components)) @ heights
        r, phi = s175q.white(rng, calm.samples)
        trials.append(s175q.with_noise(calm, r, phi + np.deg2rad(size) * waves))
    return identify(trials, s175q.MODEL, SETTINGS)


def is_wrong(fit: Fit) -> bool:
    """By more than a factor of 1.5."""
    return bool(abs(np.log(fit.value("GM") / GM)) > np.log(1.5))


def told_as_unknown(fit: Fit) -> bool:
    """Whether a page says so, with values that ships have to either side."""
    said = any("the record does not tell GM" in line for line in remarks(fit))
    found = [values["GM"] for values in fit.rivals]
    return said and min(found) < GM < max(found)


def test_a_swells_period_is_not_told_as_her_gm() -> None:
    """Damped by 0.03 of what is critical as any ship's, five times her GM stood without a word."""
    fit = in_swell(5.0, 83)
    assert is_wrong(fit)
    assert is_a_ships(fit.problem, fit.theta)
    assert told_as_unknown(fit)
    assert any("most is of nothing that the model has" in line for line in remarks(fit))
    damped = [values["Kp"] for values in fit.rivals]
    assert min(damped) < s175q.MODEL.value("Kp") < max(damped) < 0.0


def test_beside_a_smaller_swell_her_own_roll_is_told() -> None:
    fit = in_swell(1.0, 84)
    assert fit.value("GM") == pytest.approx(GM, rel=0.01)
    assert not is_rolled_by_others(fit.problem, fit.theta)
    assert fit.rivals == ()


@pytest.mark.study(turn=21)
def test_whatever_the_swell_no_wrong_gm_is_told() -> None:
    """Most end at the swell's period; of 18 others 15 did, 13 of them without a word of it."""
    fits = [in_swell(size, seed) for size in (3.0, 5.0, 8.0) for seed in range(90, 96)]
    wrong = [fit for fit in fits if is_wrong(fit)]
    assert len(wrong) >= 6
    assert all(told_as_unknown(fit) for fit in wrong)
    hers = [fit for fit in fits if not is_wrong(fit)]
    assert not any(is_rolled_by_others(fit.problem, fit.theta) for fit in hers)
