"""Eq. 3 to 7 against what they mean."""

import numpy as np
import pytest
from s175q import MODEL, SETTINGS, TEN, white, with_noise, zigzag

from trialid.accuracy.equations import normed_rms
from trialid.identification.fit import identify
from trialid.identification.output_error import hessian, linearise, loss, stretches
from trialid.identification.problem import pose_problem, replace

PLAIN = replace(SETTINGS, nuisance=())
PROBLEM = pose_problem([zigzag(10)], MODEL, PLAIN)


def test_the_hessian_is_the_curvature_of_V_where_the_residual_is_zero():
    """Eq. 7 drops eps times the second derivative, which vanishes at a perfect fit."""
    theta = PROBLEM.start
    _, psi = linearise(PROBLEM, theta)
    H = hessian(psi)
    for i in (0, 1, 5):
        step = 1e-3 * abs(theta[i])
        moved = [np.where(np.arange(10) == i, theta + s * step, theta) for s in (-1, 1)]
        V = [loss(linearise(PROBLEM, t)[0]) for t in moved]
        assert (V[0] + V[1]) / step**2 == pytest.approx(H[i, i], rel=1e-3)


def test_V_is_half_of_eps_squared_and_eps_is_eq_8_averaged_over_outputs():
    trial = with_noise(zigzag(10), *white(np.random.default_rng(1), 2401))
    fit = identify([trial], MODEL, SETTINGS)
    y_hat = fit.scores[0].response.y
    parts = [
        normed_rms(trial.signals[c] - y_hat[:, i], fit.problem.y_rms[i])
        for i, c in enumerate(("r", "phi"))
    ]
    assert fit.eps_by_output == pytest.approx(dict(zip(("r", "phi"), parts, strict=True)))
    V = 0.5 * np.mean(np.square(parts))
    assert pytest.approx(V, rel=1e-12) == fit.V
    assert fit.eps_rmsn == pytest.approx(np.sqrt(2.0 * fit.V), rel=1e-12)


def test_units_of_an_output_do_not_matter():
    """Degrees or radians: every output is over its own y_RMS."""
    one = linearise(PROBLEM, PROBLEM.start * 1.01)
    scaled = replace(PROBLEM, y_rms=PROBLEM.y_rms * 57.3)
    other = linearise(scaled, PROBLEM.start * 1.01)
    np.testing.assert_allclose(other[0] * 57.3, one[0], rtol=1e-12)


def test_rows_are_where_stretches_say():
    residual, psi = linearise(PROBLEM, PROBLEM.start * 1.02)
    parts = stretches(PROBLEM)
    assert parts[-1].rows.stop == len(residual) == len(psi)
    assert [(p.trial, p.output) for p in parts] == [(0, 0), (0, 1)]
    assert psi.shape == (2 * 2401, len(TEN))


def test_weights_favour_an_output():
    rng = np.random.default_rng(2)
    trial = with_noise(zigzag(10), *white(rng, 2401))
    few = replace(SETTINGS, free=("Nr", "Ndelta", "Kdelta", "Kp"))
    wrong = MODEL.with_values({"Nv": -0.0045})  # so that r and phi want different parameters
    even = identify([trial], wrong, few).eps_by_output
    roll = identify([trial], wrong, replace(few, weights={"phi": 30.0})).eps_by_output
    assert roll["phi"] < even["phi"]
    assert roll["r"] > even["r"]
