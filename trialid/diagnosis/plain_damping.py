"""A resonance that an effect brings, and the plain damping of the equation that it acts on.

A tank has three numbers, and beside a model without damping it damps. Of a model of 5 m let go at
rest, whose damping grows with speed in the pipeline, a tank had the name with p = 1: it took the
error from 59 % to 8.7 where damping at rest takes it to 10.1, and slopes of a fit so far off had
damping on the wrong side. So plain damping is fitted, too, before a resonance has a name.
"""

from collections.abc import Collection, Sequence
from dataclasses import replace
from typing import Final, Protocol

from trialid.diagnosis.search.carried import RIVAL, Carried, does_as_well
from trialid.diagnosis.search.score import Candidate
from trialid.ship.effect import Effect, Force

RATES: Final = {"X": "u", "Y": "v", "K": "p", "N": "r"}
"""Of each equation the motion that plain damping opposes."""


class Fitted(Protocol):
    """A candidate that was fitted, and what carries over."""

    @property
    def candidate(self) -> Candidate:
        """What was added."""

    @property
    def carried(self) -> Carried:
        """What it does to blocks left out."""


def dampings(
    named: Candidate, ranking: Sequence[Candidate], fitted: Collection[str]
) -> list[Candidate]:
    """Plain damping to fit before a resonance, or another damping, has the name; by no slope.

    Nothing where what would be named is neither; `fitted` are names of what is done. That a slope
    leads out of the range is nothing against it: it is fitted within.
    """
    if not (_resonates(named.effect) or _damps_beside(named.effect, named.effect)):
        return []
    able = (c for c in ranking if c.effect.name not in fitted)
    return [replace(c, allowed=True) for c in able if _damps_beside(c.effect, named.effect)]


def is_plain_damping(mine: Fitted, others: Sequence[Fitted], level: float) -> bool:
    """Whether plain damping does as well as a resonance, or takes most of what no test shows.

    Most is `RIVAL` of its fall, as a logarithm. Of what two true tanks take it takes 0.03 and
    nothing, of what a tank takes where damping at rest is missing 0.94 and more.
    """
    if not _resonates(mine.candidate.effect):
        return False
    plain = [o.carried for o in others if _damps_beside(o.candidate.effect, mine.candidate.effect)]
    if any(does_as_well(mine.carried, its) for its in plain):
        return True
    shown = mine.candidate.p_value < level
    return not shown and any(its.ratio < mine.carried.ratio**RIVAL for its in plain)


def _resonates(effect: Effect) -> bool:
    """Whether it brings a resonance of its own: two states, one the rate of the other."""
    return len(effect.states) > 1


def _damps_beside(effect: Effect, resonant: Effect) -> bool:
    """Whether it is plain damping of the equation that a resonance acts on, by its rate alone."""
    if {*effect.forms} != {Force} or effect.states:
        return False
    pushes = _pushes(effect)
    return pushes <= _pushes(resonant) and {*effect.signals} == {RATES[name] for name in pushes}


def _pushes(effect: Effect) -> set[str]:
    """Equations in which it is a force, where all that it reads differs."""
    values = {name: 0.1 * (1.0 + place) for place, name in enumerate(effect.signals)}
    parts = effect(values | {n: p.start for n, p in effect.parameters.items()})
    return {n for part in parts if isinstance(part, Force) for n, x in part._asdict().items() if x}
