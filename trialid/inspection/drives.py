"""Which channels drive a boat that steers by two thrusters."""

from typing import Final

from trialid.inspection.channel_names import SIDES, words
from trialid.inspection.inspected import ChannelInspection, Inspection

DRIVES: Final = frozenset(
    words(
        "thrust thruster thrusters throttle motor motors engine engines prop props propeller "
        "propellers rpm esc outboard"
    )
)
"""Words of a channel that drives a boat, ..."""

NO_DRIVE: Final = frozenset(
    words(
        "angle pos position joint temperature temp voltage current fuel oil pressure torque load "
        "hours trim tilt state status enable"
    )
)
"""... and of one that only is about what drives her."""


def drives_of(survey: Inspection) -> tuple[ChannelInspection, ...]:
    """The port and the starboard drive of a log; fewer where there is not one of each."""
    found: dict[str, list[ChannelInspection]] = {"n_p": [], "n_s": []}
    for one in survey.channels.values():
        told = words(one.name)
        sides = {SIDES[word] for word in told if word in SIDES}
        drives = bool(DRIVES & {*told}) and not NO_DRIVE & {*told}
        if len(sides) == 1 and drives and not one.constant and one.missing < 0.5:
            found[sides.pop()].append(one)
    return tuple(ones[0] for ones in found.values() if len(ones) == 1)
