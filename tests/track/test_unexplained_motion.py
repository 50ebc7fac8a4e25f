"""What fitted trials did beyond the model: what it adds to a manoeuvre, how much of it there is."""

from dataclasses import replace

import numpy as np
import pytest
from sailed_tracks import CURRENTS, NOISE, SETTINGS, SHIP, noisy, sailed
from scipy.stats import t as student

from trialid.design.prediction.unexplained_motion import UnexplainedMotion, unexplained_motion
from trialid.identification.fit import Fit, identify
from trialid.trial import Trial

SPEED, SECONDS = 7.0, 200
BY_NOISE = replace(SETTINGS, weights={"x": 12.0, "y": 12.0, "psi": 12.0})
T = np.arange(SECONDS + 1.0)
STRAIGHT = {"psi": np.zeros(len(T)), "x": SPEED * T, "y": np.zeros(len(T))}
ORDER = 50
WIDER = float(student.ppf(0.975, 4.0)) / 1.96
"""Of four trials."""


def read(track):
    return {"ahead": track["x"][-1], "aside": track["y"][-1], "turned": track["psi"][-1]}


def always(*rates: float) -> UnexplainedMotion:
    return UnexplainedMotion(np.tile(rates, (30, 1)), np.zeros((30, 3)), 1.0, 4)


def test_a_speed_that_is_always_there_adds_its_way_from_the_order_on() -> None:
    since = SECONDS - ORDER
    found = always(0.0, 0.1, -0.2).errors(read, STRAIGHT, ORDER)
    assert found["ahead"] == pytest.approx(WIDER * 0.1 * since, rel=1e-3)
    assert found["aside"] == pytest.approx(WIDER * 0.2 * since, rel=1e-3)
    assert found["turned"] == 0.0


def test_a_rate_of_turn_leads_her_off_her_course_along_an_arc() -> None:
    rate, since = 1e-4, SECONDS - ORDER
    found = always(rate, 0.0, 0.0).errors(read, STRAIGHT, ORDER)
    assert found["turned"] == pytest.approx(WIDER * rate * since)
    assert found["aside"] == pytest.approx(WIDER * 0.5 * SPEED * rate * since**2, rel=0.02)


def blown(trial: Trial, rng: np.random.Generator, size: float) -> Trial:
    """A heading that wanders by gusts as well, as a random walk of this size [rad s^-0.5]."""
    walk = np.cumsum(size * np.sqrt(trial.period) * rng.standard_normal(trial.samples))
    return replace(trial, signals={**trial.signals, "psi": trial.signals["psi"] + walk})


@pytest.fixture(scope="module")
def fits() -> dict[float, Fit]:
    found = {}
    for size in (0.0, 3e-3):
        rng = np.random.default_rng(8)
        logs = [blown(noisy(sailed(n, w), rng), rng, size) for n, w in CURRENTS.items()]
        found[size] = identify(logs, SHIP, BY_NOISE)
    return found


def test_noise_of_sensors_is_no_motion_and_gusts_are(fits: dict[float, Fit]) -> None:
    """After 100 s a random walk of 3e-3 is 0.03 rad off; white noise is as far as on the first."""
    samples = 12
    straight = {n: x[: 50 + 1] for n, x in STRAIGHT.items()}
    off = {}
    for size, fit in fits.items():
        known = unexplained_motion(fit, samples)
        assert known is not None
        assert (known.period, known.trials) == (2.0, 2)
        off[size] = known.errors(read, straight, 0)["turned"] / (student.ppf(0.975, 2.0) / 1.96)
    assert off[0.0] < 0.2 * NOISE["psi"]  # 0.5 with what a mean over a length leaves of it
    assert off[3e-3] == pytest.approx(0.03, rel=0.5)


def test_a_fit_of_roll_alone_tells_of_no_track() -> None:
    settings = replace(SETTINGS, outputs=("x", "y"), nuisance=())
    fit = identify([noisy(sailed("circle", (0.0, 0.0)), np.random.default_rng(1))], SHIP, settings)
    assert unexplained_motion(fit, 12) is None
