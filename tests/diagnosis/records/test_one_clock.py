"""No clock drifts from another where all that was logged has one."""

from dataclasses import replace

import pytest
from s175q import zigzag

from trialid.diagnosis.search.candidates import TABLES, of_one_clock
from trialid.effects import CATALOGUE
from trialid.ingest import ADAPTERS
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
