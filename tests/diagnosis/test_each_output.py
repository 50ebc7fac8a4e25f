"""What carries over with each output held against its own error: a coarse one hides no other."""

from dataclasses import replace

import numpy as np
import pytest
from test_carry_over import ROWS, made

from trialid.diagnosis.search.carry_over import left_out, levels


def beside_a_coarse_one(seed, hidden):
    """A record of two outputs: the second one, that no effect moves, is known ten times worse."""
    fit, residual, psi, S, parts = made(seed, hidden=hidden)
    rng = np.random.default_rng((seed, 1))
    coarse = 10.0 * rng.standard_normal(ROWS)
    both = [
        replace(p, output=1, rows=slice(p.rows.start + ROWS, p.rows.stop + ROWS)) for p in parts
    ]
    fit.eps_by_output = {"r": float(np.std(residual)), "phi": 10.0}
    fit.problem.weights = np.ones(2)
    still = [np.zeros_like(x) for x in (psi, S)]
    return (
        fit, np.append(residual, coarse), np.vstack([psi, still[0]]), np.vstack([S, still[1]]),
        (*parts, *both),
    )  # fmt: skip


def test_what_one_output_shows_is_not_hidden_by_another():
    shown = [beside_a_coarse_one(seed, 0.09) for seed in range(40, 60)]
    found = [left_out(*record).carried([0]) for record in shown]
    assert max(abs(one.ratio - 1.0) for one in found) < 0.015  # of all outputs nobody sees it
    assert sum(one.falls for one in found) >= 18
    nothing = [left_out(*beside_a_coarse_one(seed, 0.0)).carried([0]) for seed in range(60, 80)]
    assert not any(one.falls for one in nothing)


def test_levels_hold_each_output_against_its_own_error():
    fit = made(3)[0]
    fit.eps_by_output, fit.problem.weights = {"r": 0.02, "phi": 0.2}, np.ones(2)
    found = levels(fit)
    assert found * np.square([0.02, 0.2]) == pytest.approx(np.full(2, (0.02**2 + 0.2**2) / 2))
    fit.problem.weights = np.array([1.0, 3.0])  # the user's own weights stay between them
    squares = levels(fit) * np.square([0.02, 0.2]) * fit.problem.weights**2
    assert squares[1] == pytest.approx(9.0 * squares[0])
    assert squares.sum() == pytest.approx(0.02**2 + 9.0 * 0.2**2)
