"""Telling two effects apart: how alike they look in a test, and the test that shows the difference.

Both effects are added to the model that is to be fitted. What each does to the outputs, with
everything projected out that the free parameters can mimic and measured in standard deviations of
the sensors' noise, is compared with what the other can do.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from trialid.arrays import Mask, Vector
from trialid.design.helm import Vessel
from trialid.design.kinds import Test
from trialid.design.limits import Limits, excesses
from trialid.design.rating import Goal, Noise, goal
from trialid.design.search import BROKEN, Found, Search, binding_limit, sail_all, search_open
from trialid.design.triangles import Triangles, triangles
from trialid.errors import DesignError
from trialid.identification.problem import Settings
from trialid.least_squares.fold import triangle
from trialid.ship.effect import Effect
from trialid.ship.model import ShipModel
from trialid.trial import Trial

ENOUGH: Final = 6.0
"""Log-likelihood by which the right effect must be expected to win: odds of 400 to 1."""
WORTH_MORE: Final = 2.0
"""Times the log odds of the trials so far that a test has to bring with them. Two effects that
their noise alone should have kept apart, and did not, are not told apart by more of the same: of
seven strangers' records six gain 5 times or more, one 1.6 times. At half any test will do, at twice
the same six are left."""

BUT: Final = "were it not for what else is in them"
"""Said of log odds that the trials have by their noise alone, and have not told the two apart."""


@dataclass(frozen=True)
class Rivals:
    """Two effects to be told apart on one ship: a fit of both, and which columns are whose."""

    names: tuple[str, str]
    vessel: Vessel
    goal: Goal
    first: tuple[str, ...]
    second: tuple[str, ...]
    roll_frequency: float
    speed: float


@dataclass(frozen=True)
class Likeness:
    """How alike two effects look in a test.

    Attributes
    ----------
    cosine
        Largest |cos| between what they can do to the outputs, everything refitted; 1: the same.
    odds
        Log-likelihood by which the one wins when it is there in its typical size and the other is
        tried in its place, first and second.
    """

    cosine: float
    odds: tuple[float, float]

    @property
    def separate(self) -> bool:
        """Whether either would be recognised."""
        return min(self.odds) >= ENOUGH


@dataclass(frozen=True)
class Separation:
    """A test that tells two effects apart as well as any found, and how it compares."""

    names: tuple[str, str]
    programme: tuple[Test, ...]
    before: Likeness | None
    after: Likeness
    tried: int

    @property
    def so_far(self) -> float:
        """Log odds for the right one in the trials there are."""
        return 0.0 if self.before is None else min(self.before.odds)

    @property
    def separate(self) -> bool:
        """Whether either would be recognised, and the test is what makes it so."""
        return self.after.separate and min(self.after.odds) >= WORTH_MORE * self.so_far

    @property
    def sentence(self) -> str:
        """What was found, in words."""
        one, other = self.names
        if not self.after.separate:
            return (
                f"no feasible test separates {one} from {other}: the best found leaves "
                f"|cos| {self.after.cosine:.3f}, and log odds for the right one of "
                f"{min(self.after.odds):.1f}, where {ENOUGH:g} are needed"
            )
        odds = f"log odds for the right one {min(self.after.odds):.0f}"
        known = self.so_far >= ENOUGH
        if not self.separate:
            return (
                f"no feasible test tells {one} from {other} much better than the trials there are, "
                f"whose {self.so_far:.0f} would be enough, {BUT}: {odds} at best"
            )
        came = "" if self.before is None or known else f", {self.so_far:.0f} so far"
        but = f"; the {self.so_far:.0f} so far would be, too, {BUT}" if known else ""
        return (
            f"{one} and {other} come apart: {odds}{came}, where {ENOUGH:g} are enough against "
            f"noise alone{but}; |cos| {self.after.cosine:.3f}"
        )


def rivals(
    model: ShipModel, settings: Settings, noise: dict[str, Noise], effects: tuple[Effect, Effect],
    vessel: Vessel, roll_frequency: float, speed: float,
) -> Rivals:  # fmt: skip
    """Make two effects ready to be compared; those the model has already are taken out of it."""
    for effect in effects:
        if effect.name in {e.name for e in model.effects}:
            model = model - effect.name
    own = [tuple(effect.parameters) for effect in effects]
    shared = {*own[0]} & {*own[1]}
    if shared:
        raise DesignError(f"the two effects share {min(shared)!r}; they cannot be compared")
    both = model + effects[0] + effects[1]
    both = both.with_values({n: where for e in effects for n, where in expansion_point(e).items()})
    left = tuple(n for n in settings.free if n in model.parameters)
    asked = goal(both, replace(settings, free=(*left, *own[0], *own[1])), noise)
    names = (effects[0].name, effects[1].name)
    return Rivals(
        names=names,
        vessel=vessel,
        goal=asked,
        first=own[0],
        second=own[1],
        roll_frequency=roll_frequency,
        speed=speed,
    )


def expansion_point(effect: Effect) -> dict[str, float]:
    """Where an effect's sensitivities are taken: at its null, or at its size where none acts."""
    return {
        n: p.start if p.null is None or p.scan else p.null for n, p in effect.parameters.items()
    }


def likeness(rivals: Rivals, trials: Sequence[Trial]) -> Likeness:
    """How alike the two look in these trials."""
    return likeness_of(rivals, triangles(rivals.goal, trials))


def likeness_of(rivals: Rivals, so_far: Triangles) -> Likeness:
    """How alike the two look in what trials show."""
    rows, names = so_far.rows(rivals.goal.noise), so_far.names
    A = triangle(rows)  # as far as angles and lengths go, the same; a record long, a square high
    one, other = (np.isin(names, part) for part in (rivals.first, rivals.second))
    Q = _span(A[:, ~(one | other)])
    first, second = (A[:, c] - Q @ (Q.T @ A[:, c]) for c in (one, other))
    return Likeness(
        _cosine(first, second),
        (_odds(rivals, names, first, one, second), _odds(rivals, names, second, other, first)),
    )


def _cosine(first: Vector, second: Vector) -> float:
    """Largest canonical correlation of two blocks of columns."""
    spans = [_span(block) for block in (first, second)]
    if any(s.shape[1] == 0 for s in spans):
        return 1.0
    return float(min(np.linalg.svd(spans[0].T @ spans[1], compute_uv=False)[0], 1.0))


def _span(block: Vector) -> Vector:
    """Orthonormal columns of what a block of columns can do."""
    norms = np.linalg.norm(block, axis=0)
    u, s, _ = np.linalg.svd(block[:, norms > 0.0] / norms[norms > 0.0], full_matrices=False)
    return np.asarray(u[:, s > 1e-8])


def _odds(
    rivals: Rivals, names: Sequence[str], block: Vector, columns: Mask, rival: Vector
) -> float:
    """Log-likelihood lost when an effect of typical size is taken for its rival."""
    sizes = {x: rivals.goal.model.parameters[x].start for x in (*rivals.first, *rivals.second)}
    mine = [n for n, on in zip(names, columns, strict=True) if on]
    signal = block @ np.array([np.sign(sizes[n]) or 1.0 for n in mine])
    taken = _span(rival)
    left = signal - taken @ (taken.T @ signal)
    return float(left @ left) / 2.0


def separate(
    programme: Sequence[Test],
    rivals: Rivals,
    limits: Limits,
    search: Search,
    so_far: Sequence[Trial] = (),
    progress: Callable[[int, float], None] = lambda tried, best: None,
) -> Separation:
    """The feasible test in which two effects look least alike, in what is left open.

    Parameters
    ----------
    so_far
        Trials that were run already: they are fitted together with the new ones.

    Raises
    ------
    DesignError
        No candidate keeps the limits: the message names the one that binds.
    """

    def score(candidate: Sequence[Test]) -> float:
        passages = sail_all(candidate, rivals.vessel, rivals.roll_frequency)
        broken = [e for p in passages for e in excesses(p, limits, rivals.speed)]
        if broken:
            return BROKEN * (1.0 + sum(min(e.share, 5.0) for e in broken))
        try:
            alike = likeness(rivals, [*so_far, *(p.trial for p in passages)])
        except DesignError:  # nothing moves in it, or the model cannot follow
            return 10.0 * BROKEN
        # odds beyond enough are still worth something: the noise at sea is never as stated
        return alike.cosine + ENOUGH / (ENOUGH + min(alike.odds))

    found: Found = search_open(programme, score, search, progress)
    if found.score >= BROKEN:
        passages = sail_all(found.programme, rivals.vessel, rivals.roll_frequency)
        likeness(rivals, [*so_far, *(p.trial for p in passages)])  # says so where nothing moves
        broken = [e for p in passages for e in excesses(p, limits, rivals.speed)]
        raise DesignError(binding_limit(broken))
    passages = sail_all(found.programme, rivals.vessel, rivals.roll_frequency)
    after = likeness(rivals, [*so_far, *(p.trial for p in passages)])
    before = likeness(rivals, so_far) if so_far else None
    return Separation(rivals.names, found.programme, before, after, found.tried)
