"""Numbers of a sign that no ship has: something that is missing stands in them."""

from dataclasses import replace

import pytest
import s175q

from trialid.effects import CATALOGUE
from trialid.identification.fit import Fit, identify
from trialid.identification.remarks import remarks

SETTINGS = replace(s175q.SETTINGS, free=("Yv", "Nv", "Nr", "Ndelta"))
SLIPSTREAM = CATALOGUE["rudder_slipstream"]


@pytest.fixture(scope="module")
def fit() -> Fit:
    return identify([s175q.zigzag(5)], s175q.MODEL, SETTINGS)


def with_sign(fit: Fit, name: str) -> Fit:
    """The fit with that number on the other side of zero."""
    names = [x.name for x in fit.problem.unknowns]
    theta = fit.theta.copy()
    theta[names.index(name)] *= -1.0
    return replace(fit, theta=theta)


@pytest.mark.parametrize(
    ("name", "when"), [("Yv", "drifts"), ("Nr", "turns"), ("Ndelta", "to the other side")]
)
def test_what_no_hull_and_no_rudder_does_is_told(fit: Fit, name: str, when: str) -> None:
    told = [one for one in remarks(with_sign(fit, name)) if one.startswith(f"{name} = ")]
    assert len(told) == 1
    assert when in told[0]
    assert not any(one.startswith(f"{name} = ") for one in remarks(fit))


def test_a_part_of_what_the_rudder_does_may_have_any_sign(fit: Fit) -> None:
    other = with_sign(fit, "Ndelta")
    beside = replace(other, model=other.model + SLIPSTREAM)
    assert not any(one.startswith("Ndelta = ") for one in remarks(beside))
    assert any(one.startswith("Ndelta = ") for one in remarks(other))


def test_a_drift_moment_may_have_any_sign(fit: Fit) -> None:
    assert not any(one.startswith("Nv = ") for one in remarks(with_sign(fit, "Nv")))
