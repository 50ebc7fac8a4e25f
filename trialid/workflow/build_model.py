"""What a pipeline file asks for, as objects: its effects, model, settings and candidates."""

from collections.abc import Mapping
from typing import Final

import numpy as np

from trialid import effects
from trialid.effects.actuators import actuator_effects
from trialid.errors import NotIdentifiable, PipelineError, ShipError, UnitError, nearest
from trialid.identification.problem import Settings
from trialid.identification.ship_priors import ship_priors
from trialid.names import units
from trialid.names.quantities import PARTICULARS
from trialid.pipeline_file import Pipeline, where
from trialid.pipeline_file.form import Described
from trialid.pipeline_file.own_quantities import ship_quantities
from trialid.pipeline_file.prior_section import OfTheShip
from trialid.ship.effect import Effect
from trialid.ship.model import STATES, ShipModel, needs_ship
from trialid.ship.particulars import NO_SHIP, read_ship
from trialid.simulation.at_rest import check_at_rest
from trialid.trial import Trial

STEERED: Final = frozenset({"r", "psi", "v"})
"""Outputs that move because the ship is steered."""
TURN_ON_THE_SPOT: Final = frozenset({"n_p", "n_s", "Y_ext", "N_ext"})
"""Inputs that need no speed to turn a ship."""
LYING_STILL: Final = 0.1
"""Share of the approach speed; the rudder's force there is a hundredth of what it was."""


def available(pipeline: Described) -> dict[str, Effect]:
    """The catalogue, effects of the ship's own actuators, and the user's, by name.

    Raises
    ------
    PipelineError
        Two of the user's files define one name.
    """
    return {**effects.CATALOGUE, **_of_actuators(pipeline), **_of_files(pipeline)}


def _of_files(pipeline: Described) -> dict[str, Effect]:
    """The user's own; two of one name are refused, as nobody knows which is meant."""
    found, first = dict[str, Effect](), dict[str, str]()
    for i, path in enumerate(pipeline.model.effects_from):
        for name, effect in effects.from_file(path).items():
            if name in found:
                raise PipelineError(
                    f"{where(pipeline, f'model.effects_from[{i}]')}: {path.name} and {first[name]} "
                    f"both define {name!r}; rename one"
                )
            found[name], first[name] = effect, path.name
    return found


def _of_actuators(pipeline: Described) -> dict[str, Effect]:
    """Effects that the ship's actuators bring; none where her file names none."""
    if pipeline.ship is None:
        return {}
    return actuator_effects(read_ship(pipeline.ship), _ordered(pipeline))


def _ordered(pipeline: Described) -> set[str]:
    """Signals of which the pipeline names the order."""
    trials = pipeline.trials if isinstance(pipeline, Pipeline) else ()
    named = {name for trial in trials for name in trial.signals}
    return {name.removesuffix("_order") for name in named if name.endswith("_order")}


def build_model(pipeline: Described, catalogue: Mapping[str, Effect]) -> ShipModel:
    """The ship with the pipeline's states, effects and values.

    Raises
    ------
    PipelineError
        An effect, a free parameter or a value the model does not have.
    """
    chosen = []
    for i, name in enumerate(pipeline.model.effects):
        if name not in catalogue:
            raise PipelineError(
                f"{where(pipeline, f'model.effects[{i}]')}: there is no effect {name!r}; "
                f"{nearest(name, catalogue)}"
            )
        chosen.append(catalogue[name])
        if trouble := _senseless(pipeline, catalogue[name]):
            raise PipelineError(f"{where(pipeline, f'model.effects[{i}]')}: {name} {trouble}")
    _check_states(pipeline)
    ship = NO_SHIP if pipeline.ship is None else read_ship(pipeline.ship)
    model = ShipModel(ship, pipeline.model.states, tuple(chosen))
    _check_own(model, catalogue)
    for i, name in enumerate(pipeline.identify.free):
        if name not in model.parameters:
            raise PipelineError(
                f"{where(pipeline, f'identify.free[{i}]')}: no effect of the model has the "
                f"parameter {name!r}; {nearest(name, model.parameters)}"
            )
    return model.with_values({n: _value(pipeline, model, n) for n in pipeline.model.values})


def _check_states(pipeline: Described) -> None:
    for i, state in enumerate(pipeline.model.states):
        if state not in STATES:
            raise PipelineError(
                f"{where(pipeline, f'model.states[{i}]')}: {state!r} cannot be simulated; "
                f"{nearest(state, STATES)}"
            )


def _value(pipeline: Described, model: ShipModel, name: str) -> float:
    given = pipeline.model.values[name]
    if name not in model.parameters:
        raise PipelineError(
            f"{where(pipeline, f'model.values.{name}')}: no effect of the model has this "
            f"parameter; {nearest(name, model.parameters)}"
        )
    if given.unit is None:
        return given.value
    try:
        return given.value * units.factor(given.unit, model.parameters[name].unit)
    except UnitError as error:
        raise UnitError(f"{where(pipeline, f'model.values.{name}')}: {error}") from error


def check_bounds(pipeline: Pipeline, model: ShipModel, settings: Settings) -> None:
    """Refuse bounds that leave out the start, where no search could begin.

    Raises
    ------
    PipelineError
        In one line, with the key.
    """
    for name, (low, high) in settings.bounds.items():
        start = model.stated(name) if name in model.parameters else None
        if start is not None and not low <= start <= high:
            raise PipelineError(
                f"{where(pipeline, f'identify.bounds.{name}')}: [{low:g}, {high:g}] leaves out the "
                f"start {start:.6g}; widen it, or state another start in [model.values]"
            )


def settings_of(pipeline: Described, model: ShipModel) -> Settings:
    """The pipeline's `[identify]` as the identifier takes it.

    Raises
    ------
    PipelineError
        A prior or a bound of a parameter that is not free, or the ship's where she gives none.
    """
    r = pipeline.identify
    for table, names in (("priors", r.priors), ("bounds", r.bounds)):
        for name in names:
            if name not in r.free:
                raise PipelineError(
                    f"{where(pipeline, f'identify.{table}.{name}')}: {name!r} is not free; "
                    f"{nearest(name, r.free)}"
                )
    return Settings(
        free=r.free, outputs=r.outputs, nuisance=r.nuisance, weights=r.weights, loss=r.loss,
        priors=priors_of(pipeline, model), bounds=r.bounds,
        starts=r.starts, spread=r.spread, seed=r.seed, max_iterations=r.max_iterations,
        norm=r.norm, substeps=r.substeps, engine=r.engine,
        priors_of_ship=isinstance(r.priors, OfTheShip),
    )  # fmt: skip


def priors_of(pipeline: Described, model: ShipModel) -> dict[str, tuple[float, float]]:
    """Mean and standard deviation of what is known beforehand, by the pipeline or by the ship.

    Raises
    ------
    PipelineError
        The ship's file was asked, and says nothing.
    """
    said = pipeline.identify.priors
    if not isinstance(said, OfTheShip):
        return {n: p.known for n, p in said.items()}
    try:
        return ship_priors(model, pipeline.identify.free)
    except ShipError as error:
        raise PipelineError(f"{where(pipeline, 'identify.priors')}: {error}") from error


def candidates(pipeline: Pipeline, catalogue: Mapping[str, Effect]) -> dict[str, Effect]:
    """Effects to try: all, none, or those the pipeline lists.

    Raises
    ------
    PipelineError
        A listed effect does not exist.
    """
    asked = pipeline.diagnose.candidates
    if asked == "all":
        return {n: e for n, e in catalogue.items() if not _senseless(pipeline, e)}
    if asked == "none":
        return {}
    for i, name in enumerate(asked):
        if name not in catalogue:
            raise PipelineError(
                f"{where(pipeline, f'diagnose.candidates[{i}]')}: there is no effect {name!r}; "
                f"{nearest(name, catalogue)}"
            )
    return {n: catalogue[n] for n in asked}


def stated_noise(pipeline: Pipeline) -> dict[str, float]:
    """Sensor figures of the pipeline, from the unit of reports to SI."""
    known = ship_quantities(pipeline)
    return {c: x / units.shown_factor(known[c]) for c, x in pipeline.diagnose.noise.items()}


def check_quiet(pipeline: Pipeline, trials: tuple[Trial, ...]) -> None:
    """Refuse a stretch declared quiet that its trial does not hold.

    Raises
    ------
    PipelineError
        In one line, with the key.
    """
    ends = {t.name: t.duration for t in trials}
    for i, stretch in enumerate(pipeline.diagnose.quiet):
        start, stop = stretch.window
        if start < 0.0 or stop > ends[stretch.trial] + 1e-9:
            raise PipelineError(
                f"{where(pipeline, f'diagnose.quiet[{i}].window')}: [{start:g}, {stop:g}] s is "
                f"outside trial {stretch.trial!r}, which lasts {ends[stretch.trial]:g} s"
            )


def check_headway(pipeline: Pipeline, model: ShipModel, trials: tuple[Trial, ...]) -> None:
    """Refuse to fit steering to a ship that lies still.

    Only where the speed is on record, and where nothing but a rudder could have turned her: two
    propellers or a tug turn a ship on the spot, and a roll decay needs no speed.

    Raises
    ------
    NotIdentifiable
        The message names the trial and both speeds.
    """
    approach = model.ship.particulars.get("U0", 0.0)
    steered = sorted(STEERED & {*pipeline.identify.outputs})
    recorded = {t.name for t in pipeline.trials if t.signals.get("u")}
    spot = TURN_ON_THE_SPOT | {one.drive for one in model.ship.actuators}
    for trial in trials if model.states and steered else ():
        if trial.name not in recorded:
            continue
        u = np.abs(trial.signals["u"][trial.valid["u"]])
        fast = float(np.quantile(u, 0.9)) if len(u) else approach
        if fast < LYING_STILL * approach and not spot & trial.signals.keys():
            raise NotIdentifiable(
                f"trial {trial.name!r}: the ship lies still, u is below {fast:.2g} m/s for nine "
                f"tenths of it and U0 is {approach:.3g} m/s, so no rudder steers {steered[0]}; "
                "take a trial under way, correct U0, or leave that trial out"
            )


def declared_quiet(pipeline: Pipeline) -> dict[str, list[tuple[float, float]]]:
    """Stretches that the user declares to be without excitation [s], by trial."""
    declared: dict[str, list[tuple[float, float]]] = {}
    for stretch in pipeline.diagnose.quiet:
        declared.setdefault(stretch.trial, []).append(stretch.window)
    return declared


def _senseless(pipeline: Described, effect: Effect) -> str:
    """Why an effect has no place among sensors alone, empty where it has one."""
    if pipeline.ship is None and needs_ship(effect):
        return "is about a ship, and the pipeline names none; write ship = ..., or leave it out"
    own = {*effect.signals} & {*pipeline.identify.outputs}
    if own and not pipeline.model.states:
        return f"reads {min(own)}, an output that is not simulated: it would explain itself"
    return ""


def _check_own(model: ShipModel, catalogue: Mapping[str, Effect]) -> None:
    """Refuse a user's own effect that gives no number at rest: it would spoil the search too.

    Raises
    ------
    EffectError
        The message names it.
    """
    for name, effect in catalogue.items():
        own = effects.CATALOGUE.get(name) is not effect
        asked = {*effect.signals} & {*PARTICULARS}
        if own and asked <= {*model.ship.particulars}:
            check_at_rest(ShipModel(model.ship, model.states, (effect,)))
