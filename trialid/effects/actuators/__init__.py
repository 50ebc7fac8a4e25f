"""Effects of a ship's own actuators: made of her file, each kind in a loop over its instances.

They stand beside the catalogue for a ship that names actuators, and for no other: what is tried on
a ship with one rudder stays what it was.
"""

from collections.abc import Collection

from trialid.effects.actuators.actuator_faults import fault_effects
from trialid.effects.actuators.jets import jet_effects
from trialid.effects.actuators.many_rudders import rudder_effects
from trialid.effects.actuators.pods import pod_effects
from trialid.effects.actuators.pushes import push_effects
from trialid.effects.actuators.standstill import standstill_effects
from trialid.ship.effect import Effect
from trialid.ship.particulars import Ship

__all__ = ["actuator_effects"]


def actuator_effects(ship: Ship, ordered: Collection[str] = ()) -> dict[str, Effect]:
    """All effects that this ship's actuators bring with them, by name; none where she has none.

    Parameters
    ----------
    ordered
        Signals of which the order is recorded, `left` for `left_order`: what is late then is it.
    """
    if not ship.actuators:
        return {}
    made = (
        *rudder_effects(ship),
        *push_effects(ship),
        *pod_effects(ship),
        *jet_effects(ship),
        *standstill_effects(ship),
        *fault_effects(ship, ordered),
    )
    return {one.name: one for one in made}
