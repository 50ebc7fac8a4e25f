"""How a second source of a quantity is read: its unit and its side, by one that is known.

A table may hold a rudder three times, in degrees, in radians, and with the other sign.
"""

from typing import Final

import numpy as np

from trialid.inspection.inspected import ChannelInspection
from trialid.inspection.relations import RATES, SPEEDS
from trialid.inspection.sketch import on_one_clock
from trialid.inspection.usual_units import to_si
from trialid.names.quantities import SIGNALS

UNITS: Final = {"rad": ("rad", "deg"), "rad/s": RATES, "m/s": SPEEDS}
"""What a quantity may be logged in, by its SI unit."""

ALIKE: Final = 0.9
"""Correlation from which two sources are one motion, so that the ratio of their numbers is that of
their units. An order and its rudder, in zig-zags of three made ships, have 0.89 to 0.98; two logs
of a speed that hardly changes may have less, and are left open."""

NEAR: Final = 1.25
"""Times by which that ratio may differ from the units'; the nearest two, kn and km/h, are 1.85."""


def unit_and_side(
    other: ChannelInspection, known: ChannelInspection, unit: str | None, quantity: str
) -> tuple[str | None, bool | None]:
    """The unit of `other` and whether it counts to the other side than `known`, which is in `unit`.

    None for what their numbers do not tell.
    """
    slope, si = _slope(other, known), SIGNALS[quantity].unit
    size = to_si(unit or known.stated_unit or "", si)
    if slope is None or size is None:
        return None, None if slope is None else slope < 0.0
    sizes = {one: to_si(one, si) or np.inf for one in UNITS.get(si, ())}
    fitting = (one for one in sizes if 1 / NEAR < abs(slope) * size / sizes[one] < NEAR)
    return next(fitting, None), slope < 0.0


def _slope(other: ChannelInspection, known: ChannelInspection) -> float | None:
    """By how much the known one changes with the other; None where they are not one motion."""
    common = on_one_clock(other.sketch, known.sketch)
    if common is None:
        return None
    _, values, whole = common
    x, y = (one[whole] - one[whole].mean() for one in values) if whole.any() else ([], [])
    power = np.sqrt(np.dot(x, x) * np.dot(y, y))
    if not power or abs(np.dot(x, y)) < ALIKE * power:
        return None
    return float(np.dot(x, y) / np.dot(x, x))
