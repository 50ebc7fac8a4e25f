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


SHAFTS: Final = frozenset(("n_p", "n_s"))
ENGINES: Final = {"single engine or port": "n_p", "starboard engine": "n_s"}
"""Words by which NMEA 2000 says which of two engines it is."""


def drives_of(survey: Inspection) -> tuple[ChannelInspection, ...]:
    """The port and the starboard drive of a log; fewer where there is not one of each."""
    found: dict[str, list[ChannelInspection]] = {"n_p": [], "n_s": []}
    for one in survey.channels.values():
        told = words(one.name)
        sides = {SIDES[word] for word in told if word in SIDES} or _by_format(one)
        drives = bool(DRIVES & {*told}) and not NO_DRIVE & {*told}
        if len(sides) == 1 and drives and not one.constant and one.missing < 0.5:
            found[sides.pop()].append(one)
    return tuple(ones[0] for ones in found.values() if len(ones) == 1)


def _by_format(one: ChannelInspection) -> set[str]:
    """The side that the format itself gives a shaft or an engine by its number."""
    if one.guess is not None and one.guess.how == "format" and one.guess.quantity in SHAFTS:
        return {one.guess.quantity}
    return {side for words_of_it, side in ENGINES.items() if f"({words_of_it})" in one.description}
