"""Known truth comes back: from wrong starts, and within the stated errors in the stated share."""

from dataclasses import replace

import numpy as np
import pytest
from s175q import GYRO, MODEL, SETTINGS, TEN, waves, white, with_noise, zigzag

from trialid.accuracy.coloured import white_covariance
from trialid.accuracy.equations import minimum_sensitivity, relative_error, relative_sensitivities
from trialid.accuracy.parameter_table import Subject, assess
from trialid.identification.fit import identify
from trialid.identification.output_error import stretches
from trialid.threads import one_thread

TRUTH = np.array([MODEL.value(n) for n in TEN])
REPEATS = 300
CLEAN = [zigzag(10), zigzag(20)]


def noisy(kind, seed):
    rng = np.random.default_rng(seed)
    return [with_noise(t, *kind(rng, t.samples)) for t in CLEAN]


def accuracy(fit):
    subjects = [
        Subject(x.name, x.kind, x.unit, v, v if x.kind == "physical" else x.size)
        for x, v in zip(fit.problem.unknowns, fit.theta, strict=True)
    ]
    return assess(subjects, fit.psi, fit.residual, stretches(fit.problem), fit.eps_rmsn, 0.0)


def test_without_noise_the_truth_comes_back_to_rounding():
    start = dict(zip(TEN, TRUTH * np.linspace(0.75, 1.25, 10), strict=True))
    as_simulated = replace(SETTINGS, most_substeps=1)  # finer steps would be another truth
    fit = identify(CLEAN, MODEL.with_values(start), as_simulated)
    assert fit.converged
    np.testing.assert_allclose(fit.theta[:10], TRUTH, rtol=1e-3)
    assert fit.eps_rmsn < 1e-6


@pytest.mark.study(turn=6)
def test_at_least_95_of_100_starts_reach_the_same_optimum():
    rng = np.random.default_rng(20)
    trials = noisy(white, 1)
    best, ends = np.inf, []
    for _ in range(100):
        start = dict(zip(TEN, TRUTH * (1.0 + 0.3 * rng.uniform(-1.0, 1.0, 10)), strict=True))
        fit = identify(trials, MODEL.with_values(start), SETTINGS)
        ends.append((fit.V, fit.theta[:10]))
        best = min(best, fit.V)
    reached = [theta for V, theta in ends if best * (1.0 + 1e-6) > V]
    print(f"{len(reached)} of 100 starts reach V = {best:.8g}")
    assert len(reached) >= 95
    spread = np.std(reached, axis=0) / np.abs(TRUTH)
    assert spread.max() < 0.01


@one_thread
def coverage(kind):
    """Share of repeats in which the 95 % interval holds the truth; coloured and white formula."""
    coloured, plain = [], []
    for seed in range(REPEATS):
        fit = identify(noisy(kind, seed), MODEL, SETTINGS)
        rows = accuracy(fit).physical
        off = np.abs(fit.theta[:10] - TRUTH)
        coloured.append(off < 1.96 * np.array([p.standard_error for p in rows]))
        plain.append(off < 1.96 * np.array([p.white_error for p in rows]))
    return np.mean(coloured, axis=0), np.mean(plain, axis=0)


@pytest.mark.study(turn=2)
def test_intervals_cover_with_white_noise():
    coloured, plain = coverage(white)
    print("white noise: coverage", dict(zip(TEN, coloured.round(3), strict=True)))
    assert 0.92 <= coloured.mean() <= 0.98
    assert np.all((coloured >= 0.92) & (coloured <= 0.98))
    assert 0.92 <= plain.mean() <= 0.98


@pytest.mark.study(turn=3)
def test_intervals_cover_with_wave_coloured_noise():
    coloured, plain = coverage(waves)
    print("wave noise: coverage with N_eff", dict(zip(TEN, coloured.round(3), strict=True)))
    print("            by the white formula", dict(zip(TEN, plain.round(3), strict=True)))
    assert np.all((coloured >= 0.90) & (coloured <= 0.98))
    assert coloured.mean() > plain.mean()


def test_first_term_of_eq_14_is_the_white_noise_covariance():
    """Theory's oracle: for white noise of equal normed size both are the same number."""
    fit = identify(noisy(white, 3), MODEL, SETTINGS)
    reference = np.array([*fit.theta[:10], *[x.size for x in fit.problem.unknowns[10:]]])
    A = relative_sensitivities(fit.psi, reference)
    rows, columns = A.shape
    eps = np.sqrt(np.sum(fit.residual**2) * rows / (rows - columns))
    first, _ = relative_error(eps, 0.0, minimum_sensitivity(A), rows)
    white_errors = np.sqrt(np.diag(white_covariance(A, fit.residual)))
    np.testing.assert_allclose(first, white_errors, rtol=1e-8)


def test_a_prior_pulls_by_its_weight_against_the_data():
    """One parameter, hardly visible: the estimate is the precision-weighted mean."""
    from dataclasses import replace

    free = identify(noisy(white, 5), MODEL, SETTINGS)
    i = TEN.index("Nvav")
    variance = accuracy(free).parameters[i].white_error ** 2
    deviation = 0.0002
    prior = replace(SETTINGS, priors={"Nvav": (-0.001, deviation)})
    held = identify(noisy(white, 5), MODEL, prior)
    weight = (1 / variance) / (1 / variance + 1 / deviation**2)
    expected = weight * free.theta[i] + (1 - weight) * -0.001
    assert held.theta[i] == pytest.approx(expected, abs=0.1 * deviation)


def test_huber_loss_shrugs_off_outliers():
    from dataclasses import replace

    trials = noisy(white, 7)
    rng = np.random.default_rng(8)
    hit = rng.random(trials[0].samples) < 0.02
    struck = [with_noise(t, hit * 40.0 * GYRO, 0.0 * hit) for t in trials]
    clean, plain = identify(trials, MODEL, SETTINGS), identify(struck, MODEL, SETTINGS)
    robust = identify(struck, MODEL, replace(SETTINGS, loss="huber"))
    errors = np.array([p.standard_error for p in accuracy(clean).physical])
    off_plain = np.abs(plain.theta[:10] - clean.theta[:10]) / errors
    off_robust = np.abs(robust.theta[:10] - clean.theta[:10]) / errors
    assert off_robust.max() < 0.5 * off_plain.max()


@pytest.mark.study
def test_two_runs_and_both_engines_agree():
    from dataclasses import replace

    trials = noisy(white, 9)
    one, two = identify(trials, MODEL, SETTINGS), identify(trials, MODEL, SETTINGS)
    assert np.array_equal(one.theta, two.theta)
    slow = identify(trials, MODEL, replace(SETTINGS, engine="numpy"))
    np.testing.assert_allclose(slow.theta, one.theta, rtol=1e-6, atol=1e-12)


def test_check_trials_are_scored_and_never_fitted():
    trials = noisy(white, 11)
    held = zigzag(5, use="check")
    alone, beside = identify(trials, MODEL, SETTINGS), identify([*trials, held], MODEL, SETTINGS)
    assert np.array_equal(alone.theta, beside.theta)
    assert alone.eps_check is None
    assert beside.eps_check is not None
    assert beside.eps_check < 0.2 * beside.eps_rmsn  # the held trial has no noise of its own


def test_a_gap_is_simulated_through_and_not_compared():
    from trialid.trial import Trial

    [trial, other] = noisy(white, 13)
    hole = np.zeros(trial.samples, dtype=bool)
    hole[800:1000] = True
    signals = {**trial.signals, "r": np.where(hole, 99.0, trial.signals["r"])}
    masked = Trial(trial.name, "fit", 0.5, signals, {**trial.valid, "r": ~hole})
    fit = identify([masked, other], MODEL, SETTINGS)
    whole = identify([trial, other], MODEL, SETTINGS)
    errors = np.array([p.standard_error for p in accuracy(whole).physical])
    assert np.all(np.abs(fit.theta[:10] - whole.theta[:10]) < 2.0 * errors)
    assert len(whole.residual) - len(fit.residual) == 200


def test_multi_start_reports_how_many_agree():
    from dataclasses import replace

    fit = identify(noisy(white, 15), MODEL, replace(SETTINGS, starts=4, seed=3))
    assert fit.agreeing == (4, 4)


def test_nuisance_parameters_are_recovered():
    """A late, biased roll sensor and a rudder whose zero is off."""
    from dataclasses import replace

    from trialid.trial import Trial

    trials = noisy(white, 17)
    t = trials[0].t
    late, offset = 0.7, np.deg2rad(0.5)
    made = []
    for trial in trials:
        signals = dict(trial.signals)
        signals["phi"] = np.interp(t - late, t, signals["phi"]) + np.deg2rad(0.3)
        signals["delta"] = signals["delta"] - offset
        made.append(Trial(trial.name, "fit", 0.5, signals, trial.valid))
    every = ("initial_state", "bias", "rudder_offset", "delay")
    fit = identify(made, MODEL, replace(SETTINGS, nuisance=every))
    errors = {p.name: p.standard_error for p in accuracy(fit).parameters}
    for trial in made:
        for name, truth in (("tau_phi", late), ("b_phi", np.deg2rad(0.3)), ("delta_0", offset)):
            label = f"{name} [{trial.name}]"
            assert abs(fit.value(label) - truth) < 4.0 * errors[label], label
    assert fit.value("tau_phi [zigzag-20]") == pytest.approx(late, abs=0.15)


def test_huber_weighs_even_where_the_search_starts_at_the_plain_optimum():
    """The first pass moves nothing there, and is not the last for that."""
    from dataclasses import replace

    trials = noisy(white, 7)
    hit = np.random.default_rng(8).random(trials[0].samples) < 0.02
    struck = [with_noise(t, hit * 40.0 * GYRO, 0.0 * hit) for t in trials]
    plain = identify(struck, MODEL, SETTINGS)
    robust = replace(SETTINGS, loss="huber")
    here = identify(struck, MODEL, robust, near=plain.estimates)
    there = identify(struck, MODEL, robust)
    errors = np.array([p.standard_error for p in accuracy(plain).physical])
    assert np.all(np.abs(here.theta[:10] - there.theta[:10]) < 0.02 * errors)
    assert np.any(np.abs(here.theta[:10] - plain.theta[:10]) > 0.1 * errors)


def test_a_prior_holds_what_the_record_alone_would_not():
    """Ydelta and Yv hardly part in roll and turn: with a prior on one, both keep their place."""
    from dataclasses import replace

    trials = noisy(waves, 19)
    known = replace(SETTINGS, priors={"Ydelta": (MODEL.value("Ydelta"), 1e-5)})
    fit = identify(trials, MODEL.with_values({"Ydelta": -0.004}), known)
    assert fit.converged
    assert fit.value("Ydelta") == pytest.approx(MODEL.value("Ydelta"), abs=3e-5)
