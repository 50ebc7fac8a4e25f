"""Anderson's mixing: the steps of an iteration so far tell of those that would follow.

Where residuals are not small each step of Gauss-Newton is a share of the one before, and in a
narrow valley a small one. How steps change from point to point says where they would be none.
"""

from typing import Final

import numpy as np

from trialid.arrays import Mask, Vector

REMEMBERED: Final = 3
"""Points before this one whose steps are looked at. Of the searches for six boats and ships by
others 123 of 205 ended where nothing is left to win without it, and 72 for want of iterations; with
it 142 of 207 and 58, for as many points tried (2681 for 2704). Before any waited 142 did with two
points, 143 with three and with five."""

RANK: Final = 1e-6
"""Share of the largest below which a change of steps is rounding; at 1e-3 the same."""


class Steps:
    """The points of a search of late and the step from each, by what moved there."""

    def __init__(self) -> None:
        self._theta: list[Vector] = []
        self._step: list[Vector] = []
        self._moving: bytes = b""
        self._wait, self._next = 0, 1

    def mixed(self, theta: Vector, step: Vector, moving: Mask, R: Vector) -> Vector | None:
        """The step by all of them, that with which changes of steps would leave the least.

        None at a first point, where bounds hold others than before, and for a while after it led
        astray. Anderson (1965), seen by the outputs.

        Parameters
        ----------
        theta, step
            A point and the step from it, (n_theta,).
        moving
            Which parameters no bound holds there, (n_theta,).
        R
            Triangle of the sensitivities there, (n_theta, n_theta).
        """
        if moving.tobytes() != self._moving:
            self._keep(0)
        self._moving = moving.tobytes()
        self._theta.append(theta)
        self._step.append(step)
        self._keep(REMEMBERED + 1)
        self._wait -= 1
        if len(self._theta) < 2 or self._wait > 0:
            return None
        gone, changed = (np.diff(np.array(x), axis=0).T for x in (self._theta, self._step))
        share = np.linalg.lstsq(R @ changed, R @ step, rcond=RANK)[0]
        return np.asarray(step - (gone + changed) @ share)

    def judge(self, well: bool) -> None:
        """Whether the last one led well; after each that did not the next waits twice as long.

        Where a valley bends none does: of the published minima MGH10 took 19 168 points without
        waiting, 8 119 with it, 7 693 without looking back; ENSO 40 without and 10 with it.
        """
        self._next = 1 if well else 2 * self._next
        if not well:
            self._wait = self._next
            self._keep(1)

    def _keep(self, last: int) -> None:
        first = len(self._theta) - last
        self._theta, self._step = (x[max(first, 0) :] for x in (self._theta, self._step))
