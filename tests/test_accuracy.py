"""Laws of the sensitivities, and the coloured covariance against repeats of a linear problem."""

import numpy as np
import pytest
from scipy.signal import lfilter

from trialid.accuracy import (
    Stretch,
    Subject,
    assess,
    autocovariance,
    coloured_covariance,
    correlation_ratio,
    minimum_sensitivity,
    sensitivity,
    sensitivity_range,
    spoken,
    weak_directions,
    white_covariance,
    without_nuisance,
)

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


def test_a_parameter_without_trace_is_named():
    dead = np.column_stack([A, np.zeros(400)])
    assert minimum_sensitivity(dead)[4] == 0.0
    sentences = [w.sentence for w in weak_directions(dead, ["a", "b", "c", "d", "Xuu"], 0.01)]
    assert "Xuu leaves no trace in this record" in sentences


def test_orthogonal_parameters_are_not_weak():
    assert weak_directions(A, ["a", "b", "c", "d"], 0.01) == ()
    assert [spoken(n) for n in ("Nrar", "Yphiauv", "GM")] == ["Nr|r|", "Yphiauv", "GM"]


def test_nuisance_columns_are_projected_out():
    nuisance = A[:, :1] + 0.3 * A[:, 1:2]
    both = np.column_stack([A, nuisance])
    clean = without_nuisance(both, np.array([True, True, True, True, False]))
    assert np.abs(nuisance.T @ clean).max() < 1e-10


def ar1(seed, n, rho):
    noise = np.random.default_rng(seed).standard_normal(n + 200)
    return lfilter([np.sqrt(1 - rho**2)], [1.0, -rho], noise)[200:]


@pytest.mark.parametrize("rho", [0.0, 0.8, 0.95])
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
        residual = e - design @ theta
        coloured.append(np.diag(coloured_covariance(design, residual, stretch)))
        white.append(np.diag(white_covariance(design, residual)))
    actual = np.var(estimates, axis=0)
    ratio = np.mean(coloured, axis=0) / actual
    print(
        f"rho {rho}: coloured {ratio.round(2)}, white {(np.mean(white, axis=0) / actual).round(2)}"
    )
    assert np.all((ratio > 0.7) & (ratio < 1.3))
    if rho == 0.95:
        assert np.all(np.mean(white, axis=0) / actual < 0.2)


def test_autocovariance_does_not_mind_gaps():
    e = ar1(3, 20000, 0.9)
    mask = np.ones(20000, dtype=bool)
    mask[rng.integers(0, 19900, 30)[:, None] + np.arange(60)] = False
    whole = autocovariance(e, np.ones(20000, dtype=bool))
    holed = autocovariance(np.where(mask, e, 0.0), mask)
    n = min(len(whole), len(holed), 10)
    np.testing.assert_allclose(holed[:n], whole[:n], rtol=0.15)


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
