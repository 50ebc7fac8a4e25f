"""What each trial has for itself: where its motion starts, its sensors, its rudder, its current."""

from collections.abc import Sequence
from typing import Final, Literal, Protocol

import numpy as np

from trialid.effects import CATALOGUE
from trialid.effects.environment import drift_in_speed_record
from trialid.effects.track import current, current_in_speed, current_in_velocity
from trialid.errors import NotIdentifiable
from trialid.identification.nuisance.delays import delay_limits
from trialid.identification.nuisance.priors import limits, nuisance_prior
from trialid.identification.output_error import Unknown
from trialid.names.quantities import OVER_GROUND, SIGNALS
from trialid.ship.effect import Effect, Parameter
from trialid.ship.model import ShipModel
from trialid.simulation.integrate import Simulator, guess, initial
from trialid.trial import Trial

Nuisance = Literal["initial_state", "bias", "rudder_offset", "delay", "current"]

STATE_SIZE: Final = {
    **{"u": 0.1, "v": 0.1, "p": 0.002, "r": 0.0005, "phi": 0.01, "psi": 0.01},
    **{"x": 5.0, "y": 5.0},
}
"""Typical error of a start guessed from the record [SI]: the scale of an initial state."""


class Asked(Protocol):
    """What of the settings says which nuisances there are."""

    @property
    def outputs(self) -> tuple[str, ...]:
        """What the simulation is held against."""

    @property
    def nuisance(self) -> tuple[Nuisance, ...]:
        """Which are asked for."""

    @property
    def hold_nuisance(self) -> bool:
        """Whether they are weakly held."""


def with_nuisance(
    model: ShipModel, asked: Asked
) -> tuple[ShipModel, tuple[str, ...], tuple[str, ...]]:
    """The model with the effects that nuisance parameters act through.

    And their names: those of each trial, and those of all, which is the current in a speed over
    ground. A trial's own, which a speed hardly tells, would take up what the hull does there.
    """
    wanted: list[Effect] = []
    if "bias" in asked.nuisance:
        wanted += [CATALOGUE[f"bias_{c}"] for c in asked.outputs if f"bias_{c}" in CATALOGUE]
    if "delay" in asked.nuisance:
        wanted += [CATALOGUE[f"delay_{c}"] for c in asked.outputs if f"delay_{c}" in CATALOGUE]
    if "rudder_offset" in asked.nuisance:
        wanted += [CATALOGUE["rudder_offset"]]
    present = {e.name for e in model.effects}
    if "current" in asked.nuisance:
        wanted += _currents(present, asked)
    added = [e for e in wanted if e.name not in present]
    for effect in added:
        model = model + effect
    own = tuple(p for e in added if e is not current_in_speed for p in e.parameters)
    shared = tuple(p for e in added if e is current_in_speed for p in e.parameters)
    return model, own, shared


def _currents(present: set[str], asked: Asked) -> list[Effect]:
    """What a current shows in; NotIdentifiable where that is nothing."""
    outputs = {*asked.outputs}
    shown = [current] if {*OVER_GROUND} & outputs else []
    if not shown and {"u", "v"} <= outputs:
        shown = [current_in_velocity]
    read = [current_in_speed] if drift_in_speed_record.name in present else []
    if not shown and not read:
        raise NotIdentifiable(
            'nuisance "current" shows only over the ground: simulate x and y, or u and v, and put '
            "them among [identify] outputs, read a speed over ground by the effect "
            "drift_in_speed_record, or take it out"
        )
    return [*shown, *read]


def nuisances(
    simulator: Simulator, trials: Sequence[Trial], names: Sequence[str], asked: Asked
) -> list[Unknown]:
    """Unknowns of every trial: parameters of these names, and initial states where asked for."""
    model = simulator.model
    made = []
    for i, trial in enumerate(trials):
        for name in names:
            p: Parameter = model.parameters[name]
            late = name.startswith("tau_")
            low, high = delay_limits(p, [trial]) if late else (p.low, p.high)
            label = f"{name} [{trial.name}]"
            null, size = p.start if p.null is None else p.null, abs(p.start)
            held = asked.hold_nuisance
            prior = nuisance_prior(model, trial, name, size, null) if held else None
            made.append(
                Unknown(
                    name=label,
                    column=name,
                    trial=i,
                    start=null,
                    size=size,
                    low=low,
                    high=high,
                    unit=p.unit,
                    kind="nuisance",
                    prior=prior,
                )
            )
        if "initial_state" in asked.nuisance:
            made += [_initial(model, trial, i, s, asked) for s in model.states]
    return made


def _initial(model: ShipModel, trial: Trial, index: int, state: str, asked: Asked) -> Unknown:
    start, size = guess(model, trial, state), STATE_SIZE[state]
    unit = SIGNALS[state].unit
    label = f"{initial(state)} [{trial.name}]"
    prior, low, high = None, -np.inf, np.inf
    if asked.hold_nuisance:
        prior = nuisance_prior(model, trial, initial(state), size)
        low, high = limits(prior)
    start = float(np.clip(start, low, high))
    return Unknown(
        name=label,
        column=initial(state),
        trial=index,
        start=start,
        size=size,
        low=low,
        high=high,
        unit=unit,
        kind="nuisance",
        prior=prior,
    )
