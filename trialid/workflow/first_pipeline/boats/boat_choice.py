"""A boat that steers by two thrusters: which channels drive her, and which of them is to port."""

import dataclasses
from typing import Final

import numpy as np

from trialid.inspection.channel_names import ORDERED
from trialid.inspection.drives import (
    ENDS,
    drives_by_end,
    drives_of,
    end_of,
    has_side,
    of_some_steering,
)
from trialid.inspection.inspected import ChannelInspection, Inspection
from trialid.inspection.name_words import words
from trialid.inspection.relations import side, turns_late
from trialid.inspection.sketch import Sketch
from trialid.names.quantities import SIGNALS
from trialid.workflow.first_pipeline.boats.one_drive import DRIVE
from trialid.workflow.first_pipeline.boats.over_ground import with_velocity_over_ground
from trialid.workflow.first_pipeline.boats.turned_drives import (
    AFT,
    FORE,
    angle_signals,
    angles_of,
    do_the_same,
    hardly_differ,
)
from trialid.workflow.first_pipeline.boats.unit_of_drive import unit_of_drive
from trialid.workflow.first_pipeline.choice import (
    RUDDERS,
    Live,
    approach_speed,
    choose_signals,
    live_sources,
    other_speed,
    plain_signal,
    rate_signal,
    through_water,
)
from trialid.workflow.first_pipeline.chosen import OPEN, Chosen, Reason, Signal
from trialid.workflow.first_pipeline.further_signals import (
    with_further,
    with_heading,
    with_sway,
    with_wind,
)
from trialid.workflow.first_pipeline.not_begun import no_speed_of_boat
from trialid.workflow.first_pipeline.signed_speed import with_course

PORT, STARBOARD = "thruster_port", "thruster_starboard"
BY_END: Final = Reason("fore or aft by its name; on the midships line, as her file has it")
ASK_PORT: Final = Reason(
    "FILL IN the unit after settling which is to port: the motion does not tell", "asked"
)
BOTH_ALIKE: Final = Reason(
    "CAREFUL: which is to port does not show; both always do the same, so that little hangs on it",
    "alike",
)
BY_DRIVES: Final = "her two drives differ, and are taken to steer her"
UNSIGNED: Final = "CAREFUL: without sign, thrust astern counts as ahead: hold it against the gear"


def choose(survey: Inspection, speed: float | None) -> Chosen:
    """What to take from a log, of a ship with a rudder or of a boat with two thrusters.

    `speed` [m/s] is the user's own word for the approach speed.

    Raises
    ------
    TooLittle
        It holds neither, or no motion.
    """
    live = {name: live_sources(survey, name) for name in SIGNALS}
    turns, drives = live.get("r") or live.get("psi"), _two_drives(survey)
    if not turns or len(drives) != 2:
        return with_further(choose_signals(survey, speed), live)
    rudders = [one for name in RUDDERS for one in live[name]]
    steered = any(not of_some_steering(one) for one in rudders)
    steered = steered or (bool(rudders) and hardly_differ(*drives))
    if steered and not angles_of(survey, drives):
        return with_further(choose_signals(survey, speed), live)
    boat = _choose_boat(survey, live, speed)
    unread = [plain_signal(name, live, "") for name in RUDDERS if live[name] and not steered]
    return dataclasses.replace(boat, beside=(*boat.beside, *((one, BY_DRIVES) for one in unread)))


def _choose_boat(survey: Inspection, live: Live, stated: float | None) -> Chosen:
    no_rate = "no yaw rate is logged"
    turn = rate_signal(live) if live.get("r") else plain_signal("psi", live, no_rate)
    drives = _drive_signals(survey, turn)
    known, told = approach_speed(survey, live, stated)
    speed = through_water(live, known, told) if live.get("u") else velocity_speed(survey)
    speed = speed or other_speed(survey, known, told)
    if known is None and speed is not None and speed.source.angle == "speed":
        known = float(np.median(speed.source.sketch.y))
        told = f"median length of {speed.source.name}"
    moved = (turn,) if speed is None else (turn, speed)
    signals = (*angle_signals(survey, drives, turn), *drives, *moved)
    boat = Chosen(survey=survey, path=survey.path, signals=signals, speed=known, speed_words=told)
    boat = with_course(with_heading(boat, live))
    boat = with_velocity_over_ground(boat, live)
    if "u" not in boat.quantities:
        raise no_speed_of_boat(survey)
    return with_sway(with_wind(boat, live), live)


def _two_drives(survey: Inspection) -> tuple[ChannelInspection, ...]:
    """Those to port and starboard, or one aft and one fore, which steer her where they turn."""
    at_ends = drives_by_end(survey)
    return at_ends if angles_of(survey, at_ends) else drives_of(survey)


def _drive_signals(survey: Inspection, turn: Signal) -> list[Signal]:
    """Both drives as signals of a pipeline, their sides held against the turn."""
    port, starboard = _two_drives(survey)
    if {end_of(port.name), end_of(starboard.name)} == {*ENDS}:
        return [_drive(AFT, port, BY_END), _drive(FORE, starboard, BY_END)]
    says = _agreement(port, starboard, turn)
    if not (has_side(port) or says.rests_on("measured")):
        says = _agreement(starboard, port, turn)
        if says.rests_on("measured"):
            port, starboard = starboard, port
    if says is ASK_PORT and do_the_same(survey, (port, starboard)):
        says = BOTH_ALIKE
    return [_drive(PORT, port, says), _drive(STARBOARD, starboard, says)]


def _drive(name: str, source: ChannelInspection, side: Reason) -> Signal:
    unit, of_unit = unit_of_drive(source)
    if side.rests_on("asked", "denied"):
        unit = OPEN
    unsigned = (UNSIGNED,) if "without sign" in source.description else ()
    told = "by its parameters" if "by its parameters" in source.description else "by its name"
    return Signal(
        quantity=name,
        source=source,
        unit=unit,
        taken=told,
        of_unit=of_unit,
        of_side=side,
        further=unsigned,
    )


def _agreement(port: ChannelInspection, starboard: ChannelInspection, turn: Signal) -> Reason:
    """What tells which is to port: that the boat turns away from the stronger one, or not."""
    left, right = port.sketch, starboard.sketch
    other = np.interp(left.t, right.t, right.y) if len(right.t) else np.zeros(len(left.t))
    both = dataclasses.replace(port, sketch=Sketch(left.t, left.y - other))
    towards = turn.positive or "starboard" if turn.quantity == "r" else None
    found = side(both, turn.source, towards)
    if found is None:
        if has_side(port):
            return Reason("side by its name, the motion does not confirm it")
        return ASK_PORT
    told = f"correlation of port less starboard with {found.by} {found.strength:+.2f}"
    if found.side == "starboard":
        return Reason(f"side confirmed by the turn: {told}", "measured")
    settle = f"FILL IN the unit after settling this: she turns towards the stronger one ({told})"
    lag, strength = turns_late(both, turn.source) or (0.0, 0.0)
    if strength * found.strength < 0.0:
        return Reason(
            f"{settle}, and away from it with clocks {abs(lag):.1f} s apart ({strength:+.2f}): the "
            f"{'thrusters are' if lag < 0.0 else f'{turn.quantity} is'} logged late, and `delay` "
            "says by how much; else port and starboard are exchanged",
            "denied",
        )
    return Reason(
        f"{settle}: port and starboard are exchanged, or the side of {turn.quantity} is wrong",
        "denied",
    )


def velocity_speed(survey: Inspection) -> Signal | None:
    """The length of a logged velocity, for want of a speed."""
    for x in survey.channels.values():
        stem = x.name.removesuffix(".x")
        y = survey.channels.get(f"{stem}.y")
        told = y is not None and x.stated_unit == y.stated_unit == "m/s"
        if stem == x.name or y is None or not told or x.constant or ORDERED & {*words(stem)}:
            continue
        if len(x.sketch.t) == len(y.sketch.t):
            course = Sketch(x.sketch.t, np.hypot(x.sketch.y, y.sketch.y))
            taken = dataclasses.replace(x, name=stem, angle="speed", sketch=course)
            why = "CAREFUL: the length of a velocity over ground; a current adds to it"
            unit = None if x.unit else x.stated_unit
            return Signal(quantity="u", source=taken, unit=unit, taken=why, over_ground=True)
    return None


def is_boat(signals: frozenset[str]) -> bool:
    """Whether signals are of a boat that steers by thrusters, or by what pushes her."""
    return {PORT, STARBOARD} <= signals or {AFT, FORE} <= signals or DRIVE in signals
