"""Logs of the reference ship in zig-zags, with one fault of their clocks at a time.

The ship, her rudder, the noise of her sensors and the seeds are the same whatever the fault, so
that what a fitted parameter moves by is the fault's doing alone. Two recorders: the bridge has the
rudder, the shaft and a compass, the motion box the gyro and the inclinometer.
"""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from s175q import (
    GYRO,
    INCLINOMETER,
    MODEL,
    SETTINGS,
    SHAFT,
    TEN,
    zigzag,
)

from trialid.accuracy.parameter_table import Subject, assess
from trialid.alignment import LogClock, SignalSource, align
from trialid.identification.fit import identify
from trialid.identification.output_error import stretches
from trialid.recording import Channel, Recording
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial

FINE = 0.1  # s, of the motion and of the fast sensors
EPOCH = 1_700_000_000 * 10**9
TRIALS = (10, 20)
SLOW = 10
NOISE = {"gyro": GYRO, "roll": INCLINOMETER, "compass": np.deg2rad(0.1)}
SOURCES = {
    "delta": SignalSource("delta", "rudder", "rad", "starboard"),
    "n": SignalSource("n", "shaft", "rad/s"),
    "r": SignalSource("r", "gyro", "rad/s"),
    "phi": SignalSource("phi", "roll", "rad"),
}


@dataclass(frozen=True)
class Sensor:
    """One channel: the true instants [s] of its samples, the stamps they got [s], the values."""

    t: np.ndarray
    stamp: np.ndarray
    y: np.ndarray

    def kept(self, which):
        return Sensor(self.t[which], self.stamp[which], self.y[which])

    def stamped(self, stamp):
        return replace(self, stamp=stamp)


def motion(angle):
    """True rudder, rate of turn, roll and heading on the fine clock."""
    coarse = zigzag(angle)
    t = np.arange(0.0, coarse.duration + FINE / 2, FINE)
    delta = np.interp(t, coarse.t, coarse.signals["delta"])
    signals = {"delta": delta, "n": np.full(len(t), SHAFT)}
    trial = Trial("truth", "fit", FINE, signals, {})
    y = respond(prepare(MODEL, (), ("r", "phi")), trial, {}, {"u": 7.33}, sensitivities=False).y
    r, phi = y.T
    psi = np.concatenate([[0.0], np.cumsum((r[1:] + r[:-1]) / 2) * FINE])
    return t, {"rudder": delta, "shaft": signals["n"], "gyro": r, "roll": phi, "compass": psi}


def sensors(angle):
    """Every sensor without a fault: 10 Hz on its own clock, noise from one seed.

    The noise of the inclinometer changes within a second, so that one sample a second has it whole.
    """
    t, true = motion(angle)
    rng = np.random.default_rng(angle)
    made = {}
    for k, (name, y) in enumerate(true.items()):
        at = t[2:-2] + 0.013 * k
        noise = np.interp(at, at[::SLOW], rng.standard_normal(len(at[::SLOW])))
        noise = noise if name == "roll" else rng.standard_normal(len(at))
        made[name] = Sensor(at, at.copy(), np.interp(at, t, y) + NOISE.get(name, 0.0) * noise)
    return made


def logs(made):
    """The two recordings."""
    boxes = {"bridge.log": ("rudder", "shaft", "compass"), "motion.log": ("gyro", "roll")}
    return [
        Recording(
            Path(path), "made", "0" * 64, {name: _channel(name, made[name]) for name in names}
        )
        for path, names in boxes.items()
    ]


def _channel(name, sensor):
    stamps = EPOCH + np.rint(sensor.stamp * 1e9).astype(np.int64)
    return Channel(name, stamps, sensor.y.copy(), clock="made")


def trial(angle, made, sources=SOURCES, clock=None, repair=True):
    """The aligned trial; `clock` is the motion box's."""
    window = (5.0, 1150.0)
    return align(
        f"zigzag-{angle}", "fit", logs(made), list(sources.values()), 0.5, window,
        repair=repair, log_clocks=[None, clock],
    )  # fmt: skip


def held(angle, made):
    """The trial as tables are often merged: at each row the last value received."""
    whole = trial(angle, sensors(angle))
    start = _start(made)
    signals = {}
    for name, source in SOURCES.items():
        sensor = made[source.channel]
        last = np.searchsorted(sensor.stamp, start + whole.t + 1e-9, side="right") - 1
        signals[name] = sensor.y[np.clip(last, 0, None)]
    return replace(whole, signals=signals)


def _start(made):
    """First instant of the trial [s]: what all channels cover, and the window's beginning."""
    return max(made[s.channel].stamp.min() for s in SOURCES.values()) + 5.0


def fitted(trials, settings=SETTINGS):
    """Values of the ten parameters and their standard errors."""
    fit = identify(trials, MODEL, settings)
    assert fit.converged
    subjects = [
        Subject(x.name, x.kind, x.unit, v, v if x.kind == "physical" else x.size)
        for x, v in zip(fit.problem.unknowns, fit.theta, strict=True)
    ]
    found = assess(subjects, fit.psi, fit.residual, stretches(fit.problem), fit.eps_rmsn, 0.0)
    return fit.theta[: len(TEN)], np.array([p.standard_error for p in found.physical])


# --- faults: sensors and a seed to sensors ------------------------------------------------------

FAST = ("rudder", "gyro", "roll")


def jittered(made, rng, rms=0.028):
    return made | {
        name: made[name].stamped(made[name].t + rms * rng.standard_normal(len(made[name].t)))
        for name in FAST
    }


def late_rudder(made, rng, delay=1.0):
    return made | {"rudder": made["rudder"].stamped(made["rudder"].t + delay)}


def slow_roll(made, rng):
    return made | {"roll": made["roll"].kept(slice(None, None, SLOW))}


def dropped(made, rng, share=0.002, rms=0.005):
    lost = {}
    for name in FAST:
        sensor = made[name].kept(rng.random(len(made[name].t)) > share)
        lost[name] = sensor.stamped(sensor.t + rms * rng.standard_normal(len(sensor.t)))
    return made | lost


def numbered(made):
    """Every channel by its number of rows: what is left when stamps are taken for even."""
    return made | {
        name: made[name].stamped(made[name].stamp[0] + FINE * np.arange(len(made[name].t)))
        for name in FAST
    }


def drifting(made, rng, ahead=1.3, drift=500e-6):
    """The motion box's clock is ahead and runs fast."""
    return made | {
        name: made[name].stamped(made[name].t * (1.0 + drift) + ahead) for name in ("gyro", "roll")
    }


def bundled(made, rng, size=5):
    """Delivered by the half second."""
    out = {}
    for name in FAST:
        last = np.minimum(
            np.arange(len(made[name].t)) // size * size + size - 1, len(made[name].t) - 1
        )
        latency = np.repeat(0.01 * rng.random(len(last) // size + 1), size)[: len(last)]
        out[name] = made[name].stamped(made[name].t[last] + latency)
    return made | out


def whole_seconds(made, rng):
    return made | {name: made[name].stamped(np.floor(made[name].t)) for name in FAST}


def set_back(made, rng, by=2.3):
    """The motion box's clock is set back in the middle, with some jitter besides."""
    made = jittered(made, rng, 0.005)
    return made | {
        name: made[name].stamped(made[name].stamp - by * (made[name].t > 700.0))
        for name in ("gyro", "roll")
    }


BY_MATCH = LogClock(match=("gyro", "compass"), within=10.0)


def by_events(ahead=1.3, drift=500e-6):
    """Two shared events that the crew wrote down; seconds from each log's first stamp."""
    made = drifting(sensors(10), None, ahead, drift)
    here = min(made[name].stamp[0] for name in ("gyro", "roll"))
    there = min(made[name].stamp[0] for name in ("rudder", "shaft", "compass"))
    instants = (60.0, 1100.0)
    return LogClock(events=tuple((t * (1 + drift) + ahead - here, t - there) for t in instants))
