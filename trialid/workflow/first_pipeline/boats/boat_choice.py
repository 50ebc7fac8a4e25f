"""A boat that steers by two thrusters: which channels drive her, and which of them is to port."""

import dataclasses
from collections.abc import Iterator
from itertools import groupby
from typing import Final

import numpy as np

from trialid.errors import LogError
from trialid.inspection.channel_names import ORDERED
from trialid.inspection.drives import drives_of, has_side, of_some_steering
from trialid.inspection.inspected import ChannelInspection, Inspection
from trialid.inspection.name_words import words
from trialid.inspection.own_scale import at_rest
from trialid.inspection.relations import side, turns_late
from trialid.inspection.sketch import Sketch
from trialid.names.quantities import SIGNALS
from trialid.ship.actuators import Actuator, Command, actuator_tables
from trialid.ship.particulars import Ship
from trialid.workflow.first_pipeline.boats.over_ground import (
    with_speed_by_position,
    with_velocity_over_ground,
)
from trialid.workflow.first_pipeline.boats.turned_drives import (
    ANGLE,
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
ASK_PORT: Final = Reason(
    "FILL IN the unit after settling which is to port: the motion does not tell", "asked"
)
BOTH_ALIKE: Final = Reason(
    "CAREFUL: which is to port does not show; both always do the same, so that little hangs on it",
    "alike",
)
BY_DRIVES: Final = "her two drives differ, and are taken to steer her"
UNSIGNED: Final = "CAREFUL: without sign, thrust astern counts as ahead: hold it against the gear"
ARM: Final = 0.2
"""Thrusters stand so far from the middle, over the length of a boat: 0.2 of the Otter and the
WAM-V, 0.24 of the BlueBoat."""
ARM_OF_PODS: Final = 0.08
"""Of pods: 0.08 of a research vessel, 0.09 of tugs; turned alike they do without it."""
AFT: Final = -0.4
"""And so far aft, which where both push alike tells nothing."""


ASSUMED: Final = {
    "thruster": (
        "# ASSUMED: where the thrusters stand. Measure it: the moment goes with it, and what is",
        "# found of the inertia in yaw too.",
    ),
    "azimuth": (
        "# ASSUMED: where the pods stand. Measure it: the moment goes with it, and what is",
        "# found of the inertia in yaw too.",
    ),
    "tunnel": (
        "# ASSUMED: where the tunnel stands; which way it pushes the turn shows. Measure it: the",
        "# moment goes with it.",
    ),
    "rudder": (
        "# ASSUMED: where the rudders stand. Only `rudders_drag` and `rudders_race` ask for it; a",
        "# rudder in the race of a screw is `behind` it.",
    ),
}


def choose(survey: Inspection, speed: float | None) -> Chosen:
    """What to take from a log, of a ship with a rudder or of a boat with two thrusters.

    `speed` [m/s] is the user's own word for the approach speed.

    Raises
    ------
    TooLittle
        It holds neither, or no motion.
    """
    live = {name: live_sources(survey, name) for name in SIGNALS}
    turns, drives = live.get("r") or live.get("psi"), drives_of(survey)
    if not turns or len(drives) != 2:
        return _choose_ship(survey, live, speed)
    rudders = [one for name in RUDDERS for one in live[name]]
    steered = any(not of_some_steering(one) for one in rudders)
    steered = steered or (bool(rudders) and hardly_differ(*drives))
    if steered and not angles_of(survey, drives):
        return _choose_ship(survey, live, speed)
    boat = _choose_boat(survey, live, speed)
    unread = [plain_signal(name, live, "") for name in RUDDERS if live[name] and not steered]
    return dataclasses.replace(boat, beside=(*boat.beside, *((one, BY_DRIVES) for one in unread)))


def _choose_ship(survey: Inspection, live: Live, stated: float | None) -> Chosen:
    return with_speed_by_position(with_further(choose_signals(survey, stated), live))


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


def _drive_signals(survey: Inspection, turn: Signal) -> list[Signal]:
    """Both drives as signals of a pipeline, their sides held against the turn."""
    port, starboard = drives_of(survey)
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
    """Whether signals are of a boat that steers by thrusters."""
    return {PORT, STARBOARD} <= signals


def boat_actuators(signals: tuple[Signal, ...], ship: Ship) -> tuple[Actuator, ...]:
    """Both thrusters of a boat, where nobody says where they stand."""
    length = ship.particulars.get("L", 0.0)
    units = {one.quantity: _unit_once_filled(one) for one in signals}
    turned = f"{PORT}{ANGLE}" in units
    return tuple(
        Actuator(
            name=name,
            kind="azimuth" if turned else "thruster",
            x=round(AFT * length, 2),
            y=round(sign * (ARM_OF_PODS if turned else ARM) * length, 2),
            command=command_of(units[name]),
        )
        for name, sign in ((PORT, -1.0), (STARBOARD, 1.0))
    )


def _unit_once_filled(signal: Signal) -> str:
    """The unit of a drive; of one that is open for its side the one that will be filled in."""
    unit = signal.unit or "1"
    if unit == OPEN and at_rest(signal.source):
        return "1"  # of pulses the guide's line makes a share of full
    return unit_of_drive(signal.source)[0] if unit == OPEN else unit


def command_of(unit: str) -> Command:
    """What a drive with this unit is told: revolutions, a share of full, or a thrust."""
    if unit in ("1", "%", "percent"):
        return "share"
    return "thrust" if unit in ("N", "kN", OPEN) else "revolutions"


def actuator_lines(actuators: tuple[Actuator, ...]) -> Iterator[str]:
    """Tables for a ship file, with what was assumed; nothing where there is none."""
    for kind, ones in groupby(actuators, lambda one: one.kind):
        yield ""
        yield from ASSUMED[kind]
        yield from actuator_tables(ones)


def named_by_ship(signals: tuple[Signal, ...], ship: Ship) -> tuple[Signal, ...]:
    """The same signals with the names of the ship's own two thrusters.

    Raises
    ------
    LogError
        Her file does not name one to each side.
    """
    kind = "azimuth" if any(one.quantity.endswith(ANGLE) for one in signals) else "thruster"
    port = [a.name for a in ship.actuators if a.kind == kind and a.y < 0.0]
    starboard = [a.name for a in ship.actuators if a.kind == kind and a.y > 0.0]
    if len(port) != 1 or len(starboard) != 1:
        raise LogError(
            f"the log has two of kind {kind}, and the file of ship {ship.name!r} names {len(port)} "
            f"to port and {len(starboard)} to starboard; write an [[actuator]] for each, see "
            "`trialid guide actuators`"
        )
    names = {PORT: port[0], STARBOARD: starboard[0]}
    names |= {f"{ours}{ANGLE}": f"{hers}{ANGLE}" for ours, hers in names.items()}
    return tuple(
        dataclasses.replace(one, quantity=names.get(one.quantity, one.quantity)) for one in signals
    )


def main_drives(ship: Ship) -> frozenset[str]:
    """Signals of what drives her, as fed back; a tunnel pushes her aside and no boat on."""
    return frozenset(one.drive for one in ship.actuators if one.drive and one.kind != "tunnel")
