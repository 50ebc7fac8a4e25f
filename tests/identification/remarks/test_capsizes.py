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


@pytest.mark.study(turn="each")
@pytest.mark.parametrize(
    ("drift", "heel", "GM"),
    [
        pytest.param(30.0, 60.0, 0.01, marks=pytest.mark.study(turn="each")),
        (60.0, 100.0, 0.005),
    ],
)
def test_one_whose_file_makes_her_turn_on_and_capsize_is_found_all_the_same(drift, heel, GM):
    """No pipeline of an outsider's RIB ran, of whose draught nobody had said anything."""
    stated = s175q.SHIP.coefficients
    wild = {"Nv": drift * stated["Nv"], "Kdelta": heel * stated["Kdelta"], "GM": GM}
    model = replace(s175q.MODEL, ship=replace(s175q.SHIP, coefficients=stated | wild))
    free = ("Nv", "Nr", "Ndelta", "Kdelta", "GM")
    trials = [s175q.zigzag(10), s175q.zigzag(20)]
    found = identify(trials, model, replace(s175q.SETTINGS, free=free))
    assert found.converged
    for name in free:
        assert found.value(name) == pytest.approx(s175q.MODEL.value(name), rel=1e-3), name
