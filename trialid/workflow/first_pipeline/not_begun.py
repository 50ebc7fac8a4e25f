"""What to say where logs hold too little to begin with: no rudder, no motion, no speed."""

import math
import shlex
from collections.abc import Iterator, Sequence
from typing import Final

from trialid.errors import LogError
from trialid.inspection import Inspection
from trialid.inspection.channel_names import is_course, unit_in_name
from trialid.inspection.drives import drives_among
from trialid.inspection.inspected import ChannelInspection
from trialid.inspection.name_words import sides
from trialid.inspection.own_scale import are_pulses
from trialid.inspection.positions import positions
from trialid.inspection.relations import side
from trialid.inspection.usual_units import to_si
from trialid.recording import OF_TEXT
from trialid.ship.estimate.particulars_given import KNOT

NO_SPEED: Final = "no log tells the speed in a stated unit; add --speed KNOTS, the approach speed"


OF_ONE: Final = "begin with logs of one recorder"
STILL: Final = (
    f"{OF_ONE}; where they are, her drives stand still in some, in which what turns them is read "
    "as a rudder: begin with the others, and map those by hand"
)
AT_ONCE: Final = "dr/dt"
"""What goes by what steers her: with the rate itself a position, a lost speed and a heel do."""
TURNS: Final = 0.7
"""Correlation with that from which a channel may be what steers her. Of 148 logs of outsiders and
real ones eight have one, a servo's pulse in each; at half of it eleven more, most of them speeds,
winds and positions, at twice none."""


PULSED: Final = 100.0
"""[us] How far pulses range at least that steer, a tenth of 1000 to 2000; a pressure of the air
does not in an hour. Only words depend on it."""


class TooLittle(LogError):
    """One log holds too little to begin with: `reason` why, and beside others it is left out."""

    def __init__(self, survey: Inspection, reason: str, then: str) -> None:
        self.reason = f"{survey.path.name}: {reason}"
        super().__init__(f"{survey.path}: {reason}, so no pipeline can be begun; {then}")


def no_signal(survey: Inspection, quantities: Sequence[str]) -> TooLittle:
    """That a log has no rudder or no motion that moves, which of its channels seemed to be, why."""
    called = "rudder or rudder order" if "delta" in quantities else "yaw rate or heading"
    sources = [one for q in quantities for one in survey.sources(q)]
    unlike = [words for one in sources for words in _useless(one)]
    unlike += [] if "delta" in quantities else _courses(survey)
    unlike += [told for file in survey.files for told in file.remarks if OF_TEXT in told]
    among = f"among its {len(survey.channels)} channels"
    why = f" ({'; '.join(unlike)})" if unlike else ""
    reason = f"no moving {called} is recognised {among}{why}"
    return TooLittle(survey, reason, _what_then(survey, bool(sources)))


def no_speed_of_boat(survey: Inspection) -> TooLittle:
    """That a boat with two thrusters has no speed, and what may tell it."""
    there = positions(survey.channels.values())
    coarse = (
        "her positions scatter too much to tell one in the time in which she turns, or no heading "
        "is logged along which she goes; "
    )
    beside = coarse if there else ""
    return TooLittle(
        survey,
        "she steers by two thrusters, and no speed is recognised, which is half of what they do",
        f"{beside}map one by hand, see `trialid inspect --all {shlex.quote(str(survey.path))}`",
    )


def _useless(one: ChannelInspection) -> Iterator[str]:
    """Why a channel that is called so is none to begin with."""
    if one.constant:
        yield f"{one.key!r} " + ("holds no number" if math.isnan(one.low) else "does not move")
    elif not one.mostly_there:
        yield (
            f"{one.key!r} has a value in {1.0 - one.missing:.0%} of its rows, the longest time "
            f"without one {one.gaps.longest:.4g} s: where it is logged as it changes and holds "
            "between, fill it up, with the value before"
        )


def _courses(survey: Inspection) -> list[str]:
    """That a course over ground is no heading, and what can be done with one."""
    named = [
        one.key
        for one in survey.channels.values()
        if is_course(one.name, one.description, one.stated_unit) and not one.constant
    ]
    words = "is no heading, for drift and current are in it: `trialid guide track` compares it"
    return [f"{named[0]!r} {words}"] if named else []


def _what_then(survey: Inspection, called: bool) -> str:
    """What to do where no rudder or no motion is recognised, or one is that is `called` so."""
    turning = None if called else _turns_with(survey)
    if turning is not None:
        return (
            f"{turning}: where it steers her, call it `steering`, or map it to delta or "
            f"delta_order by hand, see `trialid inspect --all {shlex.quote(str(survey.path))}`"
        )
    drives = [] if called else drives_among(survey)
    if drives:
        turned = any(survey.sources(one) for one in ("psi", "r"))
        lacking = "" if turned else ", of which neither is recognised: log one, or map it"
        return (
            f"she seems to steer by thrusters ({', '.join(drives[:4])}): two are begun with, "
            f"called left and right or 1 and 2, beside heading or yaw rate{lacking}; map others by "
            "hand, see `trialid guide actuators`"
        )
    pulses = [] if called else [one.name for one in survey.channels.values() if _is_driven(one)]
    if pulses:
        return (
            f"{', '.join(pulses[:4])} may be pulse widths [us]: where they order two thrusters, "
            "call them thruster_port and thruster_starboard, where one orders her servo, call it "
            "steering; `trialid guide actuators`"
        )
    return f"see `trialid inspect --all {shlex.quote(str(survey.path))}`, and map them by hand"


def _is_driven(one: ChannelInspection) -> bool:
    """Whether its numbers move as pulses of servos do, and no pressure of the air."""
    return one.guess is None and are_pulses(one) and one.high - one.low > PULSED


def _turns_with(survey: Inspection) -> str | None:
    """The channel that is not read by which she turns most, where it is by one; else None."""
    turns = next((one for q in ("r", "psi") for one in survey.sources(q) if not one.constant), None)
    if turns is None:
        return None
    moves = [c for c in survey.channels.values() if c.guess is None and not c.constant]
    found = [(s, c.name) for c in moves if _may_steer(c) and (s := side(c, turns)) is not None]
    turning = [(s, name) for s, name in found if s.by == AT_ONCE and abs(s.strength) >= TURNS]
    if not turning:
        return None
    told, name = max(turning, key=lambda one: abs(one[0].strength))
    return f"{name!r} goes with {told.by} of {turns.name!r} (correlation {told.strength:+.2f})"


def _may_steer(one: ChannelInspection) -> bool:
    """Whether it is no drive to one side, and no course, which goes behind the heading."""
    return not sides(one.name) and not is_course(one.name, one.description, one.stated_unit)


def no_speed(surveys: Sequence[Inspection]) -> str:
    """That no log tells the speed; or that one holds a single value, and how to take it."""
    for survey in surveys:
        for one in survey.sources("u"):
            if one.constant and (held := _held(one)) > 0.0:
                unit = one.stated_unit
                return (
                    f"{one.name!r} is {float(one.sketch.y[0]):g} {unit} throughout, as no log "
                    "under way is; if that is the approach speed, add "
                    f"--speed {held / KNOT:.4g} (knots)"
                )
    unread = dict.fromkeys(name for survey in surveys for name in _in_a_speeds_unit(survey))
    if not unread:
        return NO_SPEED
    listed = ", ".join(repr(name) for name in [*unread][:3])
    more = f" and {len(unread) - 3} more" if len(unread) > 3 else ""
    return (
        f"{NO_SPEED}; of what is not read, in a unit of speeds: {listed}{more}: where one is her "
        "speed through the water, call it stw"
    )


def _in_a_speeds_unit(survey: Inspection) -> Iterator[str]:
    """Channels that are read as nothing, and move in a unit of speeds."""
    for one in survey.channels.values():
        unit = one.stated_unit or unit_in_name(one.name)
        if one.guess is None and not one.constant and unit and to_si(unit, "m/s") is not None:
            yield one.name


def _held(one: ChannelInspection) -> float:
    """The one value of a channel [m/s], 0 where its unit is not stated."""
    size = to_si(one.stated_unit or "", "m/s")
    y = one.sketch.y
    return float(y[0]) * size if size is not None and len(y) else 0.0
