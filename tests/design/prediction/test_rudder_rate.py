from dataclasses import replace

import numpy as np
import pytest
from s175q import MODEL, SETTINGS, zigzag

from trialid.design.following import vessel_of
from trialid.design.rudder_rate import GEAR, gear_rate, rudder_rate
from trialid.design.rudders import ramp
from trialid.identification.fit import identify
from trialid.trial import Trial

D = float(np.deg2rad(1.0))
PERIOD = 0.5


def steered(rate, angle=20.0, period=PERIOD):
    """Twenty minutes of a rudder that is ordered over each minute, and goes so fast [deg/s]."""
    t = np.arange(0.0, 1200.0, period)
    orders = angle * D * np.sign(np.sin(np.pi * t / 60.0 + 0.01))
    return Trial("zz", "fit", period, {"delta": ramp(orders, rate * D * period)}, {})


def test_a_rudder_is_clocked_over_its_moves_not_from_sample_to_sample():
    """Its feedback noisy, logged fast, with a wild value; one that is moved slowly has no gear."""
    rng = np.random.default_rng(4)
    orders = 10 * D * np.sign(np.sin(0.05 * np.arange(12000) * 0.1))
    delta = ramp(orders, 2.5 * D * 0.1)
    assert rudder_rate(delta, 0.1) == pytest.approx(2.5 * D)
    noisy = delta + 0.05 * D * rng.standard_normal(len(delta))
    noisy[777] += 25 * D
    by_samples = np.quantile(np.abs(np.diff(noisy)), 0.99) / 0.1
    assert by_samples > 1.4 * 2.5 * D
    assert rudder_rate(noisy, 0.1) == pytest.approx(2.5 * D, rel=0.07)
    assert rudder_rate(np.zeros(50), 0.1) == 0.0


@pytest.mark.parametrize("rate", [0.8, 1.6, 2.4, 5.0])
def test_a_gear_goes_as_fast_as_it_went(rate):
    """A rudder that was ordered over, went slowly and was held there has a slow gear."""
    assert gear_rate([steered(rate)]) == pytest.approx(rate * D, rel=0.01)
    assert gear_rate([steered(rate, angle=10.0), steered(rate)]) == pytest.approx(
        rate * D, rel=0.01
    )


@pytest.mark.parametrize(("rate", "period"), [(2.3, 0.2), (2.7, 1.0), (2.7, 0.5)])
def test_noise_makes_no_gear_quicker(rate, period):
    """By its quickest part one of 2.7 deg/s in 0.2 deg of noise went 2.84, and overshoots less."""
    trial = steered(rate, period=period)
    rng = np.random.default_rng(5)
    noisy = trial.signals["delta"] + 0.2 * D * rng.standard_normal(trial.samples)
    assert rudder_rate(noisy, period) == pytest.approx(rate * D, rel=0.02)


@pytest.mark.parametrize("seed", range(4))
def test_moves_of_few_samples_are_clocked_between_their_ends(seed):
    """By its quickest part 8 deg/s at 0.5 s were 7.66 to 8.33, and each overshoot off with it."""
    rng = np.random.default_rng(seed)
    fine = steered(8.0, angle=15.0, period=0.05)
    t = 0.05 * np.arange(fine.samples)
    noisy = fine.signals["delta"] + 0.05 * D * rng.standard_normal(fine.samples)
    seen = np.interp(np.arange(rng.uniform(0.0, PERIOD), t[-1], PERIOD), t, noisy)
    assert rudder_rate(seen, PERIOD) == pytest.approx(8.0 * D, rel=0.01)


def test_a_long_way_is_believed_before_a_short_one_that_is_not_unlike():
    rng = np.random.default_rng(6)
    long, short = steered(2.7, period=1.0), steered(2.7, angle=6.0, period=1.0)
    noisy = short.signals["delta"] + 0.15 * D * rng.standard_normal(short.samples)
    short = Trial("short", "fit", 1.0, {"delta": noisy}, {})
    assert gear_rate([short]) > 2.78 * D
    assert gear_rate([long, short]) == pytest.approx(2.7 * D, rel=0.01)
    quicker = steered(3.6, angle=9.0, period=1.0)  # with both pumps
    assert gear_rate([long, quicker]) == pytest.approx(3.6 * D, rel=0.02)


def test_a_rudder_worked_little_by_little_shows_no_gear():
    t = np.arange(0.0, 1200.0, PERIOD)
    waved = Trial("wave", "fit", PERIOD, {"delta": 10.0 * D * np.sin(0.05 * t)}, {})
    assert rudder_rate(waved.signals["delta"], PERIOD) < 0.6 * D
    assert gear_rate([waved]) == GEAR
    assert gear_rate([waved, steered(1.6)]) == pytest.approx(1.6 * D, rel=0.01)
    assert gear_rate([]) == GEAR


def test_a_rudder_that_is_over_from_one_sample_to_the_next_shows_no_gear():
    """A log each 20 s of a 5/5 zig-zag would have her gear go 0.5 deg/s at most."""
    rare = steered(2.5, angle=5.0, period=20.0)
    assert rudder_rate(rare.signals["delta"], 20.0) < 0.6 * D
    assert gear_rate([rare]) == GEAR


def test_an_order_beside_the_rudder_is_no_rate_of_its_gear() -> None:
    """It jumps from angle to angle: her rudder would go over at once in every prediction."""
    trial = zigzag(10)
    order = np.deg2rad(10.0) * np.sign(trial.signals["delta"])
    both = replace(trial, signals={**trial.signals, "delta_order": order})
    rates = [vessel_of(identify([one], MODEL, SETTINGS)).rudder_rate for one in (trial, both)]
    assert rates[0] == rates[1] < np.deg2rad(10.0)
