"""The fitted ship through the water under the inputs of a trial, with where all of it may lie.

What a trial holds is measured from its track; the same is read here from the track that the model
sails under the same rudder, whether or not the fit compared a position. Ranges are as those of the
standard measures: what the record leaves open of the parameters, of what was held fixed, and of
what may be missing is followed to each number by its slopes.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.design.imo.measure_slopes import Shows
from trialid.design.imo.speed_loss import logged_loss, speed_loss
from trialid.design.prediction.likely_spread import LikelySpread, under_own_logs
from trialid.design.standard import AT_SEA
from trialid.effects.environment import steady_wind
from trialid.effects.track import current
from trialid.errors import EffectError, NotIdentifiable
from trialid.identification.check.start_error import StartError
from trialid.identification.fit import Fit
from trialid.identification.trial_score import of_trial, own_start_error
from trialid.ship.effect import Effect
from trialid.ship.model import STATES, ShipModel, moves_her
from trialid.simulation.integrate import Simulator, initial, prepare, respond
from trialid.trial import Trial

PLACE: Final = ("psi", "x", "y")
Track = Mapping[str, Vector]
Numbers = Callable[[Track], Mapping[str, float]]
"""What is read from a track; DesignError where it does not come so far."""


@dataclass(frozen=True, kw_only=True)
class SailedTrial:
    """A trial as the fitted ship sails it.

    Attributes
    ----------
    track
        `psi` [rad], `x` and `y` [m]; (N,) each.
    by
        Their slopes by what is known and what may be missing; (N, 3, n).
    others
        Tracks with an effect at a value tried, and the columns of it.
    speed, speed_by
        Where it is simulated, the speed ahead [m/s] (N,), and its slopes (N, n).
    noise
        Slopes by what noise leaves open of where it begins, where no parameter of the fit says so,
        times that; (N, 3, m).
    """

    track: Track
    by: Vector
    others: tuple[tuple[Track, tuple[int, ...]], ...]
    spread: LikelySpread
    speed: Vector | None = None
    speed_by: Vector | None = None
    noise: Vector | None = None


@dataclass(frozen=True, kw_only=True)
class Sailing:
    """What is sailed: a model with a track, her parameters and start, and columns by their place.

    Attributes
    ----------
    starts
        Columns of initial states that slopes are wanted by.
    """

    model: ShipModel
    trial: Trial
    values: Mapping[str, float]
    start: Mapping[str, float]
    starts: Mapping[str, int]


def sail_trial(fit: Fit, trial: Trial, spread: LikelySpread) -> SailedTrial | None:
    """The trial as the fitted ship sails it; None where she cannot, or leaves her model."""
    spread = under_own_logs(fit, spread)
    try:
        values, start = of_trial(fit, trial)
        known = own_start_error(fit, trial) if trial.use == "check" else None
        one = Sailing(
            model=with_track(fit, trial),
            trial=trial,
            values=values,
            start=start,
            starts=_own_starts(fit, trial) if known is None else _found_starts(known, spread),
        )
        if known is None:
            return sail(fit, one, spread)
        sailed = sail(fit, one, spread, len(known.names))
        return None if sailed is None else _from_found_start(sailed, known)
    except (EffectError, NotIdentifiable):
        return None  # a motion that carries her along is neither simulated nor recorded


def _found_starts(known: StartError, spread: LikelySpread) -> dict[str, int]:
    """Place of what a trial to check has for itself, beyond all else; what turns her turns all."""
    first = len(spread.known) + spread.width
    return {n: first + i for i, n in enumerate(known.names) if n != initial("psi")}


def _from_found_start(sailed: SailedTrial, known: StartError) -> SailedTrial:
    """A trial to check begins where it was found to for these parameters, as far as noise lets."""
    first = sailed.by.shape[-1] - len(known.names)
    places = [sailed.spread.fitted.index(c) for c in known.shared]
    by, start = sailed.by[..., :first].copy(), sailed.by[..., first:]
    by[..., places] += start @ known.by
    ahead = None if sailed.speed_by is None else sailed.speed_by[..., :first].copy()
    if ahead is not None and sailed.speed_by is not None:
        ahead[..., places] += sailed.speed_by[..., first:] @ known.by
    return replace(sailed, by=by, speed_by=ahead, noise=start @ known.noise)


def has_wind(model: ShipModel) -> bool:
    """Whether there is any wind in a model."""
    return any(is_wind(e) for e in model.effects)


def is_wind(effect: Effect) -> bool:
    """Whether an effect is by the wind, recorded or unseen; so is what frees a part of one."""
    steady = {*effect.parameters} & {*steady_wind.parameters}
    return bool(steady or {"V_aw", "gamma_aw"} & {*effect.signals})


def sail(fit: Fit, one: Sailing, spread: LikelySpread, more: int = 0) -> SailedTrial | None:
    """What a model sails, with its slopes; None where she leaves her model.

    Parameters
    ----------
    more
        Columns beside what is known and what may be missing.
    """
    acting = [m for m in spread.missing if _acts(m.effect, one.trial, one.model)]
    linear = [m for m in acting if not m.tried]
    model = one.model
    for rival in linear:
        model = (model + rival.effect).with_values(rival.effect.nulls)
    places = {**_places(spread, linear), **one.starts}
    free = [n for n in places if n in model.parameters]
    outputs = (*PLACE, "u") if "u" in model.states else PLACE
    simulator = prepare(model, free, outputs, substeps=fit.settings.substeps)
    own = {n: one.values.get(n, model.value(n)) for n in free}
    response = respond(simulator, one.trial, own, one.start)
    if response.departure is not None or response.S is None:
        return None
    width = len(spread.known) + spread.width + more
    by = np.zeros((one.trial.samples, len(outputs), width))
    for i, column in enumerate(simulator.columns):
        if column in places:
            by[..., places[column]] = response.S[..., i]
    others = tuple(o for m in acting if m.tried and (o := _tried(one, m, spread)))
    ahead = "u" in outputs
    return SailedTrial(
        track=_track(response.y),
        by=by[:, :3],
        others=others,
        spread=spread,
        speed=response.y[:, 3] if ahead else None,
        speed_by=by[:, 3] if ahead else None,
    )


def sail_plainly(fit: Fit, trial: Trial) -> Track | None:
    """The track alone as the fitted ship sails it, from the first position and heading recorded."""
    try:
        _, start = of_trial(fit, trial)
        response = respond(_plain(with_track(fit, trial)), trial, {}, start, sensitivities=False)
    except (EffectError, NotIdentifiable):
        return None
    return None if response.departure is not None else _track(response.y)


def with_track(fit: Fit, trial: Trial) -> ShipModel:
    """The fitted model with a track of its own, through the water; losing speed where none is.

    Her rudder stands off its record as it does in this trial, and its speed has the current in it:
    else who was steered by a rudder reversed in time turns to the side where it was reversed late.
    """
    states = tuple(s for s in STATES if s in {*fit.model.states, *PLACE})
    model, present = replace(fit.model, states=states), {e.name for e in fit.model.effects}
    values, _ = of_trial(fit, trial)
    for effect in fit.problem.simulator.model.effects:
        if effect.name not in present and moves_her(effect):
            model = (model + effect).with_values({n: values[n] for n in effect.parameters})
    if current.name in {e.name for e in model.effects}:
        model = model - current.name
    logged = "u" in trial.signals and float(np.ptp(trial.signals["u"])) > 0.0
    loss = None if logged else speed_loss(fit)
    return model if loss is None else (model + logged_loss).with_values(loss.values)


def _acts(effect: Effect, trial: Trial, model: ShipModel) -> bool:
    """Whether an effect moves the ship by what this trial holds."""
    unknown = ({*effect.signals} & AT_SEA) - {*trial.signals} - {*model.states}
    return moves_her(effect) and not unknown


def _own_starts(fit: Fit, trial: Trial) -> dict[str, int]:
    """Place of what a fitted trial has for itself, its initial states and its sensors'."""
    fitted = [t.name for t in fit.problem.trials]
    own = {
        x.column: i
        for i, x in enumerate(fit.problem.unknowns)
        if x.trial is not None and fitted[x.trial] == trial.name
    }
    return {n: i for n, i in own.items() if n != initial("psi")}


def _places(spread: LikelySpread, linear: Sequence[Shows]) -> dict[str, int]:
    """Place of each column of a simulator among what the spread is by."""
    known = {n: i for i, n in enumerate(spread.known) if n != initial("psi")}
    for one in linear:
        more = zip(one.parameters, one.columns, strict=True)
        known |= {n: len(spread.known) + c for n, c in more}
    return known


def _tried(
    one: Sailing, rival: Shows, spread: LikelySpread
) -> tuple[Track, tuple[int, ...]] | None:
    model = (one.model + rival.effect).with_values({**rival.effect.nulls, **rival.tried})
    response = respond(_plain(model), one.trial, {}, one.start, sensitivities=False)
    if response.departure is not None:
        return None
    return _track(response.y), tuple(len(spread.known) + c for c in rival.columns)


def _plain(model: ShipModel) -> Simulator:
    return prepare(model, (), PLACE)


def _track(y: Vector) -> Track:
    return dict(zip(PLACE, y[:, :3].T, strict=True))
