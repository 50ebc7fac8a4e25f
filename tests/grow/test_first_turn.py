"""To which side ships begin to turn: stable and unstable ones, of a structure no model here has."""

import mmg
import numpy as np
import pytest

from trialid.alignment.agreement.first_turn import first_turn
from trialid.alignment.agreement.signs import answer_of

MANOEUVRES = {"zz5": (5.0, 5.0), "zz20": (20.0, 20.0), "turn20": (20.0,), "turn35": (35.0,)}


@pytest.fixture(scope="module")
def logs(tmp_path_factory):
    """Time [s], rudder and yaw rate [deg, deg/s] of five ships; the last is unstable."""
    made = []
    for seed in (600, 601, 602, 603, 367):
        for manoeuvre in MANOEUVRES.values():
            path = tmp_path_factory.mktemp("turn") / "log.csv"
            mmg.write_log(path, mmg.drawn(seed), np.random.default_rng(seed), *manoeuvre)
            made.append(np.loadtxt(path, delimiter=",", skiprows=1)[:, :3].T)
    return made


def gusts(t, size, rng):
    """A rate that strays by so much within 20 s."""
    kept = np.exp(-(t[1] - t[0]) / 20.0)
    found, drawn = np.zeros(len(t)), rng.standard_normal(len(t))
    for k in range(1, len(t)):
        found[k] = kept * found[k - 1] + np.sqrt(1.0 - kept**2) * drawn[k]
    return size * found


def told(rudder, rate):
    return first_turn(rudder, rate, np.ones(len(rate), dtype=bool)).sign


def test_she_begins_to_turn_to_the_side_of_her_rudder(logs):
    """As logged, with the rudder's sign the other way, and from one straight course to another."""
    assert all(told(delta, r) == 1.0 for _, delta, r in logs)
    assert all(told(-delta, r) == -1.0 for _, delta, r in logs)
    assert all(told(delta + 3.0, r - 0.2) == 1.0 for _, delta, r in logs)


def test_it_tells_where_the_whole_record_does_not(logs):
    whole = [
        answer_of(delta, r, np.ones(len(r), dtype=bool), t[1] - t[0]).sign for t, delta, r in logs
    ]
    assert whole.count(0.0) >= 6


def test_in_gusts_it_tells_the_side_or_nothing(logs):
    rng = np.random.default_rng(9)
    found = [told(d, r + gusts(t, 0.3 * np.std(r), rng)) for _ in range(5) for t, d, r in logs]
    assert found.count(-1.0) == 0
    assert found.count(1.0) > 0.5 * len(found)


def test_what_does_not_show_it_tells_nothing(logs):
    t, delta, r = logs[0]
    rng = np.random.default_rng(10)
    assert told(delta, 0.01 * rng.standard_normal(len(t))) == 0.0  # she lies still
    t, delta, r = logs[2]
    laid = int(np.argmax(np.abs(delta) > 10.0))
    assert told(delta[laid - 3 :], r[laid - 3 :]) == 0.0  # no straight course before
    assert told(delta[laid + 30 :], r[laid + 30 :]) == 0.0  # nor any way of the rudder
    holes = np.ones(len(t), dtype=bool)
    holes[laid] = False
    assert first_turn(delta, r, holes).sign == 0.0


@pytest.mark.study(turn=11)
def test_of_1200_records_none_is_told_wrongly(tmp_path):
    """Of 60 ships, calm, in gusts, in a swell, by a drifting gyro."""
    found, rng = list[float](), np.random.default_rng(11)
    for seed in range(600, 660):
        for manoeuvre in (*MANOEUVRES.values(), (10.0, 10.0)):
            path = tmp_path / "log.csv"
            mmg.write_log(path, mmg.drawn(seed), np.random.default_rng(seed), *manoeuvre)
            t, delta, r = np.loadtxt(path, delimiter=",", skiprows=1)[:, :3].T
            size = float(np.std(r))
            swell = np.sin(2.0 * np.pi * t / 7.0 + rng.uniform(0.0, 2.0 * np.pi))
            others = (
                0.0 * t,
                gusts(t, 0.3 * size, rng),
                0.5 * size * swell,
                0.3 * size * t / t[-1],
            )
            found += [told(delta, r + other) for other in others]
    print(f"{found.count(1.0)} of {len(found)} told, {found.count(-1.0)} wrongly")
    assert len(found) == 1200
    assert found.count(-1.0) == 0
    assert found.count(1.0) > 900
