"""The shipped example, whose truth is known: every range holds it, before the effect and after."""

from pathlib import Path

import pytest

import trialid as ti
from trialid.report.words import doubt
from trialid.result import json_file
from trialid.ship.particulars import read_ship

ROOT = Path(__file__).parents[2]
TRUTH = read_ship(ROOT / "sample_data/ships/s175q.toml").coefficients
HARDENING = 3.2
"""GM3 of the true righting arm [m]."""


@pytest.fixture(scope="module")
def before(sample_run):
    return json_file.read(sample_run / "result.json")


@pytest.fixture(scope="module")
def after():
    return ti.run(ROOT / "pipelines" / "hidden_effect.toml").add("righting_arm_cubic").result


@pytest.fixture(params=["before", pytest.param("after", marks=pytest.mark.study(turn=9))])
def parameters(request):
    """Physical parameters of the run without the effect, or with it."""
    return request.getfixturevalue(request.param).physical


@pytest.mark.study
def test_every_range_holds_the_truth(parameters):
    known = TRUTH | {"GM3": HARDENING}
    outside = [p.name for p in parameters if not p.likely[0] <= known[p.name] <= p.likely[1]]
    assert len(parameters) >= 11
    assert outside == []


@pytest.mark.study(turn=0)
def test_standard_errors_alone_do_not(before):
    """GM is 18 of its standard errors off: what the ranges are for."""
    off = {p.name: abs(p.value - TRUTH[p.name]) / p.standard_error for p in before.physical}
    assert off["GM"] > 15.0


@pytest.mark.study(turn=4)
def test_with_the_effect_in_the_model_they_do(after):
    """As the README says: all twelve within one."""
    known = TRUTH | {"GM3": HARDENING}
    off = {p.name: abs(p.value - known[p.name]) / p.standard_error for p in after.physical}
    assert len(off) == 12
    assert max(off.values()) < 1.0


@pytest.mark.study(turn=9)
def test_what_is_said_of_the_noise_holds_the_noise(before):
    """Of what the right model leaves, 3.84 %, nothing is the model's: the noise is that at least.

    The interval ended at 3.83 %, what a wrong effect of four parameters leaves by chance.
    """
    left = next(m for m in before.missing if m.effect == "righting_arm_cubic").eps_rmsn_refitted
    low, high = before.split.interval.noise
    assert low < left < high


def test_a_range_is_no_bound_for_everything(parameters):
    """Ranges that held the truth by being endless would say nothing: half are within 0.3."""
    widths = sorted(p.may_be_off for p in parameters)
    assert widths[len(widths) // 2] < 0.3


def test_what_is_believed_is_right_to_half_its_value(parameters):
    known = TRUTH | {"GM3": HARDENING}
    believed = [p for p in parameters if not doubt.doubtful([p])]
    assert believed
    assert all(abs(p.value / known[p.name] - 1.0) < 0.5 for p in believed)


def test_the_missing_effect_is_what_widens(before):
    """The righting arm, or one of the family that this record cannot tell it from."""
    widened = {p.name: p.widened_by for p in before.physical}
    assert widened["GM"] in {before.verdict.effect, *before.verdict.family}


def test_the_models_part_of_eq_14_is_a_bound(before):
    """It takes the upper end of what the model's part of the error may be, not the middle."""
    most = before.split.interval.undermodelling[1]
    assert most > 1.1 * before.split.undermodelling
    for p in before.physical:
        assert p.undermodelling_error * p.S_imin == pytest.approx(most, rel=1e-9)
