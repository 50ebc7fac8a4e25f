"""From a split of the error to Eq. 14: which part goes where, and what an error is a share of."""

from types import SimpleNamespace

import numpy as np
import pytest

from trialid.accuracy.likely import Averaged, student
from trialid.diagnosis.noise.error_parts import Split
from trialid.diagnosis.trust import accuracy_of

N = 3000
PARTS = Split(
    "quiet stretch",
    "",
    noise=0.1,
    undermodelling=0.03,
    noise_interval=(0.09, 0.11),
    undermodelling_interval=(0.0, 0.05),
)


def unknown(name, size, prior=None):
    ends = {"low": -np.inf, "high": np.inf}
    return SimpleNamespace(name=name, kind="physical", unit="1", size=size, prior=prior, **ends)


def fit_of(theta, sizes):
    """Orthogonal columns, one for each unknown, of length 1 where it changes by its unit."""
    wave = np.arange(N)[:, None] * np.arange(1, len(theta) + 1)
    psi = np.sqrt(2.0 / N) * np.cos(np.pi * (2 * wave + 1) / N)
    e = np.random.default_rng(1).standard_normal(N)
    problem = SimpleNamespace(
        unknowns=[unknown(f"x{i}", s) for i, s in enumerate(sizes)],
        compared=(np.ones((N, 1), dtype=bool),),
        trials=(),  # no record that drives anything
    )
    fit = SimpleNamespace(
        problem=problem,
        theta=np.array(theta),
        psi=psi,
        residual=0.1 * e / np.linalg.norm(e),
        level=0.1 / np.sqrt(N),
        settings=SimpleNamespace(loss="squares"),
        rivals=(),
    )
    fit.examined = fit
    return fit


def averaged(columns):
    none = np.zeros((2, columns))
    return Averaged(none, none, ("",) * columns)


def test_noise_falls_with_the_samples_and_the_model_part_is_the_most_it_may_be():
    (row,) = accuracy_of(fit_of([2.0], [1.0]), PARTS, averaged(1)).parameters
    assert row.reference == 2.0
    assert row.S_imin == pytest.approx(2.0, rel=1e-3)
    assert row.undermodelling_error == pytest.approx(0.05 * 2.0 / row.S_imin)
    assert row.noise_error == pytest.approx(0.1 * 2.0 / row.S_imin / np.sqrt(row.n_effective))
    assert row.noise_error == pytest.approx(0.1 / np.sqrt(N), rel=0.3)
    off = student(row.freedom) * row.standard_error / 2.0  # outward as where slopes grow with it
    assert row.likely == pytest.approx((2.0 * (1.0 - off), 2.0 * np.exp(off)))


def test_a_parameter_near_zero_is_held_against_its_typical_size():
    """Yrar of 0.1 % of its typical size is not a thousand times as badly known as others."""
    small, large = accuracy_of(fit_of([1e-3, 0.5], [1.0, 1.0]), PARTS, averaged(2)).parameters
    assert small.reference == 1.0
    assert large.reference == 0.5
    assert small.relative_error == pytest.approx(0.05 + 0.1 / np.sqrt(N), rel=0.2)


def test_a_noise_that_is_not_told_apart_leaves_no_figure():
    none = Split("not separable", "no route holds")
    (row,) = accuracy_of(fit_of([2.0], [1.0]), none, averaged(1)).parameters
    assert row.noise_error is row.undermodelling_error is row.relative_error is None
    assert row.standard_error > 0.0
