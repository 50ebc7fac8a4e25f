"""A rudder in the race of a propeller, fitted by one in free flow: what only stands in for it."""

from dataclasses import replace

import numpy as np
import pytest
from s175q import MODEL, OUTPUTS, SHAFT, white, with_noise

from trialid.diagnosis.diagnose import diagnose
from trialid.diagnosis.diagnosed import DiagnoseSettings
from trialid.diagnosis.objections import likeliest_refit
from trialid.diagnosis.search import carried
from trialid.diagnosis.search.augment import augment
from trialid.diagnosis.search.stand_in import _large_beside, look_beside
from trialid.effects import CATALOGUE
from trialid.identification.fit import identify
from trialid.identification.problem import Settings
from trialid.sample import rudder_orders as helm
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial

FREE = ("Yv", "Ydelta", "Nv", "Nr", "Ndelta", "Kv", "Kdelta", "Kp", "GM")
RACE = {"N_un": 4.15e-6, "N_nn": 2.39e-8, "z_race": 0.033}
"""As much moment as the linear rudder's at the speed of approach, half of it by the shaft alone."""

TRUTH = (MODEL - "linear_rudder" + CATALOGUE["rudder_race_shaft"]).with_values(RACE)
SAILED = prepare(replace(TRUTH, states=(*TRUTH.states, "psi")), (), OUTPUTS)


def motion(delta, period):
    """States and outputs of the true ship at constant shaft speed."""
    signals = {"delta": delta, "n": np.full(len(delta), SHAFT)}
    trial = Trial("truth", "fit", period, signals, {})
    return respond(SAILED, trial, {}, {"u": 7.33}, sensitivities=False)


def heading(delta):
    return motion(delta, helm.PERIOD).states[:, SAILED.equations.states.index("psi")]


def trial(name, use, delta, rng):
    """What is logged each half second of what the helmsman did."""
    every = round(0.5 / helm.PERIOD)
    y = motion(delta, helm.PERIOD).y[::every]
    signals = {"delta": delta[::every], "n": np.full(len(y), SHAFT)}
    signals |= dict(zip(OUTPUTS, y.T, strict=True))
    valid = {n: np.ones(len(y), dtype=bool) for n in signals}
    return with_noise(Trial(name, use, 0.5, signals, valid), *white(rng, len(y)))


def whole(fit):
    return CATALOGUE


@pytest.fixture(
    scope="module", params=[pytest.param(s, marks=pytest.mark.study(turn="each")) for s in (31, 32)]
)
def found(request):
    rng = np.random.default_rng(request.param)
    orders = {
        "zigzag-10": helm.zigzag(10.0, 10.0, heading),
        "zigzag-20": helm.zigzag(20.0, 20.0, heading),
        "binary-15": helm.multi_frequency_binary(15.0, 3),
        "zigzag-15": helm.zigzag(15.0, 15.0, heading),
    }
    uses = dict.fromkeys(orders, "fit") | {"zigzag-15": "check"}
    trials = tuple(trial(n, uses[n], delta, rng) for n, delta in orders.items())
    settings = Settings(FREE, OUTPUTS, nuisance=("initial_state",))
    return diagnose(identify(trials, MODEL, settings), DiagnoseSettings(refit=1))


def test_the_race_is_named_although_slopes_put_others_before_it(found):
    by_slope = [c.effect.name for c in found.ranking]
    assert by_slope.index("rudder_slipstream") > 0  # and only the first is fitted
    assert found.verdict.effect == "rudder_slipstream"
    assert found.after is not None
    assert found.after.fit.eps_rmsn < 0.9 * min(
        r.fit.eps_rmsn for r in found.refits if r.candidate.effect.name != "rudder_slipstream"
    )


def test_without_the_look_beside_it_another_would_be_the_best(found):
    first = [r for r in found.refits if r.candidate.effect.name != "rudder_slipstream"]
    fit = found.before.fit
    best = likeliest_refit(fit, first, 0.05)
    assert best is not None
    asked = []

    def catalogue(fit):  # an effect in the place of another has other coefficients than the base
        asked.append(fit)
        return CATALOGUE

    more = look_beside(
        fit, found.ranking, [best], catalogue, most=1, level=0.05, grown=False, progress=print
    )
    assert [id(f) for f in asked] == [id(best.fit), id(more.best.fit)]
    assert [r.candidate.effect.name for r in more.refits[1:]] == ["rudder_slipstream"]
    assert more.best is more.refits[-1]
    assert more.augmented is not None
    assert more.augmented.fit is more.best.fit


def test_beside_what_is_missing_nothing_large_is_found(found):
    named = [r for r in found.refits if r.candidate.effect.name == "rudder_slipstream"]
    fit = found.before.fit
    more = look_beside(
        fit, found.ranking, named, whole, most=1, level=0.05, grown=False, progress=print
    )
    assert more.refits == tuple(named)


def test_what_explains_most_comes_first_and_what_explains_little_not_at_all(found, monkeypatch):
    monkeypatch.setattr(carried, "LARGE", 0.97)  # a little less counts, so that there are several
    large = _large_beside(augment(found.before.fit, CATALOGUE), found.ranking)
    prices = [c.price for c in large]
    assert len(set(prices)) > 1
    assert prices == pytest.approx(sorted(prices))
    assert all(c.carried.large for c in large)
    assert any(not c.carried.large for c in found.ranking)
