"""A GM that lets her capsize where a search would begin is told, and what to state."""

from dataclasses import replace

import pytest
import s175q

from trialid.errors import SimulationError
from trialid.identification.fit import identify


def test_a_ship_that_capsizes_at_once_is_asked_for_her_gm():
    """An outsider's planing boat: `give nearer values in [model.values]` was all that was said."""
    heels = {"Kdelta": 40.0 * s175q.SHIP.coefficients["Kdelta"], "GM": 0.01}
    ship = replace(s175q.SHIP, coefficients=s175q.SHIP.coefficients | heels)
    free = replace(s175q.SETTINGS, free=("Nr",))
    with pytest.raises(SimulationError, match="the GM of her file lets her capsize: state hers"):
        identify([s175q.zigzag(20)], replace(s175q.MODEL, ship=ship), free)
