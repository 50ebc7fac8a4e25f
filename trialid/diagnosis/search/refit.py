"""Candidates added to the model and fitted, and what carries over."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from trialid.diagnosis.noise.thinning import on_every_sample, with_means
from trialid.diagnosis.search.carried import (
    EACH,
    Carried,
)
from trialid.diagnosis.search.carry_over import carried_between
from trialid.diagnosis.search.score import Candidate
from trialid.errors import TrialidError
from trialid.identification.fit import Fit, identify
from trialid.identification.problem import Settings
from trialid.identification.roll.own_roll import goes_on
from trialid.identification.ship_priors import known_of_ship
from trialid.second_process import each
from trialid.ship.effect import Effect
from trialid.ship.model import ShipModel


@dataclass(frozen=True)
class Refit:
    """A candidate added to the model and fitted; what carries over about the fits' own optima."""

    candidate: Candidate
    fit: Fit
    carried: Carried

    @property
    def effects(self) -> tuple[Effect, ...]:
        """What was added, one effect."""
        return (self.candidate.effect,)

    @cached_property
    def rolls_on(self) -> bool:
        """Whether her roll with it goes on as a swell's: asked often, and a simulation."""
        return goes_on(self.fit.problem, self.fit.theta)

    @property
    def cost(self) -> float:
        """What refits are ordered by, the least first: what is left, and 1 % a parameter."""
        return self.carried.log_ratio + EACH * (len(self.candidate.effect.parameters) - 1)


Progress = Callable[[str], None]


def refit(fit: Fit, candidates: Sequence[Candidate], progress: Progress) -> list[Refit]:
    """Each candidate added and fitted from its expected value; those that fail are left out."""
    if not candidates:
        return []
    seen = with_means(fit)

    def tried(candidate: Candidate) -> Refit | None:
        progress(f"trying {candidate.effect.name}")
        try:
            found = _fitted(seen.examined, candidate)
        except TrialidError:  # it cannot be fitted on this record: it is not the missing one
            return None
        carried = carried_between(seen.examined, found, candidate.carried.seen)
        return Refit(candidate, on_every_sample(seen, found), carried)

    known = (*seen.trials, *seen.examined.trials, *candidates)
    return [done for done in each(tried, candidates, known) if done is not None]


def _fitted(fit: Fit, candidate: Candidate) -> Fit:
    """The model with a candidate, from its expected value.

    A value that was tried may lie far from all that the rest was fitted to: where the search does
    not arrive, it begins again where the model itself began, and what only shapes the effect waits.
    """
    effect = candidate.effect
    model, start = begun_at(fit.model, (effect,), candidate.expected)
    settings = settings_with(fit, (effect,))
    found = identify(fit.trials, model, settings, near=fit.estimates | start, smaller=fit)
    if moves_rudder(effect):  # a hull that is fitted without one may be none
        begun = identify(fit.trials, first_model(fit) + effect, settings, near=start)
        found = min(begun, found, key=lambda one: (not one.converged, one.eps_rmsn))
    if found.converged or not effect.scanned:
        return found
    shape = {n for n, p in effect.parameters.items() if not p.scan}
    kept = tuple(n for n in settings.free if n not in shape)
    rest = identify(fit.trials, model, replace(settings, free=kept), near=start)
    again = identify(fit.trials, model, settings, near=start | rest.estimates, smaller=fit)
    return again if again.converged else found


def first_model(fit: Fit) -> ShipModel:
    """The model where its own search began: far from a fault it may have ended anywhere."""
    own = fit.model.parameters
    return fit.model.with_values(
        {x.column: x.start for x in fit.problem.unknowns if x.column in own}
    )


def moves_rudder(effect: Effect) -> bool:
    """Whether it is a steering gear: the rudder is a state that follows its order."""
    return "delta" in effect.states


def begun_at(
    model: ShipModel, effects: Sequence[Effect], values: Mapping[str, float]
) -> tuple[ShipModel, dict[str, float]]:
    """The model with effects at these values, as far as their ends allow, and the values."""
    start = dict[str, float]()
    for effect in effects:
        model = model + effect
        ends = {n: (p.low, p.high) for n, p in effect.parameters.items() if n in values}
        start |= {n: float(np.clip(values[n], *ends[n])) for n in ends}
    return model.with_values(start), start


def settings_with(fit: Fit, effects: Sequence[Effect]) -> Settings:
    """Their parameters free, too, with the priors that the pipeline would give them."""
    model, settings = fit.model, fit.settings
    free, new = settings.free, list[str]()
    for effect in effects:
        lost, model = model.lost_to(effect), model + effect
        free = tuple(n for n in free if n not in lost)
        new += [p for p in effect.parameters if p not in free]
        free = tuple(dict.fromkeys((*free, *new)))
    known = known_of_ship(model, tuple(new)) if settings.priors_of_ship else {}
    return replace(settings, free=free, priors={**settings.priors, **known})
