"""Records of a ship of another class than the model: the S-175 of Son and Nomoto, all its terms.

Its hull is cubic in sway, yaw and heel, its rudder stands in the race of the propeller and in a
flow that the hull straightens. Nothing of this is in the second-order model that is fitted.
"""

from functools import cache
from pathlib import Path

import numpy as np
from scipy.signal import lfilter

from trialid.effects import CATALOGUE
from trialid.sample import rudder_orders as helm
from trialid.ship.model import ShipModel
from trialid.ship.particulars import read_ship
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial

ROOT = Path(__file__).parent.parent
SHIPS = ROOT / "sample_data" / "ships"
CUBIC = (
    "linear_hull", "centripetal_added_mass", "sway_cubic_vvv", "sway_cubic_cross",
    "sway_cubic_rrr", "yaw_cubic_vvv", "yaw_cubic_cross", "yaw_cubic_rrr", "roll_cubic",
    "heel_sway", "heel_yaw", "roll_rate_yaw", "heel_sway_cubic", "heel_roll_cubic",
    "heel_yaw_cubic", "linear_roll", "heel_roll", "surge_resistance", "surge_turning",
    "surge_heel", "propeller_rudder",
)  # fmt: skip
"""Everything the source has; the tests of the ship check it against figures of another program."""

STATES = ("u", "v", "p", "r", "phi", "psi")
PERIOD = 0.5  # s
SHAFT = 70.0 * 2.0 * np.pi / 60.0  # rad/s
DEG = np.deg2rad(1.0)
NOISE = {"r": 0.05 * DEG, "phi": 0.1 * DEG, "psi": 0.1 * DEG, "u": 0.02}
"""Standard deviations of gyro, inclinometer, compass and log [rad/s, rad, rad, m/s]."""


def ship():
    """The ship that is tried."""
    known = read_ship(SHIPS / "s175.toml")
    return ShipModel(known, STATES, tuple(CATALOGUE[n] for n in CUBIC))


@cache
def _simulator():
    return prepare(ship(), (), ("r", "phi"))


def motion(delta, period):
    """Every state under a rudder, by name; no sea."""
    n = len(delta)
    signals = {"delta": delta, "n": np.full(n, SHAFT)}
    trial = Trial("truth", "fit", period, signals, {})
    response = respond(_simulator(), trial, {}, {"u": 7.33}, sensitivities=False)
    assert response.departure is None, response.departure
    return dict(zip(_simulator().equations.states, response.states.T, strict=True))


@cache
def manoeuvres():
    """Trial to time, rudder and true motion: 20 minutes each, 150 s of them straight on."""

    def heading(delta):
        return motion(delta, helm.PERIOD)["psi"]

    rudders = {
        "zigzag-10": helm.zigzag(10.0, 10.0, heading),
        "zigzag-20": helm.zigzag(20.0, 20.0, heading),
        "binary-15": helm.multi_frequency_binary(15.0, 3),
        "zigzag-15": helm.zigzag(15.0, 15.0, heading),
    }
    every = round(PERIOD / helm.PERIOD)
    made = {}
    for name, delta in rudders.items():
        x = motion(delta, helm.PERIOD)
        t = helm.PERIOD * np.arange(len(delta))
        made[name] = (t[::every], delta[::every], {n: s[::every] for n, s in x.items()})
    return made


def share_of_rudder(term):
    """Of what a model of second order with a slipstream leaves of the true rudder's moment.

    `term` is a function of drift angle, turn rate, rudder and heel, without dimension; what of the
    squares goes with it, in the manoeuvres of `manoeuvres`.
    """
    found = [_without_dimension(delta, x) for _, delta, x in manoeuvres().values()]
    v, r, delta, phi, slowed, moment = np.concatenate(found, axis=1)
    known = [v, r, delta, v * abs(v), v * abs(r), r * abs(r), delta * slowed]

    def left(columns):
        A = np.column_stack(columns)
        return float(np.sum((moment - A @ np.linalg.lstsq(A, moment, rcond=None)[0]) ** 2))

    return 1.0 - left([*known, term(v, r, delta, phi)]) / left(known)


def _without_dimension(delta, x):
    """Drift, turn rate, rudder, heel, slipstream by `rudder_slipstream`, and moment of rudder."""
    true, rudder = ship(), CATALOGUE["propeller_rudder"]
    L, rho, U0 = (true.ship.particulars[n] for n in ("L", "rho", "U0"))
    values = {n: true.value(n) for n in rudder.parameters}
    speed = np.hypot(x["u"], x["v"])
    shaft = np.full(len(delta), SHAFT)
    force = rudder.function(x["u"], x["v"], x["r"], shaft, delta, L=L, rho=rho, **values)
    slowed = x["u"] * (U0 - x["u"]) / speed**2
    moment = force.N / (0.5 * rho * L**3 * speed**2)
    return np.stack([x["v"] / speed, x["r"] * L / speed, delta, x["phi"], slowed, moment])


def white(rng, n):
    """Unit-variance noise without memory."""
    return rng.standard_normal(n)


def waves(rng, n):
    """Unit-variance noise with a narrow band at 0.6 rad/s: the sea in a sensor."""
    pole = np.exp((-0.1 + 1j * np.sqrt(0.99)) * 0.6 * PERIOD)
    e = lfilter([1.0], [1.0, -2.0 * pole.real, abs(pole) ** 2], rng.standard_normal(n + 500))[500:]
    return e / np.std(e)


def write_logs(folder, coloured, seed):
    """A CSV a trial, as a logger on one clock writes it."""
    rng = np.random.default_rng(seed)
    for name, (t, delta, x) in manoeuvres().items():
        seen = {s: x[s] + NOISE[s] * coloured(rng, len(t)) for s in ("r", "phi")}
        seen |= {s: x[s] + NOISE[s] * rng.standard_normal(len(t)) for s in ("psi", "u")}
        table = np.column_stack([t, delta, *seen.values()])
        head = ",".join(["t", "delta", *seen])
        np.savetxt(folder / f"{name}.csv", table, "%.9g", ",", header=head, comments="")


def noise_share(result):
    """What the error would be if nothing but the sensors' noise were left, as eps_RMSn."""
    rms = result.fit.y_rms
    return float(np.sqrt(np.mean([(NOISE[s] / rms[s]) ** 2 for s in rms])))
