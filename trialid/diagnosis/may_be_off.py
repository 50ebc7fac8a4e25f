"""By how much every parameter of a fit may be off, by all that its model may lack or hold wrong."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final

import numpy as np

from trialid.accuracy.likely import WIDE, Averaged, Rows, Standing, stand
from trialid.accuracy.one_missing import Rival
from trialid.arrays import Vector
from trialid.diagnosis.restated import restates
from trialid.diagnosis.search.augment import Augmented, Trace
from trialid.diagnosis.search.carry_over import prior_rows
from trialid.identification.check.log_scales import log_scales
from trialid.identification.fit import Fit
from trialid.ship.effect import Parameter
from trialid.ship.estimate.roll_moments import MOMENTS

SMALLEST: Final = 1e-12
"""Typical size of a parameter whose effect calls nothing typical."""

IN_PART: Final = (0.0, 1.0)
"""How much of an effect there may be that was tried at one value."""


@dataclass(frozen=True)
class Doubts:
    """How the models of what may be missing stand, and what their columns are.

    Attributes
    ----------
    held, missing
        Coefficients that were held fixed, and what may be missing.
    """

    standing: Standing
    held: tuple[str, ...]
    missing: tuple[Trace, ...]

    @cached_property
    def averaged(self) -> Averaged:
        """The parameters' moves, averaged over the catalogue and the model as it is."""
        return self.standing.average()


def may_be_off(augmented: Augmented) -> Averaged:
    """The parameters' moves, averaged over the catalogue and the model as it is."""
    return doubts(augmented).averaged


def doubts(augmented: Augmented) -> Doubts:
    """What the rows of a fit say of the catalogue and of the model as it is.

    What is there whole or not at all has no size that could be small and unseen: it is left out,
    and so are the freeing of what was held fixed, which counts with its own uncertainty, and what
    says again what is free.
    """
    fit = augmented.fit
    ship = fit.problem.simulator.model
    deviations = [abs(ship.value(n)) * ship.ship.share_off(n) for n in augmented.held]
    S, traces = _may_be_missing(augmented)
    of_scales, scales = log_scales(fit)
    rows = Rows(
        residual=augmented.residual,
        psi=augmented.psi,
        priors=_as_contradicted(prior_rows(fit), fit),
        held=augmented.H,
        deviations=np.array(deviations),
        S=np.column_stack([S, of_scales]),
        level=fit.level,
        scales=scales,
    )
    ways = Counter(t.effect.name for t in traces)
    standing = stand(rows, [_rival(t, ways[t.effect.name]) for t in traces])
    return Doubts(standing, augmented.held, traces)


def _as_contradicted(priors: Vector, fit: Fit) -> Vector:
    """Rows of priors, of her own numbers each as uncertain as the record shows it to be.

    The likeliest scatter of what is off by several of its own is that. Held to it as it was stated,
    it moves what is held instead: of ships whose rudder heels them four times as much as their
    file says, 4.2 of its deviations, inertias in roll went down with it and the range of a GM that
    was right to 8 % ended below it. Moments in roll are sway forces over one lever, and off
    together: each for itself, they took down the inertias of a boat whose lever is 1.6 times that
    of her file, and of 12 sets of her trials six ranges ended below her GM, now none.
    """
    own = np.array([x.kind == "physical" for x in fit.problem.unknowns])
    off = np.maximum(np.abs(priors[:, 1]) / fit.level, 1.0)
    by_lever = np.array([x.column in MOMENTS for x in fit.problem.unknowns]) & own
    off[by_lever] = np.max(off[by_lever], initial=1.0)
    return priors / np.where(own, off, 1.0)[:, None]


def _may_be_missing(augmented: Augmented) -> tuple[Vector, tuple[Trace, ...]]:
    """The traces that count, and their columns alone."""
    kept, columns = list[Trace](), list[int]()
    for trace in augmented.traces:
        effect = trace.effect
        if effect.held is None and not effect.is_whole and not restates(effect, augmented.fit):
            first = len(columns)
            columns += trace.columns
            kept.append(replace(trace, columns=tuple(range(first, len(columns)))))
    return augmented.S[:, columns], tuple(kept)


def _rival(trace: Trace, ways: int) -> Rival:
    """An effect that may be missing, at its typical size; where values were tried, at that one.

    One that shows in several ways is one effect all the same.
    """
    name, columns, share = trace.effect.name, trace.columns, 1.0 / ways
    if trace.tried:
        return Rival(name, columns, (1.0,) * len(columns), IN_PART, share)
    parameters = [trace.effect.parameters[n] for n in trace.parameters]
    typical = tuple(WIDE * (abs(p.start) or SMALLEST) for p in parameters)
    return Rival(name, columns, typical, _limits(parameters), share)


def _limits(parameters: Sequence[Parameter]) -> tuple[float, float] | None:
    """Of the size of a single parameter, about its null; None where it has none."""
    [one, *others] = parameters
    null = one.null or 0.0
    bounded = np.isfinite([one.low, one.high]).any() and not others
    return (one.low - null, one.high - null) if bounded else None
