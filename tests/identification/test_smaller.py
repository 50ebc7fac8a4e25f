"""The optimum of a smaller model as a point of a larger one."""

from types import SimpleNamespace

import numpy as np
import s175q

from trialid.effects import CATALOGUE
from trialid.identification.smaller import point_of_smaller
from trialid.ship.model import STATES, ShipModel

SMALLER = ShipModel(s175q.SHIP, STATES, tuple(CATALOGUE[n] for n in ("linear_hull", "linear_roll")))


def point(*names: str, more: str = "righting_arm_cubic", **known: float):
    """Where the smaller model had these unknowns of the larger one."""
    larger = SMALLER + CATALOGUE[more]
    unknowns = [SimpleNamespace(name=n, column=n, start=7.0) for n in names]
    problem = SimpleNamespace(unknowns=unknowns, simulator=SimpleNamespace(model=larger))
    return point_of_smaller(problem, known, SMALLER)


def test_each_unknown_is_where_the_smaller_model_had_it() -> None:
    """Fitted, held fixed, absent; what is no parameter of the model where it starts."""
    held = SMALLER.value("Yr")
    assert held != 0.0
    found = point("Nr", "Yr", "GM3", "bias_r", Nr=-0.003)
    assert np.array_equal(found, [-0.003, held, 0.0, 7.0])


def test_what_only_shapes_an_effect_was_nowhere() -> None:
    shapes = [n for n, p in CATALOGUE["anti_roll_tank"].parameters.items() if p.null is None]
    assert point(shapes[0], more="anti_roll_tank") is None
