"""A ship that was let go has no input: what is left of her roll depends on none."""

import pytest
from decays import Roller

from trialid.diagnosis.noise.split import INPUT_DRIVEN, split
from trialid.diagnosis.search.augment import augment
from trialid.effects import CATALOGUE
from trialid.workflow.notebook.front import diagnose

ASKED = {n: CATALOGUE[n] for n in ("heel_roll", "still_water_roll_damping", "righting_arm_cubic")}


def fitted(seed, **her):
    of = Roller(length=90.0, GM=0.7, ratio=0.03, **her)
    return of.fit(of.decays(seed, speed=4.0))


@pytest.mark.parametrize("square", [0.0, 0.3])
def test_no_noise_is_told_by_an_input_that_there_is_not(square):
    fit = fitted(21, square=square)
    _, routes = split(fit, augment(fit, ASKED), {})
    [by_input] = [r for r in routes if r.method == INPUT_DRIVEN]
    assert not by_input.available
    assert "nothing that was recorded drives her" in by_input.why


def test_where_no_noise_is_told_a_hundredth_is_not_little():
    """Noise of the sensors alone, 1.1 % of what she rolls, and nothing says so."""
    found = diagnose(fitted(22))
    assert 0.01 < found.fit.eps_rmsn < 0.015
    assert (found.verdict.kind, found.verdict.effect) == ("cannot tell", None)


def test_where_much_is_left_it_is_not_said():
    """Damping by the square that nobody asks for."""
    verdict = diagnose(fitted(23, square=0.4), candidates=ASKED).verdict
    assert verdict.kind != "nothing missing"
