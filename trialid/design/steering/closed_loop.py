"""A linear ship under a controller: how a step is answered, and how far from swinging the loop is.

Delta is what steers, a rudder angle or a difference of thrusters; the loop is broken there:
k (sI - A)^-1 B is what comes back of an order.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.design.steering.straight_course import LinearShip

BAND: Final = 0.05
"""Share of a step within which it counts as settled."""
LONG: Final = 80.0
"""Time that a step is watched, and ...."""
STEPS: Final = 2000
DECADES: Final = (-3.0, 4.0)
"""Frequencies that are looked at, both by the bandwidth."""
POINTS: Final = 300


@dataclass(frozen=True, kw_only=True)
class Controller:
    """delta = forward reference - back x, x the ship's states and then the controller's own.

    Attributes
    ----------
    A, B
        Ship and controller without feedback; (n, n), (n,).
    reference, back, output
        How a reference drives the states, what goes back to the order, what is steered; (n,).
    forward
        Order by reference.
    """

    A: Vector
    B: Vector
    reference: Vector
    back: Vector
    output: Vector
    forward: float


@dataclass(frozen=True, kw_only=True)
class Answer:
    """How a loop behaves.

    Attributes
    ----------
    overshoot
        Beyond the step, as a share of it.
    settling
        Until the answer stays within 5 % of the step [s]; inf where it does not settle.
    phase_margin
        Least, at every frequency where the loop's gain is one [rad].
    delay_margin
        By how much later the order may act until the loop swings [s]; inf: by any time.
    """

    stable: bool
    overshoot: float
    settling: float
    phase_margin: float
    delay_margin: float


SWINGS: Final = Answer(
    stable=False, overshoot=np.inf, settling=np.inf, phase_margin=np.nan, delay_margin=0.0
)
"""That of a loop that is not stable."""


def hold_rate(ship: LinearShip, P: float, I: float, FF: float) -> Controller:  # noqa: E741
    """Delta = FF r_d + P (r_d - r) + I integral (r_d - r)."""
    n, r = len(ship.states), ship.turning
    A, B = _wider(ship, 1)
    A[n, r] = -1.0
    back, output = np.zeros(n + 1), np.zeros(n + 1)
    back[[r, n]] = P, -I
    output[r] = 1.0
    reference = np.append(np.zeros(n), 1.0)
    return Controller(A=A, B=B, reference=reference, back=back, output=output, forward=FF + P)


def hold_heading(ship: LinearShip, Kp: float, Ki: float, Kd: float) -> Controller:
    """Delta = Kp (psi_d - psi) + Ki integral (psi_d - psi) - Kd r."""
    n, r = len(ship.states), ship.turning
    A, B = _wider(ship, 2)
    A[n, r], A[n + 1, n] = 1.0, -1.0
    back, output = np.zeros(n + 2), np.zeros(n + 2)
    back[[r, n, n + 1]] = Kd, Kp, -Ki
    output[n] = 1.0
    reference = np.append(np.zeros(n + 1), 1.0)
    return Controller(A=A, B=B, reference=reference, back=back, output=output, forward=Kp)


def _wider(ship: LinearShip, more: int) -> tuple[Vector, Vector]:
    n = len(ship.states)
    A, B = np.zeros((n + more, n + more)), np.zeros(n + more)
    A[:n, :n], B[:n] = ship.A, ship.B
    return A, B


def answer(loop: Controller, bandwidth: float) -> Answer:
    """How the loop answers a step, looked at by the time and frequency of its bandwidth [rad/s]."""
    closed = loop.A - np.outer(loop.B, loop.back)
    poles, shapes = np.linalg.eig(closed)
    if poles.real.max() >= 0.0:
        return SWINGS
    t = np.linspace(0.0, LONG / bandwidth, STEPS)
    drive = np.linalg.solve(shapes, loop.B * loop.forward + loop.reference) / poles
    parts = (loop.output @ shapes) * drive
    y = (np.exp(np.outer(t, poles)) @ parts).real - float(np.sum(parts).real)
    outside = np.flatnonzero(np.abs(y - 1.0) > BAND)
    last = int(outside[-1]) + 1 if len(outside) else 0
    phase, delay = _margins(loop, bandwidth)
    return Answer(
        stable=True,
        overshoot=max(float(y.max()) - 1.0, 0.0),
        settling=float(t[last]) if last < len(t) else np.inf,
        phase_margin=phase,
        delay_margin=delay,
    )


def _margins(loop: Controller, bandwidth: float) -> tuple[float, float]:
    """Least phase margin [rad] and delay margin [s]; inf where the gain is nowhere one."""
    omega = bandwidth * np.logspace(*DECADES, POINTS)
    s = 1j * omega[:, None, None] * np.eye(len(loop.B))
    back = np.linalg.solve(s - loop.A, loop.B[None, :, None])[..., 0] @ loop.back
    size, phase = np.log(np.abs(back)), np.angle(back)
    k = np.flatnonzero(np.diff(np.sign(size)) != 0.0)
    if not len(k):
        return np.inf, np.inf
    part = size[k] / (size[k] - size[k + 1])
    turn = np.angle(back[k + 1] / back[k])
    margin = np.mod(phase[k] + part * turn + np.pi, 2.0 * np.pi)
    crossing = omega[k] * (omega[k + 1] / omega[k]) ** part
    return float(np.min(np.minimum(margin, 2.0 * np.pi - margin))), float(np.min(margin / crossing))
