"""A screw astern that still meets the water: what it brakes."""

import pytest

from trialid.effects import CATALOGUE


@pytest.mark.parametrize(
    ("n", "u", "pull"), [(-2.0, 3.0, -3e-5), (2.0, 3.0, 0.0), (-2.0, -3.0, 3e-5), (-2.0, 0.0, 0.0)]
)
def test_it_brakes_by_the_way_she_has(n: float, u: float, pull: float) -> None:
    """X = X_ast_u u |n| while the shaft turns astern; with way astern it brakes that."""
    [force] = CATALOGUE["propeller_astern_advance"]({"n": n, "u": u, "X_ast_u": -5e-6})
    assert list(force) == pytest.approx([pull, 0.0, 0.0, 0.0])
