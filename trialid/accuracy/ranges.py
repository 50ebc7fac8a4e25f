"""What can be said of a range by itself: how far it goes, where it ends, what it holds."""

import math
from typing import Final

Range = tuple[float, float]
ANYWHERE: Final[Range] = (-float("inf"), float("inf"))
FROM_ZERO: Final[Range] = (0.0, float("inf"))

ANOTHER_GM: Final = "another GM"
"""What widens a range where the record does not tell the metacentric height."""

USUAL_FORCES: Final = "the usual forces at once"
"""What widens a range where all forces that a hull usually has move it further than any alone."""

LOG_SCALES: Final = "scales of the logs"
"""What widens a range where logs that read by other factors move it further than any effect."""

IN_TIME: Final = "sensors that are not early"
"""What widens a range where a sensor is taken to be early, which none is."""


def cut_to_ends(likely: Range | None, ends: Range) -> Range | None:
    """A likely range as far as the ends go between which a parameter may lie.

    >>> cut_to_ends((-0.5, 2.0), (0.0, float("inf"))), cut_to_ends((-3.0, -2.0), (0.0, 1.0))
    ((0.0, 2.0), (0.0, 0.0))
    """
    if likely is None:
        return None
    low, high = (min(max(end, ends[0]), ends[1]) for end in likely)
    return low, high


def wider(own: Range | None, there: Range | None) -> Range | None:
    """A range that holds another one too; its own where either is not known.

    >>> wider((0.0, 2.0), (-4.0, -3.0)), wider(None, (0.5, 1.0)), wider((0.0, 2.0), None)
    ((-4.0, 2.0), None, (0.0, 2.0))
    """
    if own is None or there is None:
        return own
    return min(own[0], there[0]), max(own[1], there[1])


def share_off(value: float | None, likely: tuple[float, float] | None) -> float | None:
    """How far a likely range goes from its value, as a share of it; None where unknown.

    >>> share_off(-2.0, (-3.0, -1.5)), share_off(0.0, (-1.0, 1.0))
    (0.5, None)
    """
    if likely is None or not value:
        return None
    return max(abs(end - value) for end in likely) / abs(value)


def by_share(value: float, likely: Range | None) -> Range | None:
    """A range as far out as slopes reach that grow with the parameter.

    Slopes are those at the fit. What moves it by a share of itself moves one that is larger by the
    same share, so that off by rho outward is off by exp(rho) - 1: 35 % for 30, 11 for 10. Of ships
    that lack several effects Nv and Nr came out a half too small, and slopes at such a fit foretold
    half of the way. One that is off by more than itself is no measure of its slopes any more.

    >>> [round(end, 3) for end in by_share(-2.0, (-2.6, -1.0))], by_share(2.0, (0.0, 1.0))
    ([-2.7, -1.0], (0.0, 1.0))
    """
    if likely is None or not value:
        return likely
    low, high = likely
    out = ((high if value > 0.0 else low) - value) / value
    if out <= 0.0:
        return likely
    end = value * (1.0 + max(out, math.expm1(min(out, 1.0))))
    return (low, end) if value > 0.0 else (end, high)
