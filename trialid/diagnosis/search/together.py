"""Two effects that are missing at once, where neither alone has a name.

Each alone may take next to nothing off, or make trials held out worse. Of a simulated ship whose
screw turns on while she loses speed in turns (`tests/grow/test_mmg_ships.py`) the race alone makes
them worse, sway by the cube of drift and turning adds to the error of blocks left out, and both
together leave 0.27 of its square. So all pairs are held against blocks left out by their slopes,
and those that foretell most are fitted.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import combinations

import numpy as np

from trialid.diagnosis.found_values import SURE, her_own, leaves_priors
from trialid.diagnosis.noise.thinning import on_every_sample, with_means
from trialid.diagnosis.objections import follows_a_swell, outputs_beside
from trialid.diagnosis.records.course_keeping import by_the_rudder, gained_on_course
from trialid.diagnosis.search.augment import Augmented, Trace, augment
from trialid.diagnosis.search.carried import EACH, LARGE, Carried, as_good
from trialid.diagnosis.search.carry_over import LeftOut, carried_between, left_out
from trialid.diagnosis.search.falls import fall, fall_of_check
from trialid.diagnosis.search.refit import begun_at, settings_with
from trialid.errors import TrialidError
from trialid.identification.adequacy import why_no_fit
from trialid.identification.fit import Fit, identify
from trialid.identification.problem import Settings
from trialid.identification.roll.own_roll import goes_on
from trialid.ship.effect import Effect

Pair = tuple[Trace, Trace]


@dataclass(frozen=True)
class Together:
    """Effects fitted at once, and what carries over about the fits' own optima.

    `alike` are the names of other pairs that stand every check and do as much.
    """

    effects: tuple[Effect, ...]
    fit: Fit
    carried: Carried
    alike: tuple[tuple[str, ...], ...] = ()

    @property
    def names(self) -> tuple[str, ...]:
        """Of the effects, in the order of the catalogue."""
        return tuple(e.name for e in self.effects)

    @property
    def arrives(self) -> bool:
        """Whether the search did, with none of their parameters at an end of its range."""
        new = {n for e in self.effects for n in e.parameters}
        return self.fit.converged and not new & {*self.fit.at_bounds}

    @cached_property
    def rolls_on(self) -> bool:
        """Whether her roll with them goes on as a swell's."""
        return goes_on(self.fit.problem, self.fit.theta)

    @property
    def cost(self) -> float:
        """What pairs are ordered by, the least first: what is left, and 1 % a parameter."""
        return self.carried.log_ratio + EACH * sum(len(e.parameters) for e in self.effects)


def two_at_once(
    fit: Fit, catalogue: Mapping[str, Effect], most: int, progress: Callable[[str], None]
) -> Together | None:
    """The two effects of the ship that explain most of it together; None where no two do.

    Parameters
    ----------
    most
        How many pairs are fitted.
    """
    found = able(fit, fit_pairs(fit, catalogue, most, progress))
    best = min(found, key=lambda one: one.cost, default=None)
    if best is None:
        return None
    others = (one for one in found if one is not best)
    alike = (one.names for one in others if as_good(best.carried.after, one.carried.after))
    return replace(best, alike=tuple(alike))


def fit_pairs(
    fit: Fit,
    catalogue: Mapping[str, Effect],
    most: int,
    progress: Callable[[str], None],
    among: Callable[[Pair], bool] = lambda pair: True,
) -> list[Together]:
    """The pairs that foretell most, of those that are meant, fitted; what cannot be is left out."""
    fit = with_means(fit)
    pairs = [pair for pair in _worth_a_fit(augment(fit, catalogue)) if among(pair)]
    done = list[Together]()
    for pair in _unlike(pairs, most):
        effects = tuple(trace.effect for trace in pair)
        progress(f"trying {' and '.join(e.name for e in effects)}")
        try:
            found = fit_together(fit.examined, effects, settings_with(fit.examined, effects))
        except TrialidError:  # these two cannot be fitted on this record
            continue
        carried = carried_between(fit.examined, found)
        done.append(Together(effects, on_every_sample(fit, found), carried))
    return done


def stands(fit: Fit, one: Together) -> bool:
    """Whether nothing speaks against two effects once they are fitted.

    A tenth of the squared error must go: off what they were fitted to, off blocks left out, one
    like the other, and off trials held out; and of an output of which much is left, too.
    """
    held = fit.eps_check is None or fall_of_check(fit, one) > 1.0 - LARGE
    return (
        one.arrives
        and held
        and not leaves_priors(fit, one.fit, SURE)
        and not outputs_beside(fit, one)
        and fall(fit, one) > 1.0 - LARGE
        and one.carried.large
        and not (any(map(by_the_rudder, one.effects)) and gained_on_course(fit, one.fit))
        and not follows_a_swell(fit, one)
    )


def able(fit: Fit, done: Iterable[Together]) -> list[Together]:
    """Those against which nothing speaks, and whose fits can carry a verdict at all."""
    return [one for one in done if stands(fit, one) and why_no_fit(one.fit) is None]


def _worth_a_fit(augmented: Augmented) -> list[Pair]:
    """Pairs of her own that foretell far more than either alone, in all blocks, most first."""
    blocks = left_out(
        augmented.fit, augmented.residual, augmented.psi, augmented.S, augmented.stretches
    )
    traces = [t for t in augmented.traces if t.parameters and her_own(t.effect)]
    alone = {t.columns: blocks.carried(t.columns).ratio for t in traces}
    found = list[tuple[float, Pair]]()
    for pair in combinations(traces, 2):
        one, other = pair
        carried = blocks.carried((*one.columns, *other.columns))
        least = min(alone[one.columns], alone[other.columns])
        if carried.large and carried.ratio < LARGE * least and _possible(blocks, pair):
            parameters = len(one.parameters) + len(other.parameters)
            found.append((carried.price(parameters), pair))
    return [pair for _, pair in sorted(found, key=lambda each: each[0])]


def _possible(blocks: LeftOut, pair: Pair) -> bool:
    """Whether the values that slopes tell lie where a ship has them, in most of the blocks."""
    found = np.median(blocks.coefficients([c for t in pair for c in t.columns]), axis=0)
    each = [t.effect.parameters[n] for t in pair for n in t.parameters]
    nulls = np.array([p.null or 0.0 for p in each])
    low, high = (np.array([getattr(p, end) for p in each]) for end in ("low", "high"))
    return bool(np.all((low <= nulls + found) & (nulls + found <= high)))


def _unlike(pairs: Sequence[Pair], most: int) -> Iterator[Pair]:
    """The first of the pairs, but none whose effects have both been tried with others."""
    tried = set[str]()
    for pair in pairs:
        names = {trace.effect.name for trace in pair}
        if names <= tried:
            continue
        tried |= names
        yield pair
        most -= 1
        if not most:
            return


def fit_together(fit: Fit, effects: Sequence[Effect], settings: Settings) -> Fit:
    """The model with these effects, begun where they are absent."""
    absent = {n: x for effect in effects for n, x in effect.nulls.items()}
    model, start = begun_at(fit.model, effects, absent)
    near = fit.estimates | start
    return identify(fit.trials, model, settings, near=near, smaller=fit)
