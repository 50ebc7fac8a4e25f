from dataclasses import replace

import numpy as np
import pytest
from s175q import MODEL, OUTPUTS, SHAFT, with_noise, zigzag
from waters import NOISE, SPEED, D

from trialid.accuracy.parameter_table import Subject, assess
from trialid.design import following, measures, observed
from trialid.design.helm import carry_out
from trialid.design.manoeuvres import zigzag as ordered
from trialid.effects import CATALOGUE
from trialid.identification.fit import identify
from trialid.identification.output_error import stretches
from trialid.identification.problem import Settings

FREE = ("Nv", "Nr", "Ndelta", "Yv", "Ydelta")
ROUGH = Settings(FREE, OUTPUTS, nuisance=("initial_state",))


@pytest.fixture(scope="module")
def fit():
    rng = np.random.default_rng(2)
    trial = zigzag(10)
    noise = (NOISE[c].sigma * rng.standard_normal(trial.samples) for c in OUTPUTS)
    return identify([with_noise(trial, *noise)], MODEL, ROUGH)


def accuracy(fit):
    subjects = [
        Subject(x.name, x.kind, x.unit, float(a), x.size)
        for x, a in zip(fit.problem.unknowns, fit.theta, strict=True)
    ]
    return assess(subjects, fit.psi, fit.residual, stretches(fit.problem), 0.1, 0.0)


def test_a_fitted_ship_is_sailed_with_the_engine_of_her_trial(fit):
    ready = following.vessel_of(fit)
    assert ready.constants["n"] == pytest.approx(SHAFT)
    assert ready.constants["u"] == SPEED
    assert "delta" not in ready.constants
    assert ready.rudder_rate == pytest.approx(2.5 * D, rel=0.01)


def test_the_interval_holds_what_the_true_ship_does(fit):
    found = {m.criterion.name: m for m in following.standard_measures(fit, accuracy(fit), 0.0)}
    true = following.vessel_of(fit, MODEL)
    over = measures.overshoots(carry_out(true, ordered(10 * D, 10 * D, 4), 20.0, 1000.0))
    low, high = found["first overshoot 10/10"].interval
    assert low < over[0] / D < high
    assert high - low < 1.0
    assert found["advance"].kept


def test_a_model_error_widens_the_interval(fit):
    narrow, wide = (following.standard_measures(fit, accuracy(fit), e) for e in (0.0, 0.05))
    for one, other in zip(narrow, wide, strict=True):
        assert np.ptp(other.interval) > np.ptp(one.interval)
        assert np.ptp(other.interval) >= 2 * 1.96 * 0.05 * other.value * 0.99


def test_a_trial_is_proposed_that_tells_more_than_the_one_there_is(fit):
    pair = following.by_name(CATALOGUE, ["rudder_offset", "propeller_side_force"])
    proposal = following.next_trial(fit, pair, {c: n.sigma for c, n in NOISE.items()})
    assert proposal.after.cosine < proposal.before.cosine
    assert proposal.after.separate
    assert proposal.programme[0].name in following.FEASIBLE


def test_where_no_test_helps_it_is_said(fit):
    pair = following.by_name(CATALOGUE, ["delay_r", "lag_r"])
    proposal = following.next_trial(fit, pair, {c: n.sigma for c, n in NOISE.items()})
    assert not proposal.after.separate
    assert proposal.sentence.startswith("no feasible test separates")


def test_one_effect_needs_no_trial_to_tell_it_apart():
    assert following.by_name(CATALOGUE, ["lag_r"]) is None
    assert following.by_name(CATALOGUE, ["lag_r", "of my own"]) is None


def test_overshoots_of_a_recorded_zigzag(fit):
    found = observed.overshoots(fit)
    assert len(found) >= 8
    psi = np.cumsum(zigzag(10).signals["r"]) * 0.5
    for one in found:
        k = round(one.t / 0.5)
        beyond = np.sign(one.rudder) * (psi[k : k + 120] - psi[k])
        assert one.measured == pytest.approx(beyond.max(), abs=0.7 * D)  # of 5; noise, integrated
        assert one.predicted == pytest.approx(one.measured, abs=0.7 * D)


def test_a_steady_turn_has_no_overshoot():
    passage = carry_out(
        following.vessel_of(identify([zigzag(10)], MODEL, ROUGH)),
        ordered(10 * D, 900.0, 1),
        20,
        300,
    )
    fit = identify([passage.trial], MODEL, Settings(("Nr",), OUTPUTS))
    assert observed.overshoots(fit) == ()


def test_the_trial_that_narrows_a_range_does_so_when_it_is_sailed(fit):
    """About the share foretold, by the errors of two fits with the effect in the model.

    Nr beside a missing cubic yaw damping, known beforehand to twice its typical size: ten degrees
    tell hardly which of the two it is.
    """
    effect = CATALOGUE["yaw_cubic_rrr"]
    noise = {c: NOISE[c].sigma for c in OUTPUTS}
    found = following.narrowing_trial(fit, "Nr", effect, noise)
    assert found.share < 0.6
    said = f" would narrow that most, to about {found.share:.0%}."
    assert found.sentence.lower() == found.test + said
    ready = following.vessel_of(fit)
    sailed = {test.name: trial for test, trial in following._feasible(fit, ready)}
    size = abs(effect.parameters["Nrrr"].start)
    wider = replace(ROUGH, free=(*FREE, "Nrrr"), priors={"Nrrr": (0.0, 2.0 * size)})
    rng, errors = np.random.default_rng(5), {}
    for name in (None, found.test, "zig-zag 5/5"):
        trials = list(fit.problem.trials)
        if name:
            blurred = (NOISE[c].sigma * rng.standard_normal(sailed[name].samples) for c in OUTPUTS)
            trials.append(with_noise(sailed[name], *blurred))
        again = identify(trials, fit.model + effect, wider, near={**fit.estimates, "Nrrr": 0.0})
        errors[name] = row_error(again, "Nr")
    assert errors[found.test] / errors[None] == pytest.approx(found.share, rel=0.05)
    assert errors[found.test] < errors["zig-zag 5/5"]


def row_error(fit, name):
    """Standard error of a parameter by the white formula, priors counted."""
    subjects = [
        Subject(x.name, x.kind, x.unit, float(a), x.size, x.prior and x.prior[1])
        for x, a in zip(fit.problem.unknowns, fit.theta, strict=True)
    ]
    known = {"noise": 0.1, "undermodelling": 0.0, "level": fit.level}
    rows = assess(subjects, fit.psi, fit.residual, stretches(fit.problem), **known).parameters
    return next(r.white_error for r in rows if r.name == name)


def test_an_effect_that_is_not_linear_at_its_null_is_not_foretold(fit):
    noise = {c: NOISE[c].sigma for c in OUTPUTS}
    assert following.narrowing_trial(fit, "Nr", CATALOGUE["rudder_backlash"], noise) is None
    assert following.narrowing_trial(fit, "GM", CATALOGUE["yaw_cubic_rrr"], noise) is None
