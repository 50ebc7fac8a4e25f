"""Starts that the record itself gives: in pieces; yaw alone first, then roll on a grid.

A ship that is unstable on her course, or turns on the spot, forgets nothing: the loss over a long
record has valleys without number, and fewer the shorter what is simulated in one go (Ribeiro et al.
2020, On the smoothness of nonlinear system identification, Automatica 121). So each trial is cut,
each piece starts where it was recorded, and all of them are fitted by one ship.

From a placeholder ship a search of everything at once has to find the period of a resonance while
the motion that drives it is still wrong. Yaw is found first, by itself. Then each metacentric
height of a grid, with light or heavy damping, leaves all else of the roll linear: one linear solve
tells how well the record's own period and decrement agree, and the best few are followed.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.identification.nuisance.delays import spoilt_by_delay
from trialid.identification.one_search import search
from trialid.identification.output_error import Problem, ranges
from trialid.identification.problem import Settings, question
from trialid.identification.weighing import Weighing
from trialid.least_squares.gauss_newton import minimise
from trialid.trial import Trial

Vector = NDArray[np.float64]
Rows = NDArray[np.int_]

GM_OVER_L: Final = tuple(np.geomspace(0.001, 0.045, 12))
"""A factor of 1.4 from one to the next, 1.2 in the roll period."""

STIFF: Final = 0.1
"""GM over the length from which a ship that capsizes at every other begins: a boat of 7.5 m has
0.08. Half of it and twice lead her to the same end."""

DRIFT: Final = "Nv"
"""The moment by which a ship that drifts turns on."""

RATIOS: Final = (0.03, 0.15)
FOLLOWED: Final = 3
"""Points of the grid that are searched from, ..."""

MOST_FOLLOWED: Final = 6
"""... or so many where the grid hardly chooses, ..."""

ALIKE: Final = 0.1
"""... which is where the squared error is by such a share above the least: one linear solve leaves
yaw and damping as they were. Half of it left two of 60 drawn ships in another valley, ..."""

APART: Final = 1.5
"""... all of them with GM apart by this factor."""

YAW_STEPS: Final = 40
YAW_NEAR: Final = 1e-3
ROLLING: Final = ("phi", "p")

PIECES: Final = (8, 4, 2)
"""Of a trial, one after the other; sixteen first lead to the same ends, eight alone now and then to
another."""

MANY: Final = 32
"""Where she cannot be sailed as far as that from where the search starts."""

PIECES_STEPS: Final = 20
"""Of a search in pieces: it is a start, and need not have arrived."""

SHORTEST: Final = 30
"""Samples of a piece that are compared: fewer say little beside where it starts."""


def record_starts(problem: Problem, settings: Settings) -> list[Vector]:
    """Starts by the record, the most promising first; (n_theta,) each, perhaps none.

    Deterministic. Where GM is free they are of a grid of it; else in pieces, and yaw found without
    the roll where there is one.
    """
    if problem.roll is not None:
        return _by_motion(problem, problem.start)
    return [*_in_pieces(problem, settings), *_by_motion(problem, problem.start)]


def further_starts(problem: Problem, settings: Settings) -> list[Vector]:
    """Where no GM of the grid leads anywhere: in pieces, and the grid again from there."""
    pieces = _in_pieces(problem, settings) if problem.roll is not None else []
    return [start for one in pieces for start in (one, *_by_motion(problem, one))]


def with_own_starts(problem: Problem) -> Vector:
    """The ship as stated, what each trial has for itself found while she is held; (n_theta,).

    A ship that is unstable on her course shows no other way how good her numbers are.
    """
    of_a_trial = np.array([x.trial is not None for x in problem.unknowns])
    every = np.arange(Weighing(problem).rows)
    return _descend(problem, problem.start, every, of_a_trial)


def _in_pieces(problem: Problem, settings: Settings) -> list[Vector]:
    """Where the trials lead in pieces, ever longer; (n_theta,), none where nothing can be sailed.

    What belongs to a trial alone is its first piece's in the end.
    """
    near = {x.name: x.start for x in problem.unknowns if x.trial is None}
    most = min(PIECES_STEPS, settings.max_iterations)
    for number in PIECES:
        for pieces, begun in ((number, near), (MANY, near), (MANY, _steady(problem, near))):
            cut = in_pieces(problem, settings, pieces, begun)
            end = search(cut, settings, cut.start, max_iterations=most)
            if end.began:
                break
        else:
            return []
        ended = zip(cut.unknowns, end.minimum.theta, strict=True)
        near = {x.name: float(a) for x, a in ended}
    return [np.array([near.get(x.name, x.start) for x in problem.unknowns])]


def _steady(problem: Problem, near: Mapping[str, float]) -> Mapping[str, float]:
    """The same starts of a ship whose drift turns her no way, and that no moment capsizes.

    As far as both are free; she stays within her model whatever else is wrong with her file.
    """
    wanted = {x.name: 0.0 for x in problem.unknowns if x.trial is None and x.column == DRIFT}
    if problem.roll is not None:
        wanted[problem.unknowns[problem.roll.GM].name] = STIFF * problem.roll.length
    known = {x.name: x for x in problem.unknowns}
    steady = {n: min(max(x, known[n].low), known[n].high) for n, x in wanted.items()}
    return {**near, **steady}


def in_pieces(
    problem: Problem, settings: Settings, number: int, near: Mapping[str, float]
) -> Problem:
    """The same question of trials cut into so many pieces, each with a start of its own.

    Parameters
    ----------
    near
        Starts by the name of the unknown; the first piece has the name of its trial.
    """
    shared = [x.name for x in problem.unknowns if x.trial is None]
    own = dict.fromkeys(x.column for x in problem.unknowns if x.trial is not None)
    kept = [n for n in own if not n.endswith("(0)")]
    pieces = [piece for trial in problem.trials for piece in _cut(problem, trial, number)]
    asked = replace(settings, nuisance=("initial_state",))
    cut = question(problem.simulator, pieces, asked, shared, kept, near)
    return replace(cut, y_rms=problem.y_rms)


def _cut(problem: Problem, trial: Trial, number: int) -> list[Trial]:
    """Pieces of about the same length; the first has the trial's name."""
    spoilt = (spoilt_by_delay(problem.simulator, c, trial) for c in problem.outputs)
    most = int(np.clip(trial.samples // (SHORTEST + 2 * max(spoilt)), 1, number))
    ends = np.linspace(0, trial.samples, most + 1).round().astype(int)
    return [
        replace(
            trial,
            name=f"{trial.name} from {a}" if a else trial.name,
            signals={n: y[a:b] for n, y in trial.signals.items()},
            valid={n: y[a:b] for n, y in trial.valid.items()},
        )
        for a, b in pairwise(ends)
    ]


def _by_motion(problem: Problem, begun: Vector) -> list[Vector]:
    """Yaw found without the roll, then the best of a grid of the roll where its GM is free."""
    rolls, turns = rows_of(problem, ROLLING), rows_of(problem, _others(problem))
    if not len(rolls) or not len(turns):
        theta = begun
    else:
        theta = _descend(problem, begun, turns, ~of_roll(problem))
    if problem.roll is None or not len(rolls):
        return [theta] if len(rolls) and len(turns) else []
    return _best_of_grid(problem, theta, rolls)


def of_roll(problem: Problem) -> NDArray[np.bool_]:
    """Which unknowns act on roll alone, by the letters of SNAME; (n_theta,)."""
    own = {f"{kind}_{c}" for kind in ("b", "tau", "T", "e") for c in ROLLING}
    own |= {f"{c}(0)" for c in ROLLING}
    return np.array(
        [x.column in own or x.column.startswith(("K", "GM", "I_xx")) for x in problem.unknowns]
    )


def _linear(problem: Problem) -> NDArray[np.bool_]:
    """Unknowns in which the roll is linear: moments that do not depend on it, and sensors."""
    own = {"b_phi", "b_p", "phi(0)", "p(0)"}
    return np.array(
        [
            x.column in own or (x.column.startswith("K") and "p" not in x.column)
            for x in problem.unknowns
        ]
    )


def _others(problem: Problem) -> tuple[str, ...]:
    return tuple(c for c in problem.outputs if c not in ROLLING)


def rows_of(problem: Problem, outputs: Sequence[str]) -> Rows:
    """Rows of the residual that are of these outputs."""
    parts = [
        np.arange(p.rows.start, p.rows.stop)
        for p in Weighing(problem).parts
        if problem.outputs[p.output] in outputs
    ]
    return np.concatenate(parts) if parts else np.zeros(0, dtype=int)


class Part:
    """Some unknowns against some rows, priors kept; all other unknowns stay where they are."""

    def __init__(
        self, problem: Problem, theta: Vector, rows: Rows, moving: NDArray[np.bool_]
    ) -> None:
        self.weighing, self.theta, self.rows, self.moving = Weighing(problem), theta, rows, moving

    def __call__(self, part: Vector) -> tuple[Vector, Vector] | None:
        """Rows and gradient at values of the moving unknowns, None where there is no motion."""
        theta = self.theta.copy()
        theta[self.moving] = part
        point = self.weighing(theta)
        return None if point is None else self._of(point)

    def _of(self, point: tuple[Vector, Vector]) -> tuple[Vector, Vector]:
        priors = np.arange(self.weighing.rows, len(point[0]))
        kept = np.concatenate([self.rows, priors])
        return point[0][kept], point[1][np.ix_(kept, np.flatnonzero(self.moving))]


def _descend(problem: Problem, theta: Vector, rows: Rows, moving: NDArray[np.bool_]) -> Vector:
    """The best of some unknowns for some rows, the others held; theta where none can be had."""
    chosen = [x for x, moves in zip(problem.unknowns, moving, strict=True) if moves]
    evaluate = Part(problem, theta, rows, moving)
    end = minimise(evaluate, theta[moving], *ranges(chosen), YAW_STEPS, YAW_NEAR, keep=False)
    found = theta.copy()
    found[moving] = end.theta
    return found


def _best_of_grid(problem: Problem, theta: Vector, rows: Rows) -> list[Vector]:
    """Points of the grid with all else of the roll by one linear solve, the best that differ."""
    roll = problem.roll
    assert roll is not None
    weighing, linear = Weighing(problem), _linear(problem)
    if (here := weighing(theta)) is not None:
        weighing.again(theta, here)
    found = []
    for start in _grid(problem, theta):
        point = weighing(start)
        if point is None:
            continue
        kept = np.concatenate([rows, np.arange(weighing.rows, len(point[0]))])
        residual, psi = point[0][kept], point[1][np.ix_(kept, np.flatnonzero(linear))]
        sizes = np.maximum(np.linalg.norm(psi, axis=0), 1e-300)
        step = np.linalg.lstsq(psi / sizes, residual, rcond=1e-9)[0] / sizes
        start[linear] += step
        found.append((float(np.sum((residual - psi @ step) ** 2)), float(start[roll.GM]), start))
    return _followed(sorted(found, key=lambda f: f[0]))


def _followed(found: Sequence[tuple[float, float, Vector]]) -> list[Vector]:
    """The best points that are apart; (squared error, GM, start) each, best first."""
    chosen: list[tuple[float, Vector]] = []
    for squares, GM, start in found:
        apart = all(abs(np.log(GM / other)) > np.log(APART) for other, _ in chosen)
        most = MOST_FOLLOWED if squares < (1.0 + ALIKE) * found[0][0] else FOLLOWED
        if apart and len(chosen) < most:
            chosen.append((GM, start))
    return [start for _, start in chosen]


def _grid(problem: Problem, theta: Vector) -> list[Vector]:
    roll = problem.roll
    assert roll is not None
    low, high = problem.unknowns[roll.GM].low, problem.unknowns[roll.GM].high
    starts = []
    for GM in (roll.length * share for share in GM_OVER_L):
        for ratio in RATIOS if roll.Kp is not None else RATIOS[:1]:
            start = theta.copy()
            start[roll.GM] = GM
            if roll.Kp is not None:
                start[roll.Kp] = roll.damping(GM, ratio)
            if low < GM < high:
                starts.append(start)
    return starts
