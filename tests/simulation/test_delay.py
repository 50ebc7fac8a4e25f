"""A delayed signal: exact for cubics, smooth in the delay, true to a finer simulation."""

from collections.abc import Callable

import numpy as np
import pytest

from trialid.ship.model import ShipModel
from trialid.simulation.delay import REACH, delay_samples, margin
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial

LAGS = (0.0, 0.2, 0.5, 0.999, 1.0, 2.4, 3.0, -0.3, -1.0, -2.7)


def inner(lag: float, samples: int) -> slice:
    spoilt = int(np.ceil(abs(lag))) + REACH
    return slice(spoilt, samples - spoilt)


@pytest.mark.parametrize("lag", LAGS)
@pytest.mark.parametrize("power", [0, 1, 2, 3])
def test_cubics_are_exact_and_so_is_their_slope(power: int, lag: float) -> None:
    k = np.arange(40.0)
    y, rate = delay_samples(((k - 20.0) / 10.0) ** power, lag)
    at = (k - lag - 20.0) / 10.0
    here = inner(lag, 40)
    np.testing.assert_allclose(y[here], (at**power)[here], atol=1e-13)
    slope = -power * at ** max(power - 1, 0) / 10.0
    np.testing.assert_allclose(rate[here], slope[here], atol=1e-13)


def test_no_delay_is_the_signal_itself() -> None:
    y = np.random.default_rng(3).standard_normal(50)
    np.testing.assert_array_equal(delay_samples(y, 0.0)[0], y)


@pytest.mark.parametrize("lag", [-4.0, 2.0, 7.0])
def test_whole_samples_only_shift(lag: float) -> None:
    y = np.random.default_rng(4).standard_normal(60)
    here = inner(lag, 60)
    np.testing.assert_allclose(
        delay_samples(y, lag)[0][here], np.roll(y, int(lag))[here], rtol=0, atol=1e-15
    )


@pytest.mark.parametrize("lag", [-1.0, 0.0, 1.0, 2.0])
def test_value_and_slope_do_not_jump_at_a_sample(lag: float) -> None:
    """On noise, where nothing but the formula makes it smooth."""
    y, step = np.random.default_rng(5).standard_normal(60), 1e-9
    (a, da), (b, db) = delay_samples(y, lag - step), delay_samples(y, lag + step)
    np.testing.assert_allclose(a, b, atol=1e-7)
    np.testing.assert_allclose(da, db, atol=1e-6)


@pytest.mark.parametrize("lag", [0.31, 0.5, 1.73, -0.4, -2.25, 58.5, 1000.2, -1000.2])
def test_derivative_by_the_lag_is_that_of_the_formula(lag: float) -> None:
    """Against central differences on noise, at the ends too, and with more columns."""
    y, step = np.random.default_rng(6).standard_normal((60, 3)), 1e-5
    difference = (delay_samples(y, lag + step)[0] - delay_samples(y, lag - step)[0]) / (2.0 * step)
    np.testing.assert_allclose(delay_samples(y, lag)[1], difference, atol=1e-8)


def test_the_margin_covers_what_the_ends_spoil() -> None:
    y = np.random.default_rng(7).standard_normal(80)
    longer = np.concatenate([np.full(20, 9.0), y, np.full(20, -9.0)])
    for lag in (-2.6, -2.0, -0.5, 0.5, 2.0, 2.6):
        spoilt = margin(-1.3, 1.3, 0.5)
        inside = slice(spoilt, 80 - spoilt)
        np.testing.assert_array_equal(
            delay_samples(y, lag)[0][inside], delay_samples(longer, lag)[0][20:100][inside]
        )


def test_a_delayed_output_is_the_output_earlier(
    everything: ShipModel, lively: Callable[..., Trial]
) -> None:
    """Against a simulation 16 times finer, read at t - tau; and its slope by tau is -dr/dt."""
    fine_steps, samples, period = 16, 400, 0.5
    coarse = lively(samples, period)
    fine_t = np.arange((samples - 1) * fine_steps + 1) * period / fine_steps
    signals = {n: np.interp(fine_t, coarse.t, y) for n, y in coarse.signals.items()}
    fine = Trial("fine", "fit", period / fine_steps, signals, {})
    ahead = 11
    tau = ahead * period / fine_steps
    late = everything.with_values({"tau_r": tau})
    none = everything.with_values({"tau_r": 0.0})
    simulator = prepare(late, ("tau_r",), ("r",), substeps=4)
    answer = respond(simulator, coarse, {"tau_r": tau}, {})
    exact = respond(prepare(none, (), ("r",)), fine, {}, {}, sensitivities=False).y[:, 0]
    inside = slice(8, samples - 8)
    when = np.arange(samples)[inside] * fine_steps - ahead
    size = np.ptp(exact)
    plain = respond(prepare(none, (), ("r",), substeps=4), coarse, {}, {}, False).y[:, 0]
    assert np.abs(plain[inside] - exact[when]).max() > 3e-3 * size
    np.testing.assert_allclose(answer.y[inside, 0], exact[when], atol=2e-5 * size)
    rate = (exact[when + 1] - exact[when - 1]) / (2.0 * period / fine_steps)
    column = answer.S[inside, 0, simulator.columns.index("tau_r")]
    np.testing.assert_allclose(column, -rate, atol=2e-3 * np.abs(rate).max())
