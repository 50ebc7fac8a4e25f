"""Models averaged: the algebra against closed forms, its words, and the ranges of a fit."""

import numpy as np
import pytest

from trialid.accuracy.likely import COARSE, Rows, average, stand
from trialid.accuracy.one_missing import Rival

RNG = np.random.default_rng(11)
N = 400
PSI = RNG.standard_normal((N, 2)) / np.sqrt(N)
HIDDEN = RNG.standard_normal((N, 1)) / np.sqrt(N) + 0.8 * PSI[:, :1]
OTHER = RNG.standard_normal((N, 1)) / np.sqrt(N)


def rows(
    residual, *, S=None, held=None, deviations=(), slopes=(0.0, 0.0), gaps=(0.0, 0.0), level=0.01
):
    none = np.zeros((N, 0))
    return Rows(
        residual=residual,
        psi=PSI,
        priors=np.column_stack([slopes, gaps]),
        held=none if held is None else held,
        deviations=np.array(deviations, dtype=float),
        S=none if S is None else S,
        level=level,
    )


def fitted(y):
    """Least squares by both columns: estimates and what is left."""
    theta = np.linalg.lstsq(PSI, y, rcond=None)[0]
    return theta, y - PSI @ theta


def test_with_nothing_else_a_range_is_that_of_noise():
    found = average(rows(0.01 * RNG.standard_normal(N)), ())
    assert not found.shifts.any()
    assert not found.variances.any()
    assert found.range(0, 2.0, 0.1) == pytest.approx((2.0 - 0.196, 2.0 + 0.196), rel=1e-4)
    wide = 0.1 * 2.571  # Student's table, five degrees of freedom
    assert found.range(0, 2.0, 0.1, 5.0) == pytest.approx((2.0 - wide, 2.0 + wide), rel=1e-4)
    assert found.range(0, 2.0, np.nan) is None


def test_a_hidden_effect_moves_the_range_to_the_truth():
    """With y = 1.0 psi_1 - 0.5 psi_2 + 0.3 hidden: without it psi_1 comes out 0.24 too large."""
    truth = np.array([1.0, -0.5])
    theta, left = fitted(PSI @ truth + 0.3 * HIDDEN[:, 0])
    assert theta[0] - truth[0] == pytest.approx(0.24, abs=0.03)
    both = np.column_stack([HIDDEN, OTHER])
    rivals = (Rival("hidden", (0,), (2.0,)), Rival("other", (1,), (2.0,)))
    found = average(rows(left, S=both, level=1e-3), rivals)
    assert found.shifts[0] == pytest.approx(truth - theta, rel=1e-3)
    low, high = found.range(0, theta[0], 1e-3)
    assert low < truth[0] < theta[0] < high  # what the model says as it is belongs to the range
    assert high - theta[0] == pytest.approx(1.96e-3, rel=0.01)
    assert found.widest[0] == "hidden"


def test_it_is_ridge_regression_where_one_rival_stands_alone():
    """Against the normal equations of all columns at once, the rival's size known to +-0.5."""
    _, left = fitted(0.4 * HIDDEN[:, 0] + 0.01 * RNG.standard_normal(N))
    level, deviation = 1e-3, 0.5
    every = np.vstack([np.column_stack([PSI, HIDDEN]), [0.0, 0.0, level / deviation]])
    answer = np.linalg.lstsq(every, np.append(left, 0.0), rcond=None)[0]
    covariance = level**2 * np.linalg.inv(every.T @ every)
    found = average(rows(left, S=HIDDEN, level=level), (Rival("hidden", (0,), (deviation,)),))
    alone = level**2 * np.linalg.inv(PSI.T @ PSI)
    assert found.shifts == pytest.approx(np.tile(answer[:2], (len(COARSE), 1)), rel=1e-9)
    expected = np.diag(covariance)[:2] - np.diag(alone)
    assert found.variances == pytest.approx(np.tile(expected, (len(COARSE), 1)), rel=1e-9)


def test_what_is_held_fixed_and_never_seen_widens_by_all_that_it_may_be_off():
    held = (PSI @ [0.7, -0.2])[:, None]  # exactly what the fitted parameters can mimic
    found = average(rows(0.01 * RNG.standard_normal(N), held=held, deviations=(0.3,)), ())
    assert np.sqrt(found.variances[0]) == pytest.approx([0.21, 0.06])
    assert found.shifts == pytest.approx(np.zeros((2, 2)), abs=1e-9)
    assert found.widest == ("", "")


def test_what_may_be_missing_makes_the_whole_better_known():
    """Half of the variance from an error of four degrees of freedom makes sixteen in all."""
    held = (PSI @ [0.7, -0.2])[:, None]
    found = average(rows(0.01 * RNG.standard_normal(N), held=held, deviations=(0.3,)), ())
    low, high = found.range(0, 2.0, 0.21, 4.0)
    assert high - low == pytest.approx(2.0 * 2.120 * np.hypot(0.21, 0.21), rel=1e-3)
    low, high = found.range(0, 2.0, 0.021, 4.0)
    assert high - low == pytest.approx(2.0 * 1.96 * np.hypot(0.21, 0.021), rel=1e-3)


def test_what_is_exact_widens_nothing():
    held = (PSI @ [0.7, -0.2])[:, None]
    found = average(rows(0.01 * RNG.standard_normal(N), held=held, deviations=(0.0,)), ())
    assert not found.variances.any()


def test_a_prior_holds_its_parameter():
    """The same missing effect moves a parameter less that is known beforehand."""
    _, left = fitted(0.3 * HIDDEN[:, 0])
    rival = (Rival("hidden", (0,), (2.0,)),)
    loose = average(rows(left, S=HIDDEN), rival).shifts[0, 0]
    tight = average(rows(left, S=HIDDEN, slopes=(3.0, 0.0)), rival).shifts[0, 0]
    assert loose < 0.0
    assert abs(tight) < 0.5 * abs(loose)


def test_a_rival_that_explains_nothing_gets_hardly_any_weight():
    """At Schwarz's price for one of 400 independent rows, by the coarser odds: 1 in 2.6."""
    _, left = fitted(0.01 * RNG.standard_normal(N) / np.sqrt(N))
    size = np.linalg.norm(left)  # so that all rows count as one each
    unseen = Rival("other", (0,), (1e-6,))
    found = average(rows(left, S=PSI[:, :1], level=size / np.sqrt(N)), (unseen,))
    odds = np.exp(-0.5 * np.log(N) / np.array(COARSE))
    weight = odds / (1.0 + odds)
    assert 1e12 * found.variances[:, 0] == pytest.approx(weight, rel=1e-6)


@pytest.mark.parametrize("size", [0.04, 0.05, 0.06])
def test_models_that_stand_about_alike_are_mixed(size):
    """Mean and variance of two normal distributions, weighed by what each leaves and its price."""
    level, deviation = 0.02, 0.5
    noise = level * np.random.default_rng(1).standard_normal(N)
    _, left = fitted(size * HIDDEN[:, 0] + noise)
    every = np.vstack([np.column_stack([PSI, HIDDEN]), [0.0, 0.0, level / deviation]])
    rest = np.append(left, 0.0)
    answer = np.linalg.lstsq(every, rest, rcond=None)[0]
    fall = (left @ left - np.sum((rest - every @ answer) ** 2)) / level**2
    price = np.log(left @ left / level**2)
    weight = 1.0 / (1.0 + np.exp(0.5 * (price - fall) / np.array(COARSE)))[:, None]
    own = np.diag(level**2 * np.linalg.inv(every.T @ every))[:2]
    own = own - np.diag(level**2 * np.linalg.inv(PSI.T @ PSI))
    found = average(rows(left, S=HIDDEN, level=level), (Rival("hidden", (0,), (deviation,)),))
    assert found.shifts == pytest.approx(weight * answer[:2], rel=1e-6)
    spread = weight * own + weight * (1.0 - weight) * answer[:2] ** 2
    assert found.variances == pytest.approx(spread, rel=1e-6)
    assert np.all((weight > 0.02) & (weight < 0.98))


def test_at_a_fit_that_its_prior_pulls_nothing_is_shifted_by_the_pull_alone():
    """Ridge regression with a prior off the truth, and a rival: against all unknowns at once."""
    slope, aim, deviation, level = 0.8, 1.0, 0.5, 1e-3
    y = PSI @ [0.3, -0.5] + 0.4 * HIDDEN[:, 0]
    pulled = np.vstack([PSI, [slope, 0.0]])
    theta = np.linalg.lstsq(pulled, np.append(y, slope * aim), rcond=None)[0]
    gap = slope * (aim - theta[0])
    both = np.vstack([np.column_stack([PSI, HIDDEN]), [slope, 0, 0], [0, 0, level / deviation]])
    whole = np.linalg.lstsq(both, np.concatenate([y, [slope * aim, 0.0]]), rcond=None)[0]
    given = rows(y - PSI @ theta, S=HIDDEN, slopes=(slope, 0.0), gaps=(gap, 0.0), level=level)
    found = average(given, (Rival("hidden", (0,), (deviation,)),))
    assert found.shifts == pytest.approx(np.tile(whole[:2] - theta, (len(COARSE), 1)), rel=1e-9)


def test_through_slopes_of_one_it_is_the_parameters_themselves():
    _, left = fitted(0.4 * HIDDEN[:, 0])
    held = (PSI @ [0.7, -0.2])[:, None]
    given = rows(left, S=HIDDEN, held=held, deviations=(0.3,))
    standing = stand(given, (Rival("hidden", (0,), (0.5,)),))
    same = standing.average(np.eye(2, 4))
    assert same.shifts == pytest.approx(standing.average().shifts)
    assert same.variances == pytest.approx(standing.average().variances)


def test_a_missing_effect_moves_what_follows_through_the_parameters_and_by_itself():
    """With y = psi_1 + 0.3 hidden a prediction 2 theta_1 + 5 hidden is true at 2 * 1.0 + 5 * 0.3.

    With the parameters' move alone the range would end at the fitted model's prediction.
    """
    theta, left = fitted(PSI @ [1.0, -0.5] + 0.3 * HIDDEN[:, 0])
    standing = stand(rows(left, S=HIDDEN, level=1e-3), (Rival("hidden", (0,), (2.0,)),))
    found = standing.average(np.array([[2.0, 0.0, 5.0], [2.0, 0.0, 0.0]]))
    fit, true = 2.0 * theta[0], 2.0 * 1.0 + 5.0 * 0.3
    assert fit + found.shifts[0, 0] == pytest.approx(true, rel=1e-3)
    assert fit + found.shifts[0, 1] == pytest.approx(2.0, rel=1e-3)
    low, high = found.range(0, fit, 2e-3)
    assert low < fit < true < high


def test_what_is_held_fixed_acts_in_a_prediction_too():
    """A number that the parameters make up for in the record, and the prediction lacks besides."""
    held = (PSI @ [0.7, -0.2])[:, None]
    left = 0.01 * RNG.standard_normal(N)
    standing = stand(rows(left, held=held, deviations=(0.3,)), ())
    found = standing.average(np.array([[1.0, 0.0, 0.7], [1.0, 0.0, 2.0]]))
    # up by one of its units moves the first parameter by -0.7: to nothing, or to 1.3
    assert np.sqrt(found.variances[0]) == pytest.approx([0.0, 0.39], abs=1e-6)


@pytest.mark.parametrize("limits", [(0.0, 1.0), (0.35, 0.5), (-1.0, 0.1), (0.0, np.inf)])
def test_a_size_within_limits_against_a_grid_of_all_sizes(limits):
    """What the rows say times the prior, summed: moves, variances, weights and draws."""
    level, deviation = 0.02, 0.5
    noise = level * np.random.default_rng(5).standard_normal(N)
    _, left = fitted(0.05 * HIDDEN[:, 0] + noise)
    held = (PSI @ [0.7, -0.2])[:, None] + 0.5 * HIDDEN
    given = rows(left, S=HIDDEN, level=level, held=held, deviations=(0.3,))
    rival = Rival("hidden", (0,), (deviation,), limits, 0.5)
    standing = stand(given, (rival,))
    sizes, off = np.append(np.arange(-4.0, 4.0, 0.005) + 0.0025, 0.0), np.linspace(-2.0, 2.0, 401)
    beside = np.linalg.lstsq(PSI, np.column_stack([left, HIDDEN, held]), rcond=None)[0]
    clean = np.column_stack([left, HIDDEN, held]) - PSI @ beside
    gram = clean.T @ clean / level**2
    b, h = np.meshgrid(sizes, off, indexing="ij")
    fit = gram[0, 0] - 2.0 * (b * gram[0, 1] + h * gram[0, 2]) + 2.0 * b * h * gram[1, 2]
    fit += b**2 * gram[1, 1] + h**2 * gram[2, 2]
    chance = np.exp(-0.5 * (fit - fit.min() + (h / 0.3) ** 2))
    before = np.exp(-0.5 * (sizes / deviation) ** 2)
    before *= (limits[0] < sizes) & (sizes < limits[1]) & (sizes != 0.0)
    with_it = chance * (before / before.sum())[:, None]
    moves = -(b[..., None] * beside[:, 1] + h[..., None] * beside[:, 2])
    plain = chance[-1]
    price = np.log(left @ left / level**2)  # which stands for how much narrower sizes become
    narrower = np.eye(2) + gram[1:, 1:] * np.outer([deviation, 0.3], [deviation, 0.3])
    stands = with_it.sum() / plain.sum() * np.sqrt(np.linalg.det(narrower) / narrower[1, 1])
    odds = 0.5 * (stands * np.exp(-0.5 * price)) ** (1.0 / np.array(COARSE))
    weight = (odds / (1.0 + odds))[:, None]
    mean = np.einsum("bh,bhi->i", with_it, moves) / with_it.sum()
    none = np.einsum("h,hi->i", plain, -off[:, None] * beside[:, 2]) / plain.sum()
    shift = weight * mean + (1.0 - weight) * none
    assert standing.average().shifts == pytest.approx(shift, rel=0.02, abs=1e-4)
    square = np.einsum("bh,bhi->i", with_it, moves**2) / with_it.sum()
    alone = np.einsum("h,hi->i", plain, (off[:, None] * beside[:, 2]) ** 2) / plain.sum()
    whole = weight * square + (1.0 - weight) * alone - shift**2
    assert standing.average().variances == pytest.approx(whole, rel=0.03)
    drawn = standing.draw(20_000, np.random.default_rng(1))
    there = drawn.columns[drawn.rivals == 0]
    assert ((limits[0] <= there[:, 1]) & (there[:, 1] <= limits[1])).all()
    assert np.mean(drawn.rivals == 0) == pytest.approx(weight.mean(), abs=0.02)
    assert drawn.moves[drawn.rivals == 0].mean(axis=0) == pytest.approx(mean, rel=0.06, abs=2e-3)
