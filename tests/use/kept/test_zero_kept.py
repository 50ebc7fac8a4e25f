"""A rudder's zero that her trials have together: in predictions and in files of the model."""

from pathlib import Path

import numpy as np
import pytest
import s175q
from test_bad_input import EFFECTS, STATES, trialid_
from use_runs import PIPELINE, RUN, SPEED, log_of

from trialid.effects import CATALOGUE
from trialid.progress import silent
from trialid.ship.model import ShipModel
from trialid.workflow.use.finished_model import FinishedModel, finished_model
from trialid.workflow.use.orders import OrderTable
from trialid.workflow.use.predict import predict_orders

OFF = 2.0
"""Degrees to starboard that her rudder's record reads amidships."""


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    place = tmp_path_factory.mktemp("off")
    model = ShipModel(s175q.SHIP, STATES, tuple(CATALOGUE[name] for name in EFFECTS))
    for seed, amplitude in enumerate((10, 20)):
        log = log_of(model, amplitude, seed)
        log["rudder[deg]"] -= OFF
        log.to_csv(place / f"zigzag-{amplitude}.csv", index=False)
    ship = s175q.ROOT / "sample_data" / "ships" / "s175q.toml"
    (place / "ship.toml").write_bytes(ship.read_bytes())
    asked = 'nuisance = ["initial_state", "rudder_offset"]\n[diagnose]'
    (place / "used.toml").write_text(PIPELINE.replace("[diagnose]", asked), encoding="utf-8")
    told = trialid_("run", str(place / "used.toml"), "--quiet", "--out", str(place / RUN))
    assert told.exit_code == 0, told.stderr
    return place / RUN


@pytest.fixture(scope="module")
def model(run: Path) -> FinishedModel:
    return finished_model(run, silent)


def turned(model: FinishedModel, rudder: float, **given: float) -> float:
    """The rate of turn [deg/s] after five minutes at a recorded rudder [deg]."""
    t = np.arange(0.0, 300.0, 0.5)
    held = {"delta": np.deg2rad(rudder), **given}
    orders = OrderTable(t, {name: np.full(len(t), x) for name, x in held.items()})
    return float(np.rad2deg(predict_orders(model, orders, "held").motion.motion["r"][-1]))


@pytest.mark.study(turn="each")
def test_a_speed_among_the_orders_takes_no_zero_away(model: FinishedModel) -> None:
    assert turned(model, 0.0, u=SPEED) == pytest.approx(turned(model, 0.0), rel=0.05)
    assert abs(turned(model, 0.0, u=SPEED)) > 10.0 * abs(turned(model, -OFF, u=SPEED))


def test_what_is_handed_over_has_it(run: Path, model: FinishedModel, tmp_path: Path) -> None:
    out = tmp_path / "ship.py"
    told = trialid_("export", str(run), "--as", "python", "--out", str(out))
    assert told.exit_code == 0, told.stderr
    scope: dict[str, object] = {}
    exec(compile(out.read_text(encoding="utf-8"), "ship.py", "exec"), scope)
    found = scope["simulate"](np.zeros(4), np.array([[0.0, SPEED]] * 600), 0.5)
    assert np.rad2deg(found[-1, 2]) == pytest.approx(turned(model, 0.0, u=SPEED), rel=1e-3)
