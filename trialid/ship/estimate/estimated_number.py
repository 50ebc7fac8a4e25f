"""One number of a ship file that nobody has measured: its value, its scatter, its source."""

import math
from dataclasses import dataclass

from trialid.ship.particulars import MOST_UNCERTAIN


@dataclass(frozen=True)
class Estimate:
    """A number by a published formula.

    Attributes
    ----------
    share
        How far ships lie from the formula, one standard deviation as a share of the number; zero
        where it is so by definition.
    """

    value: float
    share: float
    source: str


Estimates = dict[str, Estimate]


def joint_share(*shares: float) -> float:
    """Independent shares as one, no more than a ship file may say.

    >>> joint_share(0.3, 0.4)
    0.5
    """
    return min(math.hypot(*shares), MOST_UNCERTAIN)
