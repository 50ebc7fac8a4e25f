"""What files of gains say of the order that steers: a rudder angle, or a share of two thrusters.

ArduPilot Rover (libraries/AR_Motors): a rudder's output is scaled above MOT_SPD_SCA_BASE by that
speed over the ship's own; a skid-steered vehicle (SERVOn_FUNCTION 73 and 74) gives throttle +
steering to port and throttle - steering to starboard, unscaled.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from trialid.design.steering.gains import Gains
from trialid.design.steering.straight_course import LinearShip
from trialid.names import units, wording
from trialid.ship.actuators import COMMANDS, Actuator, actuator_quantities

SCALED_FROM: Final = 1.0
"""m/s, ArduPilot's MOT_SPD_SCA_BASE where nobody has changed it."""
RUDDER: Final = "delta is the rudder angle, positive to starboard [rad]."


@dataclass(frozen=True, kw_only=True)
class Output:
    """What a steering output of one is in ArduPilot.

    Attributes
    ----------
    share
        Order [SI] that an output of one becomes at the speed of the gains.
    words
        What it is, and what the parameters beside the gains are there for.
    parameters
        Beside the gains.
    """

    share: float
    words: str
    parameters: Mapping[str, float]


def ardupilot_output(gains: Gains, full: float) -> Output:
    """What an output of one becomes, a full rudder [rad] or a full command of thrusters [SI]."""
    ship = gains.ship
    if ship.steered_by.thrusters:
        port, starboard = ship.steered_by.inputs
        words = (
            f"Skid steering, SERVOn_FUNCTION 73 for {port} and 74 for {starboard}: steering output "
            f"s is added to the one and taken from the other; one is a command of "
            f"{command_words(ship, full)}, in proportion, for which MOT_THST_EXPO and MOT_THR_MIN "
            f"are 0. {command_words(ship, ship.held)} of both hold {ship.speed:.3g} m/s. Output is "
            "not scaled by the speed; where both do not fit, MOT_STR_THR_MIX says which gives way."
        )
        return Output(
            share=full, words=words, parameters={"MOT_THST_EXPO": 0.0, "MOT_THR_MIN": 0.0}
        )
    words = (
        f"Full output is {np.rad2deg(full):.4g} deg of rudder, as --full-rudder says; above "
        f"{SCALED_FROM:g} m/s output is scaled by that speed over the ship's."
    )
    share = full * min(SCALED_FROM / ship.speed, 1.0)
    return Output(share=share, words=words, parameters={"MOT_SPD_SCA_BASE": SCALED_FROM})


def order_words(ship: LinearShip, full: float = 1.0) -> str:
    """What the order is that is called delta, or s of a full command [SI]."""
    if not ship.steered_by.thrusters:
        return RUDDER
    return (
        f"delta is a share s from -1 to 1, positive to turn to starboard: {mix_words(ship, full)}; "
        f"the command of both that holds {ship.speed:.3g} m/s is {command_words(ship, ship.held)}."
    )


def nomoto_words(ship: LinearShip) -> str:
    """What the order of K is, in SI."""
    if not ship.steered_by.thrusters:
        return RUDDER
    unit = COMMANDS[ship.steered_by.thrusters[0].command]
    port, starboard = ship.steered_by.inputs
    return (
        f"delta is half the difference of two commands [{unit}], positive to turn to starboard: "
        f"{port} = cruise + delta, {starboard} = cruise - delta; the cruise that holds "
        f"{ship.speed:.3g} m/s is {ship.held:.4g}."
    )


def mix_words(ship: LinearShip, full: float) -> str:
    """How the order goes to both thrusters."""
    port, starboard = ship.steered_by.inputs
    if full == 1.0:
        return f"{port} = cruise + s, {starboard} = cruise - s"
    size = command_words(ship, full)
    return f"{port} = cruise + s * range, {starboard} = cruise - s * range, range {size}"


def command_words(ship: LinearShip, command: float) -> str:
    """A command of the thrusters in words."""
    factor, unit = command_unit(ship.steered_by.thrusters[0])
    return f"{wording.number(command * factor, 3)} {'' if unit == '1' else unit}".strip()


def command_unit(one: Actuator) -> tuple[float, str]:
    """What to multiply the command of a thruster by to show it, and the unit it is shown in."""
    command = actuator_quantities([one])[one.drive]
    same = command.shown == command.unit
    return 1.0 if same else units.shown_factor(command), command.shown


def limits_words(ship: LinearShip) -> str:
    """What no promise holds."""
    what = (
        "Thrusters that cannot give so much"
        if ship.steered_by.thrusters
        else ("A rudder that cannot go so fast or so far")
    )
    return f"{what}, wind and waves are not in that."
