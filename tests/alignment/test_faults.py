"""Spikes, dropouts, limits, flat tops, frozen sensors: planted ones found, healthy ones left."""

import numpy as np
import pytest
from made_recordings import channel, recording
from made_trials import record
from real_channels import BUSES, DATA, DECAY, HSVA, bus_series, decay_series, hsva_series

from trialid.alignment import SignalSource, align, clocks, faults
from trialid.alignment.clocks import Grid
from trialid.errors import AlignmentError

T = np.arange(0, 200, 0.1)
UNITS = {"u": "m/s", "v": "m/s", "r": "rad/s", "p": "rad/s", "V_aw": "m/s", "n": "rad/s"}


def swing(t):
    return 0.05 * np.sin(0.3 * t) + 0.02 * np.sin(0.11 * t)


def aligned(signals, keep=None, period=0.5, t=T):
    """The trial of signals in SI, all logged at `t`."""
    log = recording(*(channel(q, t, y) for q, y in signals.items()))
    sources = [
        SignalSource(q, q, UNITS.get(q, "rad"), "starboard" if q.startswith("delta") else None)
        for q in signals
    ]
    return align("t", "fit", [log], sources, period, keep=keep)


def noisy(seed, size=1e-3):
    return swing(T) + size * np.random.default_rng(seed).normal(size=len(T))


def faulty(trial):
    """The remarks on faulty values."""
    ends = "; masked", "; left as they are", "; left as it is"
    return [r for r in trial.remarks if r.endswith(ends) and " value" in r]


def test_spikes_are_masked_counted_and_placed():
    y = noisy(1)
    y[[300, 700, 701, 1500]] += [0.3, -0.4, -0.4, 0.2]
    trial = aligned({"r": y})
    (words,) = faulty(trial)
    assert words == ("r: 4 values out of line, at 30.0, 70.0, 70.1, ... s; masked")
    inside = trial.valid["r"]
    assert np.abs(trial.signals["r"] - swing(trial.t))[inside].max() < 5e-3


def test_what_the_user_keeps_is_remarked_and_stays():
    y = noisy(1)
    y[300] = 0.5
    trial = aligned({"r": y}, {"r": ("spikes",)})
    (words,) = faulty(trial)
    assert words.endswith("30.0 s; left as it is")
    at = trial.t == 30.0
    assert trial.valid["r"][at]
    assert trial.signals["r"][at] > swing(30.0) + 0.05


@pytest.mark.parametrize("step", [0.0, np.deg2rad(1.0), np.deg2rad(3.0)])
@pytest.mark.parametrize("period", [0.1, 1.0])
def test_rudder_steps_ramps_and_kicks_are_no_spikes_however_coarse(step, period):
    t = np.arange(0, 400, period)
    order = 0.3 * np.sign(np.sin(0.1 * t))
    order[len(t) // 2 : len(t) // 2 + 2] = -order[len(t) // 2]  # a kick of two samples
    order = np.round(order / step) * step if step else order
    gear = np.interp(t, t[:: round(4 / period)], order[:: round(4 / period)])
    trial = aligned({"delta_order": order, "delta": gear}, period=1.0, t=t)
    assert not faulty(trial)


def test_a_rudder_pulse_that_a_gear_could_do_is_left_and_one_that_none_could_is_not():
    slow = np.arange(0, 400, 1.0)
    y = 0.1 * np.sin(0.05 * slow)
    y[200] += 0.15
    (words,) = faulty(aligned({"delta": y}, period=1.0, t=slow))
    assert words.endswith("200.0 s; left as it is")
    y = 0.1 * np.sin(0.05 * T)
    y[1000] += 0.15
    (words,) = faulty(aligned({"delta": y}))
    assert words.endswith("100.0 s; masked")


def test_dropouts_to_zero():
    rng = np.random.default_rng(2)
    u = 7.0 + 0.3 * np.sin(0.05 * T) + 0.02 * rng.normal(size=len(T))
    for k in (100, 500, 900, 1300):
        u[k : k + 8] = 0.0
    trial = aligned({"u": u})
    assert faulty(trial) == ["u: 32 values dropped to zero, at 10.0, 10.1, 10.2, ... s; masked"]
    assert trial.signals["u"][trial.valid["u"]].min() > 6.5


def test_a_ship_that_stops_has_not_dropped_out():
    u = np.clip(7.0 - 0.1 * T, 0.0, None)
    assert not faulty(aligned({"u": u}))


@pytest.mark.parametrize(
    ("quantity", "value", "words"),
    [("phi", 1.7, "beyond 90 deg"), ("r", 4.0, "beyond 180 deg/s"), ("u", 60.0, "beyond 50 m/s"),
     ("psi", 11.4, "beyond 360 deg"), ("V_aw", -1.0, "below zero")],
)  # fmt: skip
def test_what_nothing_afloat_can_have(quantity, value, words):
    y = 3.0 + noisy(3)
    y = y if quantity in {"psi", "u", "V_aw"} else y - 3.0
    y[500] = value
    (remark,) = faulty(aligned({quantity: y}))
    assert remark == f"{quantity}: 1 value {words}, at 50.0 s; masked"


def test_a_heading_that_counts_turns_is_none_of_that():
    assert not faulty(aligned({"psi": 0.05 * T}))
    assert not faulty(aligned({"psi": np.mod(0.05 * T, 2 * np.pi)}))


def test_a_wrong_unit_is_an_error_not_a_thousand_spikes():
    with pytest.raises(AlignmentError) as caught:
        aligned({"phi": 60 * swing(T)})
    assert "values are beyond 90 deg; the unit is wrong" in str(caught.value)
    assert "\n" not in str(caught.value)


def test_flat_tops_are_a_limit_and_a_steady_turn_is_none():
    y = noisy(4, 1e-4)
    (words,) = faulty(aligned({"r": np.minimum(y, 0.04)}))
    assert "held at the limit 2.292 deg/s in " in words
    assert words.endswith("; masked")
    coarse = np.deg2rad(0.1) * np.round(np.clip(1e-3 * T, 0, 0.05) / np.deg2rad(0.1))
    assert not faulty(aligned({"r": coarse}))
    assert not faulty(aligned({"r": np.deg2rad(1.0) * np.round(y / np.deg2rad(1.0))}))


def test_one_long_flat_top_is_a_limit_where_noise_never_stands_still():
    """Of a turning circle there is one; a coarse sensor's turn stands still elsewhere too."""
    turn = 0.02 * (1.0 - np.exp(-np.maximum(T - 40.0, 0.0) / 8.0))
    y = turn + 2e-4 * np.random.default_rng(9).normal(size=len(T))
    (words,) = faulty(aligned({"r": np.clip(np.round(y, 5), -0.015, 0.015)}))
    assert "held at the limit 0.8594 deg/s in 1 flat top" in words
    assert not faulty(aligned({"r": y}))
    assert not faulty(aligned({"r": np.round(turn, 3)}))
    digits = 0.1 + 1e-15 * np.clip(np.random.default_rng(9).normal(size=len(T)).cumsum(), -9, 9)
    assert not faulty(aligned({"r": digits}))


@pytest.mark.parametrize(("frozen", "beside"), [("phi", "r"), ("r", "v")])
def test_a_sensor_that_freezes_while_the_ship_turns(frozen, beside):
    """Of a gyro her sway tells it, too: 115 % of r was left where the heading had been left out."""
    kept, other = noisy(5), noisy(6)
    held = kept.copy()
    held[600:900] = held[600]
    (words,) = faulty(aligned({frozen: held, beside: other}))
    assert words == (
        f"{frozen}: 299 values did not change while the ship moved, "
        "at 60.1, 60.2, 60.3, ... s; masked"
    )
    moored = np.where((T > 55) & (T < 95), 1e-4, 1.0) * other
    assert not faulty(aligned({frozen: held, beside: moored}))
    assert not faulty(aligned({frozen: kept, "delta": 0.1 + 0 * T, beside: other}))


def test_a_resolution_that_matters_is_told():
    coarse = np.deg2rad(1.0) * np.round(0.1 * np.sin(2 * np.pi * T / 50) / np.deg2rad(1.0))
    remarks = aligned({"delta": coarse}).remarks
    assert "delta: in steps of 1 deg, an error of 7.0% of its motion" in remarks
    exact = aligned({"delta": np.round(coarse + 0.02 * swing(T), 4), "delta_order": coarse})
    assert not any("in steps" in one for one in exact.remarks)


def false_ones(seeds):
    """Samples of healthy simulated records that would be masked, with their story."""
    found, samples = [], 0
    for seed in seeds:
        made = record(seed)
        log = recording(*(channel(q, t, y) for q, (t, y) in made.channels.items()))
        series = [clocks.in_time_order(_series(log, q)) for q in made.channels]
        samples += sum(len(one.y) for one in series)
        found += [(made.story, words) for words in _faults(series)]
    print(f"{samples} healthy values, {len(found)} remarks: {found}")
    return found


def _series(log, quantity):
    from trialid.alignment import frames

    unit, side = UNITS.get(quantity, "rad"), "starboard" if quantity == "delta" else None
    return frames.series(SignalSource(quantity, quantity, unit, side), [log], "t")


def whole(series):
    """A clock that spans a series, so that all that is wrong with it is told."""
    return Grid(int(series.t[0]), 0.5, int((series.t[-1] - series.t[0]) / 5e8) + 2)


def _faults(series):
    words = []
    for i, one in enumerate(series):
        clock = whole(one)
        words += faults.mask_faults(one, clock, (), 0.0, "t")[1]
        stuck = faults.find_stuck(series, i, clock)
        words += [f"{one.quantity.name} {stuck.words}"] if stuck else []
    return words


def test_healthy_simulated_records_keep_every_value():
    assert not false_ones(range(42))


@pytest.mark.study(turn=6)
def test_many_healthy_simulated_records_keep_every_value():
    assert not false_ones(range(42, 420))


def planted(seeds, find, plant):
    """Share of planted values that are masked, and of others that are masked with them."""
    hit = wrong = total = 0
    for seed in seeds:
        rng = np.random.default_rng(seed)
        t, y = record(seed).channels[find]
        k = rng.choice(np.arange(5, len(y) - 5), max(1, len(y) // 500), replace=False)
        log = recording(channel(find, t, plant(y, k, rng)))
        one = clocks.in_time_order(_series(log, find))
        left, _ = faults.mask_faults(one, whole(one), (), 0.0, "t")
        out = ~np.isfinite(left.y)
        hit, wrong, total = hit + out[k].sum(), wrong + out.sum() - out[k].sum(), total + len(k)
    print(f"{find}: {hit / total:.1%} of {total} found, {wrong} others masked")
    return hit / total, wrong / total


SIZES = {"r": 20.0, "phi": 30.0, "psi": 60.0, "delta": 40.0}
"""[deg, deg/s] Of a spike."""


@pytest.mark.parametrize(("quantity", "least"), [("r", 0.9), ("phi", 0.8), ("psi", 0.8),
                                                  ("delta", 0.85)])  # fmt: skip
def test_planted_spikes_are_found(quantity, least):
    """Over ships, boats and models; the rest drown in the seas and noise of the small ones."""

    def plant(y, k, rng):
        bad = y.copy()
        bad[k] += np.deg2rad(SIZES[quantity]) * rng.choice([-1, 1], len(k))
        return bad

    found, others = planted(range(28), quantity, plant)
    assert found > least
    assert others < 0.03


def test_planted_zeros_of_the_speed_are_found():
    def plant(y, k, rng):
        return np.where(np.isin(np.arange(len(y)), k), 0.0, y)

    found, others = planted(range(28), "u", plant)
    assert found > 0.95
    assert others == 0


@pytest.mark.real_data
@pytest.mark.skipif(not DATA.is_dir(), reason="real records are not here")
@pytest.mark.parametrize("path", [*HSVA, DECAY, *BUSES], ids=lambda path: path.stem)
def test_real_records_keep_every_value(path):
    read = hsva_series if path in HSVA else decay_series if path == DECAY else bus_series
    every = read(path)
    assert not _faults([clocks.in_time_order(one) for one in every.values()])


def planted_jumps(seeds, sizes=(0.0, 10.0)):
    """Of simulated headings, those with a jump [deg] from somewhere on that are remarked."""
    said = dict.fromkeys(sizes, 0)
    for seed in seeds:
        rng = np.random.default_rng(seed)
        t, y = record(seed).channels["psi"]
        k = rng.integers(8, len(y) - 8)
        for size in sizes:
            there = np.where(np.arange(len(y)) < k, y, y + np.deg2rad(size))
            one = _series(recording(channel("psi", t, there)), "psi")
            words = _faults([clocks.in_time_order(one)])
            said[size] += any("jumped by up to" in one for one in words)
            assert not words or size
    return said


def test_a_heading_that_jumps_is_told_and_kept():
    assert planted_jumps(range(14)) == {0.0: 0, 10.0: 14}
    y = noisy(3)
    y[800:] += 0.2
    trial = aligned({"psi": y})
    (words,) = faulty(trial)
    assert "psi: 1 value jumped by up to 11 deg off the pace of its neighbours, at 80.0 s" in words
    assert trial.valid["psi"][20:-20].all()
    assert not faulty(aligned({"psi": noisy(3)}))


def test_samples_that_are_lost_in_a_turn_are_no_jump():
    y = np.deg2rad(5.0) * T + 1e-3 * np.random.default_rng(5).normal(size=len(T))
    kept = np.ones(len(T), np.bool_)
    kept[[500, 700, 701, 900, 901, 902]] = False
    assert not faulty(aligned({"psi": y[kept]}, t=T[kept]))
