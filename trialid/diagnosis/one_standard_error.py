"""Which structure to take: the simplest that chance may have put behind the best.

Structures meet the same trials, so it is their differences that count: an easy trial is easy for
all of them. A structure is as good as the best where the mean of its errors less the best's, over
trials left out, is within one standard error of that mean (Breiman, Friedman, Olshen & Stone 1984,
Classification and regression trees, section 3.4.3, there unpaired).
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.diagnosis.search.carried import FALL, LARGE

HARDLY: Final = 1.0 / float(np.sqrt(FALL)) - 1.0
"""Share of the best's error, 0.8 %, that pays for no parameter however sure it is: as for a single
effect, whose squared error has to fall by more to be worth a name."""

CLEARLY: Final = 1.0 / float(np.sqrt(LARGE)) - 1.0
"""Share, 5.4 %, from which on none is as good however large the standard error is, as a fall that
large needs no test there: a simple structure that is erratic has a large standard error. Without
this the linear hull was taken once for a ship of five effects more, on four trials, at twice the
error on others."""


@dataclass(frozen=True)
class Choice:
    """The best structure, the simplest that is as good, and how far behind each structure is.

    Attributes
    ----------
    behind
        By structure: mean of its errors less the best's, and the standard error of that mean.
    """

    best: str
    simplest: str
    behind: Mapping[str, tuple[float, float]]
    as_good: tuple[str, ...]


def choose_structure(errors: Mapping[str, Vector], parameters: Mapping[str, int]) -> Choice | None:
    """The choice from errors on trials left out; None with fewer than two trials, or no structure.

    Parameters
    ----------
    errors
        By structure, the error on every trial when it was left out, in one order; (K,) each.
    parameters
        How many free parameters each structure has: the simplest has the fewest.
    """
    if not errors or min(map(len, errors.values())) < 2:
        return None
    best = min(errors, key=lambda name: (float(np.mean(errors[name])), parameters[name]))
    behind = {name: _mean_and_error(each - errors[best]) for name, each in errors.items()}
    least = float(np.mean(errors[best]))
    good = tuple(
        name
        for name, (mean, error) in behind.items()
        if mean <= max(HARDLY * least, min(error, CLEARLY * least))
    )
    simplest = min(good, key=lambda name: (parameters[name], behind[name][0]))
    return Choice(best, simplest, behind, good)


def _mean_and_error(differences: Vector) -> tuple[float, float]:
    """Mean of differences, and its standard error."""
    spread = float(np.std(differences, ddof=1)) / float(np.sqrt(len(differences)))
    return float(np.mean(differences)), spread
