"""What only the ranges read of orders, as effects that may be missing do, is held and told."""

from pathlib import Path

import pytest
from test_bad_input import trialid_
from use_runs import PIPELINE

from trialid.progress import silent
from trialid.workflow.use.finished_model import FinishedModel, finished_model
from trialid.workflow.use.orders import read_orders
from trialid.workflow.use.predict import predict_orders

SHAFT = "rudder_race_shaft"
RPM = 100.0


@pytest.fixture(scope="module")
def model(run_folder: Path, tmp_path_factory: pytest.TempPathFactory) -> FinishedModel:
    """The run of the others with a shaft that turns evenly, whose race is tried."""
    place = tmp_path_factory.mktemp("shaft")
    for log in sorted(run_folder.parents[1].glob("zigzag-*.csv")):
        head, *rows = log.read_text(encoding="utf-8").splitlines()
        lines = [f"{head},shaft[rpm]", *(f"{row},{RPM}" for row in rows)]
        (place / log.name).write_text("\n".join(lines) + "\n", encoding="utf-8")
    ship = run_folder.parents[1] / "ship.toml"
    (place / "ship.toml").write_bytes(ship.read_bytes())
    text = PIPELINE.replace(
        'u = { channel = "stw"', 'n = { channel = "shaft", unit = "rpm" }\nu = { channel = "stw"'
    ).replace('"rudder_servo"', f'"{SHAFT}"')
    (place / "used.toml").write_text(text, encoding="utf-8")
    told = trialid_("run", str(place / "used.toml"), "--quiet", "--out", str(place / "run"))
    assert told.exit_code == 0, told.stderr
    return finished_model(place / "run", silent)


def test_what_a_missing_effect_reads_is_held_as_in_the_trials(model, tmp_path: Path) -> None:
    """`simulate` refused them: no signal n, which an effect that is not in the model needs."""
    assert SHAFT in {one.effect.name for one in model.done.doubts.missing}
    assert "n" not in model.fit.problem.simulator.equations.inputs
    path = tmp_path / "orders.csv"
    path.write_text("t[s],delta[deg]\n0,0\n20,5\n40,5\n", encoding="utf-8")
    made = predict_orders(model, read_orders(path), "orders")
    [told] = [words for words in made.words if words.startswith("Not among the orders, held")]
    assert "n = 100 rpm" in told
    path.write_text(f"t[s],delta[deg],n[rpm]\n0,0,{RPM}\n20,5,{RPM}\n40,5,{RPM}\n", "utf-8")
    given = predict_orders(model, read_orders(path), "orders")
    assert given.motion.motion["r"][-1] == pytest.approx(made.motion.motion["r"][-1])
    assert not any("n = 100 rpm" in words for words in given.words)
