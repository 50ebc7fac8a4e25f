"""Something outside the catalogue is not claimed of what nobody would notice."""

import pytest
from made_up_fits import NO_ROUTE, fit

from trialid.diagnosis.search.completeness import Completeness
from trialid.diagnosis.verdict import decide

GAP = Completeness(catalogue=340.0, any_shape=1000.0)


@pytest.mark.parametrize(("left", "kind"), [(0.00015, False), (0.0025, True)])
def test_a_record_without_noise_leaves_rounding(left: float, kind: bool) -> None:
    """Of a linear ship with two needless coefficients free 0.015 % were left: a gap was claimed."""
    assert GAP.gap
    found = decide(fit(left), (), [], NO_ROUTE, GAP, 0.05)
    assert (found.kind == "not in catalogue") is kind
