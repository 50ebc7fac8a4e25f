"""What nobody would notice has no name, and is no gap of the catalogue."""

import pytest
from made_up_fits import fit, refit

from trialid.diagnosis.noise.error_parts import Split
from trialid.diagnosis.verdict import decide

NEITHER = Split("quiet stretch", "", 0.007, 0.001, (0.006, 0.008), (0.0, 0.002))
"""A split by which nothing need be missing."""


@pytest.mark.parametrize(
    ("eps", "kind"), [(0.0073, "missing"), (0.00725, "missing"), (0.0080, "nothing missing")]
)
def test_what_nobody_would_notice_has_no_name(eps, kind):
    """Of an error of 0.82 % of the motion 0.37, 0.38 and 0.18 % go, squares taken apart."""
    found = decide(fit(0.0082), (), [refit("a", 0.7, eps)], NEITHER, None, 0.05)
    assert found.kind == kind


@pytest.mark.parametrize(
    ("high", "kind"), [(0.006, "cannot tell"), (0.02, "not in catalogue"), (0.0099, "cannot tell")]
)
def test_a_gap_that_is_little_of_what_moved_is_none(high, kind):
    parts = Split("quiet stretch", "", 0.01, 0.5 * high, (0.009, 0.011), (0.001, high))
    found = decide(fit(0.02), (), [], parts, None, 0.05)
    assert found.kind == kind
    assert ("of what moved that is little" in found.sentence) is (kind == "cannot tell")
