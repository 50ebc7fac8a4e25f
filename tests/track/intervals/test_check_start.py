"""What a trial to check finds for itself, its start and its current: how sure that is."""

from dataclasses import replace

import numpy as np
import pytest
import sailed_wind
from sailed_tracks import CURRENTS, EXACT, SETTINGS, SHIP, accuracy, noisy, sailed, spread
from sailed_wind import WINDY, blown
from turning_numbers import RECEIVERS, fitted, truth_of

from trialid.design.imo.trial_measures import measure_trials
from trialid.effects.track import CURRENT
from trialid.identification.check.own_start import OwnRows, priors_of
from trialid.identification.fit import Fit, identify
from trialid.identification.output_error import compared_mask
from trialid.identification.trial_score import of_trial, own_start_error
from trialid.least_squares.gauss_newton import minimise
from trialid.threads import one_thread

BY_NOISE = replace(SETTINGS, weights={"x": 12.0, "y": 12.0, "psi": 12.0})
KNOWN = replace(SHIP, ship=replace(SHIP.ship, uncertainty=EXACT))


def logged(seed: int) -> Fit:
    """A zig-zag fitted, and a circle to check."""
    rng = np.random.default_rng([16, seed])
    zigzag, circle = (
        noisy(sailed(n, CURRENTS[n], use), rng)
        for n, use in (("zigzag", "fit"), ("circle", "check"))
    )
    return identify([zigzag, circle], KNOWN, BY_NOISE)


def found(fit: Fit, theta: np.ndarray) -> dict[str, float]:
    """All that the circle has for itself."""
    values, start = of_trial(replace(fit, theta=theta), fit.scores[1].trial)
    return values | {f"{n}(0)": x for n, x in start.items()}


@pytest.fixture(scope="module")
def fit() -> Fit:
    return logged(0)


def test_it_moves_with_the_parameters_as_is_said(fit: Fit) -> None:
    known = own_start_error(fit, fit.scores[1].trial)
    assert known is not None
    assert {"u(0)", *CURRENT} <= {*known.names}
    for i, name in enumerate(known.shared):
        step = np.zeros(len(fit.theta))
        step[i] = 0.01 * fit.theta[i]
        up, down = (found(fit, fit.theta + side * step) for side in (1.0, -1.0))
        for n in ("u(0)", *CURRENT):
            moved = (up[n] - down[n]) / (2.0 * step[i])
            told = known.by[known.names.index(n), i]
            assert told == pytest.approx(moved, rel=0.05, abs=2e-4 / abs(fit.theta[i])), (name, n)


def test_noise_leaves_it_as_open_as_is_said(fit: Fit) -> None:
    """The same ship, another day's noise: 40 circles, whose scatter is known to 11 %."""
    known = own_start_error(fit, fit.scores[1].trial)
    assert known is not None
    errors = dict(zip(known.names, np.linalg.norm(known.noise, axis=1), strict=True))
    rng, each = np.random.default_rng(7), []
    for _ in range(40):
        trial = noisy(sailed("circle", CURRENTS["circle"], "check"), rng)
        values, start = of_trial(fit, trial)
        each.append([start["u"], *(values[n] for n in CURRENT)])
    scatter = np.std(each, axis=0)
    np.testing.assert_allclose([errors[n] for n in ("u(0)", *CURRENT)], scatter, rtol=0.35)


def test_it_is_found_however_exact_positions_are() -> None:
    """Of 2 cm: where it ends is where a search from there ends, within a tenth of its error."""
    fit = fitted(6106, RECEIVERS["RTK"], held=True)
    [circle] = [s.trial for s in fit.scores if s.trial.use == "check"]
    values, start = of_trial(fit, circle)
    ended = values | {f"{n}(0)": x for n, x in start.items()}
    known = own_start_error(fit, circle)
    assert known is not None
    compared = compared_mask(circle, fit.problem.simulator)
    priors = priors_of(fit.problem, circle, known.names)
    rows = OwnRows(fit.problem, circle, compared, values, priors, fit.level)
    at = np.array([ended[n] for n in known.names])
    further = minimise(
        rows, at, np.linalg.norm(known.noise, axis=1), max_iterations=50, tolerance=1e-9
    )
    assert np.all(np.abs(further.theta - at) < 0.1 * np.linalg.norm(known.noise, axis=1))


def test_a_fitted_trial_has_its_errors_from_the_fit(fit: Fit) -> None:
    assert own_start_error(fit, fit.scores[0].trial) is None


def test_noise_of_an_anemometer_is_in_it() -> None:
    """Half of what its noise moves a current by comes through the wind that drives the ship."""
    rng = np.random.default_rng([9, 1])
    zigzag, circle = (sailed_wind.noisy(blown(n), rng, air=3.0) for n in ("zigzag", "circle"))
    logs = [replace(zigzag, use="check"), circle]
    fit = identify(logs, WINDY, sailed_wind.SETTINGS)
    known = own_start_error(fit, fit.scores[0].trial)
    assert known is not None
    each = []
    for _ in range(40):
        trial = replace(sailed_wind.noisy(blown("zigzag"), rng, air=3.0), use="check")
        values, _ = of_trial(fit, trial)
        each.append([values[n] for n in CURRENT])
    errors = np.linalg.norm(known.noise, axis=1)[[known.names.index(n) for n in CURRENT]]
    white = np.linalg.norm(known.noise[:, : len(known.names)], axis=1)
    np.testing.assert_allclose(errors, np.std(each, axis=0), rtol=0.35)
    assert np.all(white[[known.names.index(n) for n in CURRENT]] < 0.6 * errors)


@pytest.mark.study(turn=9)
@one_thread
def test_numbers_of_a_circle_to_check_hold_the_truth() -> None:
    """The model's and those less its current; before, 70 % of the model's advances did."""
    still, model, less = truth_of((0.0, 0.0)), [], []
    for seed in range(40):
        one = logged(seed)
        errors = {p.name: p.standard_error for p in accuracy(one).parameters}
        for m in measure_trials(one, errors, spread(one, {})).turns:
            low, high = m.predicted_interval or (np.nan, np.nan)
            model.append(low < still[m.name] < high)
            low, high = m.corrected_interval or (np.nan, np.nan)
            less.append(low < still[m.name] < high)
    print(f"circle to check within 95 %: model {np.mean(model):.3f}, record {np.mean(less):.3f}")
    assert np.mean(model) >= 0.9
    assert np.mean(less) >= 0.9
