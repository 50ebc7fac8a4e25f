"""Rudder records of the sample trials: a zig-zag and a multi-frequency binary test."""

from collections.abc import Callable
from typing import Final

import numpy as np

from trialid.arrays import Vector

PERIOD: Final = 0.1
"""s, of the simulation and of the fastest sensor."""
DURATION: Final = 1200.0
"""s."""
APPROACH: Final = 150.0
"""s with the rudder amidships before each manoeuvre."""
RUDDER_RATE: Final = np.deg2rad(2.5)
"""rad/s."""


def clock() -> Vector:
    """Times of a trial [s]; (N,)."""
    return np.arange(0.0, DURATION + PERIOD / 2, PERIOD)


def follow(orders: list[tuple[float, float]], t: Vector) -> Vector:
    """Rudder angle [rad] that follows orders (time [s], angle [rad]) at the steering gear's rate.

    (N,), as the times `t` [s].
    """
    at = np.zeros(len(t))
    angle = 0.0
    ordered = np.zeros(len(t))
    for start, order in orders:
        ordered[t >= start] = order
    for k in range(1, len(t)):
        step = np.clip(ordered[k] - angle, -RUDDER_RATE * PERIOD, RUDDER_RATE * PERIOD)
        angle += step
        at[k] = angle
    return at


def zigzag(angle: float, heading: float, heading_of: Callable[[Vector], Vector]) -> Vector:
    """Rudder of a zig-zag [rad]: it reverses where the simulated heading reaches the switch angle.

    One switch after the other is found by simulating what is ordered so far, which closes the loop
    on the heading with an open-loop simulator. Both angles [deg].
    """
    t = clock()
    orders, sign = [(APPROACH, np.deg2rad(angle))], 1.0
    while True:
        psi = heading_of(follow(orders, t))
        course = psi[int((APPROACH - 5.0) / PERIOD)]
        reached = (sign * (psi - course) >= np.deg2rad(heading)) & (t > orders[-1][0] + 2.0)
        if not reached.any():
            return follow(orders, t)
        sign = -sign
        orders.append((float(t[np.argmax(reached)]), sign * np.deg2rad(angle)))


def multi_frequency_binary(angle: float, seed: int) -> Vector:
    """Rudder [rad] at plus or minus one angle [deg], by the sign of a sum of sines.

    The frequencies lie about that of roll, and two far below.
    """
    t = clock()
    orders, last = [], 0.0
    for time, sign in zip(t, np.sign(_sines(t, seed).sum(axis=0)), strict=True):
        if time >= APPROACH and sign not in (0.0, last):
            orders.append((float(time), float(sign) * np.deg2rad(angle)))
            last = sign
    return follow(orders, t)


def _sines(t: Vector, seed: int) -> Vector:
    """The sines whose sum decides; (n_lines, N)."""
    rng = np.random.default_rng(seed)
    length = DURATION - APPROACH
    roll_periods = length / 28.8
    shares = np.array([19.0, 33.0, 51.0, 80.0, 117.0]) / 80.0
    lines = np.unique([*np.round(shares * roll_periods), 3.0, 1.0])
    phases = rng.uniform(0.0, 2.0 * np.pi, len(lines))
    # the slow lines are the larger: they turn the ship, the fast ones roll it
    sizes = np.where(lines <= 3.0, 1.6, 0.8)
    ordered = np.floor((t - APPROACH) / 2.0) * 2.0  # the helmsman switches on whole two seconds
    waves = np.sin(2 * np.pi * lines[:, None] * ordered / length + phases[:, None])
    return np.asarray(sizes[:, None] * waves)
