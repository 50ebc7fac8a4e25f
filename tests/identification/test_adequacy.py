"""A fit that carries no verdict says so with its first reason, and a sound one says nothing."""

from dataclasses import replace

import numpy as np
import pytest
from s175q import MODEL, white, with_noise, zigzag

from trialid.effects import CATALOGUE
from trialid.identification.adequacy import (
    SLOWEST_TIMES,
    UNEXPLAINED,
    why_no_fit,
)
from trialid.identification.file_of_ship import steers_backwards, turned_by_rudder
from trialid.identification.fit import identify
from trialid.identification.no_manoeuvre import RUDDER_RANGE
from trialid.identification.problem import Settings
from trialid.identification.remarks import remarks
from trialid.identification.time_scales import slowest_motion
from trialid.trial import Trial

FEW = ("Nv", "Nr", "Ndelta", "Kdelta", "Kp")
SETTINGS = Settings(FEW, ("r", "phi"), nuisance=("initial_state",))


def noisy(trial, seed):
    return with_noise(trial, *white(np.random.default_rng(seed), trial.samples))


def cut(trial, seconds, begin=0.0):
    a, b = round(begin / trial.period), round((begin + seconds) / trial.period)
    signals = {n: y[a:b].copy() for n, y in trial.signals.items()}
    return Trial(trial.name, trial.use, trial.period, signals,
                 {n: np.ones(b - a, dtype=bool) for n in signals})  # fmt: skip


def with_signals(trial, **changed):
    return replace(trial, signals={**trial.signals, **changed})


@pytest.fixture(scope="module")
def sound():
    held = noisy(zigzag(5, use="check"), 2)
    return identify([noisy(zigzag(10), 1), held], MODEL, SETTINGS)


def test_a_sound_fit_is_not_objected_to(sound):
    assert why_no_fit(sound) is None
    assert remarks(sound) == ()


def test_a_zigzag_of_two_degrees_is_a_manoeuvre():
    assert why_no_fit(identify([noisy(zigzag(2), 3)], MODEL, SETTINGS)) is None


def test_a_rudder_that_keeps_a_course_is_no_manoeuvre():
    small = zigzag(10)
    small = with_signals(small, delta=small.signals["delta"] * 0.04)
    found = why_no_fit(identify([noisy(small, 4)], MODEL, SETTINGS))
    assert "never manoeuvres: the rudder moves by 0.8 deg" in found.reason
    assert "zig-zag" in found.advice


def test_a_ship_that_lies_still_while_the_helm_is_tried_never_moves():
    trial = zigzag(10)
    still = with_noise(
        with_signals(trial, r=np.zeros(trial.samples), phi=np.zeros(trial.samples)),
        *white(np.random.default_rng(5), trial.samples),
    )
    assert "never moves: r and phi" in why_no_fit(identify([still], MODEL, SETTINGS)).reason


@pytest.mark.study(turn=8)
def test_a_motion_that_is_not_the_rudders_is_not_explained():
    """A slow wander of the heading under a rudder that has nothing to do with it."""
    trial = zigzag(10)
    wander = 0.01 * np.sin(0.013 * trial.t + 1.0) * np.cos(0.0041 * trial.t)
    moved = with_noise(
        with_signals(trial, r=wander, phi=3.0 * wander),
        *white(np.random.default_rng(6), trial.samples),
    )
    fit = identify([moved], MODEL, SETTINGS)
    found = why_no_fit(replace(fit, converged=True))
    assert "explains too little" in found.reason
    assert "% of r" in found.reason


@pytest.mark.parametrize(("share", "refused"), [(0.6, False), (1.6, True)])
def test_half_of_the_variance_is_the_line(sound, share, refused):
    """The same fit with another error laid over it, a little below and above the line."""
    [fitted, _] = sound.scores
    y = np.column_stack([fitted.trial.signals[c] for c in ("r", "phi")])
    spread = np.std(y, axis=0) * np.sqrt(UNEXPLAINED * share)
    wave = np.sqrt(2.0) * np.sin(0.05 * fitted.trial.t)[:, None] * spread
    worse = replace(fitted.response, y=fitted.response.y + wave)
    fit = replace(sound, scores=(replace(fitted, response=worse),))
    assert (why_no_fit(fit) is not None) == refused


@pytest.mark.parametrize("follows", [0.0, 0.6])
def test_a_search_that_found_nothing_says_so_and_asks_for_no_better_start(sound, follows):
    """The failed search's answer is a constant, or goes with the ship in part."""
    [fitted, _] = sound.scores
    y = fitted.response.y
    part = replace(fitted.response, y=follows * y + (1.0 - follows) * np.mean(y, axis=0))
    failed = replace(sound, scores=(replace(fitted, response=part),))
    found = why_no_fit(replace(failed, converged=False, reason="iterations"))
    assert "did not converge" in found.reason
    assert ("nothing better than a constant" in found.reason) == (follows == 0.0)
    assert ("start nearer" in found.advice) == (follows > 0.0)


def test_a_record_that_ends_before_she_has_settled_is_too_short():
    model = MODEL
    whole = noisy(zigzag(10), 7)
    settings = replace(SETTINGS, free=("Ndelta", "Kdelta"))
    slow = slowest_motion(identify([whole], model, settings), 0).seconds
    for factor, refused in ((0.9, True), (1.2, False)):
        piece = cut(whole, factor * SLOWEST_TIMES * slow, begin=60.0)
        fit = replace(identify([piece], model, settings), converged=True)
        found = why_no_fit(fit)
        assert ("too short" in str(found)) == refused, (factor, found)


def at_speed(trial, speed):
    u, known = np.full(trial.samples, speed), np.ones(trial.samples, np.bool_)
    return replace(trial, signals={**trial.signals, "u": u}, valid={**trial.valid, "u": known})


@pytest.mark.parametrize("first", ["circle", "zigzag"])
def test_a_slower_trial_beside_it_makes_no_record_too_short(first):
    """A turning circle halves her speed, and comes first by its name."""
    whole = noisy(zigzag(10), 7)
    settings = replace(SETTINGS, free=("Ndelta", "Kdelta"))
    slow = slowest_motion(identify([whole], MODEL, settings), 0).seconds
    piece = cut(whole, 1.2 * SLOWEST_TIMES * slow, begin=60.0)
    approach = MODEL.ship.particulars["U0"]
    piece, slower = at_speed(piece, approach), replace(at_speed(piece, approach / 2), name="circle")
    trials = [slower, piece] if first == "circle" else [piece, slower]
    fit = replace(identify(trials, MODEL, settings), converged=True)
    assert "too short" not in str(why_no_fit(fit))
    alone = replace(identify([slower], MODEL, settings), converged=True)
    assert "too short" in str(why_no_fit(alone))


def test_the_slowest_motion_is_that_of_the_equations():
    """Yaw alone, by hand: (I_zz - Nrdot) dr/dt = Nr r, in prime units of L / U."""
    effects = tuple(e for e in MODEL.effects if e.name in ("linear_hull", "linear_rudder"))
    yaw = replace(MODEL, states=("r",), effects=effects, values={"Nr": -0.004})
    trial = zigzag(10)
    trial = with_signals(trial, u=np.full(trial.samples, 7.33), v=np.zeros(trial.samples))
    fit = identify([trial], yaw, Settings(("Ndelta",), ("r",), nuisance=("initial_state",)))
    by_hand = (0.000456 + 0.000419) / 0.004 * 175.0 / 7.33
    assert slowest_motion(fit, 0).seconds == pytest.approx(by_hand, rel=0.01)


def test_a_search_that_stopped_early_is_no_fit():
    trial = noisy(zigzag(10), 8)
    model = MODEL.with_values({"Nr": -0.02, "Nv": -0.02})
    fit = identify([trial], model, replace(SETTINGS, max_iterations=1))
    found = why_no_fit(fit)
    assert not fit.converged
    assert "did not converge" in found.reason
    assert f"{fit.eps_rmsn:.1%}" in found.reason


def test_a_held_out_trial_that_diverges_is_named(sound):
    """The fitted ship with a righting moment the wrong way round capsizes there."""
    from trialid.identification.trial_score import score_trial

    theta = sound.theta.copy()
    theta[FEW.index("Kp")] = 0.01
    lost = score_trial(replace(sound, theta=theta), sound.scores[1].trial)
    assert lost.response.departure is not None
    found = why_no_fit(replace(sound, scores=(sound.scores[0], lost)))
    assert "held-out trial 'zigzag-5' diverges" in found.reason


def test_a_held_out_trial_with_its_rudder_the_wrong_way_is_foretold_worse_than_by_nothing(sound):
    trial = noisy(zigzag(5, use="check"), 9)
    wrong = with_signals(trial, delta=-trial.signals["delta"])
    fit = identify([sound.scores[0].trial, wrong], MODEL, SETTINGS)
    assert "foretold worse than by no model" in why_no_fit(fit).reason


def test_every_reason_is_one_finite_line(sound):
    lost = replace(sound, converged=False, reason="iterations")
    for words in (str(why_no_fit(lost)), *remarks(lost)):
        assert "\n" not in words
        assert "nan" not in words
        assert "inf" not in words.split()


def test_a_bound_is_remarked_as_the_bounds_value():
    settings = replace(SETTINGS, bounds={"Kp": (-0.000006, 0.0)})
    fit = identify([noisy(zigzag(10), 10)], MODEL.with_values({"Kp": -0.000005}), settings)
    assert set(fit.at_bounds) == {"Kp"}
    assert any("Kp ended at its bound -6e-06" in line for line in remarks(fit))


def test_damping_that_would_drive_her_on_is_remarked(sound):
    """Of either kind, and neither where it holds her back."""
    assert not any("drive her on" in line for line in remarks(sound))
    places = [x.name for x in sound.problem.unknowns]
    for name in ("Nr", "Nv"):  # what drifting does to her course may have either sign
        theta = sound.theta.copy()
        theta[places.index(name)] *= -1.0
        said = [line for line in remarks(replace(sound, theta=theta)) if "drive her on" in line]
        assert [line.partition(" ")[0] for line in said] == ["Nr"] * (name == "Nr")


def test_a_rudder_that_is_off_amidships_in_all_trials_is_remarked():
    """Of a single-screw ship one overshoot is twice the other, and predictions have them alike."""
    settings = replace(SETTINGS, nuisance=("initial_state", "rudder_offset"))
    for off, said in ((-1.5, True), (0.0, False)):
        trials = [noisy(zigzag(10), 21), noisy(zigzag(20), 22)]
        turned = [with_signals(one, delta=one.signals["delta"] - np.deg2rad(off)) for one in trials]
        lines = [x for x in remarks(identify(turned, MODEL, settings)) if "rudder's zero" in x]
        assert bool(lines) is said
        assert not said or "the rudder's zero is -1.5 deg in all trials" in lines[0]


def test_a_delay_unlike_others_comes_back_and_is_remarked():
    """Four standard deviations of what is likely: the record overrules, and it is said."""
    trial = noisy(zigzag(10), 10)
    late = with_signals(trial, phi=np.interp(trial.t - 2.0, trial.t, trial.signals["phi"]))
    fit = identify([late], MODEL, replace(SETTINGS, nuisance=("initial_state", "delay")))
    assert fit.value("tau_phi [zigzag-10]") == pytest.approx(2.0, abs=0.1)
    assert set(fit.contradicted) == {"tau_phi [zigzag-10]"}
    assert any("tau_phi [zigzag-10] = " in line and "above" in line for line in remarks(fit))


def test_a_rudder_that_turns_her_the_wrong_way_is_no_fit(sound):
    """Whatever her file is; a coefficient that may be of either sign says nothing."""
    trial = noisy(zigzag(10), 13)
    turned = with_signals(trial, delta=-trial.signals["delta"])
    backwards = identify([turned], MODEL, SETTINGS)
    assert backwards.value("Ndelta") < 0.0 < sound.value("Ndelta")
    found = why_no_fit(replace(backwards, converged=True))
    assert found.reason.startswith("the rudder as fitted turns her the wrong way")
    begun = replace(MODEL, ship=replace(MODEL.ship, source="PLACEHOLDER: of another length"))
    assert "turns her the wrong way" in str(why_no_fit(identify([turned], begun, SETTINGS)))
    blind = with_signals(zigzag(10), delta=0.05 * zigzag(10).signals["delta"])
    assert not steers_backwards(identify([noisy(blind, 14)], MODEL, SETTINGS))


def test_by_a_race_that_grips_the_rudder_she_turns_as_she_should():
    """Her rudder's own coefficient is of the other sign there, as of a push that is turned."""
    racing = (MODEL + CATALOGUE["rudder_race_shaft"]).with_values(
        {"N_un": 0.0, "N_nn": 8e-8, "z_race": 0.0, "Ndelta": -0.3 * MODEL.value("Ndelta")}
    )
    trials = [noisy(zigzag(angle, racing), angle) for angle in (10, 20)]
    settings = replace(SETTINGS, free=("Nr", "Ndelta", "N_nn"))
    fit = identify(trials, replace(racing, values={**racing.values, "Ndelta": 0.0}), settings)
    assert fit.value("Ndelta") == pytest.approx(racing.value("Ndelta"), rel=0.1)
    assert turned_by_rudder(fit) > 0.0
    assert not steers_backwards(fit)
    assert why_no_fit(fit) is None


@pytest.mark.study
def test_another_ships_file_is_noticed():
    """The container ship's zig-zags as if a ship of a third of her length had sailed them."""
    ship = MODEL.ship
    particulars = {**ship.particulars, "L": 60.0, "nabla": 21222.0 * (60.0 / 175.0) ** 3}
    short = replace(MODEL, ship=replace(ship, particulars=particulars, name="another"))
    settings = replace(SETTINGS, free=("Nv", "Nr", "Ndelta", "Kv", "Kr", "Kdelta", "Kp", "GM"))
    trials = [noisy(zigzag(10), 11), noisy(zigzag(20), 12)]
    wrong = replace(identify(trials, short, settings), converged=True)
    found = why_no_fit(wrong)
    assert "the ship as fitted is not the one of her file" in found.reason
    assert why_no_fit(identify(trials, MODEL, settings)) is None
    says_so = replace(short.ship, source="PLACEHOLDER: of another length")
    begun = identify(trials, replace(short, ship=says_so), settings)
    assert "as fitted" not in str(why_no_fit(replace(begun, converged=True)))


def test_a_voyage_of_few_manoeuvres_says_where_they_are(sound):
    """Half an hour of helm in a day; a few outliers are none."""
    samples, period = 86_400, 1.0
    t = np.arange(samples) * period
    delta = np.where((t > 30_000) & (t < 31_800), 0.2 * np.sign(np.sin(t / 60.0)), 0.0)
    delta[100:103] = 0.5
    day = Trial("day", "fit", period, {"delta": delta}, {})
    scores = (replace(sound.scores[0], trial=day), *sound.scores[1:])
    found = why_no_fit(replace(sound, scores=scores))
    assert found.reason.startswith("she manoeuvres in less than a tenth of day")
    assert "window = [40, 162], [29941, 31859] s from where its logs begin" in found.advice
    corrected = delta.copy()
    corrected[50_000:50_060] = 0.6 * RUDDER_RANGE  # her course corrected: no manoeuvre
    steered = replace(scores[0], trial=replace(day, signals={**day.signals, "delta": corrected}))
    assert why_no_fit(replace(sound, scores=(steered, *scores[1:]))) == found
    cut = (replace(scores[0], trial=replace(day, opening=500.0)), *scores[1:])
    found = why_no_fit(replace(sound, scores=cut))
    assert "window = [540, 662], [30441, 32359] s from where its logs begin" in found.advice
    still = replace(scores[0], trial=replace(day, signals={"delta": 0.05 * delta}))
    assert "never manoeuvres" in why_no_fit(replace(sound, scores=(still, scores[1]))).reason
