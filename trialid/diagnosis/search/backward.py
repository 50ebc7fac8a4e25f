"""What each effect of a grown model is still worth, and which no longer pays for its place.

An effect that came first may have stood in for one that came later: with that in the model it
explains nothing. So every effect is left out in turn and the rest fitted again. Twins that are both
in the model cover each other; for their worth they are left out together.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from trialid.diagnosis.search.carried import SHAPE, Carried, Errors
from trialid.diagnosis.search.carry_over import carried_between, left_out, levels, own_errors
from trialid.diagnosis.search.falls import worse_held_out
from trialid.diagnosis.verdict import NAMED
from trialid.errors import TrialidError
from trialid.identification.fit import Fit, identify
from trialid.identification.output_error import stretches
from trialid.ship.effect import Effect
from trialid.trial import Trial


@dataclass(frozen=True)
class Worth:
    """What leaving out an effect, the rest fitted again, does to the error of blocks left out.

    Attributes
    ----------
    together
        The effect and those of its family in the model, which were left out with it.
    fit
        The model without them; None where it could not be fitted, and the cost is linear.
    carried
        From the model without to the model with them.
    """

    effect: str
    together: tuple[str, ...]
    fit: Fit | None
    carried: Carried

    @property
    def costs(self) -> float:
        """Squared error without over that with the effect."""
        return 1.0 / max(self.carried.ratio, 1e-300)

    @property
    def pays(self) -> bool:
        """Whether it is worth as much as an effect must be to join."""
        return self.carried.worth >= SHAPE


def worths(
    fit: Fit,
    trials: Sequence[Trial],
    effects: Sequence[Effect],
    kin: Mapping[str, frozenset[str]] | None = None,
    known: Sequence[Worth] = (),
) -> tuple[Worth, ...]:
    """Each of these effects left out, the dearest first.

    Parameters
    ----------
    kin
        Effects that records could not separate from one: they are left out with it.
    known
        What was found out about this fit already: no model is fitted twice.
    """
    found = list[Worth]()
    done = {w.together: w for w in known}
    for effect in effects:
        near = (kin or {}).get(effect.name, frozenset())
        out = [e for e in effects if e is effect or e.name in near]
        together = tuple(e.name for e in out)
        if together not in done:
            less = model_without(fit, trials, out)
            done[together] = Worth(effect.name, together, less, _carried(less, fit, out))
        found.append(replace(done[together], effect=effect.name))
    return tuple(sorted(found, key=lambda w: -w.costs))


def model_without(fit: Fit, trials: Sequence[Trial], effects: Sequence[Effect]) -> Fit | None:
    """The model without some of its effects, fitted; None where no search arrives."""
    own = {n for e in effects for n in e.parameters}
    model = fit.model
    for effect in effects:
        model = model - effect.name if effect.held is None else model.with_values(effect.nulls)
    settings = replace(fit.settings, free=tuple(n for n in fit.settings.free if n not in own))
    near = {n: x for n, x in fit.estimates.items() if n not in own}
    try:
        found = identify(trials, model, settings, near=near)
    except TrialidError:  # the rest cannot do without it
        return None
    return found if found.converged else None


def _carried(less: Fit | None, fit: Fit, out: Sequence[Effect]) -> Carried:
    """What the effects that are out do to the error: by the fit without them, or to first order."""
    if less is not None:
        return carried_between(less, fit, weights=levels(fit))
    return Carried.between(_linearly(fit, out), own_errors(fit))


def _linearly(fit: Fit, effects: Sequence[Effect]) -> Errors:
    """Left-out errors with the effects' parameters where they were, the rest free, to first order.

    That is zero, or the value at which a coefficient was held.
    """
    own = {n: e.nulls[n] if e.held is not None else 0.0 for e in effects for n in e.parameters}
    mine = [i for i, x in enumerate(fit.problem.unknowns) if x.column in own]
    psi = fit.psi.copy()
    psi[:, mine] = 0.0
    back = fit.theta[mine] - [own[fit.problem.unknowns[i].column] for i in mine]
    residual = fit.residual + fit.psi[:, mine] @ back
    none = np.zeros((len(residual), 0))
    return left_out(fit, residual, psi, none, stretches(fit.problem)).errors()


def to_drop(fit: Fit, found: Sequence[Worth]) -> Worth | None:
    """The cheapest effect, where it no longer pays and held-out trials do not miss it."""
    idle = [w for w in found if w.fit and not w.pays and not worse_held_out(fit, w.fit)]
    return min(idle, key=lambda w: w.costs, default=None)


def worth_naming(found: Sequence[Worth]) -> tuple[str, ...]:
    """The effects that are named for a grown model: the dearest, and others that cost a tenth."""
    dearest = sorted(found, key=lambda w: -w.costs)
    return tuple(w.effect for i, w in enumerate(dearest) if i == 0 or w.costs >= NAMED)
