"""What an effect is by ran to nothing: the rest of it stands for something else."""

from types import SimpleNamespace

import pytest

from trialid.diagnosis.found_values import is_not_there
from trialid.effects import CATALOGUE


@pytest.mark.parametrize(
    ("name", "at_bounds", "gone"),
    [
        ("rudder_backlash", {"b_play": 0.0}, True),
        ("rudder_backlash", {"b_play": 0.1}, False),
        ("rudder_backlash", {"T_play": 0.05}, False),
        ("rudder_backlash", {}, False),
        ("rudder_deadband", {"b_dead": 0.0}, False),  # nothing is left of it to do anything
        ("yaw_drag_rar", {"Nrar": 0.0}, False),
    ],
)
def test_a_play_of_nothing_is_none(name, at_bounds, gone):
    assert is_not_there(CATALOGUE[name], SimpleNamespace(at_bounds=at_bounds)) is gone
