"""Ships with actuators of every kind, for tests of what their effects do."""

from dataclasses import replace
from pathlib import Path

from trialid.effects import CATALOGUE
from trialid.effects.actuators import actuator_effects
from trialid.ship.actuators import Actuator, actuator_quantities
from trialid.ship.effect import Effect
from trialid.ship.particulars import Ship, read_ship

S175Q = Path(__file__).parents[2] / "sample_data" / "ships" / "s175q.toml"

EVERY_KIND = (
    Actuator(name="rudder_port", kind="rudder", x=-80.0, y=-4.0),
    Actuator(name="rudder_stbd", kind="rudder", x=-80.0, y=4.0, behind="right"),
    Actuator(name="left", kind="thruster", x=-75.0, y=-6.0),
    Actuator(name="right", kind="thruster", x=-75.0, y=6.0, direction=0.1, own=True),
    Actuator(name="pod", kind="azimuth", x=-78.0, y=0.0, command="share"),
    Actuator(name="jet", kind="waterjet", x=-80.0, y=2.0, command="thrust"),
    Actuator(name="bow", kind="tunnel", x=70.0, y=0.0, direction=1.5707963267948966),
)


def ship_with(actuators: tuple[Actuator, ...]) -> Ship:
    """The container ship of the samples with these actuators."""
    return replace(read_ship(S175Q), actuators=actuators)


SHIP = ship_with(EVERY_KIND)
EFFECTS: dict[str, Effect] = actuator_effects(SHIP, ("left", "right"))
QUANTITIES = actuator_quantities(EVERY_KIND)


def both(ship: Ship, *ordered: str) -> dict[str, Effect]:
    """The catalogue and the effects of a ship's actuators."""
    return {**CATALOGUE, **actuator_effects(ship, ordered)}
