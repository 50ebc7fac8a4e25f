"""A rudder to one side on a long voyage that steers to both now and then has its zero amidships."""

from types import SimpleNamespace

import numpy as np
import pytest

from trialid.inspection import own_scale


@pytest.mark.parametrize(("most", "kept"), [(20.0, False), (0.0, True)])
def test_a_voyage_on_one_course_with_few_turns_is_about_amidships(monkeypatch, most, kept):
    """She needs 1.5 deg to go straight, and turns now and then, by so much to either side."""
    y = 1.5 + 0.3 * np.sin(np.arange(2000.0))
    y[1000:1020], y[1500:1520] = 1.5 + most, 1.5 - most
    rudder = SimpleNamespace(sketch=SimpleNamespace(y=y))
    turns = np.sin(np.arange(2000.0))
    monkeypatch.setattr(own_scale, "turning_beside", lambda rudder, turning: turns)
    assert own_scale._keeps_to_a_side(rudder, None) is kept
