"""The split of the error: found where noise and model error are known."""

from dataclasses import replace

import numpy as np
import pytest
from s175q import MODEL, SETTINGS, waves, white, with_noise, zigzag

from trialid.diagnosis.noise.excitation import QUIET_ANGLE, period_of
from trialid.diagnosis.noise.split import INPUT_DRIVEN, split
from trialid.diagnosis.search.augment import augment
from trialid.effects import CATALOGUE
from trialid.identification.fit import identify
from trialid.trial import Trial

HIDDEN = CATALOGUE["righting_arm_cubic"]
TRUTH = (MODEL + HIDDEN).with_values({"GM3": 8.0})
FREE = ("Nv", "Nr", "Ndelta", "Yv", "Kv", "Kr", "Kdelta", "Kp", "GM", "Nrar")
FIT = replace(SETTINGS, free=FREE)
FIT_ADDED = replace(SETTINGS, free=(*FREE, "GM3"))
QUIET = 240  # samples before the manoeuvre


def with_approach(trial):
    """The trial with two minutes of straight course before it."""
    signals = {n: np.concatenate([np.full(QUIET, s[0]), s]) for n, s in trial.signals.items()}
    valid = {n: np.ones(len(s), dtype=bool) for n, s in signals.items()}
    return Trial(trial.name, trial.use, trial.period, signals, valid)


CLEAN = {hidden: [with_approach(zigzag(a, model)) for a in (10, 20)]
         for hidden, model in ((True, TRUTH), (False, MODEL))}  # fmt: skip


def noisy(trials, kind, seed):
    rng = np.random.default_rng(seed)
    return [with_noise(t, *kind(rng, t.samples)) for t in trials]


def normed_noise(trials, clean, y_rms):
    """eps^x_RMSn of the noise that was put in."""
    squares = [
        np.mean([(a.signals[c] - b.signals[c]) ** 2 for a, b in zip(trials, clean, strict=True)])
        / s**2
        for c, s in zip(("r", "phi"), y_rms, strict=True)
    ]  # fmt: skip
    return float(np.sqrt(np.mean(squares)))


def routes_of(fit, stated=None):
    chosen, routes = split(fit, augment(fit, CATALOGUE), stated or {})
    return chosen, dict(zip("abcde", routes, strict=True))


@pytest.mark.parametrize("kind", [white, waves])
@pytest.mark.parametrize("seed", [1, 2, 3])
@pytest.mark.study(turn="each")
def test_noise_and_model_part_are_found_within_15_percent(kind, seed):
    clean = CLEAN[True]
    trials = noisy(clean, kind, seed)
    fit = identify(trials, MODEL, FIT)
    perfect = identify(clean, MODEL, FIT)
    noise = normed_noise(trials, clean, fit.problem.y_rms)
    model = float(np.sqrt(np.mean(
        (np.array(list(perfect.eps_by_output.values())) * perfect.problem.y_rms / fit.problem.y_rms)
        ** 2
    )))  # fmt: skip
    chosen, routes = routes_of(fit)
    assert chosen.method == "quiet stretch"
    for route in (routes["c"], routes["d"]):
        assert route.noise == pytest.approx(noise, rel=0.15), route.method
        assert route.undermodelling == pytest.approx(model, rel=0.15), route.method
        low, high = route.undermodelling_interval
        assert low <= model <= high
    assert chosen.noise**2 + chosen.undermodelling**2 == pytest.approx(fit.eps_rmsn**2, rel=1e-9)


@pytest.mark.parametrize("kind", [white, waves])
def test_noise_alone_gives_a_model_part_whose_interval_holds_zero(kind):
    fit = identify(noisy(CLEAN[False], kind, 4), MODEL, FIT)
    _, routes = routes_of(fit)
    for route in (routes["c"], routes["d"]):
        assert route.undermodelling_interval[0] == 0.0, route.method


@pytest.mark.study(turn=8)
def test_after_the_effect_is_added_the_model_part_falls_and_the_noise_stays():
    trials = noisy(CLEAN[True], waves, 5)
    before, _ = routes_of(identify(trials, MODEL, FIT))
    after, _ = routes_of(identify(trials, MODEL + HIDDEN, FIT_ADDED))
    assert after.noise == pytest.approx(before.noise, rel=0.1)
    assert after.undermodelling < 0.4 * before.undermodelling
    assert after.undermodelling_interval[0] == 0.0


@pytest.mark.study(turn=5)
def test_a_repeated_manoeuvre_is_trusted_most():
    clean = CLEAN[True]
    again = Trial("again", "fit", 0.5, clean[0].signals, clean[0].valid)
    trials = noisy([*clean, again], waves, 6)
    fit = identify(trials, MODEL, FIT)
    chosen, _ = routes_of(fit)
    assert chosen.method == "repeated manoeuvre"
    noise = normed_noise(trials, [*clean, again], fit.problem.y_rms)
    assert chosen.noise == pytest.approx(noise, rel=0.1)


def test_periods_of_a_periodic_test():
    """A rudder that repeats itself every 200 s, with the same error of the model in each."""
    once = zigzag(10, TRUTH)
    delta = np.deg2rad(10.0) * np.sign(np.sin(2 * np.pi * np.arange(2400) / 400.0 + 1e-6))
    from trialid.simulation.integrate import prepare, respond

    valid = {n: np.ones(2400, dtype=bool) for n in once.signals}
    blank = {"delta": delta, "n": np.full(2400, once.signals["n"][0])}
    zero = {"r": np.zeros(2400), "phi": np.zeros(2400)}
    trial = Trial("square", "fit", 0.5, {**blank, **zero}, valid)
    y = respond(prepare(TRUTH, (), ("r", "phi")), trial, {}, {"u": 7.33}, False).y
    settled = Trial(
        "square", "fit", 0.5, {**blank, "r": y[:, 0].copy(), "phi": y[:, 1].copy()}, valid
    )
    trials = noisy([settled], white, 7)
    fit = identify(trials, MODEL, FIT)
    _, routes = routes_of(fit)
    assert routes["b"].available, routes["b"].why
    noise = normed_noise(trials, [settled], fit.problem.y_rms)
    assert routes["b"].noise == pytest.approx(noise, rel=0.15)


def test_a_stated_figure_is_the_last_resort_and_not_separable_is_said():
    rng = np.random.default_rng(8)
    trial = zigzag(10, TRUTH)
    short = {n: s[:100] for n, s in trial.signals.items()}
    valid = {n: np.ones(100, dtype=bool) for n in short}
    noise = np.deg2rad(0.05), np.deg2rad(0.1)
    piece = with_noise(
        Trial("short", "fit", 0.5, short, valid), *(s * rng.standard_normal(100) for s in noise)
    )
    few = replace(SETTINGS, free=("Nr", "Ndelta", "Kp"))
    fit = identify([piece], MODEL, few)
    none, _ = routes_of(fit)
    assert none.method == "not separable"
    assert none.noise is None
    assert "repeated" in none.why
    stated, _ = routes_of(fit, {"r": noise[0], "phi": noise[1]})
    assert stated.method == "stated sensor figure"


def test_first_differences_would_be_wrong_on_waves():
    """Why there is no such route: it finds a small part of the variance of wave noise."""
    e, _ = waves(np.random.default_rng(9), 4000)
    assert np.mean(np.diff(e) ** 2) / 2.0 < 0.15 * np.mean(e**2)


def test_a_slow_rudder_logged_fast_does_not_repeat_itself() -> None:
    """Ten samples of 10 Hz are a second: a rudder is like itself a second before."""
    rng = np.random.default_rng(4)
    switches = np.cumsum(rng.uniform(20.0, 80.0, 60))
    t = np.arange(20_000) * 0.1
    held = np.where(np.searchsorted(switches, t) % 2, 0.2, -0.2) * (t > 30.0)
    smooth = np.convolve(held, np.ones(50) / 50, mode="same")
    assert period_of(smooth[:, None] / QUIET_ANGLE) is None
    order = np.where(np.arange(500) < 60, 0.0, 0.6)  # laid over once, in one step, and held
    assert period_of(order[:, None] / QUIET_ANGLE) is None
    again = np.tile(smooth[:6000], 3)
    found = period_of(again[:, None] / QUIET_ANGLE)
    assert found is not None
    assert found[1] == pytest.approx(6000, abs=2)


def test_a_record_of_fewer_values_than_there_are_candidates_is_too_short_for_that_route():
    whole = zigzag(20)
    n = 45
    signals = {name: y[100 : 100 + n] for name, y in whole.signals.items()}
    valid = {name: np.ones(n, dtype=bool) for name in signals}
    cut = replace(whole, signals=signals, valid=valid)
    fit = identify(
        [with_noise(cut, *white(np.random.default_rng(3), n))],
        MODEL,
        replace(SETTINGS, free=("Nv", "Nr")),
    )
    augmented = augment(fit, CATALOGUE)
    assert augmented.S.shape[0] < augmented.S.shape[1]
    _, routes = split(fit, augmented, {})
    assert next(r for r in routes if r.method == INPUT_DRIVEN).why.startswith("too short: ")
