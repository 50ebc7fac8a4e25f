"""What takes numbers of hers out of what is known of them: no name, or after what does not."""

from types import SimpleNamespace

import numpy as np
import pytest
from made_up_fits import fit, refit

from trialid.diagnosis.best_refit import choose_best
from trialid.diagnosis.found_values import SURE, leaves_priors
from trialid.diagnosis.objections import ELSEWHERE, likeliest_refit, objection

GM = (0.55, 0.055)
GUESSED = (-4.2e-3, 1.5e-3)


def with_known(made, **numbers):
    """The fit with numbers of hers: where each ended, its mean and standard deviation."""
    unknowns = [
        SimpleNamespace(name=n, kind="physical", prior=prior) for n, (_, prior) in numbers.items()
    ]
    made.problem.unknowns = tuple(unknowns)
    made.theta = np.array([value for value, _ in numbers.values()])
    return made


def off(deviations, prior=GM):
    return prior[0] + deviations * prior[1], prior


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize(
    ("before", "after", "leaves"),
    [(0.5, 8.0, True), (0.5, 3.4, False), (0.5, 3.6, True), (5.0, 7.9, False), (8.0, 0.5, False)],
)
def test_a_number_leaves_what_is_known_by_three_deviations_more(before, after, leaves, side):
    old, new = (with_known(fit(0.1), GM=off(side * z)) for z in (before, after))
    assert leaves_priors(old, new) is leaves


def test_what_was_off_to_the_other_side_does_not_leave():
    old, new = (with_known(fit(0.1), GM=off(z)) for z in (-4.0, 6.0))
    assert not leaves_priors(old, new)


@pytest.mark.parametrize(
    ("prior", "sure"), [(GM, True), (GUESSED, False), ((1.0, SURE), False), ((1.0, 0.19), True)]
)
def test_only_what_is_known_to_a_fifth_denies_a_name(prior, sure):
    old, new = with_known(fit(0.1), N=off(0.0, prior)), refit("drag", 0.5, 0.06)
    with_known(new.fit, N=off(-8.0, prior))
    assert leaves_priors(old, new.fit)
    assert leaves_priors(old, new.fit, SURE) is sure
    assert objection(old, new, 0.05) == (ELSEWHERE if sure else "")
    assert (likeliest_refit(old, [new], 0.05) is None) is sure


def test_a_sensors_number_is_none_of_hers():
    old, new = (with_known(fit(0.1), GM=off(z)) for z in (0.0, 8.0))
    new.problem.unknowns[0].kind = "nuisance"
    assert not leaves_priors(old, new)


def test_an_effects_own_number_may_be_as_no_ship_has_it():
    """It has a name where nothing else does nearly as much, and none beside what does."""
    before = fit(0.1)
    far, near, little = (refit(n, r, 0.06) for n, r in (("far", 0.16), ("near", 0.18), ("l", 0.5)))
    with_known(far.fit, Yphiauv=off(-4.1, (8e-3, 8e-3)))
    assert choose_best(before, [far], 0.05, False) is far
    assert choose_best(before, [far, little], 0.05, False) is far
    assert choose_best(before, [far, near, little], 0.05, False) is near
    assert likeliest_refit(before, [far, near, little], 0.05) is near
    with_known(far.fit, Yphiauv=off(-2.0, (8e-3, 8e-3)))
    assert choose_best(before, [far, near, little], 0.05, False) is far
