"""GM is told by a roll that dies away or that her rudder excites, however it is damped."""

import numpy as np
import pytest
from decays import Roller
from s175q import MODEL, white, with_noise, zigzag

from trialid.identification.fit import identify
from trialid.identification.problem import Settings
from trialid.identification.remarks import remarks
from trialid.identification.roll.own_roll import damped_by, dies_away

EDDIES = (("linear_roll", "quadratic_roll_damping"), ("Kp", "Kpap", "GM"))


def said(fit):
    return [line for line in remarks(fit) if "GM" in line]


@pytest.mark.parametrize(("length", "GM", "seed"), [(2.5, 0.02, 5), (60.0, 0.9, 6)])
def test_a_ship_whose_eddies_damp_her_tells_gm(length, GM, seed):
    """A hundredth of her damping is linear, less than a ship has by itself."""
    her = Roller(length=length, GM=GM, ratio=0.003, square=0.25)
    fit = her.fit(her.decays(seed, speed=0.5 * np.sqrt(length)), *EDDIES)
    assert fit.value("GM") == pytest.approx(GM, rel=0.01)
    assert fit.problem.roll.ratio(fit.theta) < 0.01
    assert fit.rivals == ()
    assert said(fit) == []


def test_what_eddies_take_counts_as_a_linear_damping_that_takes_as_much():
    """2 zeta omega p^2 = d |p|^3 over the record, worked out by hand from the slope of its roll."""
    her = Roller(length=4.0, GM=0.04, ratio=0.01, square=0.2)
    trials = her.decays(7, speed=1.0, noise=0.0)
    fit = her.fit(trials, *EDDIES)
    rate = np.concatenate([np.gradient(t.signals["phi"], t.period) for t in trials])
    square = 0.2 * np.sum(np.abs(rate) ** 3) / np.sum(rate**2) / (2.0 * her.omega)
    assert damped_by(fit.problem, fit.theta) == pytest.approx(0.01 + square, rel=0.02)
    assert square > 0.005


def test_a_light_roll_that_dies_away_in_the_record_is_her_own():
    """0.007 of what is critical, as of a model without bilge keels."""
    her = Roller(length=3.0, GM=0.03, ratio=0.007)
    fit = her.fit(her.decays(9, cycles=30, speed=1.0))
    assert damped_by(fit.problem, fit.theta) < 0.01
    assert dies_away(fit.problem)
    assert fit.rivals == ()
    assert said(fit) == []


@pytest.mark.study(turn="each")
@pytest.mark.parametrize(("ratio", "hers"), [(0.004, True), (0.0, False)])
def test_a_swing_let_go_may_die_away_slowly_but_a_swell_goes_on(ratio, hers):
    """0.004 of what is critical in 25 cycles leave 0.66 of it; of the other nothing is lost."""
    her = Roller(length=3.0, GM=0.03, ratio=ratio)
    fit = her.fit(her.decays(11, cycles=25, speed=1.0))
    assert dies_away(fit.problem) == hers
    assert (said(fit) == []) == hers


@pytest.mark.parametrize("times", [pytest.param(12.0, marks=pytest.mark.study(turn="each")), 18.0])
def test_a_ship_with_fins_tells_gm_where_her_zig_zags_do(times):
    """Damped by half of what is critical, and by most of it."""
    her = MODEL.with_values({"Kp": times * MODEL.value("Kp")})
    trials = [
        with_noise(made, *white(np.random.default_rng(made.samples + k), made.samples))
        for k, made in enumerate(zigzag(a, her) for a in (10, 20))
    ]
    free = ("Nv", "Nr", "Ndelta", "Kv", "Kr", "Kdelta", "Kp", "GM")
    fit = identify(trials, her, Settings(free, ("r", "phi"), nuisance=("initial_state", "bias")))
    print(damped_by(fit.problem, fit.theta), fit.value("GM"))
    assert damped_by(fit.problem, fit.theta) > 0.36
    assert fit.value("GM") == pytest.approx(her.value("GM"), rel=0.1)
    assert fit.rivals == ()
    assert said(fit) == []
