"""No clock drifts from another where all that was logged has one; what is free is not late."""

from dataclasses import replace

import numpy as np
import pytest
from s175q import MODEL, SHIP, zigzag

from trialid.diagnosis.search.candidates import TABLES, of_one_clock, undriven
from trialid.effects import CATALOGUE
from trialid.ingest import ADAPTERS
from trialid.ship.model import ShipModel
from trialid.trial import LogSource

DRIFTING = {n for n in CATALOGUE if n.startswith("clock_drift")}


def logged(*adapters):
    logs = tuple(LogSource(f"log{i}", "", a) for i, a in enumerate(adapters))
    return replace(zigzag(10), logs=logs)


@pytest.mark.parametrize("adapter", sorted(TABLES))
def test_a_table_has_one_clock(adapter):
    assert adapter in {known.name for known in ADAPTERS}
    assert {*of_one_clock([logged(adapter), logged("csv")], CATALOGUE)} == DRIFTING


@pytest.mark.parametrize("adapters", [("mcap",), ("csv", "csv"), ()])
def test_several_logs_messages_and_arrays_may_have_more(adapters):
    assert of_one_clock([logged("csv"), logged(*adapters)], CATALOGUE) == {}


LATE = {"delay_phi", "lag_phi", "clock_drift_phi"}


def test_a_roll_that_nothing_drives_is_not_late():
    """Nor is one that is sailed with her rudder amidships, at a speed that is logged."""
    model = ShipModel(SHIP, ("p", "phi"), (CATALOGUE["linear_roll"],))
    free = zigzag(10)
    rudder = np.zeros(free.samples)
    speed = 7.0 + 0.1 * np.sin(np.arange(free.samples))
    still = replace(free, signals={**free.signals, "delta": rudder, "u": speed})
    assert {*undriven(model, [still, still], ("phi",), CATALOGUE)} == LATE
    assert undriven(model, [still, still], ("r", "phi"), CATALOGUE) == {}
    assert undriven(MODEL, [still, still], ("phi",), CATALOGUE).keys() == LATE
    assert undriven(MODEL, [still, free], ("phi",), CATALOGUE) == {}
