"""Signals a pipeline may name beside those of the dictionary: those of the ship's actuators."""

from collections.abc import Mapping

from trialid.errors import ShipError
from trialid.names.quantities import SIGNALS, Quantity
from trialid.pipeline_file.form import Described
from trialid.ship.actuators import actuator_quantities
from trialid.ship.particulars import read_ship


def ship_quantities(pipeline: Described) -> Mapping[str, Quantity]:
    """The dictionary of signals, with those of the actuators that her file names.

    A ship file that cannot be read is told of where the ship is needed.
    """
    if pipeline.ship is None:
        return SIGNALS
    try:
        return SIGNALS | actuator_quantities(read_ship(pipeline.ship).actuators)
    except ShipError:
        return SIGNALS
