"""What no catalogue holds stays outside it, with the best effect of the catalogue in the model."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))

from hidden_effects import settings_of
from hidden_scenarios import SCENARIOS, guessed
from hidden_truth import record

from trialid.diagnosis import examine
from trialid.diagnosis.diagnose import diagnose
from trialid.identification.fit import identify


@pytest.mark.study(turn="each")
def test_a_gap_stays_beside_an_effect_that_stands_every_check(monkeypatch):
    """Here a rudder's feedback curve does; beside it forces of any shape still do more."""
    odd = SCENARIOS["odd_switch"]
    model = guessed(odd, 21402, 0.0)
    fit = identify(tuple(record(odd, "white", "mixed", 21402)), model, settings_of(model))
    held = []
    close_gap = examine.close_gap

    def counted(whole, augmented):
        held.append(augmented.fit.model.effects)
        return close_gap(whole, augmented)

    monkeypatch.setattr(examine, "close_gap", counted)
    found = diagnose(fit)
    assert len(held[0]) == len(fit.model.effects) + 1
    assert (found.verdict.kind, found.verdict.effect) == ("not in catalogue", None)
