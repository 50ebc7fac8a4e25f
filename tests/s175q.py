"""The reference ship of the tests: S175Q in the zig-zags of an independent implementation."""

from pathlib import Path

import numpy as np

from trialid.effects import CATALOGUE
from trialid.identification.problem import Settings
from trialid.ship.model import ShipModel
from trialid.ship.particulars import read_ship
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial

ROOT = Path(__file__).parent.parent
REFERENCE = ROOT / "tests" / "reference"
SHIP = read_ship(ROOT / "sample_data" / "ships" / "s175q.toml")
EFFECTS = (
    "linear_hull", "linear_rudder", "linear_roll", "heel_roll", "heel_sway", "heel_yaw",
    "roll_rate_yaw", "sway_drag_vav", "sway_drag_var", "yaw_drag_vav", "yaw_drag_var",
    "yaw_drag_rar", "roll_drag_vav", "roll_drag_var", "centripetal_added_mass",
    "propeller_thrust", "surge_resistance", "surge_turning", "surge_rudder",
)  # fmt: skip
MODEL = ShipModel(SHIP, ("u", "v", "p", "r", "phi"), tuple(CATALOGUE[e] for e in EFFECTS))
TEN = ("Nv", "Nr", "Ndelta", "Yv", "Ydelta", "Yvav", "Nvav", "Nrar", "Yvar", "Nvar")
OUTPUTS = ("r", "phi")
SHAFT = 70.0 * 2.0 * np.pi / 60.0
AMPLITUDES = {2: 1, 5: 2, 10: 3, 20: 4}
"""Zig-zag angle [deg] to the column of the recorded rudder."""

SETTINGS = Settings(TEN, OUTPUTS, nuisance=("initial_state",))
GYRO, INCLINOMETER = np.deg2rad(0.05), np.deg2rad(0.1)


def zigzag(amplitude, model=MODEL, use="fit"):
    """The trial without noise: recorded rudder, simulated r and phi."""
    table = np.loadtxt(REFERENCE / "zz_rudder_deg.csv", delimiter=",", comments="#")
    delta = np.deg2rad(table[:, AMPLITUDES[amplitude]])
    n = len(delta)
    signals = {"delta": delta, "n": np.full(n, SHAFT), "r": np.zeros(n), "phi": np.zeros(n)}
    valid = {name: np.ones(n, dtype=bool) for name in signals}
    name = f"zigzag-{amplitude}"
    blank = Trial(name, use, 0.5, dict(signals), valid)
    y = respond(prepare(model, (), OUTPUTS), blank, {}, {"u": 7.33}, sensitivities=False).y
    return Trial(name, use, 0.5, {**signals, "r": y[:, 0].copy(), "phi": y[:, 1].copy()}, valid)


def with_noise(trial, r, phi):
    """The trial with noise added to its outputs."""
    signals = {**trial.signals, "r": trial.signals["r"] + r, "phi": trial.signals["phi"] + phi}
    return Trial(trial.name, trial.use, trial.period, signals, trial.valid)


def white(rng, n):
    """White sensor noise of r and phi."""
    return GYRO * rng.standard_normal(n), INCLINOMETER * rng.standard_normal(n)


def waves(rng, n, period=0.5):
    """Noise with a narrow band at 0.6 rad/s: the sea in r and phi."""
    from scipy.signal import lfilter

    pole = np.exp((-0.1 + 1j * np.sqrt(0.99)) * 0.6 * period)
    parts = []
    for sigma in (GYRO, INCLINOMETER):
        e = lfilter([1.0], [1.0, -2.0 * pole.real, abs(pole) ** 2], rng.standard_normal(n + 500))
        parts.append(sigma * e[500:] / np.std(e[500:]))
    return tuple(parts)
