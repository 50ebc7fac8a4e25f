"""What carries over: a coarse output hides no other, and blocks alone are believed where alike."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import wilcoxon
from test_carry_over import ROWS, made

from trialid.diagnosis.search.carried import Carried, signed_rank_p
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


@pytest.mark.parametrize("blocks", [1, 3, 6, 11, 21])
def test_signed_ranks_are_those_of_an_independent_hand(blocks: int) -> None:
    rng = np.random.default_rng(blocks)
    for shift in (-0.5, 0.0, 0.7):
        gaps = rng.normal(shift, 1.0, blocks)
        theirs = wilcoxon(gaps, alternative="greater", method="exact").pvalue
        assert signed_rank_p(gaps) == pytest.approx(theirs)


def test_blocks_without_any_change_show_nothing() -> None:
    assert signed_rank_p([]) == 1.0
    assert signed_rank_p([0.0] * 6) == 1.0


def test_one_block_s_trouble_is_not_large_and_a_fall_in_every_block_is() -> None:
    before = (1.0, 1.1, 0.9, 1.2, 0.8, 9.0)
    one = Carried(before, (1.1, 1.2, 0.8, 1.3, 0.9, 5.0))
    each = Carried(before, tuple(0.8 * b for b in before))
    assert one.ratio < 0.75 < each.ratio
    assert not one.large
    assert each.large
    assert not Carried(before, tuple(0.97 * b for b in before)).large
