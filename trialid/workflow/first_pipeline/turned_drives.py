"""Two drives that are turned: pods and azimuth thrusters, each with the angle it pushes at."""

from collections.abc import Iterator, Sequence
from typing import Final

from trialid.inspection.inspected import ChannelInspection, Inspection
from trialid.inspection.name_words import sides, words
from trialid.inspection.relations import side
from trialid.inspection.usual_units import to_si
from trialid.workflow.first_pipeline.choice import OPEN, Signal

TURNED: Final = frozenset(words("azimuth azimut azi pod asd angle"))
"""Words of the angle that a drive is turned to, ..."""
NO_ANGLE: Final = frozenset(words("rudder pitch blade trim tilt wind heading roll bow"))
"""... and of angles of something else."""
ANGLE: Final = "_angle"
"""What the angle of a drive is called behind its name."""

CLOCKWISE: Final = "clockwise from ahead, as to starboard she turns to port by it"
TO_PORT: Final = "positive to port, as she turns to starboard by it"
UNSEEN: Final = (
    "CAREFUL: taken as clockwise from ahead, to where it pushes; the motion does not show which "
    "way it counts"
)


def angle_signals(survey: Inspection, drives: Sequence[Signal], turn: Signal) -> list[Signal]:
    """The angle of each of two drives, its sense by the turn; none where not each has one.

    A pod stands aft: where it pushes to starboard her stern goes there, and she turns to port.
    """
    found = [[*_angles(survey, one)] for one in drives]
    if not all(len(ones) == 1 for ones in found):
        return []
    return [_signal(one, ones[0], turn) for one, ones in zip(drives, found, strict=True)]


def _angles(survey: Inspection, drive: Signal) -> Iterator[ChannelInspection]:
    mine = _whose(drive.source)
    for one in survey.channels.values():
        told = {*words(one.name)}
        is_angle = TURNED & told and not NO_ANGLE & told and one is not drive.source
        if is_angle and mine and _whose(one) == mine and _is_angle(one):
            yield one


def _whose(one: ChannelInspection) -> set[str]:
    """Its side, or its number where it has none."""
    return sides(one.name) or {word for word in words(one.name) if word in ("1", "2")}


def _is_angle(one: ChannelInspection) -> bool:
    unit = one.unit or one.unit_in_name
    stated = unit is None or to_si(unit, "rad") is not None
    return stated and not one.constant and one.mostly_there


def _signal(drive: Signal, source: ChannelInspection, turn: Signal) -> Signal:
    towards = turn.positive or "starboard" if turn.quantity == "r" else None
    found = side(source, turn.source, towards)
    told = "" if found is None else f" (correlation with {found.by} {found.strength:+.2f})"
    sense = UNSEEN if found is None else CLOCKWISE if found.side == "port" else TO_PORT
    unit = source.unit or source.unit_in_name or OPEN
    asked = "; FILL IN the unit, the log states none" if unit == OPEN else ""
    positive = "port" if sense is TO_PORT else None
    why = f"by its name; {sense}{told}{asked}"
    return Signal(f"{drive.quantity}{ANGLE}", source, unit, positive, why, ())
