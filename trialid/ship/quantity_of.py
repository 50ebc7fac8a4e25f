"""What a signal of a model is: of the dictionary, of the ship's actuators, or of one's own."""

from trialid.names import labels
from trialid.names.quantities import SIGNALS, Quantity
from trialid.ship.actuators import actuator_quantities
from trialid.ship.model import ShipModel


def quantity_of(model: ShipModel, name: str) -> Quantity:
    """Name, unit and meaning of a state, an input or an output."""
    if name in SIGNALS:
        return SIGNALS[name]
    found = actuator_quantities(model.ship.actuators).get(name)
    unit = next((e.own[name].unit for e in model.effects if name in e.own), None)
    if found is None and unit is not None:
        return Quantity(name, name, unit, unit, name)
    return found or labels.quantity(name)
