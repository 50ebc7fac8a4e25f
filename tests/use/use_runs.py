"""The short run that the tests of this folder use: its pipeline, and its logs."""

import numpy as np
import pandas as pd
import s175q

from trialid.ship.model import ShipModel

RUN = "runs/used"
SPEED = 7.33
SIGNALS = """\
[trial.signals]
delta = { channel = "rudder", unit = "deg", positive = "starboard" }
r = { channel = "rot", unit = "deg/s" }
phi = { channel = "heel", unit = "deg" }
u = { channel = "stw", unit = "m/s" }
"""
PIPELINE = f"""\
ship = "ship.toml"
imo = true
[[trial]]
name = "zigzag-10"
logs = ["zigzag-10.csv"]
{SIGNALS}
[[trial]]
name = "zigzag-20"
logs = ["zigzag-20.csv"]
{SIGNALS}
[align]
period = 0.5
[model]
states = ["v", "p", "r", "phi"]
effects = ["linear_hull", "linear_rudder", "linear_roll"]
[identify]
free = ["Nr", "Nv", "Ndelta", "GM"]
outputs = ["r", "phi"]
[diagnose]
candidates = ["yaw_cubic_rrr", "rudder_servo"]
"""


def log_of(model: ShipModel, amplitude: int, seed: int) -> pd.DataFrame:
    """Five minutes of a zig-zag as a table, with the noise of its sensors."""
    trial = s175q.zigzag(amplitude, model)
    noise = s175q.white(np.random.default_rng(seed), trial.samples)
    trial = s175q.with_noise(trial, *noise)
    columns = {
        "t[s]": trial.t,
        "rudder[deg]": np.rad2deg(trial.signals["delta"]),
        "rot[deg/s]": np.rad2deg(trial.signals["r"]),
        "heel[deg]": np.rad2deg(trial.signals["phi"]),
        "stw[m/s]": np.full(trial.samples, SPEED),
    }
    return pd.DataFrame(columns)[:600]
