"""Several channels of one quantity: where they disagree, one of them is not the truth.

Which one is not said. The rate of turn of a satellite compass comes 8.8 s after that of the other
compass of the same boat, and its roll stands seven degrees off; a model fitted to the wrong one
would be of the sensor.
"""

import itertools
from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from trialid.alignment.agreement import relation
from trialid.alignment.agreement.channel_finding import Finding
from trialid.alignment.agreement.checks import trial_of_series
from trialid.alignment.agreement.relation import Relation
from trialid.alignment.agreement.slopes import FAIR, LATE, LOOSE, MOVING, is_clear
from trialid.alignment.clocks import Series
from trialid.alignment.frames import sensor_values
from trialid.alignment.sources import SignalSource
from trialid.arrays import Vector
from trialid.errors import UnitError
from trialid.names import units
from trialid.names.quantities import SIGNALS, Quantity
from trialid.recording import Channel, Recording

OFFSET = 0.25
"""Share of the motion: two sensors whose levels differ by more are mounted or set differently."""
APART = 2.0
"""A shift explains much when it leaves less than half of what no shift leaves."""
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
    both = trial_of_series({"first": first, "second": second})
    if both is None or len(both.signals) < 2:  # one of them has hardly a sample
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
    elif is_clear(found):
        yield from _lag_and_gain(found)
    elif found.later and 1 - found.at_once**2 > APART * (1 - strength**2):
        yield f"correlation {found.at_once:.2f}, {strength:.2f} shifted by {found.lag:.2g} s"
    if strength > LOOSE and min(found.parts, default=1.0) < STEADY:
        yield f"they agree in part only (correlation {min(found.parts):.2f} to {strength:.2f})"


def _lag_and_gain(found: Relation) -> Iterator[str]:
    low, high = found.gain
    late = found.later and abs(found.lag) > LATE
    unlike = low > FAIR or high < 1 / FAIR
    if late:
        order = "later" if found.lag > 0 else "earlier"
        yield f"{abs(found.lag):.2g} s {order} ({found.lags[0]:.2g} to {found.lags[1]:.2g} s)"
    if unlike:
        yield f"moves {low:.2g} to {high:.2g} times as much"
    if late or unlike:
        yield f"correlation {found.correlation:.3f}"


def _level(offset: float, quantity: Quantity) -> Iterator[str]:
    yield f"{offset * units.shown_factor(quantity):+.3g} {quantity.shown} apart"


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


def compare_duplicates(
    sources: Sequence[SignalSource], recordings: Sequence[Recording]
) -> tuple[Finding, ...]:
    """Where a chosen channel disagrees with another of its quantity that was read with it.

    Only channels that the format itself says to be of that quantity, in a unit it states.
    """
    found: list[Finding] = []
    for source in sources:
        channels = {c.name: c for r in recordings for c in r.channels.values()}
        mine = channels.get(source.channel)
        others = [c for c in channels.values() if c.quantity == source.quantity]
        if mine is None or mine.quantity != source.quantity or len(others) < 2:
            continue
        for other in others:
            pair = {one.name: series_of(one) for one in (mine, other)}
            known = {name: one for name, one in pair.items() if one is not None}
            found += disagreements(known)
    return tuple(found)


def series_of(channel: Channel) -> Series | None:
    """The channel in SI by the format's own quantity, unit and side; None where one is missing."""
    if channel.quantity not in SIGNALS or channel.unit is None:
        return None
    quantity = SIGNALS[channel.quantity]
    try:
        factor = units.factor(channel.unit, quantity.unit)
    except UnitError:
        return None
    side = -1.0 if channel.positive == "port" and quantity.mirror < 0 else 1.0
    return Series(quantity, channel.t, side * factor * sensor_values(channel.y), channel.clock)
