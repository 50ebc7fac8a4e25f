"""More than one search where one does not arrive, and what was done, in words."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.identification.one_search import End, Progress, cost_at, random_starts, search
from trialid.identification.output_error import Problem, Unknown
from trialid.identification.problem import Settings
from trialid.identification.record_starts import further_starts, record_starts, with_own_starts
from trialid.identification.roll.own_roll import damped_by, is_a_ships
from trialid.identification.roll.roll_range import RollRange
from trialid.identification.roll.told_gm import FAR, along_GM, rivals, roll_error
from trialid.identification.weighing import NO_NOISE
from trialid.least_squares.gauss_newton import REASONS
from trialid.names import wording

Vector = NDArray[np.float64]

SAME_OPTIMUM: Final = 1e-6
"""Relative difference of V at which two searches ended at one optimum."""

DOUBTFUL: Final = 0.2
"""Normed error of roll above which its period must be looked for all over: the noise or another
error could hide a better one. Half: good fits take four times as long; twice: ships whose roll is
half noise are left at the first GM that comes."""

UNEXPLAINED: Final = 0.5
"""Normed error at which hardly anything was found."""

NOTICED: Final = 1.0
"""Twice the log likelihood by which an end is better than another: one standard error."""

FURTHER: Final = 3
"""Random starts before giving up, their physical parameters moved by up to `SPREAD`."""

SPREAD: Final = 0.6

PATIENCE: Final = 2
"""Times the iterations that the best of all searches may go on for, where it had not arrived."""


@dataclass(frozen=True)
class Arrival:
    """The best end of all searches.

    Attributes
    ----------
    same, tried
        How many searches ended there, of how many.
    told
        What was done beyond one search, in words.
    rivals
        Values by name among which the record does not choose, by GM; empty where it does.
    """

    best: End
    same: int
    tried: int
    told: tuple[str, ...]
    rivals: tuple[Mapping[str, float], ...]


def arrive(
    problem: Problem, settings: Settings, progress: Progress, embedded: Vector | None = None
) -> Arrival:
    """Search from the stated start, and from others where that does not arrive or is asked for.

    Parameters
    ----------
    embedded
        Where a smaller model ended, within this one; (n_theta,). The end is never worse.
    """
    stated = random_starts(problem, settings.starts - 1, settings.spread, settings.seed)
    ends = [search(problem, settings, start, progress) for start in (problem.start, *stated)]
    told = list[str]()
    if embedded is not None and _is_worse(problem, settings, embedded, best_of(ends)):
        ends.append(search(problem, settings, embedded, progress))
        told.append("searched again from where the smaller model had ended, which was better")
    steps = (
        (_by_ship, _by_record, _in_pieces, _further, _by_chance)
        if embedded is None
        else (_further,)
    )
    for step in steps:
        more, words = step(problem, settings, ends, progress)
        ends, told = [*ends, *more], [*told, *words]
    walked = along_GM(problem, best_of(ends)) if embedded is None or len(ends) > 1 else []
    if lower := _lower(walked, best_of(ends)):
        ends.append(search(problem, settings, lower.minimum.theta, progress))
        told.append("searched again from where another GM had left less")
        walked = along_GM(problem, best_of(ends))
    best = best_of(ends)
    same = sum(e.began and _same(e.V, best.V) for e in ends)
    found = rivals(problem, ends, best, walked)
    return Arrival(best, same, len(ends), tuple(told), found)


def _lower(walked: Sequence[End], best: End) -> End | None:
    """The best of a walk, where it is better than what the walk began at."""
    least = min(walked, key=lambda end: end.cost(best.colour), default=best)
    return least if least.cost(best.colour) < best.cost(best.colour) - NOTICED else None


Step = tuple[list[End], list[str]]
"""Ends of further searches, and what was done, in words."""


def _by_ship(problem: Problem, settings: Settings, ends: Sequence[End], progress: Progress) -> Step:
    """From the ship as stated, where her trials' own starts alone are what the search missed."""
    best = best_of(ends)
    if not _doubt(problem, best):
        return [], []
    start = with_own_starts(problem)
    if not _is_worse(problem, settings, start, best):
        return [], []
    end = search(problem, settings, start, progress)
    return [end], [
        "searched again from the ship as stated, which was better once each trial began right"
    ]


def _by_record(
    problem: Problem, settings: Settings, ends: Sequence[End], progress: Progress
) -> Step:
    """From the starts that the record gives, where the stated one did not lead to a sure end."""
    why = _doubt(problem, best_of(ends))
    starts = record_starts(problem, settings) if why else []
    more = [search(problem, settings, start, progress) for start in starts]
    return more, _words(why, "starts by the record itself", ends, more)


def _in_pieces(
    problem: Problem, settings: Settings, ends: Sequence[End], progress: Progress
) -> Step:
    """From what the record tells of her in pieces, where all else explained next to nothing."""
    best = best_of(ends)
    if best.began and not _explains_nothing(best):
        return [], []
    starts = further_starts(problem, settings)
    more = [search(problem, settings, start, progress) for start in starts]
    return more, _words(_doubt(problem, best), "the record in pieces", ends, more)


def _further(problem: Problem, settings: Settings, ends: Sequence[End], progress: Progress) -> Step:
    """On from the best end, where its iterations were used up."""
    best, most = best_of(ends), PATIENCE * settings.max_iterations
    if not best.began or best.minimum.reason != "iterations":
        return [], []
    end = search(problem, settings, best.minimum.theta, progress, most)
    return [end], [f"the best went on for up to {most} more iterations"]


def _by_chance(
    problem: Problem, settings: Settings, ends: Sequence[End], progress: Progress
) -> Step:
    """From random starts, where nothing arrived or a sensor's number ran to its bound."""
    best = best_of(ends)
    if _arrived(best) and not any(x.kind == "nuisance" for x in _at_bounds(problem, best)):
        return [], []
    starts = random_starts(problem, FURTHER, SPREAD, settings.seed + 1)
    more = [search(problem, settings, start, progress) for start in starts]
    return more, _words(_doubt(problem, best), "random starts", ends, more)


def best_of(ends: Sequence[End]) -> End:
    """The end of smallest cost, all priors weighed alike; of those as good, one that arrived."""
    colour = min(ends, key=lambda end: end.V).colour
    least = min(end.cost(colour) for end in ends)
    alike = [e for e in ends if e.cost(colour) <= least + NOTICED] or list(ends)
    return min(alike, key=lambda end: (not _arrived(end), end.cost(colour)))


def _arrived(end: End) -> bool:
    return end.began and end.minimum.converged


def _explains_nothing(end: End) -> bool:
    return bool(np.sqrt(2.0 * end.V) > UNEXPLAINED)


def _same(V: float, best: float) -> bool:
    return best * (1.0 + SAME_OPTIMUM) + 1e-20 >= V


def _is_worse(problem: Problem, settings: Settings, embedded: Vector, best: End) -> bool:
    """Whether a search ended above a point that it could have begun from."""
    return cost_at(problem, settings, embedded, best.colour) < best.cost(best.colour)


def _doubt(problem: Problem, end: End) -> str:
    """Why the end of the first search is not trusted, in words; empty where it is."""
    if not _arrived(end):
        return REASONS[end.minimum.reason]
    if held := _at_bounds(problem, end):
        return f"{held[0].name} ended at its bound"
    if _explains_nothing(end):
        return "next to nothing was explained"
    if problem.roll is None:
        return "more is left than noise" if np.sqrt(2.0 * end.V) > NO_NOISE else ""
    return _doubt_of_roll(problem, problem.roll, end)


def _doubt_of_roll(problem: Problem, roll: RollRange, end: End) -> str:
    """Why the roll that was found may be another."""
    stated, found = (t[roll.GM] for t in (problem.start, end.minimum.theta))
    if abs(np.log(max(found, 1e-9) / max(stated, 1e-9))) > np.log(FAR):
        return f"GM was found at {found:.3g} m, far from the {stated:.3g} m it began with"
    if not is_a_ships(problem, end.minimum.theta):
        ratio = damped_by(problem, end.minimum.theta)
        return f"roll was found damped by {abs(ratio):.2g} of what is critical, as no ship is"
    return "roll is hardly explained" if roll_error(problem, end) > DOUBTFUL else ""


def _at_bounds(problem: Problem, end: End) -> list[Unknown]:
    ended = zip(problem.unknowns, end.minimum.theta, strict=True)
    return [x for x, a in ended if a <= x.low or a >= x.high]


def _words(why: str, what: str, ends: Sequence[End], more: Sequence[End]) -> list[str]:
    if not more:
        return []
    before = best_of(ends)
    won = before.cost(before.colour) - best_of([before, *more]).cost(before.colour)
    better = "one of them went further" if won > NOTICED else "none went further"
    began = wording.count_of(len(more), "start")
    return [f"{why}: searched again from {began} ({what}), {better}"]
