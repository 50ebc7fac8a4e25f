"""Turning circles of a record: found by evidence, measured with intervals that hold the truth."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from sailed_tracks import (
    APPROACH,
    CURRENTS,
    SETTINGS,
    SHIP,
    accuracy,
    noisy,
    sailed,
    spread,
    trials,
)

from trialid.design.imo.recognise import recognise
from trialid.design.imo.trial_measures import approach_speed, measure_trials
from trialid.design.imo.trial_numbers import TurnMeasure
from trialid.design.imo.turns import Turn, find_turns, measure
from trialid.identification.fit import identify
from trialid.threads import one_thread
from trialid.trial import Trial

BY_NOISE = replace(SETTINGS, weights={"x": 12.0, "y": 12.0, "psi": 12.0})
STILL = (0.0, 0.0)
SEEDS = 100


def without_order(trial: Trial) -> Trial:
    """The trial as a logger has it that knows the rudder's angle alone."""
    signals = {n: x for n, x in trial.signals.items() if n != "delta_order"}
    return replace(trial, signals=signals, valid={n: trial.valid[n] for n in signals})


def found_in(trial: Trial) -> list[Turn]:
    size = SHIP.ship.particulars
    return list(find_turns(trial, recognise(trial, size["L"], size["U0"])))


@cache
def truth(water: tuple[float, float]) -> dict[str, float]:
    """Of the track without noise, from the instant at which the rudder began to move."""
    trial = without_order(sailed("circle", water))
    [turn] = found_in(trial)
    assert turn.t == pytest.approx(APPROACH, abs=0.01)
    return measure(replace(turn, t=APPROACH), trial.t, trial.signals)


def measured(seed: int) -> tuple[TurnMeasure, ...]:
    fit = identify([without_order(t) for t in trials(seed)], SHIP, BY_NOISE)
    errors = {p.name: p.standard_error for p in accuracy(fit).parameters}
    return measure_trials(fit, errors, spread(fit)).turns


def test_measures_over_the_ground_and_through_the_water() -> None:
    found = {m.name: m for m in measured(0)}
    over, still = truth(CURRENTS["circle"]), truth(STILL)
    assert [*found] == ["advance", "transfer", "tactical diameter"]
    for name, m in found.items():
        assert m.interval[0] < over[name] < m.interval[1]
        assert m.corrected_interval is not None
        assert m.corrected_interval[0] < still[name] < m.corrected_interval[1]
        assert m.interval[1] - m.interval[0] < 25.0
        assert m.predicted == pytest.approx(still[name], rel=0.005)
        assert m.predicted_interval is not None
        assert m.predicted_interval[0] < still[name] < m.predicted_interval[1]
        assert m.predicted_interval[1] - m.predicted_interval[0] < 10.0
    assert abs(over["tactical diameter"] - still["tactical diameter"]) > 100.0  # what it is about


@pytest.mark.study(turn="each")
def test_the_models_advance_is_as_open_as_the_instant_of_the_order() -> None:
    """Orders logged each 2 s: half a sample is 7 m of approach; a rudder's way tells it better."""
    angles = {n: without_order(t) for n, t in logged(3).items()}
    for logs, low, high in ((logged(3), 7.0, 12.0), (angles, 0.3, 3.0)):
        fit = identify([*logs.values()], SHIP, BY_NOISE)
        [advance, *_] = measure_trials(fit, {}, spread(fit, {})).turns
        least, most = advance.predicted_interval or (0.0, 0.0)
        assert low < (most - least) / 2.0 < high
        assert least < truth(STILL)["advance"] < most


def logged(seed: int) -> dict[str, Trial]:
    """Both manoeuvres with the orders of the helm."""
    return {t.name: t for t in trials(seed)}


def test_the_approach_is_told_by_what_was_recorded() -> None:
    """Through the water as she sailed; over the ground 0.58 m/s of current are in it."""
    circle, zigzag = (noisy(sailed(n, CURRENTS[n]), np.random.default_rng(2)) for n in CURRENTS)
    full = np.full(circle.samples, 7.1)
    logged = replace(
        circle,
        signals={**circle.signals, "u": full},
        valid={**circle.valid, "u": np.ones(circle.samples, dtype=bool)},
    )
    fit = identify([circle, zigzag], SHIP, BY_NOISE)
    [one, _] = measure_trials(fit, {}, None).manoeuvres
    assert (one.course, one.speed_by) == (pytest.approx(0.7, abs=0.01), "track less the current")
    assert one.speed == pytest.approx(SHIP.ship.particulars["U0"], abs=0.15)
    span = slice(0, 15)
    ground, by = approach_speed(circle, span, None)
    course = np.array([np.cos(0.7), np.sin(0.7)])
    drift = np.hypot(*(one.speed * course + CURRENTS["circle"]))
    assert (ground, by) == (pytest.approx(drift, abs=0.15), "track over the ground")
    assert abs(drift - one.speed) > 0.15
    by_log = approach_speed(logged, span, None)
    assert by_log == (pytest.approx(7.1), "log")
    assert approach_speed(circle, slice(0, 2), None) == (None, "")


def test_a_speed_that_positions_do_not_tell_is_not_told() -> None:
    """By 1 m at 10 Hz a second and a half leaves 1.2 m/s of 7 open; five seconds 0.2 m/s."""
    t, rng = np.arange(0.0, 5.0, 0.1), np.random.default_rng(5)
    signals = {n: s * t + rng.standard_normal(len(t)) for n, s in (("x", 6.0), ("y", 3.6))}
    valid = {n: np.ones(len(t), dtype=bool) for n in signals}
    trial = Trial("begun late", "fit", 0.1, signals, valid)
    assert approach_speed(trial, slice(0, 15), None) == (None, "")
    assert approach_speed(trial, slice(0, 50), None)[0] == pytest.approx(7.0, abs=0.35)


def held_out(seed: int) -> tuple[TurnMeasure, ...]:
    """The circle of a ship that was fitted to a zig-zag alone."""
    rng = np.random.default_rng([12, seed])
    zigzag, circle = (
        without_order(noisy(sailed(n, CURRENTS[n], use), rng))
        for n, use in (("zigzag", "fit"), ("circle", "check"))
    )
    fit = identify([zigzag, circle], SHIP, BY_NOISE)
    return measure_trials(fit, {}, spread(fit)).turns


def test_a_band_of_a_turn_that_was_not_fitted_is_wider_and_holds_the_truth() -> None:
    """Fitted to 20/20: the turn of 35 deg is a guess, and the band says how much of one."""
    still = truth(STILL)
    fitted = {m.name: m.predicted_interval for m in measured(0)}
    for m in held_out(0):
        low, high = m.predicted_interval or (0.0, 0.0)
        assert low < still[m.name] < high
        assert high - low > 2.0 * np.ptp(fitted[m.name] or (np.inf, 0.0))


def test_a_zigzag_holds_no_turn_and_a_turn_to_port_is_the_mirror() -> None:
    rng = np.random.default_rng(2)
    assert (found_in(noisy(sailed("zigzag", STILL), rng))) == []
    trial = sailed("circle", STILL, course=0.0)
    odd = ("delta", "delta_order", "psi", "r", "y")
    port = replace(trial, signals={n: -x if n in odd else x for n, x in trial.signals.items()})
    [a], [b] = found_in(trial), found_in(port)
    assert b.rudder == pytest.approx(-a.rudder)
    assert measure(b, port.t, port.signals) == pytest.approx(measure(a, trial.t, trial.signals))


def test_a_turn_out_of_another_manoeuvre_or_broken_off_is_none() -> None:
    trial = sailed("circle", STILL)
    [turn] = found_in(trial)
    late = {n: x[turn.begin + 5 :] for n, x in trial.signals.items()}
    cut = replace(
        trial, signals=late, valid={n: x[turn.begin + 5 :] for n, x in trial.valid.items()}
    )
    assert (found_in(cut)) == []
    stop = int(np.argmax(trial.signals["psi"] - turn.course > np.deg2rad(150.0)))
    short = {n: x[:stop] for n, x in trial.signals.items()}
    assert (found_in(replace(trial, signals=short))) == []
    lost = {n: x.copy() for n, x in trial.valid.items()}
    lost["x"][turn.begin + 10 : turn.begin + 60] = False
    assert (found_in(replace(trial, valid=lost))) == []


@pytest.mark.study(turn=14)
@one_thread
def test_intervals_hold_the_truth() -> None:
    """Those of the model hold more: they allow for four effects that are not missing."""
    over, still = truth(CURRENTS["circle"]), truth(STILL)
    inside: dict[tuple[str, bool], list[bool]] = {}
    bands: dict[tuple[str, str], list[bool]] = {}
    for seed in range(SEEDS):
        fitted = measured(seed)
        for m in fitted:
            assert m.corrected_interval is not None
            low, high = m.interval
            inside.setdefault((m.name, True), []).append(low < over[m.name] < high)
            low, high = m.corrected_interval
            inside.setdefault((m.name, False), []).append(low < still[m.name] < high)
        for kind, found in (("model", fitted), ("held out", held_out(seed))):
            for m in found:
                low, high = m.predicted_interval or (np.nan, np.nan)
                bands.setdefault((kind, m.name), []).append(low < still[m.name] < high)
    shares = {key: float(np.mean(x)) for key, x in inside.items()}
    models = {key: float(np.mean(x)) for key, x in bands.items()}
    print(shares, models)
    assert min(*shares.values(), *models.values()) >= 0.9
    assert 0.92 <= np.mean([*shares.values()]) <= 0.98
