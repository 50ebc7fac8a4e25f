"""A column of orders that nothing reads is told."""

from pathlib import Path

import pytest

from trialid.progress import silent
from trialid.workflow.use.finished_model import FinishedModel, finished_model
from trialid.workflow.use.orders import read_orders
from trialid.workflow.use.predict import predict_orders


@pytest.fixture(scope="module")
def model(run_folder: Path) -> FinishedModel:
    return finished_model(run_folder, silent)


@pytest.mark.parametrize(
    ("column", "said"),
    [
        ("stw[m/s]", "as no signal has their names: stw (did you mean 'u'?)."),
        ("notes[m]", "as no signal has their names: notes."),
        ("r_to[rad/s]", ""),
        ("u[m/s]", ""),
    ],
)
def test_a_name_that_no_signal_has_is_told(model, column: str, said: str, tmp_path: Path) -> None:
    path = tmp_path / "orders.csv"
    path.write_text(f"t[s],delta[deg],{column}\n0,0,7\n20,5,7\n40,5,7\n", encoding="utf-8")
    words = predict_orders(model, read_orders(path), "orders").words
    told = [word for word in words if word.startswith("Columns passed over")]
    assert [word.removeprefix("Columns passed over, ") for word in told] == [said][: bool(said)]
