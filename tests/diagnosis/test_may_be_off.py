"""From a fit's columns to likely ranges: what is uncertain by how much."""

from types import SimpleNamespace

import numpy as np
import pytest

from trialid.diagnosis import may_be_off as tested
from trialid.diagnosis.may_be_off import doubts
from trialid.diagnosis.search.augment import Trace
from trialid.ship.effect import Parameter, Rate


def handed_over(monkeypatch, *, tried=(), prior=None, parameters=None, kind="physical"):
    """What a fit with one number held fixed hands to the averaging."""
    given = []
    monkeypatch.setattr(tested, "stand", lambda rows, rivals: given.append((rows, rivals)))
    scale = (np.full((5, 1), 7.0), np.array([0.03]))
    monkeypatch.setattr(tested, "log_scales", lambda fit: scale)
    parameters = parameters or {"Nrar": Parameter(-0.0015), "Nvar": Parameter(0.005)}
    names = tuple(parameters)
    places = tuple(range(len(names)))
    effect = SimpleNamespace(
        name="drag", parameters=parameters, is_whole=False, held=None, forms=(Rate,)
    )
    traces = [Trace(effect, places, names, {})]
    if tried:
        traces = [Trace(effect, (0,), (), {"Nrar": x}) for x in tried]
    ship = SimpleNamespace(value=lambda name: -0.004, ship=SimpleNamespace(share_off=lambda n: 0.1))
    problem = SimpleNamespace(
        simulator=SimpleNamespace(model=ship),
        unknowns=[
            SimpleNamespace(column=n, prior=p, kind=kind) for n, p in (("Nr", None), ("Nv", prior))
        ],
    )
    fit = SimpleNamespace(problem=problem, level=0.02, theta=np.array([1.0, 3e-3]))
    augmented = SimpleNamespace(
        fit=fit,
        residual=np.ones(5),
        psi=np.ones((5, 2)),
        H=np.ones((5, 1)),
        S=np.ones((5, 2)),
        held=("Nv",),
        traces=traces,
    )
    doubts(augmented)
    return given[0]


def test_what_is_held_fixed_is_off_by_its_share(monkeypatch):
    rows, _ = handed_over(monkeypatch)
    assert rows.deviations == pytest.approx([0.0004])
    assert rows.level == 0.02


def test_scales_of_logs_stand_last_with_how_uncertain_they_are(monkeypatch):
    rows, _ = handed_over(monkeypatch)
    assert rows.S[:, -1] == pytest.approx(7.0)
    assert rows.S[:, :-1] == pytest.approx(1.0)
    assert rows.scales == pytest.approx([0.03])


def test_what_may_be_missing_is_of_twice_its_typical_size_either_way(monkeypatch):
    _, [rival] = handed_over(monkeypatch)
    assert rival.deviations == pytest.approx((0.003, 0.01))
    assert (rival.limits, rival.share) == (None, 1.0)


def test_what_was_tried_at_four_values_is_one_effect_and_there_in_part_or_whole(monkeypatch):
    _, rivals = handed_over(monkeypatch, tried=(-0.001, -0.002, -0.003, -0.004))
    assert [r.deviations for r in rivals] == [(1.0,)] * 4
    assert [r.limits for r in rivals] == [(0.0, 1.0)] * 4
    assert sum(r.share for r in rivals) == 1.0


def test_a_single_parameter_stays_within_its_range_about_its_null(monkeypatch):
    weak = {"lost": Parameter(0.1, low=0.0, high=1.0)}
    _, [rival] = handed_over(monkeypatch, parameters=weak)
    assert rival.limits == (0.0, 1.0)
    gain = {"scale": Parameter(1.1, low=0.5, null=1.0)}
    _, [rival] = handed_over(monkeypatch, parameters=gain)
    assert rival.limits == (-0.5, np.inf)


def test_a_prior_is_a_row_in_units_of_the_level(monkeypatch):
    rows, _ = handed_over(monkeypatch, prior=(0.0, 0.005))
    assert rows.priors == pytest.approx(np.array([[0.0, 0.0], [4.0, -0.012]]))


@pytest.mark.parametrize(("kind", "sure"), [("physical", 1.0 / 3.0), ("nuisance", 1.0)])
def test_of_a_ships_own_numbers_what_is_three_off_is_a_third_as_sure(monkeypatch, kind, sure):
    """A sensor's is as sure as it was: there are many, and some are off by as much."""
    rows, _ = handed_over(monkeypatch, prior=(0.0, 0.001), kind=kind)
    assert rows.priors[1] == pytest.approx(np.array([20.0, -0.06]) * sure)
