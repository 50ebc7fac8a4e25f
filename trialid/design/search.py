"""Better tests: the numbers left open, chosen so that the wanted parameters come out accurate.

Candidates scattered over all open numbers of a programme at once, then an evolution from the best
of them. Every candidate is sailed on every plausible ship, held against the limits and rated. The
seed is explicit; the same seed gives the same programme.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

from trialid.design.evolution import evolve
from trialid.design.helm import Passage, Vessel
from trialid.design.imo.speed_loss import with_logged_speed
from trialid.design.kinds import KINDS, Test, Value, sail
from trialid.design.limits import Excess, Limits, excesses
from trialid.design.rating import Goal, Rating, rate
from trialid.design.rudders import amidships
from trialid.errors import DesignError

Vector = NDArray[np.float64]
Criterion = Literal["error", "S_imin", "R", "D", "A"]
Over = Literal["mean", "worst"]

Progress = Callable[[int, float], None]
"""Told how many candidates were tried and the best score so far."""

BROKEN: Final = 1e3
"""Score from which a programme breaks a limit; the further beyond, the more."""


@dataclass(frozen=True)
class Ship:
    """One plausible ship: what is sailed, what is to be fitted to it, and her roll."""

    vessel: Vessel
    goal: Goal
    roll_frequency: float
    speed: float


@dataclass(frozen=True)
class Outcome:
    """A programme on one ship: its passages, the limits it breaks, its rating where it may."""

    passages: tuple[Passage, ...]
    excesses: tuple[Excess, ...]
    rating: Rating | None


@dataclass(frozen=True)
class Search:
    """How to search: what counts, over the ships how, how many candidates, and the seed."""

    criterion: Criterion = "error"
    over: Over = "mean"
    candidates: int = 2000
    seed: int = 0


@dataclass(frozen=True)
class Found:
    """The best programme of a search, its score, and how many candidates were tried."""

    programme: tuple[Test, ...]
    score: float
    tried: int


def sail_all(
    programme: Sequence[Test], vessel: Vessel, roll_frequency: float
) -> tuple[Passage, ...]:
    """Every test of a programme, carried out."""
    return tuple(sail(test, vessel, roll_frequency) for test in programme)


def outcome(programme: Sequence[Test], ship: Ship, limits: Limits) -> Outcome:
    """Sail a programme and rate it; no rating where it breaks a limit."""
    passages = sail_all(programme, ship.vessel, ship.roll_frequency)
    broken = [e for p in passages for e in excesses(p, limits, ship.speed)]
    broken = sorted(broken, key=lambda e: -e.share)
    logged = [with_logged_speed(p.trial, ship.speed) for p in passages]
    rating = None if broken else rate(ship.goal, logged)
    return Outcome(passages, tuple(broken), rating)


def score(rating: Rating, criterion: Criterion, wanted: Sequence[str]) -> float:
    """What a search makes small: logarithms, so that a ratio counts the same everywhere."""
    rows = [rating.of(name) for name in wanted]
    if criterion == "R":
        return float(np.log(rating.R))
    if criterion == "S_imin":
        return -float(np.log(max(min(p.S_imin for p in rows), 1e-300)))
    if criterion == "D":
        return rating.log_volume
    errors = np.array([p.error for p in rows])
    if criterion == "A":
        return float(np.log(np.mean(errors**2))) / 2.0
    return float(np.log(errors.max()))


def optimise(
    programme: Sequence[Test],
    ships: Sequence[Ship],
    limits: Limits,
    search: Search,
    progress: Progress = lambda tried, best: None,
) -> Found:
    """Choose every open number of a programme so that the wanted parameters come out accurate.

    Raises
    ------
    DesignError
        Nothing is open, or no candidate keeps the limits: the message names the one that binds.
    """

    def over_ships(candidate: Sequence[Test]) -> float:
        scores = [_scored(candidate, ship, limits, search) for ship in ships]
        worst = max(scores)
        return worst if search.over == "worst" or worst >= BROKEN else float(np.mean(scores))

    found = search_open(programme, over_ships, search, progress)
    if found.score >= BROKEN:
        raise DesignError(_impossible(found.programme, ships, limits))
    return found


def search_open(
    programme: Sequence[Test],
    score_of: Callable[[Sequence[Test]], float],
    search: Search,
    progress: Progress,
) -> Found:
    """The open numbers with the smallest score.

    Raises
    ------
    DesignError
        Nothing is open.
    """
    places = _places(programme)
    if not places:
        raise DesignError("no number of the tests is left open; write [low, high] for one")
    count, best = 0, np.inf

    def tried(point: Vector) -> float:
        nonlocal count, best
        count += 1
        found = score_of(decode(programme, places, point))
        best = min(best, found)
        progress(count, best)
        return found

    best_one = evolve(tried, len(places), search.candidates, search.seed)
    return Found(decode(programme, places, best_one.x), best_one.score, count)


def _scored(candidate: Sequence[Test], ship: Ship, limits: Limits, search: Search) -> float:
    try:
        came = outcome(candidate, ship, limits)
    except DesignError:
        return 10.0 * BROKEN
    if came.rating is None:
        return BROKEN * (1.0 + sum(min(e.share, 5.0) for e in came.excesses))
    return min(score(came.rating, search.criterion, ship.goal.wanted), BROKEN / 2.0)


Places = list[tuple[int, str, int | None, float, float]]
"""Test, name and index of every open number, and its limits; index None where it is no list."""


def _places(programme: Sequence[Test]) -> Places:
    found: Places = []
    for i, test in enumerate(programme):
        for name, (low, high) in test.open.items():
            many = name != "duration" and KINDS[test.kind].variables[name].many
            value = test.values.get(name, ())
            count = len(value) if many and not isinstance(value, float | int) else 0
            if many and count == 0:
                raise DesignError(f"test {test.name or test.kind!r}: say how many {name!r}")
            indices = list(range(count)) if many else [None]
            found += [(i, name, index, low, high) for index in indices]
    return found


def decode(programme: Sequence[Test], places: Places, point: Vector) -> tuple[Test, ...]:
    """The programme with its open numbers at a point of the unit cube."""
    made = list(programme)
    for (i, name, index, low, high), share in zip(places, point, strict=True):
        value = float(low + (high - low) * min(max(share, 0.0), 1.0))
        made[i] = _with(made[i], name, index, value)
    return tuple(made)


def _with(test: Test, name: str, index: int | None, value: float) -> Test:
    if name == "duration":
        return replace(test, duration=value)
    values: dict[str, Value] = dict(test.values)
    if index is None:
        values[name] = value
    else:
        old = values[name]
        listed = [old] if isinstance(old, float | int) else list(old)
        listed[index] = value
        values[name] = tuple(listed)
    return replace(test, values=values)


def _impossible(programme: Sequence[Test], ships: Sequence[Ship], limits: Limits) -> str:
    """Why the best that was found may still not be run."""
    broken = [e for ship in ships for e in outcome(programme, ship, limits).excesses]
    if not broken:
        return "no candidate could be rated; the model to be fitted leaves its domain in all"
    return binding_limit(broken)


def binding_limit(broken: Sequence[Excess]) -> str:
    """Why the best test that was found may not be run: the limit that binds, in words."""
    worst = max(broken, key=lambda e: e.share)
    return f"no test of this kind keeps the limits; {worst.limit} binds: {worst.sentence}"


def natural_roll(vessel: Vessel) -> float:
    """Natural frequency of roll [rad/s], from the decay of a small heel.

    Raises
    ------
    DesignError
        The model does not roll, or does not swing.
    """
    from trialid.simulation.integrate import respond
    from trialid.trial import Trial

    model = vessel.model
    if not {"p", "phi"} <= {*model.states}:
        raise DesignError("the model does not roll; put p and phi among its states")
    period, count = 0.1, 6000
    still = {c: np.full(count, value) for c, value in vessel.constants.items()}
    rest = amidships(model, count) | still
    blank = Trial("roll decay", "fit", period, rest, {})
    states = respond(vessel.simulator, blank, {}, {"phi": 0.02}, sensitivities=False).states
    roll = states[:, model.all_states.index("p")]
    crossings = np.flatnonzero(roll[1:] * roll[:-1] < 0.0)
    if len(crossings) < 3:
        raise DesignError("the roll of this ship does not swing; it has no natural period")
    return float(np.pi * (len(crossings) - 1) / ((crossings[-1] - crossings[0]) * period))
