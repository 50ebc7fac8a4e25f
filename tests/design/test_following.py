from dataclasses import replace

import numpy as np
import pytest
from s175q import MODEL, OUTPUTS, SHAFT, with_noise, zigzag
from waters import NOISE, SPEED, D

from trialid.accuracy.parameter_table import Subject, assess
from trialid.design import following
from trialid.design.helm import carry_out
from trialid.design.imo import observed
from trialid.design.manoeuvres import zigzag as ordered
from trialid.design.standard import predict
from trialid.diagnosis.may_be_off import doubts
from trialid.diagnosis.noise.split import split
from trialid.diagnosis.search.augment import augment
from trialid.diagnosis.trust import accuracy_of
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


def examined(fit, catalogue):
    """The standard measures of a fit by name, and the covariance of its unknowns by noise."""
    augmented = augment(fit, catalogue)
    off = doubts(augmented)
    parts, _ = split(fit, augmented, {})
    covariance = accuracy_of(fit, parts, off.averaged).covariance
    found = following.standard_measures(fit, covariance, off.standing, off.held, off.missing)
    return {m.criterion.name: m for m in found}, covariance


def width(measure):
    return float(np.ptp(measure.interval))


@pytest.fixture(scope="module")
def whole(fit):
    """The measures of the fit, whatever of the catalogue may be missing."""
    return examined(fit, CATALOGUE)[0]


@pytest.fixture(scope="module")
def alone(fit):
    """The same with nothing that may be missing and all that is held fixed exact."""
    model = fit.problem.simulator.model
    exact = replace(model, ship=replace(model.ship, uncertainty={"default": 0.0}))
    simulator = replace(fit.problem.simulator, model=exact)
    return examined(replace(fit, problem=replace(fit.problem, simulator=simulator)), {})


def test_a_fitted_ship_is_sailed_with_the_engine_of_her_trial(fit):
    ready = following.vessel_of(fit)
    assert ready.constants["n"] == pytest.approx(SHAFT)
    assert ready.constants["u"] == SPEED
    assert "delta" not in ready.constants
    assert ready.rudder_rate == pytest.approx(2.5 * D, rel=0.01)


@pytest.mark.study(turn=11)
def test_the_interval_holds_what_the_true_ship_does(fit, whole):
    """Ten degrees of rudder were sailed: a circle of 35 is foretold from far off."""
    for one in predict([following.vessel_of(fit, MODEL)]):
        low, high = whole[one.criterion.name].interval
        assert low < one.value < high
        assert low < whole[one.criterion.name].value < high
    assert width(whole["first overshoot 10/10"]) < 1.0
    wide, narrow = whole["tactical diameter"], whole["initial turning"]
    assert width(wide) / wide.value > 2.0 * width(narrow) / narrow.value
    assert whole["advance"].kept


@pytest.mark.study(turn=10)
def test_with_nothing_else_to_be_wrong_it_is_what_noise_leaves(fit, alone):
    """Against 50 ships drawn from the covariance of the parameters, each sailed."""
    found, covariance = alone
    draw, drawn = np.random.default_rng(1), []
    for moved in draw.multivariate_normal(fit.theta, covariance, 50):
        values = {n: float(moved[i]) for i, n in enumerate(FREE)}
        ship = following.vessel_of(fit, MODEL.with_values(values))
        drawn.append([m.value for m in predict([ship])])
    for one, values in zip(found.values(), np.transpose(drawn), strict=True):
        assert width(one) == pytest.approx(2 * 1.96 * np.std(values, ddof=1), rel=0.3)


def test_what_may_be_missing_widens_it(whole, alone):
    """More where the missing acts, in the circle, than where the trial has seen the ship."""
    grown = {n: width(m) / width(alone[0][n]) for n, m in whole.items()}
    assert min(grown.values()) > 1.0
    assert grown["tactical diameter"] > 1.5 * grown["first overshoot 10/10"]


def test_a_trial_is_proposed_that_tells_more_than_the_one_there_is(fit):
    pair = following.by_name(CATALOGUE, ["rudder_offset", "propeller_side_force"])
    proposal = following.next_trial(fit, pair, {c: n.sigma for c, n in NOISE.items()})
    assert proposal.after.cosine < proposal.before.cosine
    assert proposal.separate
    assert proposal.programme[0].name in following.FEASIBLE


def test_the_trial_with_the_most_evidence_is_proposed(fit, monkeypatch):
    """Not the one in which they look least alike: what is small in it is hidden by noise."""
    pair = following.by_name(CATALOGUE, ["yaw_drag_rar", "yaw_cubic_rrr"])
    noise = {c: n.sigma for c, n in NOISE.items()}
    proposal, alone = following.next_trial(fit, pair, noise), []
    for test in following.FEASIBLE.items():
        monkeypatch.setattr(following, "FEASIBLE", dict([test]))
        alone.append(following.next_trial(fit, pair, noise))
    by_odds = {x.programme[0].name: min(x.after.odds) for x in alone if x}
    by_cosine = {x.programme[0].name: -x.after.cosine for x in alone if x}
    assert proposal.programme[0].name == max(by_odds, key=by_odds.__getitem__)
    assert proposal.programme[0].name != max(by_cosine, key=by_cosine.__getitem__)


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
    said = f" would narrow that most, to about {found.share:.0%} of its width."
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
