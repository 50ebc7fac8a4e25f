"""Gauss-Newton with step control, for any least-squares problem with an exact Jacobian.

Undamped Gauss-Newton diverges from starts 30 % off even on easy ship data; here each step is
damped as Levenberg and Marquardt do, the damping following the ratio of actual to predicted fall
(Nielsen 1999). Where it is no more than at first, what steps before tell of those to come is tried
before it (`anderson`). A point that cannot be evaluated (the simulation left its domain) is a step
that was too long, not a crash. The normal matrix is never formed: the step comes from QR and SVD.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.least_squares.anderson import Steps
from trialid.least_squares.directions import Directions
from trialid.least_squares.fold import Fold

Vector = NDArray[np.float64]
Linearised = tuple[Vector, Vector]
"""Residual y - yhat (M,) and Jacobian dyhat/dtheta (M, n_theta)."""

STEP: Final = 1e-9
ORTHOGONAL: Final = 1e-8
EXACT: Final = 1e-24
HOPELESS: Final = 1e14
FIRST_DAMPING: Final = 1e-3
LONGEST: Final = 10.0
"""Longest step in units of max(|theta|, typical size): beyond it plateaus wait."""

FAR: Final = 1.0
"""The same of a step that steps before foretell; at ten times that one of the 54 searches for
published minima ends elsewhere, at a tenth none."""

ROUNDING: Final = 1e-6
"""Orthogonality at which a search that cannot move any more has arrived."""

PATIENCE: Final = 0.5
"""Share of the iterations after which a search that has next to nothing left to win may end."""

AT_A_KINK: Final = 5.0
"""Times that what is next to nothing, where no step lowers the error: a model with limits and play
has kinks, and slopes on one side of them. Of 36 searches for a gear of limited rate in a sea
(`test_time_constants.py`, seeds 10 to 21 with 3, 6 and 10 times the noise) one does not arrive with
this, a tenth of a standard error for all parameters together, and with half of it; with what is
asked of slow searches three. With twice of it all do, but so do gears that chatter."""

REASONS: Final = {
    "step": "no parameter moves any more",
    "orthogonal": "the residual is orthogonal to every sensitivity",
    "exact": "the residual is zero to rounding",
    "flat": "what is left to win is far below a standard error",
    "kink": "no step lowers the error, and next to nothing is left to win",
    "stalled": "no step, however short, lowers the error",
    "iterations": "the number of iterations is used up",
    "start": "the model cannot be simulated at the start values",
}


@dataclass(frozen=True)
class Iteration:
    """One accepted point: loss V = |residual|^2 / 2, and the relative step that led to it.

    V is of the record's rows alone; where priors have rows beside them, it may rise a little.
    """

    V: float
    step: float
    damping: float


@dataclass(frozen=True)
class Minimum:
    """Where the search ended, how, and the way there.

    `reason` is a key of `REASONS`; `converged` says that it marks a minimum.
    """

    theta: Vector
    residual: Vector
    jacobian: Vector
    iterations: tuple[Iteration, ...]
    reason: str
    evaluations: int

    @property
    def converged(self) -> bool:
        """Whether the search ended at a minimum."""
        return self.reason in {"step", "orthogonal", "exact", "flat", "kink"}

    @property
    def V(self) -> float:
        """Half the sum of squares at the end."""
        return 0.5 * float(self.residual @ self.residual)


def minimise(
    evaluate: Callable[[Vector], Linearised | None],
    start: Vector,
    scale: Vector,
    low: Vector | None = None,
    high: Vector | None = None,
    max_iterations: int = 50,
    tolerance: float = ORTHOGONAL,
    progress: Callable[[Iteration], None] = lambda iteration: None,
    again: Callable[[Vector, Linearised], Linearised] = lambda theta, point: point,
    worth: Callable[[], float] = lambda: 0.0,
    rows: int | None = None,
    keep: bool = True,
) -> Minimum:
    """Find the parameters with the smallest sum of squared residuals.

    Parameters
    ----------
    evaluate
        Residual and Jacobian at a point, or None where the model cannot be evaluated.
    start, scale, low, high
        Start, typical size and bounds of each parameter; (n_theta,).
    tolerance
        Share of the residual that may still lie along the sensitivities at the end; its square is
        the relative fall of V that a further step could bring.
    again
        Weighs the rows of an accepted point anew, where weights depend on where one stands.
    worth
        Standard errors of white rows, all parameters together, below which a search that is slow
        may end.
    rows
        How many rows come from a record, before those of priors; all where it is not said.
    keep
        Whether the Jacobian at the end is wanted: that of a long record is as long, and is not
        held beside the next one where nobody asks for it.
    """
    low = np.full(len(start), -np.inf) if low is None else low
    high = np.full(len(start), np.inf) if high is None else high
    theta = np.clip(start, low, high)
    here = _finite_at(evaluate, theta)
    if here is None:
        empty = np.zeros(0)
        return Minimum(theta, empty, np.zeros((0, len(start))), (), "start", 1)
    search = _Search(evaluate, scale, low, high, theta, here, tolerance, again, rows, keep)
    del here
    for count in range(max_iterations):
        reason = search.advance()
        progress(search.path[-1])
        left = search.left * np.sqrt(len(search.here[0]))
        if reason == "stalled" and left < AT_A_KINK * worth():
            reason = "kink"
        elif not reason and count >= PATIENCE * max_iterations and left < worth():
            reason = "flat"
        if reason:
            return search.minimum(reason)
    return search.minimum("iterations")


def _finite_at(evaluate: Callable[[Vector], Linearised | None], theta: Vector) -> Linearised | None:
    """Residual and Jacobian, None where a sum of squares of them is no number."""
    with np.errstate(over="ignore", invalid="ignore"):
        point = evaluate(theta)
        if point is None:
            return None
        squares = np.einsum("ij,ij->j", point[1], point[1])
        finite = np.isfinite(point[0] @ point[0]) and np.isfinite(squares).all()
    return point if finite else None


class _Search:
    """The state of one search: the point, its linearisation and the damping."""

    def __init__(
        self,
        evaluate: Callable[[Vector], Linearised | None],
        scale: Vector,
        low: Vector,
        high: Vector,
        theta: Vector,
        here: Linearised,
        tolerance: float,
        again: Callable[[Vector, Linearised], Linearised],
        rows: int | None,
        keep: bool,
    ) -> None:
        self.evaluate, self.low, self.high, self.tolerance = evaluate, low, high, tolerance
        self.size = np.where(scale > 0.0, scale, 1.0)
        self.theta, self.again, self.keep = theta, again, keep
        self.fold, self.left = Fold.of(*here), np.inf
        self.here = self._kept(here)
        self.damping, self.growth = FIRST_DAMPING, 2.0
        self.norms, self.steps = np.zeros(len(theta)), Steps()
        self.count = 1
        self.rows = slice(rows)
        self.path = [Iteration(self._of_record(here), 0.0, self.damping)]

    def _kept(self, point: Linearised) -> Linearised:
        return point if self.keep else (point[0], point[1][:0].copy())

    @staticmethod
    def _loss(point: Linearised) -> float:
        return 0.5 * float(point[0] @ point[0])

    def _of_record(self, point: Linearised) -> float:
        return 0.5 * float(point[0][self.rows] @ point[0][self.rows])

    def minimum(self, reason: str) -> Minimum:
        return Minimum(self.theta, *self.here, tuple(self.path), reason, self.count)

    def advance(self) -> str | None:
        """One accepted step, or the reason why there is none."""
        loss = self._loss(self.here)
        if loss <= EXACT:
            return "exact"
        moving = self._moving(self.fold.R.T @ self.fold.q)
        if not moving.any():
            return "orthogonal"
        self.norms = np.maximum(self.norms, np.linalg.norm(self.fold.R, axis=0))
        weights = np.where(self.norms > 0.0, self.norms, 1.0)
        directions = Directions(self.fold, moving, weights)
        self.left = directions.orthogonality
        if self.left < self.tolerance:
            return "orthogonal"
        step = self._within(directions, moving, weights)
        if self._tried_mixed(step, moving, loss):
            return None
        return self._damped(directions, moving, weights, loss)

    def _damped(
        self, directions: Directions, moving: NDArray[np.bool_], weights: Vector, loss: float
    ) -> str | None:
        """A step damped until it lowers the error, or the reason why there is none."""
        while self.damping < HOPELESS:
            step = self._within(directions, moving, weights)
            length = self._relative(step)
            foretold = loss - self.fold.loss(step)
            if length <= LONGEST and self._try(step, loss, foretold):
                return None
            if length < STEP:
                # a step made short by damping alone says nothing about a minimum
                free = self.damping <= FIRST_DAMPING
                return "step" if free or directions.orthogonality < ROUNDING else "stalled"
            self.damping *= self.growth
            self.growth *= 2.0
        return "stalled"

    def _tried_mixed(self, step: Vector, moving: NDArray[np.bool_], loss: float) -> bool:
        """Go by all steps of late, if that lowers the error within bounds."""
        far = self.steps.mixed(self.theta, step, moving, self.fold.R)
        if far is None or self.damping > FIRST_DAMPING:
            return False
        there = self.theta + far
        within = bool(np.all((there >= self.low) & (there <= self.high)))
        foretold = loss - self.fold.loss(step)
        went = within and self._relative(far) <= FAR and self._try(far, loss, foretold)
        self.steps.judge(went)
        return went

    def _moving(self, descent: Vector) -> NDArray[np.bool_]:
        """Parameters not held at a bound by the way down."""
        held_low = (self.theta <= self.low) & (descent < 0.0)
        held_high = (self.theta >= self.high) & (descent > 0.0)
        return np.asarray(~(held_low | held_high))

    def _within(self, directions: Directions, moving: NDArray[np.bool_], weights: Vector) -> Vector:
        """The damped step within all bounds: what would pass one goes to it, and the rest follows.

        A step that is only cut short there goes, in a narrow valley, up its side.
        """
        step, free = np.zeros(len(self.theta)), moving
        while True:
            step[free] = directions.step(self.damping) / weights[free]
            there = self.theta + step
            passed = free & ((there < self.low) | (there > self.high))
            free = free & ~passed
            step[passed] = (np.clip(there, self.low, self.high) - self.theta)[passed]
            if not passed.any() or not free.any():
                return step
            left = self.fold.q - self.fold.R[:, ~free] @ step[~free]
            directions = Directions(replace(self.fold, q=left), free, weights)

    def _relative(self, step: Vector) -> float:
        return float(np.max(np.abs(step) / np.maximum(np.abs(self.theta), self.size)))

    def _try(self, step: Vector, loss: float, foretold: float) -> bool:
        """Go there if the error falls; set the damping by how well the fall was foretold."""
        there = np.clip(self.theta + step, self.low, self.high)  # at a bound to the last bit
        taken = there - self.theta
        self.count += 1
        point = _finite_at(self.evaluate, there)
        actual = 0.0 if point is None else loss - self._loss(point)
        if point is None or not actual > 0.0:
            return False
        ratio = actual / foretold if foretold > 0.0 else 0.0
        self.damping *= max(1.0 / 3.0, 1.0 - (2.0 * ratio - 1.0) ** 3)
        self.growth = 2.0
        point = self.again(there, point)
        self.path.append(Iteration(self._of_record(point), self._relative(taken), self.damping))
        self.theta, self.here, self.fold = there, self._kept(point), Fold.of(*point)
        return True
