"""A held-out error that rises speaks against an effect by more than its blocks let one tell."""

from types import SimpleNamespace

import numpy as np
import pytest
from s175q import MODEL, white, with_noise, zigzag

from trialid.diagnosis import held_out_rise
from trialid.diagnosis.held_out_rise import squares_by_block, worse_held_out
from trialid.identification.fit import identify
from trialid.identification.problem import Settings


def fit(blocks):
    return SimpleNamespace(eps_check=float(np.sqrt(np.sum(blocks))), blocks=np.array(blocks))


OLD = fit([2.0, 2.0, 2.0, 2.0, 2.0, 2.0])


CASES = [
    ((0.1, -0.08, 0.09, -0.07, 0.1, -0.06), False),  # 1.46 to 1.47 %, up in half of the blocks
    ((0.013, 0.014, 0.012, 0.013, 0.014, 0.014), True),  # as much, in all of them
    ((-0.2, -0.2, -0.2, -0.2, -0.2, 8.0), True),  # one bad block, and a large rise
    ((-0.1, -0.1, 0.0, -0.1, 0.1, 0.1), False),
    ((0.1, -0.04, 0.1, -0.04, 0.1, -0.04), False),  # 0.96 standard errors
    ((0.1, -0.03, 0.1, -0.03, 0.1, -0.03), True),  # 1.2
]


@pytest.mark.parametrize(("rises", "worse"), CASES)
def test_one_standard_error(monkeypatch, rises, worse):
    monkeypatch.setattr(held_out_rise, "squares_by_block", lambda one: one.blocks)
    assert worse_held_out(OLD, fit(OLD.blocks + np.array(rises))) is worse


def test_the_blocks_are_all_of_the_error():
    rng = np.random.default_rng(4)
    trials = [
        with_noise(one, *white(rng, one.samples)) for one in (zigzag(20), zigzag(10, use="check"))
    ]
    found = identify(trials, MODEL, Settings(("Nv", "Nr"), ("r", "phi")))
    blocks = squares_by_block(found)
    assert len(blocks) == 6
    assert np.sum(blocks) == pytest.approx(found.eps_check**2)
