"""Several channels of one quantity: where they disagree, one of them is not the truth.

Which one is not said. The rate of turn of a satellite compass comes 8.8 s after that of the other
compass of the same boat, and its roll stands seven degrees off; a model fitted to the wrong one
would be of the sensor.
"""

import itertools
from collections.abc import Iterator, Mapping

import numpy as np

from trialid import units
from trialid.alignment import relation
from trialid.alignment.checks import CLEAR, FAIR, LATE, LOOSE, MOVING, Finding, together
from trialid.alignment.clocks import Series
from trialid.alignment.relation import Relation
from trialid.quantities import Quantity
from trialid.trial import Vector

OFFSET = 0.25
"""Share of the motion: two sensors whose levels differ by more are mounted or set differently."""
STEADY = 0.5
"""A level that stands apart does so by this share at least in every part of the record."""


def disagreements(channels: Mapping[str, Series]) -> tuple[Finding, ...]:
    """What differs between each two channels of one quantity, by channel name.

    Correlation, lag, gain and offset are found from what both cover; a pair that hardly moves, or
    does not overlap, gives nothing but its offset.
    """
    pairs = itertools.combinations(sorted(channels), 2)
    return tuple(
        found
        for first, second in pairs
        if channels[first].quantity.name == channels[second].quantity.name
        for found in _pair((first, second), channels[first], channels[second])
    )


def _pair(names: tuple[str, str], first: Series, second: Series) -> Iterator[Finding]:
    both = together({"first": first, "second": second})
    if both is None:
        return
    valid = both.valid["first"] & both.valid["second"]
    if not valid.any():
        return
    x, y = both.signals["first"], both.signals["second"]
    found = relation.of_values(x, y, valid, both.period)
    offset, steady = _offset(x[valid], y[valid], first.quantity)
    words = [*_motion(found), *(_level(offset, first.quantity) if steady else ())]
    if words:
        yield Finding(
            "differ", "remark", names, f"{names[1]} against {names[0]}: {', '.join(words)}",
            _evidence(found, offset),
        )  # fmt: skip


def _motion(found: Relation | None) -> Iterator[str]:
    """How the motion of the second differs from that of the first, in words."""
    if found is None or min(found.moves) < MOVING:
        return
    strength = found.correlation
    if strength < LOOSE:
        yield f"they do not agree (correlation {strength:.2f} at best)"
        return
    low, high = found.gain
    late = found.later and abs(found.lag) > LATE
    unlike = strength > CLEAR and (low > FAIR or high < 1 / FAIR)
    if late:
        order = "later" if found.lag > 0 else "earlier"
        yield f"{abs(found.lag):.2g} s {order} ({found.lags[0]:.2g} to {found.lags[1]:.2g} s)"
    if unlike:
        yield f"moves {low:.2g} to {high:.2g} times as much"
    if late or unlike:
        yield f"correlation {strength:.3f}"


def _level(offset: float, quantity: Quantity) -> Iterator[str]:
    yield f"{offset * units.shown(quantity):+.3g} {quantity.shown} apart"


def _offset(x: Vector, y: Vector, quantity: Quantity) -> tuple[float, bool]:
    """Mean difference, and whether it stands out of the motion and in each part of the record."""
    apart = y - x
    if quantity.angle:
        turns = np.round(np.median(apart) / (2 * np.pi))
        apart = apart - 2 * np.pi * turns
    whole = float(np.mean(apart))
    parts = np.array([float(np.mean(part)) for part in np.array_split(apart, relation.PARTS)])
    steady = bool(np.all(parts * np.sign(whole) > STEADY * abs(whole)))
    return whole, steady and abs(whole) > OFFSET * float(np.std(x))


def _evidence(found: Relation | None, offset: float) -> dict[str, float]:
    if found is None:
        return {"offset": offset}
    return {
        "offset": offset, "correlation": found.correlation,
        "lag": found.lag, "lag_low": found.lags[0], "lag_high": found.lags[1],
        "gain_low": found.gain[0], "gain_high": found.gain[1],
    }  # fmt: skip
