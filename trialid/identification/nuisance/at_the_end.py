"""Sensors' numbers that ran to the end of what is possible: they stand for something else."""

from collections.abc import Sequence
from typing import Final

from trialid.arrays import Vector
from trialid.identification.output_error import Unknown

ALL_THE_WAY: Final = 0.95
"""Share of the way from what is likely to a bound from which on a number is at its end: a gyro
2.97 s early, of 3 s that are possible, is no more a gyro's than one of 3. Of 300 drawn ships (seeds
10500 to 10799) three had such a clock and were called sound, besides three at the bound; half of
the last twentieth takes two of them, twice of it no fourth."""


def at_the_end(unknowns: Sequence[Unknown], theta: Vector) -> dict[str, float]:
    """Values of the nuisances with a prior that are at an end of what is possible, by name.

    Parameters
    ----------
    unknowns, theta
        What was searched for, and its values; (n_theta,).
    """
    found = dict[str, float]()
    for one, value in zip(unknowns, theta, strict=True):
        if one.kind != "nuisance" or one.prior is None:
            continue
        middle = one.prior[0]
        end = one.high if value > middle else one.low
        if abs(value - middle) >= ALL_THE_WAY * abs(end - middle):
            found[one.name] = float(value)
    return found
