"""A kernel belongs to a structure: ships of any size share it, each with numbers of her own."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from trialid.ship.model import ShipModel
from trialid.simulation.emit import module_text
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial


def test_ships_of_one_structure_share_a_kernel(
    everything: ShipModel, lively: Callable[..., Trial]
) -> None:
    """The text knows nothing of a ship's size, and the numbers are hers all the same."""
    ship = everything.ship
    larger = {"L": 1.3, "B": 1.2, "T": 1.1, "D_P": 1.25, "nabla": 1.7, "U0": 1.14, "GM": 1.05}
    grown = {n: x * larger.get(n, 1.0) for n, x in ship.particulars.items()}
    other = replace(everything, ship=replace(ship, particulars=grown))
    free = ("Nr", "m", "GM")
    first, second = (prepare(model, free, ("r", "phi")) for model in (everything, other))
    for sensitivities in (False, True):
        one, two = (module_text(s.equations, sensitivities) for s in (first, second))
        assert one == two
    values = {n: other.value(n) for n in free}
    hers = respond(second, lively(60), values, {})
    plain = respond(prepare(other, free, ("r", "phi"), "numpy"), lively(60), values, {})
    another = respond(first, lively(60), values, {})
    np.testing.assert_allclose(hers.y, plain.y, rtol=1e-12, atol=1e-15)
    np.testing.assert_allclose(hers.S, plain.S, rtol=1e-9, atol=1e-12)
    assert np.abs(hers.y - another.y).max() > 1e-3
