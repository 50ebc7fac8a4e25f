"""The manoeuvres: what a helmsman is told, one function each.

Angles and headings in rad, times in s. Every function gives instructions for `helm.carry_out`; a
manoeuvre begins on a straight course and answers to the ship where it is a closed loop.
"""

from collections.abc import Callable, Sequence
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from trialid.arrays import Mask, Vector
from trialid.design import signals
from trialid.design.helm import Follow, Hold, Instructions, Motion

Until = Callable[[Motion], Mask]

LONGEST: Final = 1e4
"""s a helmsman waits for something to happen; the trial ends before."""
STEADY: Final = 0.02
"""Share of the rate of turn that it may change by in the time to settle, and count as steady."""
STILL: Final = 1e-5
"""rad/s that no rate-of-turn indicator shows."""


def zigzag(angle: float, heading: float, reversals: int = 1000) -> Instructions:
    """Zig-zag: the rudder reverses when the heading has changed by `heading`.

    MSC.137(76), where both are 10 or 20 deg; in a modified zig-zag they differ.
    """
    look = yield Hold(0.0, 0.0)
    course, side = float(look()["psi"][-1]), 1.0
    for _ in range(reversals):
        yield Hold(side * angle, LONGEST, _beyond(side, course + side * heading))
        side = -side


def turning_circle(angle: float, turn: float = 3.0 * np.pi) -> Instructions:
    """Turning circle: one order until the heading has changed by `turn`, 540 deg by IMO's rule."""
    look = yield Hold(0.0, 0.0)
    side = float(np.sign(angle))
    yield Hold(angle, LONGEST, _beyond(side, float(look()["psi"][-1]) + side * turn))


def pull_out(angle: float, turn: float, after: float) -> Instructions:
    """Pull-out: amidships from a turn; a stable ship's rate of turn dies away, and her roll."""
    yield from turning_circle(angle, turn)
    yield Hold(0.0, after)


def spiral(angles: Sequence[float], settle: float, hold: float) -> Instructions:
    """Dieudonne's spiral: each angle until the rate of turn has not changed by 2 % in `settle` [s].

    No angle is held longer than `hold` [s].
    """
    for angle in angles:
        yield Hold(angle, hold, _settled(settle))


def reversed_spiral(
    rates: Sequence[float], gain: float, reset: float, largest: float, hold: float, watch: float
) -> Instructions:
    """Bech's reversed spiral: the rudder that keeps each rate of turn [rad/s], found by steering.

    Every `watch` [s] the helmsman orders gain [s] times the error of the rate, and as much again
    every `reset` [s] while it lasts; never more than `largest`. Each rate is kept for `hold` [s].
    """
    order = 0.0
    look = yield Hold(order, watch)
    error = 0.0
    for rate in rates:
        for _ in range(round(hold / watch)):
            before, error = error, rate - float(look()["r"][-1])
            order += gain * (error - before) + gain * error * watch / reset
            order = float(np.clip(order, -largest, largest))
            look = yield Hold(order, watch)


def modified_spiral(angles: Sequence[float], period: float, cycles: int = 1000) -> Instructions:
    """Modified spiral: a staircase of angles, all of them once in a `period` [s]."""
    for _ in range(cycles):
        for angle in angles:
            yield Hold(angle, period / len(angles))


def square_wave(angle: float, period: float) -> Instructions:
    """The rudder to one side and the other by the clock, whatever the ship does."""
    yield from modified_spiral((angle, -angle), period)


def roll_excitation(
    angle: float, roll_period: float, swings: int, decay: float, bursts: int = 1000
) -> Instructions:
    """Rolling by the rudder: to and fro at the roll period, then amidships while the roll dies."""
    for _ in range(bursts):
        yield from modified_spiral((angle, -angle), roll_period, swings)
        yield Hold(0.0, decay)


def step_sequence(orders: Sequence[float], lengths: Sequence[float]) -> Instructions:
    """Any steps: each order for its length [s]."""
    for order, length in zip(orders, lengths, strict=True):
        yield Hold(order, length)


def order_list(orders: Vector) -> Instructions:
    """Orders written down in advance, one a sample."""
    yield Follow(orders)


def multi_frequency_binary(
    angle: float, numbers: Sequence[int], sizes: ArrayLike, phases: ArrayLike,
    duration: float, period: float, hold: int = 1,
) -> Instructions:  # fmt: skip
    """The paper's multi-frequency binary test (Eq. 17 to 19) with these lines; `signals.lines`.

    Switching instants lie on every `hold`-th sample of the clock, so that what was ordered is known
    exactly.
    """
    t = np.asarray(np.arange(round(duration / period) + 1) * period)
    omega = 2.0 * np.pi * np.asarray(numbers) / duration
    yield from order_list(
        signals.binary(signals.multisine(t, 1.0, sizes, omega, phases), angle, hold)
    )


def _beyond(side: float, heading: float) -> Until:
    """The heading has come to an angle from this side."""

    def reached(motion: Motion) -> Mask:
        return np.asarray(side * (motion["psi"] - heading) >= 0.0)

    return reached


def _settled(settle: float) -> Until:
    """The rate of turn has kept its value over a time [s]."""

    def settled(motion: Motion) -> Mask:
        t, y = motion["t"], motion["r"]
        lag = max(1, round(settle / (t[1] - t[0]))) if len(t) > 1 else 1
        same = np.zeros(len(y), dtype=bool)
        if len(y) > lag:
            same[lag:] = np.abs(y[lag:] - y[:-lag]) <= STEADY * np.abs(y[lag:]) + STILL
        return same

    return settled
