"""From a fit's columns to likely ranges: what is uncertain by how much."""

from types import SimpleNamespace

import numpy as np
import pytest

from trialid.diagnosis import may_be_off as tested
from trialid.diagnosis.may_be_off import doubts
from trialid.diagnosis.search.augment import Trace


def handed_over(monkeypatch, *, tried=None, prior=None):
    """What a fit with one number held fixed hands to the averaging."""
    given = []
    monkeypatch.setattr(tested, "stand", lambda rows, rivals: given.append((rows, rivals)))
    parameters = {"Nrar": SimpleNamespace(start=-0.0015), "Nvar": SimpleNamespace(start=0.005)}
    effect = SimpleNamespace(name="drag", parameters=parameters, is_whole=False, held=None)
    trace = Trace(effect, (0, 1), ("Nrar", "Nvar"), tried or {})
    ship = SimpleNamespace(value=lambda name: -0.004, ship=SimpleNamespace(share_off=lambda n: 0.1))
    problem = SimpleNamespace(
        simulator=SimpleNamespace(model=ship),
        unknowns=[SimpleNamespace(prior=None), SimpleNamespace(prior=prior)],
    )
    augmented = SimpleNamespace(
        residual=np.ones(5),
        psi=np.ones((5, 2)),
        H=np.ones((5, 1)),
        S=np.ones((5, 2)),
        held=("Nv",),
        traces=[trace],
    )
    doubts(SimpleNamespace(problem=problem, level=0.02, theta=np.array([1.0, 3e-3])), augmented)
    return given[0]


def test_what_is_held_fixed_is_off_by_its_share(monkeypatch):
    rows, _ = handed_over(monkeypatch)
    assert rows.deviations == pytest.approx([0.0004])
    assert rows.level == 0.02


def test_what_may_be_missing_is_of_twice_its_typical_size_either_way(monkeypatch):
    _, [rival] = handed_over(monkeypatch)
    assert rival.deviations == pytest.approx((0.003, 0.01))
    _, [rival] = handed_over(monkeypatch, tried={"Nrar": -0.002})
    assert rival.deviations == (1.0, 1.0)


def test_a_prior_is_a_row_in_units_of_the_level(monkeypatch):
    rows, _ = handed_over(monkeypatch, prior=(0.0, 0.005))
    assert rows.priors == pytest.approx(np.array([[0.0, 0.0], [4.0, -0.012]]))
