"""The speed that a simulated manoeuvre is sailed at: told, written, and good for orders again."""

from pathlib import Path

import numpy as np
import pytest

from trialid.design.following import vessel_of
from trialid.design.imo.speed_loss import logged_loss, with_speed_loss
from trialid.effects import CATALOGUE
from trialid.export.predicted_file import write_motion
from trialid.progress import silent
from trialid.workflow.use import predict
from trialid.workflow.use.finished_model import FinishedModel, finished_model
from trialid.workflow.use.orders import OrderTable, named_manoeuvre, read_orders
from trialid.workflow.use.predict import predict_manoeuvre, predict_orders
from trialid.workflow.use.what_if import WhatIf

WEAVE = OrderTable(
    np.arange(0.0, 200.0, 0.5), {"delta": 0.25 * np.sign(np.sin(np.arange(0.0, 20.0, 0.05)))}
)


@pytest.fixture
def model(run_folder: Path, monkeypatch: pytest.MonkeyPatch) -> FinishedModel:
    """The run of a ship whose logs have shown her to lose speed in turns."""
    lost = {n: p.start for n, p in logged_loss.parameters.items()}
    monkeypatch.setattr(predict, "sailed_ship", lambda fit: with_speed_loss(vessel_of(fit), lost))
    return finished_model(run_folder, silent)


@pytest.mark.study(turn="each")
@pytest.mark.parametrize("words", [[], ["circle", "35"]])
def test_what_is_written_gives_the_same_again(model, words: list[str], tmp_path: Path) -> None:
    made = (
        predict_manoeuvre(model, named_manoeuvre(words)).motion
        if words
        else predict_orders(model, WEAVE, "weave").motion
    )
    u, U, v = made.given["u"], made.motion["U"], made.motion["v"]
    assert U.min() < 0.95 * U[0]
    assert np.hypot(u, v) == pytest.approx(U)
    write_motion(tmp_path / "made.csv", "made", made, {})
    again = predict_orders(model, read_orders(tmp_path / "made.csv"), "made")
    assert again.motion.motion["r"] == pytest.approx(made.motion["r"], abs=1e-6)
    assert again.motion.motion["U"] == pytest.approx(U, rel=1e-6)
    assert not [word for word in again.words if "cost speed" in word]


def test_what_becomes_of_a_speed_that_is_not_given_is_said(model, monkeypatch) -> None:
    [word] = [w for w in predict_orders(model, WEAVE, "weave").words if "Not among" in w]
    assert "u = 7.3" in word
    assert word.endswith("is how she approaches; turns cost speed as in the logs.")
    slower = predict_orders(model, WEAVE, "weave", WhatIf({"u": 5.0})).words
    assert [w for w in slower if "u = 5.00 m/s is how she approaches" in w]
    monkeypatch.setattr(predict, "sailed_ship", vessel_of)
    held = predict_orders(model, WEAVE, "weave")
    assert [w for w in held.words if "held as in the trials: u = 7.3" in w]
    assert np.ptp(held.motion.given["u"]) == 0.0


def test_a_model_that_says_itself_what_turns_cost_reads_the_approach(model, monkeypatch) -> None:
    """Its input is that speed: written as sailed, it would be lost twice."""
    typical = {n: p.start for n, p in CATALOGUE["surge_loss"].parameters.items()}
    own = (model.fit.model + CATALOGUE["surge_loss"]).with_values(typical)
    monkeypatch.setattr(predict, "sailed_ship", lambda fit: vessel_of(fit, own))
    made = predict_orders(model, WEAVE, "weave")
    assert [w for w in made.words if "turns cost speed as surge_loss has it" in w]
    assert np.ptp(made.motion.given["u"]) == 0.0
    assert np.ptp(made.motion.motion["U"]) > 0.1
