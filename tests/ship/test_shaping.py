"""What only shapes a product keeps its typical value, so that no effect of a user is lost by it."""

import inspect
from dataclasses import replace

import numpy as np
import pytest
from s175q import MODEL, white, with_noise, zigzag

from trialid.diagnosis.search.score import rank
from trialid.effects import CATALOGUE
from trialid.identification.fit import identify
from trialid.identification.problem import Settings
from trialid.ship.effect import Force, Parameter, Signal, effect
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial

HOOK = -60.0


@effect(source="tow log", system="SI")
def tow_line(tow=Signal("N"), *, x_hook=Parameter(-30.0, "m"), k_tow=Parameter(2.0)):
    """Y = k tow, N = x_hook k tow: the tow line."""
    return Force(Y=k_tow * tow, N=x_hook * k_tow * tow)


@effect(source="tow log", system="SI")
def tow_moment(tow=Signal("N"), *, x_line=Parameter(-30.0, "m"), k_line=Parameter(2.0)):
    """N = x_line k tow: a product alone."""
    return Force(N=x_line * k_line * tow)


@effect(source="made up")
def two_slopes(r, phi, *, N_a=0.01, N_b=-0.02):
    """N = N_a r + N_b phi."""
    return Force(N=N_a * r + N_b * phi)


def nulls(one):
    return {name: p.null for name, p in one.parameters.items()}


def test_a_place_beside_a_force_only_shapes_it():
    assert nulls(tow_line) == {"x_hook": None, "k_tow": 0.0}
    assert tow_line.nulls == {"x_hook": -30.0, "k_tow": 0.0}


def test_which_factor_of_a_product_alone_shapes_it_nobody_says():
    assert nulls(tow_moment) == {"x_line": 0.0, "k_line": 0.0}
    assert nulls(two_slopes) == {"N_a": 0.0, "N_b": 0.0}


def test_none_of_the_catalogue_needs_it():
    """They are written with what shapes them: `null=None` of each is stated."""
    for one in CATALOGUE.values():
        stated = inspect.signature(one.function).parameters
        written = {n: stated[n].default for n in one.parameters if n in stated}
        for name, given in written.items():
            if isinstance(given, Parameter):
                assert one.parameters[name].null == given.null


@pytest.fixture(scope="module")
def towed():
    """Zig-zags of a ship that is pulled to one side and the other, her log of that at hand."""
    made = []
    for angle in (10, 20):
        plain = zigzag(angle)
        t = np.arange(plain.samples) * plain.period
        pull = 3e5 * np.sign(np.sin(2.0 * np.pi * t / 170.0))
        signals = {**plain.signals, "tow": pull}
        ship = (MODEL + tow_line).with_values({"x_hook": HOOK, "k_tow": 1.0})
        blank = Trial(plain.name, "fit", plain.period, signals, plain.valid)
        motion = respond(prepare(ship, (), ("r", "phi")), blank, {}, {}, sensitivities=False).y
        sailed = replace(blank, signals={**signals, "r": motion[:, 0], "phi": motion[:, 1]})
        made.append(with_noise(sailed, *white(np.random.default_rng(angle), plain.samples)))
    settings = Settings(("Nv", "Nr", "Ndelta", "Kp"), ("r", "phi"), nuisance=("initial_state",))
    return identify(made, MODEL, settings)


def test_it_is_scored_and_what_cannot_be_is_told(towed):
    """An outsider's true effect of a tow line was tried by nobody, and nothing said so."""
    known = {**{n: CATALOGUE[n] for n in ("yaw_cubic_rrr", "lag_r")}, "tow_line": tow_line}
    ranking, _ = rank(towed, known)
    assert ranking[0].effect.name == "tow_line"
    assert ranking[0].p_value < 0.01
    ranking, augmented = rank(towed, {"tow_moment": tow_moment})
    assert ranking == ()
    said = (
        "x_line, k_line moves nothing that is compared; of a product write null=None to all but one"
    )
    assert augmented.left_out == {"tow_moment": said}
