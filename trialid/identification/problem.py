"""What is unknown in a fit and where it starts: trials, a model and settings to a problem."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

from trialid.arrays import Mask
from trialid.errors import NotIdentifiable, nearest
from trialid.identification.nuisance.delays import delay_limits
from trialid.identification.nuisance.of_each_trial import Nuisance, nuisances, with_nuisance
from trialid.identification.nuisance.priors import fastest, water_prior
from trialid.identification.output_error import Norm, Problem, Unknown, compared_mask
from trialid.identification.roll.roll_range import RollRange, roll_range
from trialid.names.quantities import MASS_PARAMETERS, POSITION
from trialid.ship.effect import Force, Mass, Rate
from trialid.ship.model import ShipModel
from trialid.ship.motion import check_mass
from trialid.simulation.at_rest import check_at_rest
from trialid.simulation.graph import SYMBOL, order
from trialid.simulation.integrate import (
    Engine,
    Simulator,
    inputs,
    prepare,
    record_for,
)
from trialid.trial import Trial
from trialid.trial_rows import Kind

Vector = NDArray[np.float64]

STILL_RUDDER: Final = 0.002
"""[rad rms] A rudder that moves less than this excites nothing; its sensor's noise is less."""

FASTEST: Final = 0.5
"""Share of an integration step that a time constant is at least. Below 0.36 Runge-Kutta's answer
grows from step to step; a gear of limited rate then chatters about its order, and a search stalls
among the kinks. Of four records of such a gear (`hidden_effects.py`, 14000, 14001, 14400) all four
searches had stalled there; with 0.36 one did, with half a step, a whole one and two none."""


@dataclass(frozen=True)
class Settings:
    """How to identify; see the pipeline's `[identify]`.

    `priors` are (mean, standard deviation) in the parameter's own unit; `bounds` (low, high).
    `priors_of_ship`: what joins the free parameters has the prior that the ship's file gives it.
    Steps a sample begin with `substeps` and go up to `most_substeps` where they matter.
    `hold_nuisance`: weakly, what each trial has for itself, and GM and damping without a prior.
    """

    free: tuple[str, ...]
    outputs: tuple[str, ...]
    nuisance: tuple[Nuisance, ...] = ()
    weights: Mapping[str, float] = field(default_factory=dict)
    loss: Literal["squares", "huber"] = "squares"
    priors: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    bounds: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    starts: int = 1
    spread: float = 0.3
    seed: int = 0
    max_iterations: int = 50
    norm: Norm = "mean"
    substeps: int = 1
    most_substeps: int = 16
    engine: Engine = "compiled"
    hold_nuisance: bool = True
    priors_of_ship: bool = False


def pose_problem(
    trials: Sequence[Trial],
    model: ShipModel,
    settings: Settings,
    near: Mapping[str, float] = MappingProxyType({}),
) -> Problem:
    """What is unknown, and what a residual is made of.

    Raises
    ------
    NotIdentifiable, EffectError, ShipError
        The trials or the model cannot carry the question; one line says why.
    """
    fitted = tuple(t for t in trials if t.use == "fit")
    _check_outputs(trials, settings)
    simulator, shared, per_trial = ready(model, settings)
    _check_ready(simulator, trials)
    problem = question(simulator, fitted, settings, shared, per_trial, near)
    _check_excitation(problem)
    return problem


def ready(
    model: ShipModel, settings: Settings
) -> tuple[Simulator, tuple[str, ...], tuple[str, ...]]:
    """A simulator of what is free; the free names trials share, and those each has for itself."""
    full, per_trial, of_all = with_nuisance(model, settings)
    shared = (*(n for n in settings.free if n not in (*per_trial, *of_all)), *of_all)
    free = (*shared, *per_trial)
    started = with_starts(full, free, settings)
    simulator = prepare(started, free, settings.outputs, settings.engine, settings.substeps)
    return simulator, shared, per_trial


def question(
    simulator: Simulator,
    trials: Sequence[Trial],
    settings: Settings,
    shared: Sequence[str],
    per_trial: Sequence[str],
    near: Mapping[str, float] = MappingProxyType({}),
) -> Problem:
    """The problem of these trials for a simulator that is ready, unchecked.

    Parameters
    ----------
    shared, per_trial
        Free parameters that all trials share, and those that each trial has for itself.
    near
        Starts by the name of the unknown.
    """
    unknowns = (*(_shared(simulator, n, settings, trials) for n in shared),
                *nuisances(simulator, trials, per_trial, settings))  # fmt: skip
    unknowns = tuple(replace(x, start=near.get(x.name, x.start)) for x in unknowns)
    compared = tuple(compared_mask(t, simulator) for t in trials)
    length = simulator.model.ship.particulars["L"]
    y_rms = norms(trials, compared, settings.outputs, settings.norm, length)
    weights = np.array([settings.weights.get(c, 1.0) for c in settings.outputs])
    weights = weights / np.sqrt(np.mean(weights**2))
    roll = _roll(simulator.model, trials, unknowns) if settings.hold_nuisance else None
    return Problem(simulator, tuple(trials), unknowns, compared, y_rms, weights, roll=roll)


def _roll(
    model: ShipModel, trials: Sequence[Trial], unknowns: Sequence[Unknown]
) -> RollRange | None:
    places = {x.name: i for i, x in enumerate(unknowns) if x.trial is None}
    own = frozenset(i for i, x in enumerate(unknowns) if x.prior is not None)
    return roll_range(model, fastest(model, trials), places, own)


def _check_ready(simulator: Simulator, trials: Sequence[Trial]) -> None:
    """Refuse a model that cannot be simulated in these trials."""
    _check_simulated(simulator)
    check_at_rest(simulator.model)
    check_mass(simulator.model, {n: simulator.model.value(n) for n in MASS_PARAMETERS})
    for trial in trials:
        inputs(simulator, trial, simulator.fixed)


def _check_outputs(trials: Sequence[Trial], settings: Settings) -> None:
    for trial in trials:
        for c in settings.outputs:
            if c not in trial.signals:
                raise NotIdentifiable(
                    f"trial {trial.name!r} has no signal {c!r}, which is an output to fit; "
                    f"map it in [trial.signals] ({nearest(c, trial.signals)})"
                )


def _check_simulated(simulator: Simulator) -> None:
    """Refuse an output that no simulated motion reaches: an input has nothing to fit."""
    states = simulator.equations.states
    for name, node in simulator.equations.outputs.items():
        if {*states, f"{name}_ref"}.isdisjoint(n.value for n in order([node]) if n.op == SYMBOL):
            raise NotIdentifiable(
                f"output {name!r} is not simulated, it is an input; take it out of [identify] "
                f"outputs, or choose from what is simulated: {', '.join(states)}"
            )


def with_starts(model: ShipModel, free: Sequence[str], settings: Settings) -> ShipModel:
    """Typical values for free parameters nobody states, so that the search has a start."""
    missing = {}
    for name in free:
        if name not in model.parameters:
            known = nearest(name, model.parameters)
            raise NotIdentifiable(f"free parameter {name!r} is in no effect of the model; {known}")
        if name in settings.priors and model.stated(name) is None:
            missing[name] = settings.priors[name][0]
        elif model.stated(name) is None:
            parameter = model.parameters[name]
            acts = {Force, Rate} & {*(_forms_of(model, name) or (Force,))}
            missing[name] = parameter.start if acts or parameter.null is None else parameter.null
    return model.with_values(missing) if missing else model


def _forms_of(model: ShipModel, name: str) -> tuple[type, ...]:
    """What the effect that a parameter belongs to returns; nothing where it is a mass."""
    return next((e.forms for e in model.effects if name in e.parameters), ())


def _range(simulator: Simulator, name: str, trials: Sequence[Trial]) -> tuple[float, float]:
    """The physical range, of a state's time constant less what a step cannot follow."""
    model = simulator.model
    p = model.parameters[name]
    if name in {f"tau_{c}" for c in simulator.outputs}:
        return delay_limits(p, trials)
    step = max(t.period for t in trials) / simulator.substeps
    follows = p.unit == "s" and Rate in _forms_of(model, name)
    return (min(max(p.low, FASTEST * step), p.high) if follows else p.low), p.high


def _shared(
    simulator: Simulator, name: str, settings: Settings, trials: Sequence[Trial]
) -> Unknown:
    parameter = simulator.model.parameters[name]
    low, high = settings.bounds.get(name) or _range(simulator, name, trials)
    start = simulator.model.value(name)
    size = abs(start) if start else abs(parameter.start)
    of_a_drive = any(e.of_a_drive for e in simulator.model.effects if name in e.parameters)
    forms = _forms_of(simulator.model, name)
    sensor = forms and not ({Force, Rate, Mass} & {*forms} or of_a_drive)
    beside = simulator.model.states and sensor  # where nothing moves, sensors are the matter
    kind: Kind = "nuisance" if beside else "physical"
    prior = settings.priors.get(name, water_prior(name) if settings.hold_nuisance else None)
    return Unknown(
        name=name,
        column=name,
        trial=None,
        start=start,
        size=size,
        low=low,
        high=high,
        unit=parameter.unit,
        kind=kind,
        prior=prior,
    )


def _record(trial: Trial, name: str) -> Vector:
    return trial.signals[record_for(trial, name) or name]  # without either it has been refused


def _check_excitation(problem: Problem) -> None:
    """Refuse records that cannot carry the question.

    Raises
    ------
    NotIdentifiable
        The rudder does not move, or there are fewer values than unknowns.
    """
    count = sum(int(m.sum()) for m in problem.compared)
    if count <= len(problem.unknowns):
        raise NotIdentifiable(
            f"{count} compared values for {len(problem.unknowns)} unknowns; free fewer "
            "parameters, or use a longer record or a shorter [align] period"
        )
    for name in ("delta", "delta_order"):
        if name in problem.simulator.equations.inputs:
            moves = max(float(np.std(_record(t, name))) for t in problem.trials)
            if moves < STILL_RUDDER:
                listed = ", ".join(repr(t.name) for t in problem.trials)
                raise NotIdentifiable(
                    f"the rudder ({name}) moves by only {np.rad2deg(moves):.2f} deg rms in trial "
                    f"{listed}: nothing excites the ship and no parameter can be found; use a "
                    "trial with a manoeuvre, or check the channel"
                )


def norms(
    trials: Sequence[Trial],
    compared: Sequence[Mask],
    outputs: Sequence[str],
    norm: Norm,
    length: float,
) -> Vector:
    """y_RMS of each output over the trials, about each trial's own mean or about zero; (n_y,).

    A position is normed by the ship's `length` [m]: it grows with the length of a trial, and what
    is wrong with it does not.

    Raises
    ------
    NotIdentifiable
        An output has nothing to compare, or does not move.
    """
    result = []
    for c, name in enumerate(outputs):
        pieces = [t.signals[name][m[:, c]] for t, m in zip(trials, compared, strict=True)]
        pieces = [p - p.mean() if norm == "mean" else p for p in pieces if len(p)]
        y = np.concatenate(pieces) if pieces else np.zeros(0)
        if len(y) == 0:
            raise NotIdentifiable(
                f"output {name!r}: no sample where it and every input were measured; "
                "check gaps and time windows"
            )
        rms = float(np.sqrt(np.mean(y**2)))
        if rms == 0.0:
            raise NotIdentifiable(
                f"output {name!r} does not move in the trials to fit; check the channel, or leave "
                "it out of [identify] outputs"
            )
        result.append(length if name in POSITION else rms)
    return np.array(result)
