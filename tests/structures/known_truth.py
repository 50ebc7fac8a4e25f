"""Trials of ships whose structure is known: steps of the rudder, the speed recorded, noise."""

from pathlib import Path

import numpy as np

from trialid.effects import CATALOGUE
from trialid.ship.model import ShipModel
from trialid.ship.particulars import read_ship
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial

ROOT = Path(__file__).parents[2]
SHIP = ROOT / "sample_data" / "ships" / "s175q.toml"
SURGE = ("propeller_thrust", "surge_resistance", "surge_turning", "surge_rudder")
LINEAR = ("linear_hull", "linear_rudder", "centripetal_added_mass")
RACE = {"rudder_slipstream": {"N_slip": 0.0015, "z_slip": 0.03}}
MODULUS = {"sway_drag_vav": {"Yvav": -0.05}, "yaw_drag_rar": {"Nrar": -0.0014}}
CUBIC = {
    "sway_cubic_vvv": {"Yvvv": -0.3},
    "yaw_cubic_cross": {"Nvvr": -0.04, "Nvrr": 0.004},
    "yaw_cubic_rrr": {"Nrrr": -0.003},
}
TRUTHS = {
    "linear": {},
    "linear, race": RACE,
    "modulus": MODULUS,
    "modulus, race": MODULUS | RACE,
    "cubic": CUBIC,
    "cubic, race": CUBIC | RACE,
    "cross-flow": {"cross_flow_drag": {"C_D": 0.9}},
    "cross-flow, race": {"cross_flow_drag": {"C_D": 0.9}} | RACE,
}
"""Structure to the values of its effects; of modulus and cubic the terms that matter most."""

OUTSIDE = {
    "stalling": CUBIC | RACE | {"rudder_stall": {"N_stall": -0.0015, "delta_stall": 0.3}},
    "five effects": {
        "cross_flow_drag": {"C_D": 0.6},
        "yaw_cubic_cross": {"Nvvr": -0.05, "Nvrr": 0.004},
        "rudder_cubic": {"Yddd": 0.002, "Nddd": -0.001},
        "rudder_flow_asymmetry": {"N_flow": 0.0002, "l_flow": -0.8},
        **RACE,
    },
}
"""Ships that no usual structure holds."""

PERIOD, DURATION = 1.0, 600.0  # s
DEG = np.deg2rad(1.0)
NOISE = {"r": 0.02 * DEG, "v": 0.05, "u": 0.02}  # rad/s, m/s, m/s
SHAFT = 70.0 * 2.0 * np.pi / 60.0
ANGLES = (10.0, 20.0, 15.0, 25.0, 5.0, 30.0, 12.0)

PIPELINE = """
name = "steps of the rudder"
ship = "s175q.toml"
{trials}
[signals]
delta = {{ channel = "delta", unit = "rad", positive = "starboard" }}
r = {{ channel = "r", unit = "rad/s" }}
v = {{ channel = "v", unit = "m/s" }}
u = {{ channel = "u", unit = "m/s" }}
[align]
period = 1.0
[model]
states = ["v", "r"]
effects = ["linear_hull", "linear_rudder", "centripetal_added_mass"]
[identify]
free = ["Yv", "Nv", "Nr", "Ndelta"]
outputs = ["r", "v"]
nuisance = ["initial_state"]
"""
TRIAL = """
[[trial]]
name = "{name}"
logs = ["{name}.csv"]
use = "{use}"
"""


def ship(truth):
    """The ship of this structure, her speed simulated."""
    extra = (TRUTHS | OUTSIDE)[truth]
    values = {name: x for each in extra.values() for name, x in each.items()}
    effects = (*LINEAR, *SURGE, *extra)
    return ShipModel(read_ship(SHIP), ("u", "v", "r"), tuple(CATALOGUE[e] for e in effects), values)


def rudder(rng, angle):
    """Steps to either side every 20 to 60 s, at the gear's 2.5 deg/s; [rad]."""
    t = np.arange(0.0, DURATION, PERIOD)
    ends = 50.0 + np.cumsum(rng.uniform(20.0, 60.0, 40))
    ordered = np.where(t < 50.0, 0.0, angle * (-1.0) ** np.searchsorted(ends, t))
    at = np.zeros(len(t))
    for k in range(1, len(t)):
        at[k] = at[k - 1] + np.clip(ordered[k] - at[k - 1], -2.5 * PERIOD, 2.5 * PERIOD)
    return at * DEG


def table(truth, angle, rng, noise=1.0):
    """Time, rudder, r, v and u as recorded; (N, 5)."""
    delta = rudder(rng, angle)
    n = len(delta)
    trial = Trial("truth", "fit", PERIOD, {"delta": delta, "n": np.full(n, SHAFT)}, {})
    simulator = prepare(ship(truth), (), ("r", "v"), substeps=4)
    response = respond(simulator, trial, {}, {"u": 7.33}, sensitivities=False)
    assert response.departure is None, response.departure
    x = dict(zip(simulator.equations.states, response.states.T, strict=True))
    seen = [x[s] + noise * NOISE[s] * rng.standard_normal(n) for s in ("r", "v", "u")]
    return np.column_stack([trial.t, delta, *seen])


def write_trials(folder, truth, seed, trials=5, checks=0, added="", noise=1.0):
    """Logs, ship and pipeline in a folder; the pipeline's path."""
    rng = np.random.default_rng(seed)
    (folder / "s175q.toml").write_bytes(SHIP.read_bytes())
    text = ""
    for i, angle in enumerate(ANGLES[: trials + checks]):
        name = f"steps-{angle:g}"
        made = table(truth, angle, rng, noise)
        head = "t,delta,r,v,u"
        np.savetxt(folder / f"{name}.csv", made, "%.9g", ",", header=head, comments="")
        text += TRIAL.format(name=name, use="fit" if i < trials else "check")
    path = folder / "known.toml"
    path.write_text(PIPELINE.format(trials=text) + added, encoding="utf-8")
    return path
