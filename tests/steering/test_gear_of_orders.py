"""A steering gear is fitted from where the model began: a hull fitted without it may be none."""

from dataclasses import replace

import numpy as np
import pytest
from s175q import MODEL, SETTINGS, white, with_noise, zigzag

from trialid.diagnosis.search.refit import moves_rudder, refit
from trialid.diagnosis.search.score import rank
from trialid.effects import CATALOGUE
from trialid.identification.fit import Fit, identify
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial

GEAR = CATALOGUE["rudder_servo_limited"]
HULL = replace(MODEL, values={**MODEL.values, "Nv": 0.8 * MODEL.value("Nv")})
RATE = np.deg2rad(2.0)


def ordered(angle: int) -> Trial:
    """A zig-zag of which the order alone is recorded; the gear is slow."""
    recorded = zigzag(angle)
    asked = recorded.signals.pop("delta")
    signals = {**recorded.signals, "delta_order": asked}
    given = replace(recorded, signals=signals, valid=dict.fromkeys(signals, recorded.valid["r"]))
    ship = (MODEL + GEAR).with_values({"T_servo": 1.0, "rate_max": RATE})
    y = respond(prepare(ship, (), ("r", "phi")), given, {}, {"u": 7.33}, sensitivities=False).y
    made = replace(given, signals={**given.signals, "r": y[:, 0].copy(), "phi": y[:, 1].copy()})
    return with_noise(made, *white(np.random.default_rng(angle), made.samples))


@pytest.fixture(scope="module")
def astray() -> Fit:
    """A search that ended where the rudder turns her the wrong way."""
    settings = replace(SETTINGS, free=("Nv", "Nr", "Ndelta", "Yv"))
    fit = identify([ordered(10), ordered(20)], HULL, settings)
    turned = [-1.0 if x.name == "Ndelta" else 1.0 for x in fit.problem.unknowns]
    model = fit.model.with_values({"Ndelta": -fit.value("Ndelta")})
    return replace(fit, theta=fit.theta * turned, model=model)


def test_a_gear_is_found_where_the_hull_without_it_is_none(astray: Fit) -> None:
    assert moves_rudder(GEAR)
    ranking, _ = rank(astray, {GEAR.name: GEAR})
    [found] = refit(astray, ranking, lambda words: None)
    assert found.fit.converged
    assert found.fit.value("rate_max") == pytest.approx(RATE, rel=0.05)
    assert found.fit.value("Nv") == pytest.approx(MODEL.value("Nv"), rel=0.1)
