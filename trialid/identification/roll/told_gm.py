"""Whether the record tells GM: other valleys as deep, a valley that is hardly one, or no ship's."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.identification.one_search import End
from trialid.identification.output_error import Problem, ranges, stretches
from trialid.identification.record_starts import Part, of_roll, rows_of
from trialid.identification.roll.own_roll import goes_on, is_rolled_by_others, only_follows
from trialid.identification.roll.roll_range import DAMPING_RATIO, FACTOR, GM_OVER_L
from trialid.identification.weighing import CONTRADICTS, Weighing, deviations
from trialid.least_squares.fold import triangle
from trialid.least_squares.gauss_newton import minimise
from trialid.second_process import each

Vector = NDArray[np.float64]

FAR: Final = 1.5
"""Factor by which GM must be known to be worth stating: a fifth of the roll period."""

RIVAL: Final = 12.0
"""Two ends are rivals when twice their log likelihoods differ by less, by the residual's colour:
odds of 400 to 1, because the colour is an estimate itself."""

TOLD_BY: Final = 36.0
"""Twice the log likelihood that must be lost where GM is `FAR` off and all else is fitted again,
for the record to tell it: six standard errors. Those of a resonance that is hardly excited are
known to be two to twelve times too small. Half and twice of it: the benchmark of the search."""

SPARE: Final = 12.0
"""Factor by which standard errors of a resonance that is hardly excited are too small at most."""

GROWS: Final = 0.02
"""Share by which the squared roll error must grow there: a hundredth of the error is what a small
fault of sensors or model makes, and longer records make it no more certain."""

STEPS: Final = 5
"""Factors of `FAR` that are walked to either side, while the record does not object: to 7.6 times
and an eighth; what ships of one length have differs by no more."""

NEIGHBOUR_STEPS: Final = 10
NEIGHBOUR_NEAR: Final = 1e-3

ALIKE: Final = 1.1
"""Factor within which two rivals are one in words."""


def late_roll(problem: Problem, theta: Vector) -> dict[int, float]:
    """Delays [s] of the roll's sensors that are no sensor's, by their place in theta.

    In one trial alone, or in all together: a sensor is as late in each. A boat had a GM of a fifth
    of the truth, and no rival, with an inclinometer 1.5 and 1.3 s early, either just likely.
    """
    late, off = dict[int, float](), deviations(problem, theta)
    for column in ("tau_phi", "tau_p"):
        own = {i: off[i] for i in off if problem.unknowns[i].column == column}
        together = abs(sum(own.values())) > CONTRADICTS * np.sqrt(len(own))
        late |= {i: float(theta[i]) for i, z in own.items() if together or abs(z) > CONTRADICTS}
    return late


def along_GM(problem: Problem, best: End) -> list[End]:
    """Ends with GM ever further off to either side, all else fitted again: what is hardly worse.

    Nothing where no GM is searched for or no roll compared, or what was fitted is no resonance of
    hers.
    """
    roll = problem.roll
    if roll is None or not best.began or goes_on(problem, best.minimum.theta):
        return []
    if not len(rows_of(problem, ("phi", "p"))):
        return []
    if _plainly_told(problem, roll.GM, best):
        return []
    return [end for step in (1.0 / FAR, FAR) for end in _hardly_worse(problem, best, step)]


def _plainly_told(problem: Problem, place: int, best: End) -> bool:
    """Whether slopes alone say, with a factor to spare, that GM cannot be `FAR` off.

    One gradient in place of two searches: of a long record that is most of the time.
    """
    weighing = Weighing(problem)
    if (point := weighing(best.minimum.theta)) is None:
        return False
    R, rows = triangle(point[1]), rows_of(problem, ("phi", "p"))
    others = np.delete(R, place, axis=1)
    sizes = np.maximum(np.linalg.norm(others, axis=0), 1e-300)
    made_good = np.linalg.lstsq(others / sizes, R[:, place], rcond=1e-9)[0] / sizes
    moved = point[1][: weighing.rows] @ np.insert(-made_good, place, 1.0)
    moved *= best.minimum.theta[place] * (1.0 - 1.0 / FAR)
    lost = len(best.residual) / best.colour * (moved @ moved) / (2.0 * best.V)
    grown = np.sum(moved[rows] ** 2) / np.sum(best.residual[rows] ** 2)
    return bool(lost > SPARE**2 * TOLD_BY and grown > SPARE**2 * GROWS)


def rivals(
    problem: Problem, ends: Sequence[End], best: End, walked: Sequence[End]
) -> tuple[Mapping[str, float], ...]:
    """Values by name among which the record does not choose, by their GM, the smallest first.

    Empty where it tells GM.

    Parameters
    ----------
    ends, best
        All searches of the problem, and the one that is taken.
    walked
        Ends along GM from there.
    """
    roll = problem.roll
    if roll is None or not best.began:
        return ()
    place, limit = roll.GM, best.cost(best.colour) + RIVAL
    near = [e.minimum.theta for e in ends if e.cost(best.colour) < limit]
    near += _on_time(problem, best)
    if _is_no_ships(problem, best, walked):
        near += _as_ships_have(problem, best)
    near += [end.minimum.theta for end in walked]
    near.sort(key=lambda theta: float(theta[place]))
    if _factor(near, place) < FAR * 0.999:
        return ()
    distinct = near[:1]
    for theta in near:
        distinct += [theta] if ALIKE * distinct[-1][place] < theta[place] else []
    names = [x.name for x in problem.unknowns]
    return tuple(dict(zip(names, theta.tolist(), strict=True)) for theta in distinct)


def _is_no_ships(problem: Problem, best: End, walked: Sequence[End]) -> bool:
    """Whether it is a swell's, or a heel without a period that other GM leave as it is.

    Or a resonance amid a roll that nothing in the model makes.

    Fins may damp a ship by half of what is critical, and her record tell GM all the same.
    """
    theta = best.minimum.theta
    if goes_on(problem, theta) or is_rolled_by_others(problem, theta):
        return True
    return bool(walked) and only_follows(problem, theta)


def roll_error(problem: Problem, end: End) -> float:
    """Normed error of the roll outputs."""
    squares = float(np.sum(end.residual[rows_of(problem, ("phi", "p"))] ** 2))
    return float(np.sqrt(squares * len(problem.outputs)))


def _on_time(problem: Problem, best: End) -> list[Vector]:
    """Where searches end with the roll's clocks as clocks are, the best; nothing where they are.

    From the GM that was found and from one in the middle of ships': a clock and a resonance share
    the lag of the roll. A ship whose hull is another had a GM of a fifth of the truth, and no
    rival, with an inclinometer two seconds early.
    """
    theta, roll = best.minimum.theta.copy(), problem.roll
    late = late_roll(problem, theta)
    if not late or roll is None:
        return []
    for place in late:
        prior = problem.unknowns[place].prior
        assert prior is not None
        theta[place] = prior[0]
    middle = _scaled(problem, theta, GM_OVER_L * roll.length / theta[roll.GM])
    ends = each(lambda start: _with_held(problem, start, [*late], best.colour), (theta, middle))
    able = sorted((e for e in ends if e is not None), key=lambda end: end.cost(best.colour))
    # a sensor may be slow, but none is early: then what was found may be no roll of hers at all
    return [end.minimum.theta for end in able[: 2 if min(late.values()) < 0.0 else 1]]


def _factor(near: Sequence[Vector], place: int) -> float:
    GM = [float(theta[place]) for theta in near]
    return max(GM) / max(min(GM), 1e-300)


def _as_ships_have(problem: Problem, best: End) -> list[Vector]:
    """The least and the greatest GM that a ship like her may have, her heel as it was.

    With as little and as much damping as is usual, a standard deviation. What was fitted was no
    resonance of hers, and so nothing of the record speaks of it; a GM that was stated does.
    """
    assert problem.roll is not None
    roll, found = problem.roll, list[Vector]()
    if _is_stated(problem, roll.GM):
        return found
    least = GM_OVER_L * roll.length * float(np.exp(-2.0 * FACTOR))
    for GM, off in ((least, -1.0), (roll.stiffest, 1.0)):
        there = _scaled(problem, best.minimum.theta, GM / best.minimum.theta[roll.GM])
        if roll.Kp is not None:
            there[roll.Kp] = roll.damping(GM, DAMPING_RATIO * float(np.exp(off * FACTOR)))
        found.append(there)
    return found


def _is_stated(problem: Problem, place: int) -> bool:
    """Whether it is known beforehand within `FAR`; of what a file assumes of ships it is not."""
    prior = problem.unknowns[place].prior
    return prior is not None and 2.0 * prior[1] < (FAR - 1.0) * abs(prior[0])


def _scaled(problem: Problem, theta: Vector, factor: float) -> Vector:
    """Values of the same heel in a steady turn and the same damping ratio, with another GM."""
    assert problem.roll is not None
    moments = [x.column.startswith("K") for x in problem.unknowns]
    there = np.where(of_roll(problem) & moments, theta * factor, theta)
    there[problem.roll.GM] = theta[problem.roll.GM] * factor
    if problem.roll.Kp is not None:
        there[problem.roll.Kp] = theta[problem.roll.Kp] * np.sqrt(factor)
    return np.asarray(there)


def _hardly_worse(problem: Problem, best: End, step: float) -> list[End]:
    """Ends with GM ever further off by a factor, as far as all else makes good for it.

    One that it does not make good for may be a ridge: a few rolls are followed by a resonance that
    is once more or once less in phase with the turn, and by none between. So one is passed over.
    """
    assert problem.roll is not None
    place = problem.roll.GM
    unknown, found, last, over = problem.unknowns[place], list[End](), best, False
    for _ in range(STEPS):
        start = _scaled(problem, last.minimum.theta, step)
        if not unknown.low < start[place] < unknown.high:
            break
        there = _with_held(problem, start, [place], best.colour)
        if there is None:
            break
        objects = _objects(problem, there, best)
        if objects and over:
            break
        found += [] if objects else [there]
        last, over = there, objects
    return found


def _objects(problem: Problem, end: End, best: End) -> bool:
    """Whether the record objects to an end with another GM: by its likelihood, and by its roll."""
    rows = rows_of(problem, ("phi", "p"))
    lost = end.cost(best.colour) - best.cost(best.colour)
    grown = np.sum(end.residual[rows] ** 2) / np.sum(best.residual[rows] ** 2) - 1.0
    return bool(lost >= TOLD_BY and grown >= GROWS)


def _with_held(problem: Problem, theta: Vector, places: Sequence[int], colour: float) -> End | None:
    """The end of a short search of everything but these, None where it cannot begin."""
    moving = np.ones(len(theta), dtype=bool)
    moving[places] = False
    chosen = [x for x, moves in zip(problem.unknowns, moving, strict=True) if moves]
    rows = np.arange(stretches(problem)[-1].rows.stop)
    part = Part(problem, theta, rows, moving)
    end = minimise(
        part, theta[moving], *ranges(chosen), NEIGHBOUR_STEPS, NEIGHBOUR_NEAR, keep=False
    )
    if not end.iterations:
        return None
    there = theta.copy()
    there[moving] = end.theta
    pulls = Weighing(problem).pulls(there)
    return End(replace(end, theta=there), end.iterations, end.residual[: len(rows)], colour, pulls)
