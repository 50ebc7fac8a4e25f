"""Omitted-variable bias: what linearisation foresees is what the refit does, for small effects."""

from dataclasses import replace

import numpy as np
import pytest
from s175q import MODEL, SETTINGS, white, with_noise, zigzag

from trialid.diagnosis.search.bias import foresee_adding, foresee_dropping
from trialid.effects import CATALOGUE
from trialid.identification.fit import identify

FREE = ("Nv", "Nr", "Ndelta", "Yv", "Kr", "Kp", "GM")
EFFECT = CATALOGUE["quadratic_roll_damping"]
FIT = replace(SETTINGS, free=FREE)


def trials(size):
    """Two zig-zags in white noise, with an effect of this size in the ship."""
    truth = (MODEL + EFFECT).with_values({"Kpap": size})
    rng = np.random.default_rng(5)
    made = [zigzag(amplitude, truth) for amplitude in (10, 20)]
    return [with_noise(trial, *white(rng, trial.samples)) for trial in made]


def pair(record, priors=None):
    """The fit without the effect and the one with it."""
    settings = replace(FIT, priors=priors or {})
    without = identify(record, MODEL, settings)
    wider = replace(settings, free=(*FREE, "Kpap"))
    return without, identify(record, MODEL + EFFECT, wider, near=without.estimates)


@pytest.mark.parametrize("priors", [None, {"Kp": (-7e-6, 2e-7), "GM": (0.3, 0.001)}])
def test_what_adding_moves_is_foreseen(priors):
    without, with_it = pair(trials(-3e-5), priors)
    foreseen = foresee_adding(without, EFFECT)
    assert foreseen.values["Kpap"] == pytest.approx(with_it.value("Kpap"), rel=0.1)
    assert foreseen.eps_rmsn == pytest.approx(with_it.eps_rmsn, rel=1e-3)
    agree(foreseen, without, with_it)


def agree(foreseen, before, after):
    """Moves relative to the parameter, to 15 % of the largest one."""
    moves = {n: (after.value(n) - before.value(n)) / before.value(n) for n in FREE}
    ahead = {n: foreseen.moves[n] / before.value(n) for n in FREE}
    assert ahead == pytest.approx(moves, abs=0.15 * max(map(abs, moves.values())))


def test_what_dropping_moves_is_foreseen():
    without, with_it = pair(trials(-3e-5))
    foreseen = foresee_dropping(with_it, EFFECT)
    assert foreseen.values == {"Kpap": 0.0}
    assert set(foreseen.moves) == {x.name for x in without.problem.unknowns}
    assert foreseen.eps_rmsn == pytest.approx(without.eps_rmsn, rel=1e-3)
    agree(foreseen, with_it, without)


def test_an_effect_that_was_held_is_foreseen_to_go():
    """Its parameters are no unknowns of the fit, so that their columns are made for it."""
    model = (MODEL + EFFECT).with_values({"Kpap": -3e-5})
    record = trials(-3e-5)
    held, without = identify(record, model, FIT), identify(record, MODEL, FIT)
    foreseen = foresee_dropping(held, EFFECT)
    assert foreseen.eps_rmsn == pytest.approx(without.eps_rmsn, rel=1e-3)
    agree(foreseen, held, without)


def test_the_bias_is_none_where_the_effect_leaves_no_trace_in_the_parameters():
    """A column at a right angle to all others moves nothing; a copy of one takes all of it."""
    from trialid.diagnosis.search.bias import _mimicked

    psi = np.eye(4)[:, :2]
    assert _mimicked(psi, np.array([[0.0], [0.0], [1.0], [0.0]])) == pytest.approx(0.0)
    assert _mimicked(psi, 3.0 * psi[:, 1:]).ravel() == pytest.approx([0.0, 3.0])


def test_what_is_not_linear_is_said():
    without, _ = pair(trials(-3e-5))
    assert isinstance(foresee_adding(without, CATALOGUE["rudder_servo"]), str)
    assert "not linear" in foresee_dropping(without, CATALOGUE["rudder_servo"])
    assert "not an output" in foresee_adding(without, CATALOGUE["bias_psi"])
    settings = replace(FIT, nuisance=("initial_state", "rudder_offset"))
    nuisance = identify(trials(-3e-5), MODEL, settings)
    assert "nuisance" in foresee_adding(nuisance, CATALOGUE["rudder_offset"])
