"""A turning circle alone: one step of the rudder tells its side."""

from pathlib import Path

import numpy as np
import pytest
from geared_rudder import geared

from trialid.inspection import inspect_log
from trialid.ship.estimate import Given
from trialid.workflow.first_pipeline import starter

T = np.arange(0.0, 400.0, 0.5)


@pytest.mark.parametrize("side", ["starboard", "port"])
def test_its_side_is_measured(tmp_path: Path, side: str) -> None:
    delta, r = geared(np.where(T > 60.0, 25.0, 0.0)), np.zeros(len(T))
    for k in range(len(T) - 1):
        r[k + 1] = r[k] + 0.5 * (0.04 * delta[k] - r[k]) / 15.0
    r += 0.02 * np.random.default_rng(7).standard_normal(len(T))
    sign = 1.0 if side == "starboard" else -1.0
    table = np.column_stack([T, sign * delta, r])
    heads = "t,rudder_deg,rate of turn [deg/s]"
    np.savetxt(tmp_path / "a.csv", table, delimiter=",", header=heads, comments="", fmt="%.5f")
    survey = inspect_log(tmp_path / "a.csv")
    text = starter([survey], tmp_path / "p.toml", None, Given(length=100.0), 6.0).files
    assert f'channel = "rudder_deg", unit = "deg", positive = "{side}"' in text[tmp_path / "p.toml"]
    assert "with r, as it is first laid" in text[tmp_path / "p.toml"]
