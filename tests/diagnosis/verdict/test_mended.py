"""A model without what limits an unstable ship: that drives her rudder's zero to its bound.

The truth is the S175Q whose linear yaw damping is negative and whose quadratic is ten times hers.
"""

import numpy as np
import pytest
from s175q import MODEL, white, with_noise, zigzag

from trialid.diagnosis import diagnose as module
from trialid.diagnosis.diagnose import diagnose
from trialid.diagnosis.diagnosed import DiagnoseSettings
from trialid.diagnosis.search.carry_over import carried_between
from trialid.diagnosis.search.refit import settings_with
from trialid.diagnosis.search.stand_in import Tried
from trialid.diagnosis.search.together import Together, fit_together
from trialid.effects import CATALOGUE
from trialid.identification import adequacy
from trialid.identification.adequacy import why_no_fit
from trialid.identification.fit import identify
from trialid.identification.problem import Settings

pytestmark = pytest.mark.study(turn=5)
"""Of a fit that takes 18 s; what other fits are mended by is in `test_other_manoeuvres`."""

LINEAR = MODEL - "yaw_drag_rar"
SETTINGS = Settings(("Nv", "Nr", "Ndelta"), ("r",), nuisance=("initial_state", "rudder_offset"))

TRIED = ("yaw_drag_rar", "yaw_cubic_rrr", "sway_drag_rar", "lag_r", "rudder_cubic")
ASKED = DiagnoseSettings(candidates={n: CATALOGUE[n] for n in TRIED}, coefficients=False)


def sailed(linear, quadratic):
    """Zig-zags of 5 and 20 deg by the linear model, one of 10 deg held out."""
    of_file = {"Nr": linear, "Nrar": quadratic}
    truth = MODEL.with_values({n: k * MODEL.value(n) for n, k in of_file.items()})
    made = []
    for angle, use in ((5, "fit"), (10, "check"), (20, "fit")):
        trial = zigzag(angle, truth, use=use)
        made.append(with_noise(trial, *white(np.random.default_rng(angle), trial.samples)))
    return identify(made, LINEAR, SETTINGS)


@pytest.fixture(scope="module")
def unstable():
    return sailed(-0.6, 10.0)


def test_a_sensor_at_its_bound_stands_for_what_the_model_lacks(unstable):
    """With a damping no zero is at its bound, and the trial held out gains, too."""
    failed = why_no_fit(unstable)
    assert "delta_0 [zigzag-5] = 5.73 deg" in failed.reason
    assert failed.may_lack
    found = diagnose(unstable, ASKED)
    assert found.verdict.kind == "missing"
    assert found.verdict.effect in TRIED[:3]
    assert why_no_fit(found.after.fit) is None
    assert found.after.fit.eps_check < 0.7 * unstable.eps_check


def test_what_its_slope_did_not_foretell_mends_nothing(unstable, monkeypatch):
    """Others, which were not fitted for their slopes, might do more."""
    monkeypatch.setattr(module, "foretold", lambda named: False)
    found = diagnose(unstable, ASKED)
    assert (found.verdict.kind, found.after) == ("no fit", None)
    assert "delta_0 [zigzag-5]" in found.verdict.sentence


def test_where_no_effect_alone_mends_it_a_whole_hull_may(unstable, monkeypatch):
    """And no two: they would be chosen by the slopes of a fit that stands nowhere."""
    damping = [CATALOGUE["yaw_drag_rar"]]
    damped = fit_together(unstable, damping, settings_with(unstable, damping))
    both = (CATALOGUE["yaw_drag_rar"], CATALOGUE["sway_drag_rar"])
    whole = Together(both, damped, carried_between(unstable, damped))
    monkeypatch.setattr(module, "refits_of", lambda *more: Tried(()))
    monkeypatch.setattr(module, "two_at_once", lambda *more: pytest.fail("two were tried"))
    monkeypatch.setattr(module, "hull_at_once", lambda *more: None)
    assert diagnose(unstable, ASKED).verdict.kind == "no fit"
    monkeypatch.setattr(module, "hull_at_once", lambda *more: whole)
    found = diagnose(unstable, ASKED)
    assert found.verdict.together == ("yaw_drag_rar", "sway_drag_rar")
    assert found.together is whole


def test_what_also_fails_for_another_reason_is_mended_by_nothing():
    """The ship is lost in the trial held out, which no name may excuse."""
    lost = sailed(-1.0, 4.0)
    failed = why_no_fit(lost)
    assert "delta_0 [zigzag-20] = 5.73 deg" in failed.reason
    assert not failed.may_lack
    assert not np.isfinite(lost.eps_check)
    found = diagnose(lost, ASKED)
    assert (found.verdict.kind, found.after) == ("no fit", None)


def test_a_false_valley_may_be_what_the_model_lacks(unstable, monkeypatch):
    """Pieces are followed more closely where the errors of a model cannot grow, too."""
    monkeypatch.setattr(adequacy, "CHECKS", (adequacy._false_valley,))
    monkeypatch.setattr(adequacy, "NO_NOISE", 0.1)
    monkeypatch.setattr(adequacy, "closer_in_pieces", lambda one: (4, 3.0))
    failed = why_no_fit(unstable)
    assert "false valley" in failed.reason
    assert failed.may_lack


def test_a_rudder_that_works_backwards_may_be_what_the_model_lacks(unstable, monkeypatch):
    monkeypatch.setattr(adequacy, "CHECKS", (adequacy._steered_backwards,))
    monkeypatch.setattr(adequacy.file_of_ship, "steers_backwards", lambda one: True)
    assert "the wrong way" in why_no_fit(unstable).reason
    assert why_no_fit(unstable).may_lack
