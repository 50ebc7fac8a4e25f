"""A ship that as fitted rights herself by nothing carries no verdict, whatever else it leaves."""

from types import SimpleNamespace

import numpy as np
import pytest

from trialid.identification.adequacy import CHECKS, LACKING, no_stability


@pytest.mark.parametrize(("GM", "said"), [(0.0, True), (1e-5, True), (0.05, False), (0.3, False)])
def test_a_heel_that_nothing_rights_is_of_something_else(GM, said):
    """A real yacht under sail: GM 0.0000 m, and `no effect stands out` by a noise of 61 %."""
    problem = SimpleNamespace(roll=SimpleNamespace(GM=1, length=12.0))
    found = no_stability(SimpleNamespace(problem=problem, theta=np.array([-0.01, GM])))
    assert (found is not None) is said
    assert not said or "leave phi and p out" in found.advice


def test_without_a_roll_there_is_nothing_to_right():
    fit = SimpleNamespace(problem=SimpleNamespace(roll=None), theta=np.zeros(1))
    assert no_stability(fit) is None


def test_an_effect_that_is_missing_may_mend_it():
    assert no_stability in CHECKS
    assert no_stability in LACKING
