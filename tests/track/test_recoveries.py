"""Williamson turns and stops of a record: found by evidence, measured with honest intervals."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from sailed_recoveries import DEG, SHIP, sailed_stop, sailed_williamson
from sailed_tracks import FREE, OUTPUTS, accuracy, noisy, sailed, spread

from trialid.design.imo.recognise import recognise
from trialid.design.imo.recognition import Recognised
from trialid.design.imo.stop_numbers import _reaches, stop_reader
from trialid.design.imo.track_numbers import Around, Water, track_numbers
from trialid.design.imo.trial_measures import TrialMeasures, measure_trials
from trialid.design.imo.trial_numbers import ManoeuvreNumber
from trialid.design.imo.williamson_numbers import williamson_reader
from trialid.identification.fit import identify
from trialid.identification.problem import Settings
from trialid.trial import Trial

WATER = (0.4, -0.3)
STREAM = Settings(
    (*FREE, "X_n"),
    (*OUTPUTS, "u"),
    weights={"x": 12.0, "y": 12.0, "psi": 12.0},
    nuisance=("initial_state", "current"),
)
LOG = 0.05
"""m/s of noise of the log."""
KEPT = 36
"""Samples of three ship lengths."""


def found(trial: Trial) -> tuple[Recognised, ...]:
    return recognise(trial, 175.0, 7.33)


def cut(trial: Trial, end: int) -> Trial:
    signals = {n: x[:end].copy() for n, x in trial.signals.items()}
    return replace(trial, signals=signals, valid={n: x[:end] for n, x in trial.valid.items()})


def test_a_williamson_turn_to_either_side() -> None:
    odd = ("delta", "psi", "r", "y")
    trial = noisy(sailed_williamson(), np.random.default_rng(1))
    for side in (1.0, -1.0):
        signals = {n: side * x if n in odd else x for n, x in trial.signals.items()}
        [one] = found(replace(trial, signals=signals))
        assert (one.kind, one.remark, np.sign(one.rudder)) == ("Williamson turn", "", side)
        assert one.execute * 2.0 == pytest.approx(62.0, abs=2.0)
        away = signals["psi"][one.reversals[0]] - one.course
        assert side * away == pytest.approx(60 * DEG, abs=4 * DEG)
        assert one.steady is not None
        back = signals["psi"][one.steady : one.end]
        assert np.ptp(back) < 7 * DEG
        assert np.mean(back) == pytest.approx(one.course - side * np.pi, abs=10 * DEG)


def test_what_is_not_steadied_on_the_reciprocal_course_is_none() -> None:
    """Cut off before, held on, or steadied far from it; zig-zags and circles are what they are."""
    trial = sailed_williamson()
    [whole] = found(trial)
    eased = int(np.flatnonzero(trial.signals["delta"] < -34 * DEG)[-1])
    [ended] = found(cut(trial, eased + 5))
    assert (ended.kind, ended.steady) == ("Williamson turn", None)
    assert ended.remark == "the record ends before she was steady"
    assert "Williamson turn" not in [m.kind for m in found(cut(trial, whole.reversals[0] + 60))]
    far = sailed_williamson(off=60.0)
    assert "Williamson turn" not in [m.kind for m in found(far)]
    for name in ("zigzag", "circle"):
        assert "Williamson turn" not in [m.kind for m in found(sailed(name, (0.0, 0.0)))]


@cache
def measured(seed: int) -> TrialMeasures:
    """Of both trials with noise, each in a current that the fit has to find."""
    rng = np.random.default_rng([21, seed])
    logged = []
    for name, make in (("turn", sailed_williamson), ("stop", sailed_stop)):
        trial = noisy(make(WATER), rng)
        log = trial.signals["u"] + LOG * rng.standard_normal(trial.samples)
        logged.append(replace(trial, name=name, signals={**trial.signals, "u": log}))
    fit = identify(logged, SHIP, STREAM)
    errors = {p.name: p.standard_error for p in accuracy(fit).parameters}
    return measure_trials(fit, errors, spread(fit))


def off_the_line(trial: Trial, part: slice, course: float) -> float:
    """To starboard of the line on which she was 40 s into the trial [m], on the average."""
    x, y = (np.mean(trial.signals[n][part]) - trial.signals[n][20] for n in ("x", "y"))
    return float(y * np.cos(course) - x * np.sin(course))


def true_turn(trial: Trial, end: int) -> dict[str, float]:
    """In still water, by hand, while she kept her course: the approach is on 0.7 rad."""
    back = float(np.mean(trial.signals["psi"][end - KEPT : end]))
    return {
        "deviation from the reciprocal course": back - (0.7 - np.pi),
        "offset from the old track": off_the_line(trial, slice(end - KEPT, end), 0.7),
    }


def true_stop(trial: Trial, end_of_it: int) -> dict[str, float]:
    """In still water, by hand: the shaft slows from 90 s on."""
    del end_of_it
    u, t = trial.signals["u"], trial.t
    begin, end = 91.0, float(np.interp(-0.733, -u, t))
    [dx, dy] = [
        float(np.interp(end, t, trial.signals[n]) - np.interp(begin, t, trial.signals[n]))
        for n in ("x", "y")
    ]
    fine = np.linspace(begin, end, 4000)
    step = [np.diff(np.interp(fine, t, trial.signals[n])) for n in ("x", "y")]
    return {
        "head reach": dx * np.cos(0.7) + dy * np.sin(0.7),
        "track reach": float(np.sum(np.hypot(*step))),
        "lateral deviation": dy * np.cos(0.7) - dx * np.sin(0.7),
        "time": end - begin,
    }


MADE = {"turn": (sailed_williamson, true_turn), "stop": (sailed_stop, true_stop)}


def truth_of(name: str, seed: int) -> dict[str, float]:
    make, by_hand = MADE[name]
    [end] = [m.end for m in measured(seed).manoeuvres if m.trial == name]
    return by_hand(make(), round(end / make().period))


@pytest.mark.parametrize(("name", "within"), [("turn", 1.0), ("stop", 2.0)])
def test_numbers_of_a_record_in_still_water_are_those_by_hand(name: str, within: float) -> None:
    """In metres, and a hundredth of a radian."""
    make, by_hand = MADE[name]
    trial = make()
    [one] = found(trial)
    assert one.execute * trial.period == pytest.approx({"turn": 61.0, "stop": 91.0}[name], abs=2.0)
    reader = (
        williamson_reader(one, one.execute * trial.period, 12)
        if name == "turn"
        else stop_reader(one, 91.0, 12, trial.samples)
    )
    assert reader is not None
    rows, truth = track_numbers(reader, trial, Around()), by_hand(trial, one.end)
    assert [*rows] == [*truth]
    for number, true in truth.items():
        off = rows[number]["measured"] - true
        assert abs(off) < (0.01 if reader.units[number] == "rad" else within), number
    assert max(abs(x) for n, x in truth.items() if reader.units[n] == "m") > 5.0 * within


def test_reaches_of_a_bent_track_by_hand() -> None:
    """On a course of 30 deg: 80 m along it, 60 m to starboard; half a second late is 5 m less."""
    t = np.arange(0.0, 15.0)
    ahead, aside = np.minimum(10.0 * t, 80.0), np.maximum(10.0 * (t - 8.0), 0.0)
    course = 30.0 * DEG
    track = {
        "x": ahead * np.cos(course) - aside * np.sin(course),
        "y": ahead * np.sin(course) + aside * np.cos(course),
    }
    assert _reaches(track, t, (0.0, 14.0), course) == pytest.approx(
        {"head reach": 80.0, "track reach": 140.0, "lateral deviation": 60.0, "time": 14.0}
    )
    assert _reaches(track, t, (0.5, 14.0), course)["head reach"] == pytest.approx(75.0)


def test_what_the_current_is_uncertain_by_widens_with_the_time() -> None:
    """A head reach without noise: by hand 1.96 times the error times how long the stop takes."""
    trial = sailed_stop()
    [one] = found(trial)
    reader = stop_reader(one, 91.0, 12, trial.samples)
    assert reader is not None
    around = Around(water=Water((0.0, 0.0), (0.05, 0.05)))
    row = track_numbers(reader, trial, around)["head reach"]
    low, high = row["corrected_interval"]
    time = true_stop(trial, 0)["time"]
    assert (high - low) / 2.0 == pytest.approx(1.96 * 0.05 * time, rel=0.1)
    assert row["interval"][1] - row["interval"][0] < 0.5 * (high - low)


def inside(row: ManoeuvreNumber, truth: float) -> tuple[bool, bool]:
    (low, high), (least, most) = (
        ends or (np.nan, np.nan) for ends in (row.corrected_interval, row.predicted_interval)
    )
    return low < truth < high, least < truth < most


@pytest.mark.parametrize("name", ["turn", "stop"])
@pytest.mark.study(turn=13)
def test_numbers_of_the_record_and_of_the_model(name: str) -> None:
    truth, rows = truth_of(name, 0), [r for r in measured(0).numbers if r.trial == name]
    assert [row.name for row in rows] == [*truth]
    for row in rows:
        assert row.corrected_for == "current"
        assert all(inside(row, truth[row.name])), row.name
    assert max(abs(r.measured - truth[r.name]) for r in rows) > 50.0  # the current's part


def test_a_stop_whose_log_has_a_hole_is_read_from_the_track() -> None:
    trial = sailed_stop()
    [one] = found(trial)
    reader = stop_reader(one, 91.0, 12, trial.samples)
    assert reader is not None
    whole = track_numbers(reader, trial, Around())
    lost = {n: x.copy() for n, x in trial.valid.items()}
    lost["u"][one.end - 20 :] = False
    log = np.where(lost["u"], trial.signals["u"], 99.0)
    holed = replace(trial, signals={**trial.signals, "u": log}, valid=lost)
    for name, row in track_numbers(reader, holed, Around()).items():
        assert row["measured"] == pytest.approx(whole[name]["measured"], abs=2.0)
        assert row["predicted"] is None
        assert "corrected" not in row


@pytest.mark.study(turn=14)
def test_intervals_of_turns_and_stops_hold_the_truth() -> None:
    held: dict[str, list[tuple[bool, bool]]] = {}
    for seed in range(1, 13):
        truths = {name: truth_of(name, seed) for name in MADE}
        for row in measured(seed).numbers:
            held.setdefault(row.name, []).append(inside(row, truths[row.trial][row.name]))
    for name, each in held.items():
        record, model = np.mean(each, axis=0)
        print(f"{name}: record {record:.3f}, model {model:.3f} of {len(each)}")
    record, model = np.mean([x for each in held.values() for x in each], axis=0)
    print(f"within 95 %: record {record:.3f}, model {model:.3f}")
    assert record > 0.9
    assert model > 0.9
