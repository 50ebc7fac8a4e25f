"""What trials held out leave beyond noise is told where somebody would notice it."""

from types import SimpleNamespace

import numpy as np
import pytest

from trialid.diagnosis import left_by_check
from trialid.diagnosis.left_by_check import LeftByCheck, with_held_out
from trialid.diagnosis.verdict import Verdict

NOTHING = Verdict("nothing missing", None, (), "no effect stands out")


def fitted(whole):
    """What is read of a fit whose held-out trials leave so much with the others' sensors."""
    fit = SimpleNamespace(eps_check=0.1, eps_check_by_output={"r": whole})
    fit.examined = fit
    return fit


@pytest.mark.parametrize(
    ("left", "whole", "kind", "own"),
    [
        (0.0072, 0.0072, "nothing missing", False),
        (0.02, 0.02, "cannot tell", False),
        (0.02, 0.17, "cannot tell", True),
    ],
)
def test_little_is_nothing_and_sensors_of_their_own_are_said(left, whole, kind, own, monkeypatch):
    found = (LeftByCheck("r", left, 0.0071, 1e-6),)
    monkeypatch.setattr(left_by_check, "left_by_check", lambda fit, covariance: found)
    said = with_held_out(fitted(whole), NOTHING, lambda: np.eye(1), 0.05)
    assert said.kind == kind
    assert ("of r with zeros and delays of their own where noise" in said.sentence) is own
