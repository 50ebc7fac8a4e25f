"""The ship a design file sails: as she is known, as she might be, and the limits she keeps to."""

from collections.abc import Mapping
from typing import Final

import numpy as np

from trialid.design.helm import vessel
from trialid.design.imo.speed_loss import with_speed_loss
from trialid.design.limits import Limits
from trialid.design.rating import Noise, goal
from trialid.design.search import Ship, natural_roll
from trialid.errors import PipelineError, UnitError, nearest
from trialid.identification.problem import with_starts
from trialid.names import units
from trialid.names.quantities import SIGNALS
from trialid.pipeline_file import where
from trialid.pipeline_file.design_file import DesignFile
from trialid.pipeline_file.finished_run import FinishedRun, finished_run
from trialid.pipeline_file.form import GivenValue
from trialid.ship.actuators import actuator_quantities
from trialid.ship.effect import Effect
from trialid.ship.model import ShipModel
from trialid.workflow.build_model import build_model, settings_of

NO_ROLL: Final = 2.0 * np.pi / 15.0
"""rad/s, where the model does not roll and nothing depends on it."""


def ships_of_design(pipeline: DesignFile, catalogue: Mapping[str, Effect]) -> list[Ship]:
    """The ship as she is known, first, and others she might be."""
    model = build_model(pipeline, catalogue)
    run = finished_run(pipeline)
    known = {n: x for n, x in run.values.items() if n in model.parameters}
    settings = settings_of(pipeline, model)
    model = with_starts(model.with_values(known), pipeline.identify.free, settings)
    full = _full(pipeline, model, catalogue)
    made = [_ship(pipeline, run, model, full)]
    draw = np.random.default_rng(pipeline.ships.seed)
    for _ in range(pipeline.ships.count - 1):
        factors = {
            n: 1.0 + pipeline.ships.spread * draw.standard_normal()
            for n in pipeline.identify.free
            if n in model.parameters
        }
        values = {n: model.value(n) * f for n, f in factors.items()}
        made.append(_ship(pipeline, run, model.with_values(values), full.with_values(values)))
    return made


def _full(pipeline: DesignFile, model: ShipModel, catalogue: Mapping[str, Effect]) -> ShipModel:
    """What is sailed: the model to be fitted and what the ship has beyond it."""
    full = model
    for i, name in enumerate(pipeline.full.effects):
        if name not in catalogue:
            at = where(pipeline, f"full.effects[{i}]")
            raise PipelineError(f"{at}: there is no effect {name!r}; {nearest(name, catalogue)}")
        full = full + catalogue[name]
    values = {}
    for name, given in pipeline.full.values.items():
        if name not in full.parameters:
            at = where(pipeline, f"full.values.{name}")
            raise PipelineError(f"{at}: no such parameter; {nearest(name, full.parameters)}")
        values[name] = _si(pipeline, f"full.values.{name}", given, full.parameters[name].unit, None)
    typical = {
        n: p.start
        for e in full.effects
        if e.name in pipeline.full.effects
        for n, p in e.parameters.items()
        if full.stated(n) is None
    }
    return full.with_values({**typical, **values})


def _ship(pipeline: DesignFile, run: FinishedRun, model: ShipModel, full: ShipModel) -> Ship:
    at_sea, known = pipeline.at_sea, SIGNALS | actuator_quantities(full.ship.actuators)
    constants = {n: x for n, x in run.constants.items() if n in full.recorded} | {
        name: _si(pipeline, f"at_sea.constant.{name}", given, known[name].unit, known[name].shown)
        for name, given in at_sea.constant.items()
    }
    ready = vessel(full, at_sea.period, constants, run.gear_rate(at_sea.rudder_rate))
    if "u" not in at_sea.constant:  # a speed that is stated stays
        ready = with_speed_loss(ready, run.speed_lost)
    noise = {
        c: Noise(n.sigma / units.shown_factor(SIGNALS[c]), n.memory)
        for c, n in pipeline.noise.items()
    }
    asked = goal(model, settings_of(pipeline, model), noise, pipeline.wanted, pipeline.scale)
    rolls = {"p", "phi"} <= {*model.states}
    speed = model.ship.particulars["U0"]
    return Ship(ready, asked, natural_roll(ready) if rolls else NO_ROLL, speed)


def _si(pipeline: DesignFile, key: str, given: GivenValue, unit: str, bare: str | None) -> float:
    """A given number in SI; without a unit it is in `bare`, or as it is."""
    stated = given.unit or bare
    try:
        return given.value if stated is None else given.value * units.factor(stated, unit)
    except UnitError as error:
        raise UnitError(f"{where(pipeline, key)}: {error}") from error


def limits_of_design(pipeline: DesignFile, model: ShipModel) -> Limits:
    """The file's limits in SI; one of a motion that is not simulated would never bind."""
    r = pipeline.limits
    for name, state, given in (("heel", "phi", r.heel), ("speed_loss", "u", r.speed_loss)):
        if given is not None and state not in model.states:
            raise PipelineError(
                f"{where(pipeline, f'limits.{name}')}: {state} is not simulated, so nothing can be "
                f"held against it; put {state} among model.states, or leave the limit out"
            )
    degrees = np.deg2rad(1.0)
    return Limits(
        rudder=None if r.rudder is None else r.rudder * degrees,
        rudder_rate=None if r.rudder_rate is None else r.rudder_rate * degrees,
        heel=None if r.heel is None else r.heel * degrees,
        speed_loss=r.speed_loss, room=r.room, duration=r.duration,
        rudders=tuple(one for one in model.ship.actuators if one.kind == "rudder"),
    )  # fmt: skip
