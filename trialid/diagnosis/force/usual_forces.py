"""The model with all forces at once that hulls usually have, each about what her file says of it.

A hull's forces beyond the linear come together: what brakes her sway turns and heels her, too. One
or two of them in a model stand in for all, and the linear coefficients with them: of ships that
have them all, Nv and Nr came out a half too small, in one direction. No slope at such a fit reaches
as far as a fit with all of them does, held by what her file says of each.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Final, TypeVar

from trialid.diagnosis.noise.thinning import on_every_sample, with_means
from trialid.diagnosis.search.candidates import candidates_for
from trialid.diagnosis.search.carry_over import carried_between
from trialid.diagnosis.search.refit import settings_with
from trialid.diagnosis.search.together import Together, able, fit_together
from trialid.effects import CATALOGUE
from trialid.effects.usual_structures import (
    LOST_SPEED,
    RACE,
    TELLING,
    speed_of,
    usual_structures,
)
from trialid.errors import TrialidError
from trialid.identification.fit import Fit
from trialid.identification.problem import Settings
from trialid.identification.ship_priors import known_of_ship
from trialid.second_process import each
from trialid.ship.effect import Effect
from trialid.ship.model import ShipModel
from trialid.simulation.integrate import shared_record
from trialid.threads import one_thread
from trialid.trial import Trial

T = TypeVar("T")

AT_ONCE: Final = ("modulus", "cubic")
"""Hulls whose terms are told apart by hardly any trial: the ship may have either."""

ANY_HULL: Final = ("heel_sway", "heel_yaw", "roll_rate_yaw", "rudder_cubic")
"""What joins whatever the hull: what heel and rolling do, and lift that falls off at large angles.
Heel's own moment is GM's by another name."""

AS_HELD: Final = ("linear_hull", "linear_rudder")
"""Effects whose coefficients join what is estimated, as sure as her file says."""


@one_thread
def beside_usual_forces(fit: Fit, examine: Callable[[Fit], T]) -> tuple[T, ...]:
    """What is found of the model with all usual forces, by each usual hull.

    Where the pipeline's priors are her file's, and of a hull that is linear, or so but for a term
    that may stand in for all. Nothing by a hull whose search does not arrive, or that the record
    cannot carry.
    """
    if not (fit.settings.priors_of_ship or _is_linear(fit.model)):
        return ()
    seen = with_means(fit).examined

    def by(hull: str) -> T | None:
        found = with_hull(seen, hull)
        return None if found is None else examine(found)

    done = each(by, AT_ONCE, (*fit.trials, *seen.trials))
    return tuple(known for known in done if known is not None)


def hull_at_once(fit: Fit, tried: Mapping[str, Effect]) -> Together | None:
    """All forces of a usual hull that are among the tried, where they stand every check together.

    A force that ends at the end of its range is left out, for it is not known there.
    """
    if not fit.settings.priors_of_ship:
        return None
    seen = with_means(fit).examined

    def by(hull: str) -> Together | None:
        effects = usual_effects(seen.model, _fitted(seen), hull)
        return _within_ends(seen, [e for e in effects if e.name in tried])

    done = [one for one in each(by, AT_ONCE, (*fit.trials, *seen.trials)) if one is not None]
    found = [replace(one, fit=on_every_sample(fit, one.fit)) for one in done]
    return min(able(fit, found), key=lambda one: one.cost, default=None)


def _within_ends(fit: Fit, effects: Sequence[Effect]) -> Together | None:
    """The model with those of the effects that are known in it; None where no search arrives."""
    kept = tuple(effects)
    while kept:
        try:
            found = fit_together(fit, kept, settings_with(fit, kept))
        except TrialidError:  # this record does not carry as many
            return None
        ended = {*found.at_bounds}
        within = tuple(e for e in kept if not ended & {*e.parameters})
        if within == kept:
            return Together(kept, found, carried_between(fit, found))
        kept = within
    return None


def with_hull(fit: Fit, hull: str) -> Fit | None:
    """The fitted model with all forces of a usual hull; None where no search arrives."""
    effects = usual_effects(fit.model, _fitted(fit), hull)
    try:
        found = fit_together(fit, effects, _settings(fit, effects))
    except TrialidError:  # this record does not carry as many, or her file calls one exact
        return None
    return found if found.converged else None


def _fitted(fit: Fit) -> list[Trial]:
    return [trial for trial in fit.trials if trial.use == "fit"]


def usual_effects(model: ShipModel, trials: Sequence[Trial], hull: str) -> tuple[Effect, ...]:
    """Effects of a usual hull, of those that act on what is simulated and are not there yet."""
    present = [e.name for e in model.effects]
    usual, _ = usual_structures(model.states, present, speed_of(model.states, trials))
    wanted = (*usual.get(f"{hull}, race", usual.get(hull, ())), *ANY_HULL)
    able, _ = candidates_for(model, shared_record(trials), {n: CATALOGUE[n] for n in wanted})
    return tuple(able.values())


def _is_linear(model: ShipModel) -> bool:
    """Whether its hull is the linear one, with one term beyond at most."""
    there = {e.name for e in model.effects}
    return "linear_hull" in there and len(there & (TELLING - {RACE, LOST_SPEED})) < 2


def _settings(fit: Fit, effects: Sequence[Effect]) -> Settings:
    """Free with them is what is held of the linear forces, as sure as her file is."""
    held, asked = _held(fit), settings_with(fit, effects)
    free = tuple(dict.fromkeys((*asked.free, *held)))
    new = {} if fit.settings.priors_of_ship else _usual(fit.model, effects)
    return replace(asked, free=free, priors={**asked.priors, **held, **new})


def _usual(model: ShipModel, effects: Sequence[Effect]) -> Mapping[str, tuple[float, float]]:
    """What is likely of forces of which her file does not say how sure it is: their usual size."""
    known = {}
    for effect in effects:
        for name, parameter in effect.parameters.items():
            stated = model.stated(name)
            mean = effect.nulls[name] if stated is None else stated
            known[name] = (mean, max(abs(mean), abs(parameter.start)))
    return known


def _held(fit: Fit) -> Mapping[str, tuple[float, float]]:
    """Linear coefficients that are held, and that her file states with their scatter."""
    there = (e for e in fit.model.effects if e.name in AS_HELD)
    names = [n for e in there for n in e.parameters if n not in fit.settings.free]
    return known_of_ship(fit.model, [n for n in names if fit.model.ship.share_off(n)])
