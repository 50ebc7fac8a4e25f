"""Two drives that are turned: pods and azimuth thrusters, each with the angle it pushes at."""

from collections.abc import Iterator, Sequence
from typing import Final

import numpy as np

from trialid.inspection.drives import ENDS, end_of
from trialid.inspection.inspected import ChannelInspection, Inspection
from trialid.inspection.name_words import sides, words
from trialid.inspection.relations import side
from trialid.inspection.sketch import on_one_clock
from trialid.inspection.usual_units import to_si
from trialid.workflow.first_pipeline.chosen import ASK_UNIT, OPEN, UNSAID, Reason, Signal

PODS: Final = frozenset(words("azimuth azimut azi pod asd azimuththruster"))
THRUSTERS: Final = frozenset(words("thr thruster thrusters"))
"""Words of the angle that a drive is turned to, of the second ones beside `angle`, ..."""
NO_ANGLE: Final = frozenset(words("rudder pitch blade trim tilt wind heading roll bow"))
"""... and of angles of something else."""
ANGLE: Final = "_angle"
"""What the angle of a drive is called behind its name."""

CLOCKWISE: Final = "clockwise from ahead, as to starboard she turns to port by it"
TO_PORT: Final = "positive to port, as she turns to starboard by it"
AFT: Final = "thruster_aft"
FORE: Final = "thruster_fore"
"""Signals of a drive at either end; the turn by one that stands ahead goes the other way."""
AHEAD: Final = "clockwise from ahead, as it stands fore and to starboard she turns to starboard"
AHEAD_TO_PORT: Final = "positive to port, as it stands fore and she turns to port by it"
OR_EXCHANGED: Final = "CAREFUL: or fore and aft are exchanged, which looks alike"
UNSEEN: Final = (
    "CAREFUL: taken as clockwise from ahead, to where it pushes; the motion does not show which "
    "way it counts"
)

SAME: Final = 0.05
"""Share of its largest by which one drive of two that do the same differs from the other, or one
angle, ..."""
MOSTLY: Final = 0.95
"""... for so much of the time. Two pods of a made ferry differ by 0.01, their noise alone; half and
twice say the same of them."""


def angle_signals(survey: Inspection, drives: Sequence[Signal], turn: Signal) -> list[Signal]:
    """The angle of each of two drives, its sense by the turn; none where not each has one.

    A pod stands aft: where it pushes to starboard her stern goes there, and she turns to port; to
    starboard by one that stands ahead.
    """
    angles = angles_of(survey, [one.source for one in drives])
    return [_signal(one, angle, turn) for one, angle in zip(drives, angles, strict=False)]


def angles_of(
    survey: Inspection, drives: Sequence[ChannelInspection]
) -> tuple[ChannelInspection, ...]:
    """The angle that each of these drives is turned to; nothing where not each has one."""
    found = [[*_angles(survey, one)] for one in drives]
    return tuple(ones[0] for ones in found) if all(len(ones) == 1 for ones in found) else ()


def do_the_same(survey: Inspection, drives: Sequence[ChannelInspection]) -> bool:
    """Whether two drives that are turned, and their angles, hardly differ."""
    angles = angles_of(survey, drives)
    return bool(angles) and all(hardly_differ(*pair) for pair in (drives, angles))


def hardly_differ(one: ChannelInspection, other: ChannelInspection) -> bool:
    """Whether two channels are the same, but for their noise."""
    common = on_one_clock(one.sketch, other.sketch)
    if common is None:
        return False
    _, (x, y), _ = common
    return bool(np.quantile(np.abs(x - y), MOSTLY) <= SAME * np.abs(x).max())


def _angles(survey: Inspection, drive: ChannelInspection) -> Iterator[ChannelInspection]:
    mine = _whose(drive)
    for one in survey.channels.values():
        told = {*words(one.name)}
        is_of_pod = PODS & told or ("angle" in told and THRUSTERS & told)
        no_angle = NO_ANGLE - ENDS.get(end_of(one.name), frozenset())
        of_another = no_angle & told or not mine or _whose(one) != mine
        if is_of_pod and not of_another and one is not drive and _is_angle(one):
            yield one


def _whose(one: ChannelInspection) -> set[str]:
    """Its side, or where it has none its number, or its end of the ship."""
    end = end_of(one.name)
    numbers = {word for word in words(one.name) if word in ("1", "2")}
    return sides(one.name) or numbers or ({end} if end else set())


def _is_angle(one: ChannelInspection) -> bool:
    unit = one.stated_unit
    return to_si(unit or "deg", "rad") is not None and not one.constant and one.mostly_there


def _signal(drive: Signal, source: ChannelInspection, turn: Signal) -> Signal:
    towards = turn.positive or "starboard" if turn.quantity == "r" else None
    found = side(source, turn.source, towards)
    told = "" if found is None else f" (correlation with {found.by} {found.strength:+.2f})"
    by_side = {"port": CLOCKWISE, "starboard": TO_PORT}
    if drive.quantity == FORE:
        by_side = {"starboard": AHEAD, "port": AHEAD_TO_PORT}
    sense = UNSEEN if found is None else by_side[found.side]
    to_port = sense in (TO_PORT, AHEAD_TO_PORT)
    unit = source.stated_unit or OPEN
    of_unit = ASK_UNIT if unit == OPEN else UNSAID
    return Signal(
        quantity=f"{drive.quantity}{ANGLE}",
        source=source,
        unit=unit,
        positive="port" if to_port else None,
        taken="by its name",
        of_unit=of_unit,
        of_side=Reason(f"{sense}{told}", None if found is None else "measured"),
        further=(OR_EXCHANGED,) if to_port and drive.quantity in (AFT, FORE) else (),
    )
