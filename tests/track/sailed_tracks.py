"""Trials of a ship whose truth is known, with a track by satellite receiver and a current."""

from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from types import MappingProxyType

import numpy as np
from s175q import MODEL, SHAFT
from typical import spread_of

from trialid.accuracy.parameter_table import Accuracy, Subject, assess
from trialid.design import manoeuvres
from trialid.design.helm import carry_out, vessel
from trialid.design.prediction.likely_spread import LikelySpread
from trialid.diagnosis.noise.recorded_inputs import felt_noise
from trialid.effects import CATALOGUE
from trialid.effects.track import current
from trialid.identification.fit import Fit
from trialid.identification.output_error import stretches
from trialid.identification.problem import Settings
from trialid.ship.effect import Effect
from trialid.ship.model import ShipModel
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial

FREE = ("Nv", "Nr", "Ndelta", "Yv", "Ydelta")
OUTPUTS = ("r", "psi", "x", "y")
SHIP = replace(MODEL, states=("u", "v", "p", "r", "phi", "psi", "x", "y"))
NOISE = {"r": np.deg2rad(0.05), "psi": np.deg2rad(0.3), "x": 1.0, "y": 1.0}
"""A rate gyro, a compass, and a satellite receiver of 1 m."""

PERIOD, APPROACH = 2.0, 30.0
CURRENTS = {"circle": (0.5, -0.3), "zigzag": (-0.2, 0.8)}
FEW = ("yaw_drag_rav", "sway_drag_vav", "rudder_offset", "yaw_drag_rar")
MISSING = {n: CATALOGUE[n] for n in FEW}
EXACT = {"default": 0.0}
"""What is held fixed of this ship is right; without that word a tenth or so of it is doubted."""
SETTINGS = Settings(FREE, OUTPUTS, nuisance=("initial_state", "current"))


@cache
def sailed(
    name: str,
    water: tuple[float, float],
    use: str = "fit",
    course: float = 0.7,
    hidden: tuple[str, float] | None = None,
    period: float = PERIOD,
) -> Trial:
    """A turning circle, a 20/20 or a 10/10 zig-zag without noise, from a course not north.

    Of a ship with one effect more, at a share of its typical size, where it is hidden.
    """
    told = {
        "circle": lambda: manoeuvres.turning_circle(np.deg2rad(35.0)),
        "zigzag": lambda: manoeuvres.zigzag(np.deg2rad(20.0), np.deg2rad(20.0), 4),
        "small zigzag": lambda: manoeuvres.zigzag(np.deg2rad(10.0), np.deg2rad(10.0), 4),
    }
    ship = true_ship(hidden)
    helm = vessel(ship, period, {"n": SHAFT}, np.deg2rad(3.0))
    run = carry_out(helm, told[name](), APPROACH, 500.0, name).trial
    inputs = {s: run.signals[s] for s in ("delta", "delta_order", "n")}
    on_track = replace(ship, states=SHIP.states)
    true = (on_track + current).with_values(dict(zip(("V_cn", "V_ce"), water, strict=True)))
    blank = Trial(name, "fit", period, inputs, {})
    y = respond(prepare(true, (), OUTPUTS), blank, {}, {"psi": course}, sensitivities=False).y
    signals = {**inputs, **{c: y[:, i].copy() for i, c in enumerate(OUTPUTS)}}
    valid = {c: np.ones(len(y), dtype=bool) for c in signals}
    return Trial(name, "check" if use == "check" else "fit", period, signals, valid)


def true_ship(hidden: tuple[str, float] | None) -> ShipModel:
    """The ship, or one that has an effect more."""
    if hidden is None:
        return MODEL
    effect, share = CATALOGUE[hidden[0]], hidden[1]
    return (MODEL + effect).with_values({n: share * p.start for n, p in effect.parameters.items()})


def noisy(
    trial: Trial, rng: np.random.Generator, sizes: Mapping[str, float] = MappingProxyType(NOISE)
) -> Trial:
    """The trial as its sensors log it."""
    added = {c: s * rng.standard_normal(trial.samples) for c, s in sizes.items()}
    return replace(trial, signals={n: x + added.get(n, 0.0) for n, x in trial.signals.items()})


def trials(seed: int, still: bool = False) -> list[Trial]:
    """Both manoeuvres, each in a current of its own, or in still water."""
    rng = np.random.default_rng([11, seed])
    water: Mapping[str, tuple[float, float]] = {n: (0.0, 0.0) for n in CURRENTS}
    return [noisy(sailed(n, (water if still else CURRENTS)[n]), rng) for n in CURRENTS]


def accuracy(fit: Fit) -> Accuracy:
    """Errors of every unknown by the formula of a run."""
    subjects = [
        replace(
            Subject(x.name, x.kind, x.unit, v, v if x.kind == "physical" and v else x.size), prior=p
        )
        for x, v in zip(fit.problem.unknowns, fit.theta, strict=True)
        for p in [None if x.prior is None else x.prior[1]]
    ]
    parts = stretches(fit.problem)
    residual, psi = fit.residual, fit.psi
    felt = felt_noise(fit)
    return assess(subjects, psi, residual, parts, fit.eps_rmsn, 0.0, level=fit.level, felt=felt)


def spread(fit: Fit, catalogue: Mapping[str, Effect] = MISSING) -> LikelySpread:
    """What a prediction of the fit is uncertain by, with any of these that may be missing."""
    present = {e.name for e in fit.model.effects}
    return spread_of(fit, {n: e for n, e in catalogue.items() if n not in present})
