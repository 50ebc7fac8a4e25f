"""Ships with actuators of every kind, for tests of what their effects do."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from trialid.effects import CATALOGUE
from trialid.effects.actuators import actuator_effects
from trialid.ship.actuators import Actuator, actuator_quantities
from trialid.ship.effect import Effect
from trialid.ship.model import ShipModel
from trialid.ship.particulars import Ship, read_ship
from trialid.trial import Trial

S175Q = Path(__file__).parents[2] / "sample_data" / "ships" / "s175q.toml"

EVERY_KIND = (
    Actuator(name="rudder_port", kind="rudder", x=-80.0, y=-4.0),
    Actuator(name="rudder_stbd", kind="rudder", x=-80.0, y=4.0, behind="right"),
    Actuator(name="left", kind="thruster", x=-75.0, y=-6.0),
    Actuator(name="right", kind="thruster", x=-75.0, y=6.0, direction=0.1, own=True),
    Actuator(name="pod", kind="azimuth", x=-78.0, y=0.0, command="share"),
    Actuator(name="pod_fwd", kind="azimuth", x=40.0, y=3.0, command="share"),
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


EIGHT = (
    Actuator(name="pod_1", kind="azimuth", x=-60.0, y=-8.0),
    Actuator(name="pod_2", kind="azimuth", x=-60.0, y=8.0),
    Actuator(name="pod_3", kind="azimuth", x=-20.0, y=-8.0),
    Actuator(name="pod_4", kind="azimuth", x=-20.0, y=8.0),
    Actuator(name="port", kind="rudder", x=-80.0, y=-4.0),
    Actuator(name="stbd", kind="rudder", x=-80.0, y=4.0),
    Actuator(name="bow_1", kind="tunnel", x=70.0, y=0.0, direction=np.pi / 2),
    Actuator(name="bow_2", kind="tunnel", x=75.0, y=0.0, direction=np.pi / 2),
)


def eight_actuators(
    samples: int = 600, period: float = 0.5
) -> tuple[ShipModel, tuple[str, ...], Trial]:
    """A ship with four pods, two rudders and two bow thrusters, all of them moving."""
    ship = ship_with(EIGHT)
    own = actuator_effects(ship)
    hull = [CATALOGUE[n] for n in ("linear_hull", "surge_resistance")]
    names = ("rudders", "azimuths", "tunnels", "still_water_yaw")
    model = ShipModel(ship, ("u", "v", "r"), (*hull, *(own[n] for n in names)))
    stated = {n: p.start for e in model.effects for n, p in e.parameters.items()}
    model = model.with_values({n: x for n, x in stated.items() if model.stated(n) is None})
    free = ("Nv", "Nr", "Ndelta", "k_pod_ahead", "k_tunnel", "Nr0", "Xuu")
    t = np.arange(samples) * period
    waves = {s: np.sin(0.02 * (i + 3) * t + i) for i, s in enumerate(model.recorded)}
    signals = {s: 2.0 * y if s.startswith("bow") else 0.5 * y for s, y in waves.items()}
    valid = {s: np.ones(len(t), dtype=bool) for s in signals}
    return model, free, Trial("eight", "fit", period, signals, valid)
