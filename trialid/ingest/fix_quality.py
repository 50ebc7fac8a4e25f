"""Positions of no quality become `not available`: what a receiver says beside a fix of that fix.

Some messages carry it in a field of its own: `Status` of dataflash, `fix_type` of MAVLink and PX4
(0 no receiver, 1 no fix, 2 and 3 a fix in so many dimensions, more are better ones) and
`status.status` of a ROS NavSatFix (-1 no fix). It is read along with the position, of the same
message and instance, and used stamp by stamp.
"""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Final

import numpy as np

from trialid.arrays import Mask
from trialid.ingest.adapter import Wanted, is_wanted
from trialid.recording import Channel, Recording

LEAST: Final = {"Status": 2.0, "fix_type": 2.0, "status.status": 0.0}
"""The field that says it, and from what a position can be used: in the plane, at sea, that is 2."""

OF_A_FIX: Final = frozenset(
    (
        *("Lat", "Lng", "Spd", "GCrs", "lat", "lon", "vel", "cog", "latitude", "longitude"),
        *("latitude_deg", "longitude_deg", "vel_m_s", "cog_rad"),
    )
)
"""Fields that a receiver gives out of a fix."""


def with_quality(wanted: Wanted) -> Wanted:
    """What has to be read so that the fixes among the wanted channels can be judged."""
    if wanted is None:
        return None
    places = [place for place, field in map(_cut, wanted) if field in OF_A_FIX]
    return [*wanted, *(f"{place}:{field}" for place in places for field in LEAST)]


def without_poor_fixes(recording: Recording, wanted: Wanted) -> Recording:
    """The wanted channels, NaN where the receiver said it had no fix, and a remark that says so."""
    found = recording.channels
    made, remarks = dict[str, Channel](), dict[str, list[str]]()
    for name, channel in found.items():
        if not is_wanted(name, wanted):
            continue
        poor, words = _poor(channel, found)
        made[name] = channel
        if poor is not None and (poor & np.isfinite(channel.y)).any():
            made[name] = replace(channel, y=np.where(poor, np.nan, channel.y))
            remarks.setdefault(words, []).append(name)
    told = (f"{', '.join(names)}: {words}" for words, names in remarks.items())
    return replace(recording, channels=made, remarks=(*recording.remarks, *told))


def _poor(channel: Channel, found: Mapping[str, Channel]) -> tuple[Mask | None, str]:
    """Where a channel is of no fix by the field beside it, and the words for that."""
    place, field = _cut(channel.name)
    if field not in OF_A_FIX:
        return None, ""
    for judge in _judges(place, found):
        if np.array_equal(judge.t, channel.t):
            least = LEAST[_cut(judge.name)[1]]
            poor = judge.y < least
            words = f"{poor.sum()} of {len(poor)} without a fix ({judge.name} below {least:g})"
            return poor, f"{words}, not available"
    return None, ""


def _judges(place: str, found: Mapping[str, Channel]) -> Iterator[Channel]:
    yield from (found[f"{place}:{one}"] for one in LEAST if f"{place}:{one}" in found)


def _cut(name: str) -> tuple[str, str]:
    place, _, field = name.rpartition(":")
    return place, field
