"""A sensor's number that ran to the end of what is possible, or next to it, ends in `no fit`."""

from dataclasses import replace

import numpy as np
import pytest
from s175q import MODEL, white, with_noise, zigzag

from trialid.identification.adequacy import why_no_fit
from trialid.identification.fit import identify
from trialid.identification.nuisance.at_the_end import at_the_end
from trialid.identification.problem import Settings

SETTINGS = Settings(("Nv", "Nr", "Ndelta"), ("r",), nuisance=("initial_state", "bias", "delay"))


@pytest.fixture(scope="module")
def fit():
    trial = zigzag(20)
    return identify(
        [with_noise(trial, *white(np.random.default_rng(1), trial.samples))], MODEL, SETTINGS
    )


@pytest.mark.parametrize(
    ("late", "ended"), [(-3.0, True), (-2.97, True), (2.9, True), (2.5, False), (0.1, False)]
)
def test_a_delay_is_at_its_end_from_a_twentieth_before_it(fit, late, ended):
    theta = fit.theta.copy()
    names = [x.name for x in fit.problem.unknowns]
    theta[names.index("tau_r [zigzag-20]")] = late
    found = at_the_end(fit.problem.unknowns, theta)
    assert found == ({"tau_r [zigzag-20]": late} if ended else {})
    why = why_no_fit(replace(fit, theta=theta))
    assert (why is not None and "what no sensor does" in why.reason) is ended
    told = why is not None and "the clock of what steers her" in why.advice
    assert told is (ended and late < 0.0)


def test_what_only_a_search_bounds_has_no_such_end(fit):
    """A start of a trial has no sensor that could be blamed, nor has a coefficient of the ship."""
    theta = fit.theta.copy()
    for k, one in enumerate(fit.problem.unknowns):
        if one.kind != "nuisance" or one.prior is None:
            theta[k] = one.high
    assert at_the_end(fit.problem.unknowns, theta) == {}
