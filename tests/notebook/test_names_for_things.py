"""A text where a thing or a number is expected is one line."""

from pathlib import Path
from typing import Any

import pytest

import trialid as ti
from trialid.errors import TrialidError

SHIP = Path(__file__).parents[2] / "sample_data" / "ships" / "s175q.toml"


@pytest.mark.parametrize(
    ("ship", "states", "effects", "said"),
    [
        (None, ("v", "r"), ("linear_hull",), "expected effects, got 'linear_hull'; of the catalog"),
        (None, ("v", "r"), "linear_hull", "expected effects, got 'l'"),
        (None, "v", (), "expected a list of states, got 'v'"),
        ("s175q.toml", ("v",), (), "expected a ship, as ti.read_ship gives, got 's175q.toml'"),
    ],
)
def test_a_model_of_names(ship: Any, states: Any, effects: Any, said: str) -> None:
    with pytest.raises(TrialidError, match=said):
        ti.ShipModel(ship or ti.read_ship(SHIP), states, effects)


def test_a_particular_that_is_a_text() -> None:
    with pytest.raises(TrialidError, match="length '96' is not a number"):
        ti.ship_from_particulars(length="96", beam=16.0)
