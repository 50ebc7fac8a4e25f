"""Manoeuvres found in a record, bounded right, and measured with intervals that hold the truth."""

import sys
import time
from collections import Counter
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from sailed_days import sail_day
from sailed_tracks import noisy, sailed

from trialid.design.imo import excursions, recognise, spirals, stops, williamson
from trialid.design.imo.excursions import STEP, heading, order_doubt, order_sample
from trialid.design.imo.measured import heading_numbers
from trialid.design.imo.recognition import Recognised
from trialid.design.imo.track_numbers import Around
from trialid.trial import Trial

STILL = (0.0, 0.0)
LENGTH, SPEED = 175.0, 7.33
ORDER, END = 6, 10
"""[s] By which an order and an end may be off: a gear takes so long, and a ship to stop."""
DAYS, FIRST = 200, 8000
THRESHOLDS = (
    *("MIDSHIPS", "LEAST", "ALIKE", "STRAIGHT", "LENGTHS", "PULL_OUT", "SPARE"),
    *("AWAY", "NEAR", "SETTLES", "KEPT"),
)


def without_order(trial: Trial) -> Trial:
    signals = {n: x for n, x in trial.signals.items() if n != "delta_order"}
    return replace(trial, signals=signals, valid={n: trial.valid[n] for n in signals})


def cut(trial: Trial, end: int) -> Trial:
    signals = {n: x[:end].copy() for n, x in trial.signals.items()}
    return replace(trial, signals=signals, valid={n: x[:end] for n, x in trial.valid.items()})


def late(trial: Trial, begin: int) -> Trial:
    signals = {n: x[begin:].copy() for n, x in trial.signals.items()}
    return replace(trial, signals=signals, valid={n: x[begin:] for n, x in trial.valid.items()})


def found(trial: Trial) -> tuple[Recognised, ...]:
    return recognise.recognise(trial, LENGTH, SPEED)


def seen(seed: int) -> tuple[Counter[str], Counter[str], Counter[str]]:
    """Manoeuvres sailed, found and bounded right, and named besides, by kind.

    A turn that was broken off is in none of them: it has no standard number.
    """
    trial, day = sail_day(seed)
    named = [m for m in recognise.recognise(trial, day.length, day.speed) if m.kind != "turn"]
    sailed_, right = Counter[str](), Counter[str]()
    for kind, begin, end in day.truth:
        if kind == "turn":
            continue
        sailed_[kind] += 1
        for one in named:
            near = abs(one.execute - begin) <= ORDER and abs(one.end - end) <= END
            if one.kind == kind and near:
                right[kind] += 1
                named.remove(one)
                break
    return sailed_, right, Counter[str](m.kind for m in named)


def counted(first: int, days: int) -> list[Counter[str]]:
    each = zip(*map(seen, range(first, first + days)), strict=True)
    return [sum(kinds, Counter[str]()) for kinds in each]


def test_a_day_of_trials_is_told_apart() -> None:
    whole, right, besides = counted(0, 2)
    assert sum(whole.values()) >= 6
    assert sum(right.values()) >= sum(whole.values()) - 1
    assert sum(besides.values()) <= 1


def test_a_zigzag_and_a_circle_to_either_side() -> None:
    odd = ("delta", "delta_order", "psi", "r", "y", "v", "p", "phi")
    for name, kind in (("zigzag", "zig-zag"), ("circle", "turning circle")):
        trial = noisy(sailed(name, STILL), np.random.default_rng(1))
        for side in (1.0, -1.0):
            signals = {n: side * x if n in odd else x for n, x in trial.signals.items()}
            [one] = found(replace(trial, signals=signals))
            assert one.kind == kind
            assert np.sign(one.rudder) == side
            assert one.execute * trial.period == pytest.approx(30.0, abs=2.0 * trial.period)


@pytest.mark.parametrize("name", ["zigzag", "circle"])
@pytest.mark.parametrize("before", [4, 8])
def test_a_record_that_begins_with_the_order_is_no_other_manoeuvre(name: str, before: int) -> None:
    """8 s or 16 s before it, where she sails her length in 24; what begins in a turn is none."""
    trial = without_order(noisy(sailed(name, STILL), np.random.default_rng(4)))
    [whole] = found(trial)
    [one] = found(late(trial, whole.execute - before))
    assert one.kind == whole.kind
    assert (one.execute, one.rudder) == (before, pytest.approx(whole.rudder))
    assert [k - before for k in one.reversals] == [k - whole.execute for k in whole.reversals]
    assert one.course == pytest.approx(whole.course, abs=np.deg2rad(0.5))
    midships = trial.signals["delta"].copy()
    midships[: whole.execute + 40] = 0.0  # a rudder that lies: she turns already
    turning = replace(trial, signals={**trial.signals, "delta": midships})
    kinds = [m.kind for m in found(late(turning, whole.execute + 40 - before))]
    assert whole.kind not in kinds[:1]


@pytest.mark.parametrize("kept", [-8.0, -4.0, 0.0, 4.0, 8.0])
def test_a_rudder_that_keeps_the_course_is_no_order(kept: float) -> None:
    """In a strong wind it stands off midships for minutes before it is put over."""
    period, gear = 0.5, np.deg2rad(5.0)
    t = np.arange(0.0, 120.0, period)
    wander = np.deg2rad(kept + 1.5 * np.sin(0.3 * t))
    hard = np.deg2rad(35.0)
    rudder = np.minimum(wander + gear * np.maximum(t - 60.0, 0.0), hard)
    first = int(np.argmax(rudder > np.deg2rad(3.0)))
    for side in (1.0, -1.0):
        found = order_sample(side * rudder, first, side * hard) * period
        assert found == pytest.approx(60.0, abs=0.5)


@pytest.mark.parametrize("period", [2.0, 0.5, 0.1, 0.02])
def test_a_ramp_is_told_back_to_where_it_began_at_any_rate(period: float) -> None:
    """As slow as SOLAS allows; by ten samples before it was seen it was 2.4 s late at 50 Hz."""
    t, hard = np.arange(0.7, 120.0, period), np.deg2rad(35.0)
    noise = np.deg2rad(0.1) * np.random.default_rng(8).standard_normal(len(t))
    rudder = np.clip(np.deg2rad(65.0 / 28.0) * (t - 60.0), 0.0, hard) + noise
    first = int(np.argmax(rudder > np.deg2rad(3.0)))
    found = 0.7 + order_sample(rudder, first, hard) * period
    assert found == pytest.approx(60.0, abs=0.2)
    assert order_doubt(rudder, first, hard) * period < 0.2
    step = np.where(t > 60.0, hard, 0.0)
    assert order_doubt(step, int(np.argmax(step > 0.0)), hard) == STEP


def test_what_is_broken_off_is_a_line() -> None:
    circle = without_order(sailed("circle", STILL))
    psi = circle.signals["psi"] - circle.signals["psi"][0]
    [turn] = found(cut(circle, int(np.argmax(psi > np.deg2rad(120.0)))))
    assert (turn.kind, turn.remark) == ("turn", "broken off at 119 deg of heading")
    assert found(cut(circle, int(np.argmax(psi > np.deg2rad(60.0))))) == ()
    zigzag = without_order(sailed("zigzag", STILL))
    [whole] = found(zigzag)
    first, second = whole.reversals[:2]
    [broken] = found(cut(zigzag, second - 5))
    assert broken.remark == "broken off after the first reversal"
    assert found(cut(zigzag, first - 2)) == ()
    bare = {n: x for n, x in zigzag.signals.items() if n not in ("delta", "delta_order")}
    assert found(replace(zigzag, signals=bare)) == ()


def test_excursions_all_at_once_are_those_one_by_one() -> None:
    rng = np.random.default_rng(4)
    rudder = np.deg2rad(8.0) * np.convolve(rng.standard_normal(4000), np.ones(9) / 3.0, "same")
    rudder[500:700] = np.deg2rad(20.0)
    each = list(excursions.excursions(rudder))
    assert len(each) > 200
    for one in each:
        angles = np.abs(rudder[one.begin : one.end])
        angle = np.median(angles[angles >= 0.8 * np.quantile(angles, 0.95)])
        at = np.abs(angles - angle) <= max(0.15 * angle, np.deg2rad(1.0))
        reached = np.flatnonzero(at)
        held = np.mean(at[reached[0] : reached[-1] + 1]) if len(reached) > 2 else 0.0
        assert one.angle == pytest.approx(np.sign(rudder[one.begin]) * angle)
        assert one.held == pytest.approx(held)
    assert sum(one.end - one.begin for one in each) == np.sum(np.abs(rudder) > np.deg2rad(3.0))


def test_a_long_log_with_a_restless_rudder_is_searched_at_once() -> None:
    """200 000 samples: 0.3 s; one excursion after another, three times over, took 15."""
    rng = np.random.default_rng(5)
    noise = rng.standard_normal(200_000)
    rudder = np.clip(0.5 * np.convolve(noise, np.exp(-np.arange(60) / 20.0), "same"), -0.6, 0.6)
    psi = np.cumsum(1e-4 * rudder)
    signals = {"delta": rudder, "psi": psi}
    trial = Trial("long", "fit", 0.1, signals, {n: np.ones(len(psi), bool) for n in signals})
    begin = time.process_time()
    assert found(trial) == ()
    assert time.process_time() - begin < 3.0


def test_a_pull_out_that_was_ended_too_early_has_no_number() -> None:
    """A rate that dies with 40 s: nothing of it stays, but 75 s after midships some is left."""
    t = np.arange(0.0, 800.0)
    rate = 0.01 * (np.clip(t - 100.0, 0.0, 300.0) > 0.0) * np.exp(-np.clip(t - 400.0, 0, None) / 40)
    rudder = np.where((t > 100) & (t < 400), np.deg2rad(20.0), 0.0)
    psi = np.cumsum(rate) + np.deg2rad(0.1) * np.random.default_rng(6).standard_normal(800)
    signals = {"delta": rudder, "psi": psi}
    trial = Trial("out", "fit", 1.0, signals, {n: np.ones(800, bool) for n in signals})
    whole, early = (found(x)[-1] for x in (trial, cut(trial, 475)))
    assert (whole.kind, whole.remark) == ("pull-out", "")
    assert (early.kind, early.remark) == ("pull-out", "the rate of turn had not settled")
    [row] = heading_numbers(trial, [whole], Around())
    assert row.interval[0] < 0.0001
    assert list(heading_numbers(cut(trial, 475), [early], Around())) == []


def test_reversals_at_unequal_headings_are_told_as_that() -> None:
    zigzag = without_order(sailed("zigzag", STILL))
    [whole] = found(zigzag)
    late = zigzag.signals["psi"].copy()
    late[whole.reversals[1] - 5 :] += np.deg2rad(9.0)
    [uneven] = found(replace(zigzag, signals={**zigzag.signals, "psi": late}))
    assert uneven.remark == "the second reversal is at another change of heading"


def test_a_heading_that_was_not_recorded_is_the_integral_of_the_rate() -> None:
    """By hand: r = a t turns her by a t^2 / 2."""
    t = np.arange(0.0, 100.0, 2.0)
    trial = Trial("turn", "fit", 2.0, {"r": 0.001 * t}, {})
    np.testing.assert_allclose(heading(trial), 0.0005 * t**2, atol=1e-12)
    recorded = replace(trial, signals={**trial.signals, "psi": np.cos(t)})
    np.testing.assert_array_equal(heading(recorded), np.cos(t))


@pytest.mark.study(turn=3)
def test_days_of_trials_are_found_and_bounded_right() -> None:
    """On days that were not looked at while it was built."""
    whole, right, besides = counted(FIRST, DAYS)
    share = sum(right.values()) / sum(whole.values())
    told = f"{dict(right)} of {dict(whole)}; named besides {dict(besides)}"
    print(f"{share:.1%} of {sum(whole.values())}: {told}")
    assert share >= 0.98
    assert sum(besides.values()) < 0.02 * sum(whole.values())


@pytest.mark.study(turn=8)
def test_half_and_twice_of_each_threshold(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where a threshold has no other origin: what becomes of the same days with others."""
    modules = (excursions, recognise, spirals, stops, williamson)
    monkeypatch.setattr(sys.modules[__name__], "sail_day", cache(sail_day))
    for name in THRESHOLDS:
        for by in (0.5, 1.0, 2.0):
            with monkeypatch.context() as changed:
                for module in modules:
                    if hasattr(module, name):
                        changed.setattr(module, name, by * getattr(module, name))
                whole, right, besides = counted(FIRST, 15)
            told = f"{sum(right.values())} of {sum(whole.values())}"
            print(f"{name} x {by:g}: {told}, besides {sum(besides.values())}")
    assert sum(right.values()) > 0
