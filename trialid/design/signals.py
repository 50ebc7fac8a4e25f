"""Rudder orders written down in advance: Blanke & Knudsen (1999), Eq. 17 to 19, and steps."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations_with_replacement
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

Vector = NDArray[np.float64]

ALPHA: Final = (19, 33, 51, 80, 117)
BETA: Final = 80
SLOW: Final = (3, 1)
"""Periods of the two slow lines in the test; they turn the ship, the others roll her."""


@dataclass(frozen=True)
class Lines:
    """The lines of a multi-frequency test.

    Attributes
    ----------
    numbers
        Periods of each line in the test; whole, each once.
    merged
        Lines of Eq. 18 and 19 that fell together when they were rounded.
    collisions
        (i, j, k): the second-order product of lines i and j falls on line k, where the energy of
        an even nonlinearity cannot be told from the ship's linear answer.
    """

    numbers: tuple[int, ...]
    merged: tuple[int, ...]
    collisions: tuple[tuple[int, int, int], ...]


def multisine(
    t: Vector, size: float, amplitudes: ArrayLike, omega: ArrayLike, phases: ArrayLike
) -> Vector:
    """Eq. 17: delta_s(t) = delta_0 sum_i delta_i sin(omega_i t + phi_i); (N,).

    Parameters
    ----------
    size
        delta_0 [rad].
    amplitudes
        Relative, delta_i.
    omega, phases
        [rad/s] and [rad].

    >>> t = np.array([0.0, 1.0])
    >>> multisine(t, 0.1, [1.0, 0.5], [np.pi / 2, np.pi], [0.0, 0.0]).round(12).tolist()
    [0.0, 0.1]
    """
    waves = np.sin(np.outer(t, np.asarray(omega)) + np.asarray(phases))
    return np.asarray(size * (waves @ np.asarray(amplitudes)))


def binary(order: Vector, size: float, hold: int) -> Vector:
    """delta_m(t) = delta_0 sign(delta_s(t)), switched on every `hold`-th sample only; (N,).

    Departure: the paper drops the delta_0. Where the sum is zero the side before it is kept, at the
    start the side that comes after.

    >>> binary(np.array([0.0, -2.0, 0.0, 3.0]), 0.5, 1).tolist()
    [-0.5, -0.5, -0.5, 0.5]
    """
    sides = np.sign(order[np.arange(len(order)) // hold * hold])
    moving = np.flatnonzero(sides)
    if not len(moving):
        return np.zeros(len(order))
    last = np.maximum.accumulate(np.where(sides != 0, np.arange(len(sides)), moving[0]))
    return np.asarray(size * sides[np.maximum(last, moving[0])])


def roll_lines(duration: float, roll_frequency: float) -> tuple[int, ...]:
    """Eq. 18: omega_k = round(alpha_k / beta T_per omega_0 / 2 pi) 2 pi / T_per, as whole periods.

    Departure: the paper prints alpha without its index.

    Parameters
    ----------
    duration
        T_per [s].
    roll_frequency
        omega_0, the natural frequency of roll [rad/s].

    >>> roll_lines(1200.0, 2 * np.pi / 15.0)  # 80 roll periods: the paper's integers
    (19, 33, 51, 80, 117)
    """
    periods = duration * roll_frequency / (2.0 * np.pi)
    return tuple(max(1, round(alpha / BETA * periods)) for alpha in ALPHA)


def lines(duration: float, roll_frequency: float) -> Lines:
    """Eq. 19: omega_6 = 3 (2 pi / T_per), omega_7 = 2 pi / T_per, beside those of Eq. 18, checked.

    That no second-order product falls on a line holds for the paper's 80 roll periods; after
    rounding for another duration it may be lost, and lines may merge. Both are found here.

    >>> lines(1200.0, 2 * np.pi / 15.0).collisions
    ()
    >>> lines(120.0, 2 * np.pi / 15.0).merged
    (3,)
    """
    wanted = (*roll_lines(duration, roll_frequency), *SLOW)
    numbers = tuple(sorted(set(wanted), reverse=True))
    merged = tuple(sorted(n for n in numbers if wanted.count(n) > 1))
    return Lines(numbers, merged, collisions(numbers))


def collisions(numbers: Sequence[int]) -> tuple[tuple[int, int, int], ...]:
    """Second-order products, sums and differences, that fall on a line.

    >>> collisions((1, 3, 4))
    ((1, 3, 4), (1, 4, 3), (3, 4, 1))
    """
    return tuple(
        (i, j, k)
        for i, j in combinations_with_replacement(sorted(numbers), 2)
        for k in sorted({i + j, abs(i - j)}, reverse=True)
        if k in numbers and k > 0
    )


def steps(t: Vector, instants: Sequence[float], orders: Sequence[float]) -> Vector:
    """Each order from its instant [s] on, zero before the first; (N,).

    >>> steps(np.arange(4.0), [1.0, 3.0], [0.2, -0.1]).tolist()
    [0.0, 0.2, 0.2, -0.1]
    """
    place = np.searchsorted(np.asarray(instants) - 1e-9, t, side="right")
    return np.concatenate([[0.0], orders])[place]
