"""Healthy records of many kinds: the reference ship simulated, her sensors as boats have them."""

from functools import cache
from typing import NamedTuple

import numpy as np
import s175q
from scipy.interpolate import PchipInterpolator
from scipy.signal import lfilter

from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial

MANOEUVRES = ("zigzag 5", "zigzag 10", "zigzag 20", "circle", "pull-out", "random", "straight")
SIZES = (1.0, 0.4, 0.15)
"""Froude's time scales: the ship of 175 m, a boat of 28 m, a model of 4 m."""
PERIOD = 0.5


class Record(NamedTuple):
    """What was sailed, and quantity to stamps [s] and values [SI] as the sensors gave them."""

    story: str
    channels: dict[str, tuple[np.ndarray, np.ndarray]]


def rudder(manoeuvre, rng):
    """Rudder angle [rad] every half second."""
    if manoeuvre.startswith("zigzag"):
        return s175q.zigzag(int(manoeuvre.split()[1])).signals["delta"].copy()
    n = 1200
    order = np.zeros(n)
    size = np.deg2rad(rng.uniform(5, 25)) * rng.choice([-1, 1])
    if manoeuvre in {"circle", "pull-out"}:
        order[60 : 600 if manoeuvre == "pull-out" else n] = size
    elif manoeuvre == "random":
        order = np.repeat(np.deg2rad(rng.uniform(-12, 12, n // 40)), 40)
    else:
        order = np.deg2rad(0.5) * np.repeat(rng.normal(size=n // 20), 20)
    delta, step = np.zeros(n), np.deg2rad(3.0) * PERIOD
    for k in range(1, n):
        delta[k] = delta[k - 1] + np.clip(order[k] - delta[k - 1], -step, step)
    return delta


@cache
def simulated(manoeuvre, seed):
    """Rudder, u, r, phi [SI] every half second, by the project's own simulator."""
    delta = rudder(manoeuvre, np.random.default_rng([seed, MANOEUVRES.index(manoeuvre)]))
    n = len(delta)
    names = "u", "r", "phi"
    signals = {"delta": delta, "n": np.full(n, s175q.SHAFT), **{q: np.zeros(n) for q in names}}
    valid = {name: np.ones(n, dtype=bool) for name in signals}
    blank = Trial(manoeuvre, "fit", PERIOD, signals, valid)
    simulator = prepare(s175q.MODEL, (), names)
    y = respond(simulator, blank, {}, {"u": 7.33}, sensitivities=False).y
    return {"delta": delta} | {name: y[:, i].copy() for i, name in enumerate(names)}


def record(seed):
    """One healthy record; manoeuvre, size of the ship, sea and sensors drawn from the seed."""
    rng = np.random.default_rng(seed)
    manoeuvre = MANOEUVRES[seed % len(MANOEUVRES)]
    size = float(rng.choice(SIZES))
    sea = rng.choice([0.0, 1.0, 5.0])
    truth = _motion(simulated(manoeuvre, seed // len(MANOEUVRES) % 3), size, sea, rng)
    smooth = rng.uniform(0.5, 5.0) if rng.random() < 0.2 else 0.0
    channels = {q: _sensor(q, *truth, size, rng) for q in ("delta", "u", "phi", "p", "psi")}
    channels["r"] = _sensor("r", *truth, size, rng, smooth)
    if rng.random() < 0.5:
        del channels["p"]
    sailed = f"{seed}: {manoeuvre}, size {size}, sea {sea}, r smoothed by {smooth:.1f} s"
    return Record(sailed, channels)


def _motion(ship, size, sea, rng):
    """Stamps [s] ten times a half second and the motion there: the ship's, and the sea's."""
    n = len(ship["r"])
    coarse = np.arange(n) * PERIOD * size
    t = np.arange((n - 1) * 10 + 1) * PERIOD * size / 10
    waves = [PchipInterpolator(coarse, w)(t) for w in s175q.waves(rng, n)]
    y = {q: PchipInterpolator(coarse, ship[q])(t) for q in ("u", "r", "phi")}
    y["delta"] = np.interp(t, coarse, ship["delta"])
    y["u"], y["r"] = y["u"] * size, (y["r"] + sea * waves[0]) / size
    y["phi"] = y["phi"] + 5 * sea * waves[1]
    y["p"] = np.gradient(y["phi"], t)
    y["psi"] = rng.uniform(0, 6) + np.cumsum(y["r"]) * (t[1] - t[0])
    return t, y


NOISE = {"delta": 0.05, "phi": 0.1, "psi": 0.1, "r": 0.05, "p": 0.1, "u": 0.02}
"""[deg, deg/s, m/s] White noise of a common sensor."""
STEPS = {"delta": (0, 0.1, 1), "phi": (0, 0.1), "psi": (0, 0.1, 1), "r": (0, 0.01), "p": (0, 0.1)}
"""[deg, deg/s] Resolutions."""


def _sensor(quantity, t, y, size, rng, smooth=0.0):
    """What a sensor makes of the motion: late samples, noise, steps, an offset."""
    step = (t[1] - t[0]) * rng.choice([1, 2, 5, 10])
    at = np.arange(0, t[-1], step) + rng.uniform(0, step) + 0.02 * step * rng.normal()
    at = at[(at > 0) & (at < t[-1])]
    truth = y[quantity]
    if smooth:
        pole = np.exp(-(t[1] - t[0]) / smooth)
        for _ in range(2):
            truth = lfilter([1 - pole], [1, -pole], truth)
    unit = 1.0 if quantity == "u" else np.deg2rad(1.0)
    faster = 1 / size if quantity in {"r", "p"} else size if quantity == "u" else 1.0
    noise = NOISE[quantity] * unit * faster * rng.uniform(0.1, 3.0)
    value = np.interp(at, t, truth) + noise * rng.normal(size=len(at))
    value += rng.normal() * 2 * NOISE[quantity] * unit * faster
    resolution = rng.choice(STEPS.get(quantity, (0, 0.01))) * unit * faster
    value = np.round(value / resolution) * resolution if resolution else value
    return at, np.mod(value, 2 * np.pi) if quantity == "psi" else value
