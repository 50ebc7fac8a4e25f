"""A ship that as fitted rights herself by nothing carries no verdict, whatever else it leaves."""

from dataclasses import replace

import numpy as np
import pytest
from s175q import MODEL, SETTINGS, white, with_noise, zigzag

from trialid.identification.adequacy import why_no_fit
from trialid.identification.fit import identify

FREE = ("Nr", "Nv", "Ndelta", "Kdelta", "Kr", "Kv", "Kp", "GM")


@pytest.mark.parametrize(("GM", "said"), [(0.0, True), (1e-5, True), (0.05, False), (0.3, False)])
def test_a_heel_that_nothing_rights_is_of_something_else(GM, said):
    """A real yacht under sail: GM 0.0000 m, and `no effect stands out` by a noise of 61 %."""
    blank = zigzag(20)
    trial = with_noise(blank, *white(np.random.default_rng(3), blank.samples))
    fit = identify([trial], MODEL, replace(SETTINGS, free=FREE))
    assert why_no_fit(fit) is None
    theta = fit.theta.copy()
    theta[fit.problem.roll.GM] = GM
    found = why_no_fit(replace(fit, theta=theta))
    assert (found is not None and "she does not right herself" in found.reason) is said
    assert not said or "leave phi and p out" in found.advice
