from pathlib import Path

import numpy as np
import pytest
from made_recordings import channel, recording

from trialid.alignment import SignalSource, align
from trialid.errors import AlignmentError

HSVA = Path(__file__).parents[3] / "shared/data/kvlcc2_hsva_zigzag"
ORDERS = ("random", "zigzag")


def ship(order, seed, gain=0.1, lag=15.0, waves=2e-4, sensor=1e-3, duration=600.0, step=0.25):
    """Rudder, rate of turn, heading [rad, rad/s] of a first-order ship with waves and noise."""
    rng = np.random.default_rng(seed)
    count = int(duration / step)
    t = np.arange(count) * step
    delta, r, psi = np.zeros(count), np.zeros(count), np.zeros(count)
    side = rng.choice([-1, 1], 1000)
    now = 1
    for k in range(1, count):
        now = -now if now * psi[k - 1] > 0.17 else now
        target = 0.17 * (now if order == "zigzag" else side[int(t[k] / 20)])
        if order == "autopilot":
            target = -1.0 * psi[k - 1] - 8.0 * r[k - 1]
        delta[k] = delta[k - 1] + np.clip(target - delta[k - 1], -0.05 * step, 0.05 * step)
        push = waves * np.sin(0.7 * t[k]) + 0.3 * waves * rng.normal()
        r[k] = r[k - 1] + step * ((gain * delta[k] - r[k - 1]) / lag + push)
        psi[k] = psi[k - 1] + step * r[k]
    return t, delta, r + sensor * rng.normal(size=count), psi


def log_of(t, **signals):
    return recording(*(channel(name, t, y) for name, y in signals.items()))


def sources(side="starboard", *, turn=True, heading=False, turn_side=None):
    found = [SignalSource("delta", "delta", "rad", side)]
    found += [SignalSource("r", "r", "rad/s", turn_side)] if turn else []
    return found + ([SignalSource("psi", "psi", "rad")] if heading else [])


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("seed", range(5))
def test_a_wrong_rudder_sign_is_found_and_a_right_one_accepted(order, seed):
    t, delta, r, psi = ship(order, seed)
    log = log_of(t, delta=delta, r=r, psi=psi)
    trial = align("t", "fit", [log], sources(heading=True), 0.5)
    (remark,) = (one for one in trial.remarks if one.startswith("delta and dr/dt: correlation "))
    assert float(remark.split()[-1]) > 0.8
    with pytest.raises(AlignmentError) as caught:
        align("t", "fit", [log], sources("port"), 0.5)
    message = str(caught.value)
    assert "delta looks inverted, the ship turns the other way (correlation" in message
    assert 'write positive = "starboard" for delta' in message
    assert "\n" not in message


def test_a_rudder_logged_to_port_needs_positive_port():
    t, delta, r, _ = ship("zigzag", 0)
    log = log_of(t, delta=-delta, r=r)
    with pytest.raises(AlignmentError, match='write positive = "port" for delta'):
        align("t", "fit", [log], sources(), 0.5)
    trial = align("t", "fit", [log], sources("port"), 0.5)
    inside = trial.valid["delta"]
    assert (
        np.corrcoef(trial.signals["delta"][inside], delta[::2][: trial.samples][inside])[0, 1]
        > 0.99
    )


def test_the_heading_stands_in_for_a_rate_of_turn_that_was_not_logged():
    t, delta, _, psi = ship("zigzag", 1)
    log = log_of(t, delta=-delta, psi=psi)
    with pytest.raises(AlignmentError, match="delta looks inverted"):
        align("t", "fit", [log], sources(turn=False, heading=True), 0.5)


def test_a_rate_of_turn_against_the_heading():
    t, delta, r, psi = ship("zigzag", 2)
    log = log_of(t, delta=delta, r=-r, psi=psi)
    with pytest.raises(
        AlignmentError, match="r and the slope of psi have opposite signs"
    ) as caught:
        align("t", "fit", [log], sources(heading=True), 0.5)
    assert 'add positive = "port" to the one that is positive to port' in str(caught.value)
    trial = align("t", "fit", [log], sources(heading=True, turn_side="port"), 0.5)
    assert any(
        remark.startswith("r and the slope of psi: correlation ") for remark in trial.remarks
    )


@pytest.mark.parametrize("seed", range(10))
def test_an_autopilot_in_waves_is_no_contradiction(seed):
    """Its rudder opposes the rate of turn, and yet accelerates the ship the right way."""
    t, delta, r, _ = ship("autopilot", seed, waves=2e-3)
    assert np.corrcoef(delta, r)[0, 1] < 0
    align("t", "fit", [log_of(t, delta=delta, r=r)], sources(), 0.5)


@pytest.mark.parametrize("side", ["starboard", "port"])
def test_where_nothing_is_to_be_seen_nothing_is_said_to_be_wrong(side):
    rng = np.random.default_rng(6)
    t = np.arange(0, 300, 0.25)
    noise = rng.normal(size=len(t))
    constant = log_of(t, delta=0.05 + 0 * t, r=noise)
    assert align("t", "fit", [constant], sources(side), 0.5).samples == 600
    unrelated = log_of(t, delta=rng.normal(size=len(t)), r=noise)
    assert align("t", "fit", [unrelated], sources(side), 0.5).samples == 600
    short = log_of(t[:20], delta=-noise[:20], r=noise[:20])
    assert align("t", "fit", [short], sources(side), 0.25).samples == 20


def test_astern_the_rudder_is_not_judged():
    t, delta, r, _ = ship("zigzag", 3)
    log = log_of(t, delta=-delta, r=r, u=-3 + 0 * t)
    made = align("t", "fit", [log], [*sources(), SignalSource("u", "u", "m/s")], 0.5)
    assert np.corrcoef(made.signals["delta"], -np.interp(made.t, t, delta))[0, 1] > 0.99


def test_the_ordered_rudder_is_judged_too():
    t, delta, r, _ = ship("random", 4)
    log = log_of(t, order=-delta, r=r)
    with pytest.raises(AlignmentError, match="delta_order looks inverted"):
        align(
            "t",
            "fit",
            [log],
            [
                SignalSource("delta_order", "order", "rad", "starboard"),
                SignalSource("r", "r", "rad/s"),
            ],
            0.5,
        )


def hsva(path):
    """Columns of a free-running model test: t, delta [deg, to port], r [deg/s], psi [deg], u."""
    rows = []
    for line in path.read_text(encoding="cp1252").splitlines():
        fields = line.split()
        if len(fields) == 12 and fields[0].replace(".", "", 1).isdigit():
            rows.append([float(field) for field in fields])
    table = np.array(rows).T
    return {"t": table[0], "delta": table[8], "r": table[6], "psi": table[3], "u": table[4]}


@pytest.mark.real_data
@pytest.mark.skipif(not HSVA.exists(), reason="real records are not here")
@pytest.mark.parametrize("path", sorted(HSVA.glob("*.dat")), ids=lambda path: path.stem)
def test_real_zigzags_with_the_rudder_to_port(path):
    columns = hsva(path)
    log = log_of(columns.pop("t"), **columns)
    more = [
        SignalSource("r", "r", "deg/s"),
        SignalSource("psi", "psi", "deg"),
        SignalSource("u", "u", "m/s"),
    ]
    align("t", "fit", [log], [SignalSource("delta", "delta", "deg", "port"), *more], 0.25)
    with pytest.raises(AlignmentError, match='write positive = "port" for delta'):
        align("t", "fit", [log], [SignalSource("delta", "delta", "deg", "starboard"), *more], 0.25)


@pytest.mark.parametrize("seed", range(3))
def test_a_wrong_side_is_found_in_a_rough_sea(seed):
    """The sea turns her as much as the rudder does: two thirds of a correlation are left."""
    t, delta, r, _ = ship("random", seed, waves=4e-3, sensor=4e-3)
    log = log_of(t, delta=delta, r=r)
    trial = align("t", "fit", [log], sources(), 0.5)
    (remark,) = (one for one in trial.remarks if one.startswith("delta and dr/dt: correlation "))
    assert 0.4 < float(remark.split()[-1]) < 0.97
    with pytest.raises(AlignmentError, match="delta looks inverted"):
        align("t", "fit", [log], sources("port"), 0.5)
