"""A resonance amid a roll that nothing in the model makes tells neither GM nor her damping."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import s175q
from decays import Roller

from trialid.identification.fit import Fit, identify
from trialid.identification.remarks import remarks
from trialid.identification.roll.own_roll import _about, is_a_ships, is_rolled_by_others
from trialid.identification.roll.roll_range import _stiffest
from trialid.identification.roll.told_gm import _as_ships_have

FREE = ("Nv", "Nr", "Ndelta", "Kv", "Kr", "Kdelta", "Kp", "GM")
SETTINGS = replace(s175q.SETTINGS, free=FREE)
GM = s175q.MODEL.value("GM")
PERIOD = 13.0  # s; she rolls in 33 s


def in_swell(size: float, seed: int) -> Fit:
    """Two zig-zags amid a roll of this size [deg] that is of a swell of many components."""
    trials = []
    for i, angle in enumerate((10, 20)):
        calm, rng = s175q.zigzag(angle), np.random.default_rng([seed, i])
        time, components = np.arange(calm.samples) * calm.period, 25
        omega = 2.0 * np.pi / PERIOD * (1.0 + 0.1 * rng.standard_normal(components))
        heights = rng.rayleigh(1.0, components) / np.sqrt(components)
        waves = np.cos(np.outer(time, omega) + 2.0 * np.pi * rng.random(components)) @ heights
        r, phi = s175q.white(rng, calm.samples)
        trials.append(s175q.with_noise(calm, r, phi + np.deg2rad(size) * waves))
    return identify(trials, s175q.MODEL, SETTINGS)


def is_wrong(fit: Fit) -> bool:
    """By more than a factor of 1.5."""
    return bool(abs(np.log(fit.value("GM") / GM)) > np.log(1.5))


def told_as_unknown(fit: Fit) -> bool:
    """Whether a page says so, with values that ships have to either side."""
    said = any("the record does not tell GM" in line for line in remarks(fit))
    found = [values["GM"] for values in fit.rivals]
    return said and min(found) < GM < max(found)


@pytest.mark.study(turn="each")
def test_a_swells_period_is_not_told_as_her_gm() -> None:
    """Damped by 0.037 of what is critical, as any ship, four times her GM stood without a word."""
    fit = in_swell(5.0, 83)
    assert is_wrong(fit)
    assert is_a_ships(fit.problem, fit.theta)
    assert told_as_unknown(fit)
    assert any("is of nothing in the model, as a swell's" in line for line in remarks(fit))
    damped = [values["Kp"] for values in fit.rivals]
    assert min(damped) < s175q.MODEL.value("Kp") < max(damped) < 0.0


def test_beside_a_smaller_swell_her_own_roll_is_told() -> None:
    fit = in_swell(1.0, 84)
    assert fit.value("GM") == pytest.approx(GM, rel=0.01)
    assert not is_rolled_by_others(fit.problem, fit.theta)
    assert fit.rivals == ()


@pytest.mark.parametrize(("ratio", "cycles"), [(0.06, 40), (0.1, 20), (0.1, 40)])
def test_a_decay_tells_gm_in_a_sea_that_goes_on(ratio: float, cycles: int) -> None:
    """Most of the record is the sea's; most of what rolls her is the decay's."""
    her = Roller(length=60.0, GM=0.9, ratio=ratio)
    trials = []
    for i, calm in enumerate(her.decays(85, cycles=cycles, speed=4.0)):
        rng = np.random.default_rng([86, i])
        omega = her.omega * (1.0 + 0.1 * rng.standard_normal(25))
        time = np.arange(calm.samples) * calm.period
        waves = np.cos(np.outer(time, omega) + 2.0 * np.pi * rng.random(25)).sum(axis=1)
        phi = calm.signals["phi"] + np.deg2rad(0.2) * waves / np.std(waves)
        trials.append(replace(calm, signals={**calm.signals, "phi": phi}))
    fit = her.fit(trials)
    assert fit.value("GM") == pytest.approx(0.9, rel=0.02)
    assert not is_rolled_by_others(fit.problem, fit.theta)
    assert fit.rivals == ()


def test_what_rolls_her_is_counted_alike_at_any_period_where_it_is_compared() -> None:
    """A swing of one period, at 10 and at 2 Hz, and amid a steady heel with a gap."""

    def swings(period: float) -> np.ndarray:
        return np.sin(0.5 * period * np.arange(round(400.0 / period)))

    whole = [
        period * _about(y, np.ones(len(y), bool), 0.5 * period)
        for period in (0.1, 0.5)
        for y in (swings(period),)
    ]
    assert whole[0] == pytest.approx(whole[1], rel=0.02)
    assert whole[0] == pytest.approx(200.0, rel=0.1)
    heeled = np.full(800, 3.0)
    gap = np.arange(800) % 25 > 12  # about her period
    assert _about(heeled, gap, 0.25) == pytest.approx(0.0, abs=1e-9)
    assert _about(heeled, np.zeros(800, bool), 0.25) == 0.0


def test_what_is_stated_of_her_gm_stays() -> None:
    """Within 5 %, as by an inclining test; not what a file assumes, within 70 %."""
    fit = in_swell(1.0, 84)
    roll = fit.problem.roll
    assert roll is not None
    best = SimpleNamespace(minimum=SimpleNamespace(theta=fit.theta))
    for share, count in ((0.05, 0), (0.7, 2)):
        unknowns = [*fit.problem.unknowns]
        unknowns[roll.GM] = replace(unknowns[roll.GM], prior=(GM, share * GM))
        known = replace(fit.problem, unknowns=tuple(unknowns))
        assert len(_as_ships_have(known, best)) == count


def test_as_stiff_as_her_hull_allows_is_stiffer_than_ships_are() -> None:
    """A yacht of 12.5 m stands with 1.05 m; nine times the middle of ships are 0.9 m.

    By hand: C_B 0.140, C_WP 0.427; KB 1.9 (0.833 - 0.109) = 1.37 m, BM 0.0109 * 63 = 0.69 m.
    """
    yacht = {"L": 12.5, "B": 4.1, "T": 1.9, "nabla": 13.66}
    assert _stiffest(yacht) == pytest.approx(2.06, abs=0.02)
    assert _stiffest({"L": 12.5, "nabla": 13.66}) == pytest.approx(0.9)
    narrow = {"L": 175.0, "B": 12.0, "T": 8.5, "nabla": 10000.0}
    assert _stiffest(narrow) == pytest.approx(12.6)


@pytest.mark.study(turn=21)
def test_whatever_the_swell_no_wrong_gm_is_told() -> None:
    """Most end at the swell's period; of 18 others 15 did, 13 of them without a word of it."""
    fits = [in_swell(size, seed) for size in (3.0, 5.0, 8.0) for seed in range(90, 96)]
    wrong = [fit for fit in fits if is_wrong(fit)]
    assert len(wrong) >= 6
    assert all(told_as_unknown(fit) for fit in wrong)
    hers = [fit for fit in fits if not is_wrong(fit)]
    assert not any(is_rolled_by_others(fit.problem, fit.theta) for fit in hers)
