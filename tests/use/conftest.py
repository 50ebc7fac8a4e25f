"""A finished run of a short trial, for every test of what is done with one."""

from pathlib import Path

import pytest
import s175q
from test_bad_input import EFFECTS, STATES, trialid_
from use_runs import PIPELINE, RUN, log_of

from trialid.effects import CATALOGUE
from trialid.ship.model import ShipModel


@pytest.fixture(scope="session")
def run_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two zig-zags of a ship that the model describes, but for the sensors' noise, fitted."""
    place = tmp_path_factory.mktemp("used")
    model = ShipModel(s175q.SHIP, STATES, tuple(CATALOGUE[name] for name in EFFECTS))
    for seed, amplitude in enumerate((10, 20)):
        log_of(model, amplitude, seed).to_csv(place / f"zigzag-{amplitude}.csv", index=False)
    ship = s175q.ROOT / "sample_data" / "ships" / "s175q.toml"
    (place / "ship.toml").write_bytes(ship.read_bytes())
    (place / "used.toml").write_text(PIPELINE, encoding="utf-8")
    told = trialid_("run", str(place / "used.toml"), "--quiet", "--out", str(place / RUN))
    assert told.exit_code == 0, told.stderr
    return place / RUN
