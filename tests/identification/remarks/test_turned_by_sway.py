"""A rudder whose own yaw moment is of the other sign turns her all the same where sway does it."""

from dataclasses import replace

import numpy as np
import pytest
from s175q import MODEL, SETTINGS, white, with_noise, zigzag

from trialid.identification.file_of_ship import steers_backwards, turned_by_rudder
from trialid.identification.fit import identify


def noisy(angle, model):
    trial = zigzag(angle, model)
    return with_noise(trial, *white(np.random.default_rng(angle), trial.samples))


def test_by_a_side_force_that_the_water_couples_she_turns_as_she_should():
    """An outsider's boat: her Ndelta alone was of the other sign, and her sides were doubted."""
    coupled = replace(MODEL, ship=replace(MODEL.ship, mass={**MODEL.ship.mass, "Nvdot": -0.004}))
    coupled = coupled.with_values({"Ndelta": -0.1 * MODEL.value("Ndelta")})
    trials = [noisy(angle, coupled) for angle in (10, 20)]
    assert np.corrcoef(trials[0].signals["delta"][:60], trials[0].signals["r"][:60])[0, 1] > 0.5
    fit = identify(trials, coupled, replace(SETTINGS, free=("Nr", "Ndelta")))
    assert fit.value("Ndelta") == pytest.approx(coupled.value("Ndelta"), rel=0.2)
    assert turned_by_rudder(fit) > 0.0
    assert not steers_backwards(fit)
