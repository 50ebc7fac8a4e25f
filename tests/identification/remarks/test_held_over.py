"""A rudder that is held over all the time is a manoeuvre, one that keeps a course is none."""

from dataclasses import replace

import numpy as np
import pytest
from s175q import MODEL, OUTPUTS, SHAFT, white, with_noise

from trialid.identification.fit import identify
from trialid.identification.no_manoeuvre import no_manoeuvre
from trialid.identification.problem import Settings
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial

SETTINGS = Settings(("Nv", "Nr", "Ndelta"), OUTPUTS, nuisance=("initial_state",))


def sailed(delta):
    """Her record with this rudder [rad], a sample in half a second."""
    n = len(delta)
    signals = {"delta": delta, "n": np.full(n, SHAFT), "r": np.zeros(n), "phi": np.zeros(n)}
    blank = Trial("a", "fit", 0.5, dict(signals), {k: np.ones(n, np.bool_) for k in signals})
    y = respond(prepare(MODEL, (), OUTPUTS), blank, {}, {"u": 7.33}, sensitivities=False).y
    made = replace(blank, signals={**signals, "r": y[:, 0].copy(), "phi": y[:, 1].copy()})
    return with_noise(made, *white(np.random.default_rng(4140), n))


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("zero", [0.0, 3.0])
def test_a_turning_circle_is_a_manoeuvre(side, zero):
    """`no fit`, cut out [0, 100] s: which then was too short, as were 390 and 440."""
    delta = np.deg2rad(zero + side * 15.0 * np.clip((np.arange(1800) - 40) / 10.0, 0.0, 1.0))
    assert no_manoeuvre(identify([sailed(delta)], MODEL, SETTINGS)) is None


@pytest.mark.parametrize("zero", [0.0, 3.0])
def test_a_turn_in_a_voyage_that_keeps_its_course_is_cut_out(zero):
    rng, delta = np.random.default_rng(4141), np.full(6000, np.deg2rad(zero))
    delta += np.deg2rad(0.2) * np.repeat(rng.normal(size=300), 20)
    delta[3000:3100] += np.deg2rad(15.0)
    found = no_manoeuvre(identify([sailed(delta)], MODEL, SETTINGS))
    assert found.reason.startswith("she manoeuvres in less than a tenth of a: in the rest")
    assert "window = [1440, 16" in found.advice
