"""Noise of recorded inputs, a wind's above all, in the errors of what is slow in a track."""

from dataclasses import replace

import numpy as np
import pytest
from current_intervals import CASES, count
from sailed_tracks import accuracy, sailed
from sailed_wind import SETTINGS, WATERS, WINDY, blown, noisy

from trialid.accuracy.coloured import coloured_covariance
from trialid.diagnosis.noise.recorded_inputs import felt_noise
from trialid.identification.fit import identify
from trialid.identification.input_noise import input_noise
from trialid.trial_rows import Stretch
from trialid.white_noise import white_noise_of_most

N = 300
LINE = np.arange(N)[:, None] / N
WHOLE = [Stretch(0, 0, slice(0, N), np.ones(N, dtype=bool))]


def walks(size: float, draws: int, seed: int) -> np.ndarray:
    """White noise of an input in what sums it up; (draws, N)."""
    return size * np.cumsum(np.random.default_rng(seed).standard_normal((draws, N)), axis=1)


def fitted_line(residual: np.ndarray) -> tuple[float, np.ndarray]:
    slope = float(LINE[:, 0] @ residual) / float(LINE[:, 0] @ LINE[:, 0])
    return slope, residual - slope * LINE[:, 0]


def test_a_walk_that_the_residual_hardly_shows() -> None:
    """Slopes of 100 records scatter as said; by the residual alone they would by half as much."""
    slopes, told, before = [], [], []
    for seed in range(100):
        e = np.random.default_rng([1, seed]).standard_normal(N) + walks(0.04, 1, seed)[0]
        slope, left = fitted_line(e)
        with_walk = coloured_covariance(
            LINE, left, WHOLE, felt=lambda n, k=seed: walks(0.04, n, 10_000 + k)
        )
        slopes.append(slope)
        told.append(with_walk.covariance[0, 0] ** 0.5)
        before.append(coloured_covariance(LINE, left, WHOLE).covariance[0, 0] ** 0.5)
    assert np.mean(told) == pytest.approx(np.std(slopes), rel=0.2)
    assert np.mean(before) < 0.7 * np.std(slopes)


def test_noise_that_the_residual_has_no_room_for_was_none() -> None:
    """Gusts ten times what the record leaves: the ship felt them, or there were none."""
    _, left = fitted_line(np.random.default_rng(3).standard_normal(N))
    [[most]] = coloured_covariance(LINE, left, WHOLE, felt=lambda n: walks(10.0, n, 4)).covariance
    [[less]] = coloured_covariance(LINE, left, WHOLE, felt=lambda n: walks(1.0, n, 4)).covariance
    assert most == pytest.approx(less, rel=1e-6)
    [[none]] = coloured_covariance(LINE, left, WHOLE, felt=lambda n: walks(1e-4, n, 4)).covariance
    assert none == coloured_covariance(LINE, left, WHOLE).covariance[0, 0]


def test_what_noise_of_inputs_leaves_is_not_counted_twice() -> None:
    """All of the residual is such noise: the error is what it moved the parameter by, no more."""
    [walk] = walks(1.0, 1, 6)
    slope, left = fitted_line(walk)

    def draw(draws: int) -> np.ndarray:
        return np.where(np.arange(draws) % 2, 1.0, -1.0)[:, None] * walk

    [[variance]] = coloured_covariance(LINE, left, WHOLE, felt=draw).covariance
    assert variance == pytest.approx(slope**2, rel=1e-6)


def test_the_noise_of_an_anemometer_is_read_from_its_record() -> None:
    rng = np.random.default_rng(7)
    fit = identify([noisy(blown(n), rng) for n in WATERS], WINDY, SETTINGS)
    for trial in fit.problem.trials:
        assert input_noise(fit.problem.simulator, trial) == {
            "V_aw": pytest.approx(0.3, rel=0.25),
            "gamma_aw": pytest.approx(np.deg2rad(2.0), rel=0.25),
        }


def test_a_filter_of_the_clock_takes_none_of_what_is_slow() -> None:
    """A mean of three: single samples show a third of the noise that acts on the ship."""
    trial = blown("circle")
    white = np.random.default_rng(1).standard_normal(40 * trial.samples)
    smooth = np.convolve(white, np.full(3, 1.0 / 3.0), "same")
    quick = replace(trial, period=0.5, signals={**trial.signals, "V_aw": 12.0 + smooth}, valid={})
    fit = identify([noisy(trial, np.random.default_rng(2))], WINDY, SETTINGS)
    assert white_noise_of_most(smooth) < 0.4
    assert input_noise(fit.problem.simulator, quick)["V_aw"] == pytest.approx(1.0, abs=0.1)


def test_a_rudder_that_is_held_or_put_over_has_no_noise() -> None:
    fit = identify(
        [noisy(blown(n), np.random.default_rng(5), air=0.0) for n in WATERS], WINDY, SETTINGS
    )
    assert "delta" not in input_noise(fit.problem.simulator, sailed("zigzag", (0.0, 0.0)))


def test_only_the_noise_of_inputs_widens() -> None:
    """The same record, once with a wind that is exact: nothing is drawn, nothing wider."""
    logs = [noisy(blown(n), np.random.default_rng(9), air=0.0) for n in WATERS]
    exact = identify(logs, WINDY, SETTINGS)
    rough = identify([noisy(t, np.random.default_rng(9), 0.0) for t in logs], WINDY, SETTINGS)
    one, other = ({p.name: p for p in accuracy(fit).parameters} for fit in (exact, rough))
    name = "V_ce [circle]"
    assert other[name].standard_error > 1.3 * one[name].standard_error
    assert felt_noise(rough) is not None


@pytest.mark.study(turn=10)
def test_currents_in_wind_lie_within_their_intervals() -> None:
    [case] = [c for c in CASES if c.name == "wind by anemometer"]
    inside, _ = count(case, range(8000, 8090))
    print(f"current in wind within 95 %: {np.mean(inside):.3f} of {len(inside)}")
    assert 0.93 <= np.mean(inside) <= 0.97
