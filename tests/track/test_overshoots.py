"""Overshoots of a zig-zag: read to a hundredth of a degree, with intervals that hold the truth."""

from dataclasses import replace

import numpy as np
import pytest
from sailed_tracks import PERIOD, SETTINGS, SHIP, noisy, sailed, spread
from test_recognise import STILL, found, without_order

from trialid.design.helm import Passage
from trialid.design.imo import measures
from trialid.design.imo.measured import heading_numbers, zigzag_reader
from trialid.design.imo.sailed_trial import sail_plainly
from trialid.design.imo.track_numbers import Around
from trialid.design.imo.trial_measures import measure_trials
from trialid.design.imo.trial_numbers import ManoeuvreNumber
from trialid.identification.fit import Fit, identify
from trialid.trial import Trial

OFF = ("rudder_offset", 3.0)
"""A rudder that pushes to one side amidships as one 1.7 deg over would."""
NUISANCE = {None: SETTINGS.nuisance, OFF: (*SETTINGS.nuisance, "rudder_offset")}


def fitted(seed: int, hidden: tuple[str, float] | None = None) -> Fit:
    true = sailed("zigzag", STILL, hidden=hidden)
    trial = without_order(noisy(true, np.random.default_rng([3, seed])))
    weights = {"x": 12.0, "y": 12.0, "psi": 12.0}
    settings = replace(SETTINGS, weights=weights, nuisance=NUISANCE[hidden])
    return identify([trial], SHIP, settings)


def true_overshoots(period: float = PERIOD, hidden: tuple[str, float] | None = None) -> list[float]:
    trial = sailed("zigzag", STILL, period=period, hidden=hidden)
    return measures.overshoots(Passage(trial, trial.signals["x"], trial.signals["y"], None))


def check(row: ManoeuvreNumber, truth: float) -> tuple[bool, bool]:
    low, high = row.predicted_interval or (np.nan, np.nan)
    return row.interval[0] < truth < row.interval[1], low < truth < high


def test_overshoots_with_intervals_of_record_and_model() -> None:
    fit = fitted(0)
    found = measure_trials(fit, {}, spread(fit))
    [zigzag] = found.manoeuvres
    assert (zigzag.kind, zigzag.remark) == ("zig-zag", "")
    assert zigzag.t == pytest.approx(30.0, abs=0.2)
    rows = found.numbers
    assert [row.name for row in rows] == [f"{n} overshoot" for n in ("first", "second", "third")]
    for row, truth in zip(rows, true_overshoots(), strict=True):
        assert all(check(row, truth))
        assert row.measured == pytest.approx(truth, abs=np.deg2rad(0.6))
        assert row.interval[1] - row.interval[0] < np.deg2rad(2.5)


def test_a_trial_s_own_rudder_s_zero_is_in_what_the_model_foretells_of_it() -> None:
    """Without it she turned to the side where the rudder was reversed late, 2 deg and more."""
    fit = fitted(0, OFF)
    truth = true_overshoots(hidden=OFF)
    rows = measure_trials(fit, {}, spread(fit)).numbers
    assert max(truth[1:]) - min(truth[1:]) > np.deg2rad(1.0)  # to one side further than the other
    for row, x in zip(rows, truth, strict=True):
        assert all(check(row, x))
        assert row.predicted == pytest.approx(x, abs=np.deg2rad(0.6))
    plain, true = sail_plainly(fit, fit.trials[0]), sailed("zigzag", STILL, hidden=OFF)
    assert plain is not None
    assert np.std(plain["psi"] - true.signals["psi"]) < np.deg2rad(0.6)


@pytest.mark.parametrize("period", [0.5, 1.0, 2.0])
def test_an_overshoot_is_read_where_she_swings_out_faster_than_back(period: float) -> None:
    """What takes noise off put it up to 0.04 deg too high; a simulated track has none."""
    trial = without_order(sailed("zigzag", STILL, period=period))
    rows = list(heading_numbers(trial, found(trial), Around()))
    [zigzag] = [one for one in found(trial) if one.kind == "zig-zag"]
    smooth = zigzag_reader(trial, zigzag)(trial.signals["psi"], 0.0)
    for row, truth in zip(rows, true_overshoots(period), strict=True):
        assert row.measured == pytest.approx(truth, abs=np.deg2rad(0.01))
        assert smooth[row.name][0] == pytest.approx(truth, abs=np.deg2rad(0.001))


def test_every_overshoot_of_a_long_zigzag_is_measured() -> None:
    """Ten reversals at 10 deg of a heading that swings by 20: each goes 10 deg too far."""
    t = np.arange(0.0, 1400.0, 1.0)
    psi = np.deg2rad(20.0) * np.sin(2.0 * np.pi * np.clip(t - 100.0, 0.0, None) / 200.0)
    side, order = 0.0, []
    for k, now in enumerate(psi):
        if k == 100 or side * now >= np.deg2rad(10.0):
            side = -side or 1.0
        order.append(side * np.deg2rad(10.0))
    signals = {"delta": np.array(order), "psi": psi}
    trial = Trial("long", "fit", 1.0, signals, {n: np.ones(len(t), bool) for n in signals})
    rows = list(heading_numbers(trial, found(trial), Around()))
    assert [r.name for r in rows][:2] == ["first overshoot", "second overshoot"]
    assert [r.name for r in rows][6:] == [f"{n}th overshoot" for n in range(7, len(rows) + 1)]
    assert len(rows) >= 11
    assert [r.measured for r in rows] == pytest.approx([np.deg2rad(10.0)] * len(rows), abs=0.01)


@pytest.mark.study(turn=8)
@pytest.mark.parametrize("hidden", [None, OFF])
def test_intervals_of_overshoots_hold_the_truth(hidden: tuple[str, float] | None) -> None:
    truth = true_overshoots(hidden=hidden)
    inside = []
    for seed in range(60):
        fit = fitted(seed, hidden)
        rows = measure_trials(fit, {}, spread(fit)).numbers
        inside += [check(row, x) for row, x in zip(rows, truth, strict=True)]
    record, model = np.mean(inside, axis=0)
    print(f"overshoots within 95 %: record {record:.3f}, model {model:.3f} of {len(inside)}")
    assert 0.92 < record < 0.98
    assert model > 0.9
