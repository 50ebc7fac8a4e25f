"""Ships of another structure, as a newcomer begins with them: two things are missing at once."""

from dataclasses import replace
from types import SimpleNamespace

import mmg
import numpy as np
import pytest
from begun import begun

from trialid.diagnosis.diagnose import diagnose
from trialid.diagnosis.found_values import of_the_ship
from trialid.diagnosis.objections import objection
from trialid.diagnosis.search import together
from trialid.diagnosis.search.backward import worth_naming
from trialid.diagnosis.search.together import stands, two_at_once
from trialid.effects import CATALOGUE
from trialid.identification.inadequate import Inadequate
from trialid.progress import silent
from trialid.workflow.build_model import available
from trialid.workflow.findings import diagnose_settings
from trialid.workflow.fit_model import fit_of
from trialid.workflow.grow import stages
from trialid.workflow.read_trials import align_trials

SAILED = {
    "zigzag-10": (10.0, 10.0),
    "zigzag-20": (20.0, 20.0),
    "zigzag-20-10": (20.0, 10.0),
    "turn-20": (20.0,),
    "turn-35": (35.0,),
}


def of_seed(folder, seed):
    """The pipeline that a newcomer begins with."""
    return begun(folder, mmg.drawn(seed), np.random.default_rng(seed), SAILED)


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    asked = of_seed(tmp_path_factory.mktemp("mmg"), 102)
    catalogue = available(asked)
    fit = fit_of(asked, align_trials(asked, silent), catalogue, silent)
    return diagnose(fit, diagnose_settings(asked, catalogue))


@pytest.mark.study(turn="each")
def test_two_effects_do_what_none_does_alone(found):
    fit, both = found.before.fit, found.together
    assert (found.verdict.kind, found.verdict.effect) == ("cannot tell", None)
    damping, race = both.names
    assert (damping[:4], race) == ("sway", "rudder_slipstream")  # her hull's and her screw's
    assert f"with {damping} and {race} together the error falls" in found.verdict.sentence
    assert both.fit.eps_rmsn < 0.7 * fit.eps_rmsn
    assert both.fit.eps_check < 0.9 * fit.eps_check
    assert all(objection(fit, alone, 0.05) for alone in found.refits)


LOOKED_AT = (
    *("residual", "eps_rmsn", "eps_by_output", "eps_check", "at_bounds", "converged"),
    *("problem", "theta"),
)


def test_each_check_can_deny_two_effects(found):
    """Of trials held out a tenth of the squared error must go, too."""
    fit, both = found.before.fit, found.together
    assert stands(fit, both)
    told = {n: getattr(both.fit, n) for n in LOOKED_AT}
    for name, other in {
        "eps_rmsn": 0.96 * fit.eps_rmsn,
        "eps_check": 0.96 * fit.eps_check,
        "at_bounds": {n: 1.0 for n in both.effects[0].parameters},
        "converged": False,
    }.items():
        assert not stands(fit, replace(both, fit=SimpleNamespace(**{**told, name: other})))
    assert stands(fit, replace(both, fit=SimpleNamespace(**{**told, "at_bounds": {"Nv": 0.0}})))
    back = replace(both.carried, before=both.carried.after, after=both.carried.before)
    assert not stands(fit, replace(both, carried=back))


def test_of_effects_that_hold_only_one_of_them_no_two_stand(found):
    few = {n: CATALOGUE[n] for n in ("rudder_slipstream", "rudder_cubic", "bias_r", "delay_r")}
    assert two_at_once(found.before.fit, few, 4, lambda words: None) is None


def test_two_are_not_told_from_a_fit_that_carries_no_verdict(found, monkeypatch):
    fit, both = found.before.fit, found.together
    assert [one.names for one in together.able(fit, [both])] == [both.names]
    ended = Inadequate("a rudder's zero is at its end", "look at its sign")
    monkeypatch.setattr(together, "why_no_fit", lambda fit: ended)
    assert stands(fit, both)
    assert not together.able(fit, [both])


@pytest.mark.study(turn="each")
@pytest.mark.parametrize("seed", range(200, 206))
def test_the_loop_gets_nearer_to_a_ship_of_another_structure(tmp_path, seed):
    """Trials held out are never followed worse; no sensor or clock is blamed, none is at fault."""
    done = [s for s in stages(of_seed(tmp_path, seed), silent) if s.kept]
    held_out = [s.run.result.fit.eps_rmsn_check for s in done]
    assert held_out == sorted(held_out, reverse=True)
    named = {
        *worth_naming(done[-1].worths),
        *filter(None, (s.run.result.verdict.effect for s in done)),
    }
    assert all(of_the_ship(CATALOGUE[n]) for n in named if n in CATALOGUE)
