"""What drives a boat, as her file has it: of the logs' signals, or by her own file's names."""

import dataclasses
from collections.abc import Iterator
from itertools import groupby
from typing import Final

from trialid.errors import LogError
from trialid.inspection.own_scale import at_rest
from trialid.ship.actuators import Actuator, Command, actuator_tables
from trialid.ship.particulars import Ship
from trialid.workflow.first_pipeline.boats.boat_choice import PORT, STARBOARD
from trialid.workflow.first_pipeline.boats.one_drive import DRIVE, HUNG, TURNED
from trialid.workflow.first_pipeline.boats.turned_drives import AFT, ANGLE, FORE
from trialid.workflow.first_pipeline.boats.unit_of_drive import unit_of_drive
from trialid.workflow.first_pipeline.chosen import OPEN, Signal

ARM: Final = 0.2
"""Thrusters stand so far from the middle, over the length of a boat: 0.2 of the Otter and the
WAM-V, 0.24 of the BlueBoat."""
ARM_OF_PODS: Final = 0.08
"""Of pods: 0.08 of a research vessel, 0.09 of tugs; turned alike they do without it."""
FAR_AFT: Final = -0.4
"""And so far aft, which where both push alike tells nothing; pods of a ferry with a bow at either
end so far aft and ahead: 0.36 of a small one that is published."""


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


def boat_actuators(signals: tuple[Signal, ...], ship: Ship) -> tuple[Actuator, ...]:
    """Both thrusters of a boat, or the one that is turned, where nobody says where they stand."""
    length = ship.particulars.get("L", 0.0)
    units = {one.quantity: _unit_once_filled(one) for one in signals}
    if DRIVE in units:
        x, command = round(HUNG * length, 2), command_of(units[DRIVE])
        return (Actuator(name=DRIVE, kind="azimuth", x=x, y=0.0, command=command),)
    turned = any(name.endswith(ANGLE) for name in units)
    arm = ARM_OF_PODS if turned else ARM
    at_ends = {AFT: (FAR_AFT, 0.0), FORE: (-FAR_AFT, 0.0)}
    places = at_ends if AFT in units else {PORT: (FAR_AFT, -arm), STARBOARD: (FAR_AFT, arm)}
    return tuple(
        Actuator(
            name=name,
            kind="azimuth" if turned else "thruster",
            x=round(x * length, 2),
            y=round(y * length, 2),
            command=command_of(units[name]),
        )
        for name, (x, y) in places.items()
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
    """The same signals with her own names of two thrusters, or of the one that is turned.

    Raises
    ------
    LogError
        Her file does not name one to each side, or at each end.
    """
    lone = any(one.quantity == DRIVE for one in signals)
    names = _lone_name(ship) if lone else _names_by_place(signals, ship)
    names |= {f"{ours}{ANGLE}": f"{hers}{ANGLE}" for ours, hers in names.items()}
    return tuple(
        dataclasses.replace(one, quantity=names.get(one.quantity, one.quantity)) for one in signals
    )


def _lone_name(ship: Ship) -> dict[str, str]:
    [name] = [one.name for one in ship.actuators if one.kind in TURNED]
    return {DRIVE: name}


def _names_by_place(signals: tuple[Signal, ...], ship: Ship) -> dict[str, str]:
    kind = "azimuth" if any(one.quantity.endswith(ANGLE) for one in signals) else "thruster"
    at_ends = any(one.quantity == AFT for one in signals)
    hers = {a.name: a.x if at_ends else a.y for a in ship.actuators if a.kind == kind}
    below = [name for name, place in hers.items() if place < 0.0]
    above = [name for name, place in hers.items() if place > 0.0]
    if len(below) != 1 or len(above) != 1:
        where = ("aft", "ahead") if at_ends else ("to port", "to starboard")
        raise LogError(
            f"the log has two of kind {kind}, and the file of ship {ship.name!r} names "
            f"{len(below)} {where[0]} and {len(above)} {where[1]}; write an [[actuator]] for each, "
            "see `trialid guide actuators`"
        )
    names = (AFT, FORE) if at_ends else (PORT, STARBOARD)
    return dict(zip(names, (below[0], above[0]), strict=True))


def main_drives(ship: Ship) -> frozenset[str]:
    """Signals of what drives her, as fed back; a tunnel pushes her aside and no boat on."""
    return frozenset(one.drive for one in ship.actuators if one.drive and one.kind != "tunnel")
