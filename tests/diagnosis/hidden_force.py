"""Zig-zags of S175Q with a force in them that the fitted model does not have."""

import numpy as np
from s175q import MODEL, OUTPUTS, SETTINGS, waves, with_noise, zigzag
from scipy.signal import lfilter

from trialid.effects import CATALOGUE
from trialid.identification.fit import identify
from trialid.identification.problem import replace
from trialid.maths import sin
from trialid.ship.effect import Force, effect
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial

FREE = ("Nv", "Nr", "Ndelta", "Yv", "Kv", "Kr", "Kdelta", "Kp", "GM")
FIT = replace(SETTINGS, free=FREE)
AMPLITUDES = (5, 10, 20)
SIZES = {"Y": 3e4, "K": 2e5, "N": 2e6}
"""Outer forces [N, N m] that add a tenth or two to the error that wave noise makes."""


@effect(source="test")
def rudder_in_heel(phi, delta, *, N_hidden=-0.005):
    """N = N_hidden delta |phi|: a rudder that bites less when heeled."""
    return Force(N=N_hidden * delta * abs(phi))


@effect(source="test")
def turning_in_heel(phi, r, *, N_hidden=-0.01):
    """N = N_hidden r |phi|."""
    return Force(N=N_hidden * r * abs(phi))


@effect(source="test")
def odd_shape(phi, r, *, N_hidden=4e-4):
    """N = N_hidden sin(phi / 0.05) |r|."""
    return Force(N=N_hidden * sin(phi / 0.05) * abs(r))


@effect(source="test")
def stiffness(phi, *, K_hidden=2e-5):
    """K = K_hidden sin(phi / 0.04)."""
    return Force(K=K_hidden * sin(phi / 0.04))


def gusts(rng, samples, memory=60.0, period=0.5):
    """A force of its own course, variance 1: an Ornstein-Uhlenbeck process; (N,)."""
    a = np.exp(-period / memory)
    drive = rng.standard_normal(samples + 2000)
    return lfilter([np.sqrt(1.0 - a * a)], [1.0, -a], drive)[2000:]


def pushed(trial, row, force):
    """The trial as it would have gone with an outer force in one equation."""
    names = ("X_ext", "Y_ext", "K_ext", "N_ext")
    outer = {n: force if n[0] == row else np.zeros(trial.samples) for n in names}
    valid = {**trial.valid, **{n: np.ones(trial.samples, dtype=bool) for n in names}}
    model = (MODEL + CATALOGUE["outer_force"]).with_values({"scale_ext": 1.0})
    known = Trial(trial.name, trial.use, trial.period, {**trial.signals, **outer}, valid)
    y = respond(prepare(model, (), OUTPUTS), known, {}, {"u": 7.33}, sensitivities=False).y
    signals = {**trial.signals, "r": y[:, 0].copy(), "phi": y[:, 1].copy()}
    return Trial(trial.name, trial.use, trial.period, signals, trial.valid)


def fit_of(hidden, seed, noise=waves):
    """The fit of `MODEL` to records with a hidden effect or, by the letter, an outer force.

    And the outer force over each trial.
    """
    rng, trials, forces = np.random.default_rng(seed), [], []
    truth = MODEL
    if hidden is not None and not isinstance(hidden, str):
        values = {n: p.start for n, p in hidden.parameters.items()}
        truth = (MODEL + hidden).with_values(values)
    for amplitude in AMPLITUDES:
        trial = zigzag(amplitude, truth)
        if isinstance(hidden, str):
            forces.append(SIZES[hidden] * gusts(rng, trial.samples))
            trial = pushed(trial, hidden, forces[-1])
        trials.append(with_noise(trial, *noise(rng, trial.samples)))
    return identify(trials, MODEL, FIT), forces
