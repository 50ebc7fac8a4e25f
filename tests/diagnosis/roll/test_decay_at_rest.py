"""A ship let go at rest: by a speed of none no motion has a number, and all of it is motion."""

import numpy as np
import pytest
from decays import Roller

from trialid.diagnosis.force.missing_force import missing_force
from trialid.diagnosis.search.simple_forces import probes
from trialid.workflow.notebook.front import diagnose

AT_REST = (("linear_roll", "still_water_roll_damping"), ("Kp0", "GM"))


@pytest.fixture(scope="module")
def fit():
    her = Roller(length=6.0, GM=0.05, ratio=0.01, square=0.12)
    return her.fit(her.decays(3), *AT_REST)


def test_what_forces_of_any_shape_would_cause_is_numbers(fit):
    """The functions of p and phi, and their products, each of some size."""
    columns = probes(fit).columns
    assert np.isfinite(columns).all()
    assert (np.linalg.norm(columns, axis=0) > 0.0).mean() > 0.9


def test_what_damps_her_at_large_angles_has_its_name(fit):
    verdict = diagnose(fit).verdict
    assert verdict.effect == "quadratic_roll_damping"


def test_the_missing_force_is_a_roll_moment_by_her_roll_rate(fit):
    [moment] = missing_force(fit).equations
    assert moment.row == "K"
    assert moment.p_value < 0.05
    assert "p" in {s for t in moment.shape.terms for s in t.term.signals}
