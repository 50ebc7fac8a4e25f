"""Standard measures as data: in what conditions, and kept or not only where that can be known."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from trialid.result.imo import condition_rows, measure_rows
from trialid.trial import Trial


def test_conditions_are_the_middle_and_where_95_of_100_samples_lie() -> None:
    """Of what is known: samples without a value and those that were masked have no part in it."""
    wind = np.append(np.linspace(0.0, 10.0, 1001), [99.0, np.nan])
    valid = np.append(np.ones(1001, dtype=bool), [False, True])
    signals = {"V_aw": wind, "r": wind}
    trial = Trial("circle", "fit", 1.0, signals, {n: valid for n in signals})
    [row] = condition_rows([trial])
    assert (row.trial, row.signal, row.median) == ("circle", "V_aw", 5.0)
    assert row.interval == pytest.approx((0.25, 9.75))


@pytest.mark.parametrize("kept", [True, False])
def test_a_measure_is_kept_or_not_only_where_the_fit_has_a_verdict(kept: bool) -> None:
    criterion = SimpleNamespace(name="advance", unit="m", largest=787.5, words="a circle")
    measure: Any = SimpleNamespace(
        criterion=criterion, value=523.0, interval=(501.0, 544.0), kept=kept, remark=""
    )
    [known], [open_] = (measure_rows([measure], reliable=r) for r in (True, False))
    assert (known.kept, known.allowed, known.interval) == (kept, 787.5, (501.0, 544.0))
    assert (open_.kept, open_.value) == (None, 523.0)
