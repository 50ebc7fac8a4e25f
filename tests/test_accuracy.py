"""Laws of the sensitivities, and the coloured covariance against repeats of a linear problem."""

import numpy as np
import pytest
from scipy.linalg import toeplitz
from scipy.signal import lfilter

from trialid.accuracy.coloured import autocovariance, coloured_covariance, white_covariance
from trialid.accuracy.equations import (
    correlation_ratio,
    minimum_sensitivity,
    sensitivity,
    sensitivity_range,
)
from trialid.accuracy.likely import student
from trialid.accuracy.parameter_table import Subject, assess
from trialid.accuracy.weak import SHARE, coefficient_label, weak_directions, without_nuisance
from trialid.trial_rows import Stretch

rng = np.random.default_rng(5)
A = rng.standard_normal((400, 4)) @ np.diag([1.0, 0.1, 3.0, 0.5])


def test_minimum_sensitivity_is_that_of_the_inverse_hessian():
    H = A.T @ A
    expected = 1.0 / np.sqrt(np.diag(np.linalg.inv(H)))
    np.testing.assert_allclose(minimum_sensitivity(A), expected, rtol=1e-12)
    np.testing.assert_allclose(sensitivity(A), np.sqrt(np.diag(H)), rtol=1e-12)


def test_minimum_sensitivity_is_a_minimum_over_the_other_parameters():
    """Eq. 10 in words: the smallest error a unit change of one parameter leaves behind."""
    others = np.delete(A, 1, axis=1)
    best, *_ = np.linalg.lstsq(others, -A[:, 1], rcond=None)
    left = np.linalg.norm(A[:, 1] + others @ best)
    assert minimum_sensitivity(A)[1] == pytest.approx(left, rel=1e-12)


def test_ratio_depends_on_scaling_and_R_i_does_not():
    scaled = A * np.array([1.0, 10.0, 10.0, 500.0])
    assert sensitivity_range(scaled)[2] != pytest.approx(sensitivity_range(A)[2], rel=0.1)
    np.testing.assert_allclose(correlation_ratio(scaled), correlation_ratio(A), rtol=1e-10)
    assert np.all(correlation_ratio(A) >= 1.0)


def test_two_copies_of_a_parameter_have_no_sensitivity_of_their_own_and_are_named():
    twins = np.column_stack([A, A[:, 0]])
    S_imin = minimum_sensitivity(twins)
    assert S_imin[0] == 0.0
    assert S_imin[4] == 0.0
    np.testing.assert_allclose(S_imin[1:4], minimum_sensitivity(A)[1:4], rtol=1e-6)
    names = ["Yvar", "Nr", "Kp", "GM", "Nvav"]
    [weak] = weak_directions(twins, names, 0.01)
    assert set(weak.parameters) == {"Yvar", "Nvav"}
    assert "Yv|r| and Nv|v| cannot be told apart here" in weak.sentence.replace(
        "Nv|v| and Yv|r|", "Yv|r| and Nv|v|"
    )


def test_moves_along_a_weak_direction_change_the_output_by_the_noise_alone():
    near = np.column_stack([A[:, 0], -3.0 * (A[:, 0] + 0.02 * A[:, 1])])
    [weak] = weak_directions(near, ["a", "b"], 0.01)
    moves = np.array([weak.moves["a"], weak.moves["b"]])
    assert np.linalg.norm(near @ moves) == pytest.approx(0.01)
    assert np.linalg.norm(moves) == pytest.approx(weak.relative_error)
    assert moves[0] * moves[1] > 0.0
    assert np.linalg.norm(near @ (moves * [1.0, -1.0])) > 0.1


def test_a_direction_of_many_small_shares_names_the_two_that_have_most():
    """Of 16 parameters as alike none has a third of the direction; no sentence was an error."""
    shares = 0.22 + 0.004 * np.arange(16)
    shares /= np.linalg.norm(shares)
    assert shares.max() < SHARE
    columns, _ = np.linalg.qr(np.random.default_rng(4).standard_normal((400, 16)))
    columns -= np.outer(columns @ shares, shares) * (1.0 - 1e-3)
    columns /= np.linalg.norm(columns, axis=0)
    names = [f"a{i}" for i in range(16)]
    [weak] = weak_directions(columns, names, 0.01)
    assert set(weak.parameters) == {"a14", "a15"}
    assert "a15 and a14 cannot be told apart" in weak.sentence


def test_a_parameter_without_trace_is_named():
    dead = np.column_stack([A, np.zeros(400)])
    assert minimum_sensitivity(dead)[4] == 0.0
    sentences = [w.sentence for w in weak_directions(dead, ["a", "b", "c", "d", "Xuu"], 0.01)]
    assert "Xuu leaves no trace in this record" in sentences


def test_orthogonal_parameters_are_not_weak():
    assert weak_directions(A, ["a", "b", "c", "d"], 0.01) == ()
    assert [coefficient_label(n) for n in ("Nrar", "Yphiauv", "GM")] == ["Nr|r|", "Yphiauv", "GM"]


def test_nuisance_columns_are_projected_out():
    nuisance = A[:, :1] + 0.3 * A[:, 1:2]
    both = np.column_stack([A, nuisance])
    clean = without_nuisance(both, np.array([True, True, True, True, False]))
    assert np.abs(nuisance.T @ clean).max() < 1e-10


def ar1(seed, n, rho):
    noise = np.random.default_rng(seed).standard_normal(n + 200)
    return lfilter([np.sqrt(1 - rho**2)], [1.0, -rho], noise)[200:]


@pytest.mark.parametrize("rho", [0.0, 0.8, 0.95])
@pytest.mark.study(turn="each")
def test_coloured_covariance_against_400_repeats(rho):
    """A slow signal in AR(1) noise: the sandwich is right where the white formula is far off."""
    n = 3000
    t = np.arange(n)
    design = np.column_stack([np.sin(t / 60.0), np.sign(np.sin(t / 97.0)), np.ones(n)]) / np.sqrt(n)
    stretch = [Stretch(0, 0, slice(0, n), np.ones(n, dtype=bool))]
    pseudo = np.linalg.pinv(design)
    estimates, coloured, white = [], [], []
    for seed in range(400):
        e = ar1(seed, n, rho)
        theta = pseudo @ e
        estimates.append(theta)
        if seed % 10:
            continue
        residual = e - design @ theta
        coloured.append(np.diag(coloured_covariance(design, residual, stretch).covariance))
        white.append(np.diag(white_covariance(design, residual)))
    actual = np.var(estimates, axis=0)
    ratio = np.mean(coloured, axis=0) / actual
    print(
        f"rho {rho}: coloured {ratio.round(2)}, white {(np.mean(white, axis=0) / actual).round(2)}"
    )
    assert np.all((ratio > 0.7) & (ratio < 1.3))
    if rho == 0.95:
        assert np.all(np.mean(white, axis=0) / actual < 0.2)


@pytest.mark.parametrize("trials", [1, 3])
def test_errors_hold_in_noise_as_slow_as_the_manoeuvre(trials):
    """What the parameters take up of slow noise is missed in the residual, and made good."""
    n, each = 600, 600 // trials
    t = np.arange(n)
    slow = [np.sin(2.0 * np.pi * k * t / 600.0 + k) for k in range(3, 10)]
    design = np.column_stack([*slow, np.cos(t / 25.0)])
    every = np.ones(each, dtype=bool)
    parts = [Stretch(i, 0, slice(i * each, (i + 1) * each), every) for i in range(trials)]
    pseudo = np.linalg.pinv(design)
    t_values, plain = [], []
    for seed in range(100):
        e = np.concatenate([ar1(1000 * i + seed, each, 0.95) for i in range(trials)])
        theta = pseudo @ e
        found = coloured_covariance(design, e - design @ theta, parts)
        t_values.append(theta / np.sqrt(np.diag(found.covariance)) / student(found.freedom))
        plain.append(theta / np.sqrt(np.diag(found.covariance)))
    held = np.mean(np.abs(t_values) < 1.0)
    print(f"{trials}: {held:.1%}, without Student {np.mean(np.abs(plain) < 1.96):.1%}")
    assert 0.92 < held < 0.985
    assert np.mean(np.abs(plain) < 1.96) < held - 0.01


def test_autocovariance_does_not_mind_gaps():
    e = ar1(3, 20000, 0.9)
    mask = np.ones(20000, dtype=bool)
    mask[rng.integers(0, 19900, 30)[:, None] + np.arange(60)] = False
    whole = autocovariance(e, np.ones(20000, dtype=bool))
    holed = autocovariance(np.where(mask, e, 0.0), mask)
    n = min(len(whole), len(holed), 10)
    np.testing.assert_allclose(holed[:n], whole[:n], rtol=0.15)


def test_half_of_a_record_in_gaps_says_the_same_of_the_noise():
    """Pairs are counted where both were compared: half of the samples make half of the sums."""
    e = ar1(6, 40_000, 0.8)
    mask = np.arange(len(e)) // 500 % 2 == 0
    holed = autocovariance(np.where(mask, e, 0.0), mask)
    assert holed[1] / holed[0] == pytest.approx(0.8, rel=0.1)
    assert holed[0] == pytest.approx(1.0, rel=0.05)


def test_absent_knowledge_stays_absent():
    subjects = [Subject(n, "physical", "1", 1.0, 1.0) for n in "abcd"]
    e = rng.standard_normal(400) / 20.0
    stretch = [Stretch(0, 0, slice(0, 400), np.ones(400, dtype=bool))]
    accuracy = assess(subjects, A, e, stretch, None, None)
    assert all(
        p.noise_error is None and p.undermodelling_error is None for p in accuracy.parameters
    )
    assert all(p.relative_error is None for p in accuracy.parameters)
    known = assess(subjects, A, e, stretch, 0.1, 0.05)
    for p in known.parameters:
        expected = 0.1 / (p.S_imin * np.sqrt(p.n_effective)) + 0.05 / p.S_imin
        assert p.relative_error == pytest.approx(expected, rel=1e-12)


def test_a_prior_adds_its_information_to_the_record():
    """White noise: precisions add, for the parameter and for what is entangled with it."""
    subjects = [Subject(n, "physical", "1", 1.0, 2.0) for n in "abcd"]
    e = rng.standard_normal(400) / 20.0
    e -= A @ np.linalg.lstsq(A, e, rcond=None)[0]
    stretch = [Stretch(0, 0, slice(0, 400), np.ones(400, dtype=bool))]
    known = [*subjects[:1], Subject("b", "physical", "1", 1.0, 2.0, prior=0.05), *subjects[2:]]
    scaled = assess(known, A / 2.0, e, stretch, None, None)
    H = A.T @ A / 4.0 / (float(e @ e) / 396)
    H[1, 1] += 1.0 / 0.05**2
    expected = np.sqrt(np.diag(np.linalg.inv(H)))
    found = [p.white_error for p in scaled.parameters]
    np.testing.assert_allclose(found, expected, rtol=1e-9)
    np.testing.assert_allclose([p.standard_error for p in scaled.parameters], expected, rtol=0.15)


def test_what_only_the_prior_knows_has_the_priors_error():
    twins = np.column_stack([A[:, 0], np.zeros(400)])
    subjects = [
        Subject("a", "physical", "1", 1.0, 1.0), Subject("b", "physical", "1", 1.0, 1.0, prior=0.3)
    ]  # fmt: skip
    e = rng.standard_normal(400) / 20.0
    stretch = [Stretch(0, 0, slice(0, 400), np.ones(400, dtype=bool))]
    rows = assess(subjects, twins, e, stretch, None, None).parameters
    assert rows[1].S_imin == 0.0
    assert rows[1].standard_error == pytest.approx(0.3, rel=1e-9)
    alone = assess([*subjects[:1], Subject("b", "physical", "1", 1.0, 1.0)], twins, e, stretch,
                   None, None).parameters  # fmt: skip
    assert np.isnan(alone[1].standard_error)


def alone(n, rho=0.0, seed=1):
    """The stretch of one output, noise of a colour with squares that sum to 1."""
    e = ar1(seed, n, rho)
    return [Stretch(0, 0, slice(0, n), np.ones(n, dtype=bool))], e / np.linalg.norm(e)


@pytest.mark.parametrize("rho", [0.0, 0.8, 0.95])
def test_autocovariance_sums_to_the_long_run_variance(rho):
    """(1 + rho) / (1 - rho) for a first-order process; what is cut off is a tenth at most."""
    e = ar1(2, 200_000, rho)
    c = autocovariance(e, np.ones(len(e), dtype=bool))
    share = (c[0] + 2.0 * c[1:].sum()) * (1.0 - rho) / (1.0 + rho)
    assert 0.84 < share < 1.06


def test_autocovariance_is_one_of_a_process():
    """No combination of samples has a negative variance, however regular the sea."""
    t = np.arange(20_000)
    e = np.sin(0.31 * t) + 0.3 * ar1(4, len(t), 0.5)
    c = autocovariance(e, np.ones(len(t), dtype=bool))[:800]
    assert np.linalg.eigvalsh(toeplitz(c)).min() > -0.02 * c[0]


@pytest.mark.parametrize("rho", [0.0, 0.9])
def test_errors_of_a_mean_in_coloured_noise(rho):
    """The mean of n samples: variance (1 + rho) / (1 - rho) / n, as known as that many fewer."""
    n, slow = 40_000, (1.0 + rho) / (1.0 - rho)
    stretch, e = alone(n, rho)
    subjects = [Subject("Nr", "physical", "m", 2.0, 2.0)]
    mean = np.full((n, 1), 1.0 / np.sqrt(n))
    accuracy = assess(subjects, mean, 0.1 * e, stretch, 0.1, 0.03)
    (p,) = accuracy.parameters
    assert p.S_imin == pytest.approx(2.0)
    assert p.white_error == pytest.approx(0.1 / np.sqrt(n), rel=1e-3)
    assert p.standard_error == pytest.approx(0.1 * np.sqrt(slow / n), rel=0.12)
    assert p.n_effective == pytest.approx(n / slow, rel=0.25)
    assert accuracy.covariance[0, 0] == pytest.approx(p.standard_error**2)
    # all of the error is noise: Eq. 14 says of it what the covariance says
    assert p.noise_error == pytest.approx(p.standard_error, rel=1e-3)
    assert p.undermodelling_error == pytest.approx(0.03 * 2.0 / p.S_imin)
    assert p.relative_error == pytest.approx((p.noise_error + p.undermodelling_error) / 2.0)


def test_what_is_fitted_is_no_noise_of_the_rest():
    """A third of the rows taken up by parameters: the residual alone says a third too little."""
    n, columns = 120, 40
    design = np.random.default_rng(8).standard_normal((n, columns))
    stretch = [Stretch(0, 0, slice(0, n), np.ones(n, dtype=bool))]
    truth = np.diag(np.linalg.inv(design.T @ design))
    coloured, white = [], []
    for seed in range(150):
        e = np.random.default_rng(seed).standard_normal(n)
        left = e - design @ np.linalg.lstsq(design, e, rcond=None)[0]
        coloured.append(np.diag(coloured_covariance(design, left, stretch).covariance) / truth)
        white.append(np.diag(white_covariance(design, left)) / truth)
    assert np.mean(white) == pytest.approx(1.0, abs=0.05)
    assert np.median(np.mean(coloured, axis=1)) == pytest.approx(1.0, abs=0.12)


def test_chance_is_taken_for_no_colour():
    """Errors of 60 white records differ by 3 %, not by the 9 % of lags that stand out by luck.

    A weak colour still counts: with a correlation of 0.3 a slow parameter is 36 % less certain.
    """
    n = 900
    design = np.sin(np.arange(n) / 40.0)[:, None]
    stretch = [Stretch(0, 0, slice(0, n), np.ones(n, dtype=bool))]

    def errors(rho):
        residuals = (ar1(seed, n, rho) for seed in range(60))
        return [coloured_covariance(design, e, stretch).covariance[0, 0] ** 0.5 for e in residuals]

    sure = 1.0 / np.linalg.norm(design)
    assert np.mean(errors(0.0)) == pytest.approx(sure, rel=0.02)
    assert np.std(errors(0.0)) < 0.05 * sure
    assert np.mean(errors(0.3)) == pytest.approx(1.36 * sure, rel=0.06)
