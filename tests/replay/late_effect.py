"""Records of a ship that loses part of its rudder's force in the middle of one of them."""

from pathlib import Path

import numpy as np

from trialid.sample import hidden_effect as make
from trialid.sample.rudder_orders import DURATION, PERIOD, multi_frequency_binary, zigzag
from trialid.sample.sample_sensors import sensors, write_table
from trialid.ship.model import ShipModel
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial

ROOT = Path(__file__).parent.parent.parent
SHIP = ROOT / "sample_data" / "ships" / "s175q.toml"
PIPELINE = """
ship = "s175q.toml"
[[trial]]
name = "before"
logs = ["before.csv"]
[[trial]]
name = "binary"
logs = ["binary.csv"]
[[trial]]
name = "halfway"
logs = ["halfway.csv"]
use = "check"
[signals]
delta = { channel = "rudder", unit = "deg", positive = "starboard" }
r = { channel = "rot", unit = "deg/min" }
phi = { channel = "heel", unit = "deg" }
u = { channel = "stw", unit = "kn" }
[align]
period = 0.5
[model]
states = ["v", "p", "r", "phi"]
effects = [
  "linear_hull", "linear_rudder", "linear_roll", "centripetal_added_mass",
  "heel_roll", "heel_sway", "heel_yaw", "roll_rate_yaw",
  "sway_drag_vav", "sway_drag_var", "yaw_drag_vav", "yaw_drag_var", "yaw_drag_rar",
  "roll_drag_vav", "roll_drag_var",
]
[identify]
free = ["Yv", "Nv", "Nr", "Ndelta", "Kv", "Kr", "Kdelta", "Kp", "GM", "Yvav", "Nrar"]
outputs = ["r", "phi"]
nuisance = ["initial_state", "bias", "rudder_offset", "delay"]
"""


def ship(lost=0.0):
    """The ship of the samples without their hidden effect, less a share of her rudder's force."""
    model = make.ship_model(SHIP)
    effects = tuple(e for e in model.effects if e.name != make.HIDDEN[0])
    values = {"delta_0": make.OFFSET, "scale_ext": 1.0}
    values |= {n: (1.0 - lost) * model.value(n) for n in ("Ydelta", "Kdelta", "Ndelta")}
    return ShipModel(model.ship, model.states, effects, values)


def write_log(path, delta, seed, lost=0.0, onset=0.0):
    """One log of the ship in her sea; from `onset` [s] on she lacks a share of her rudder."""
    sea = make.sea(ship(), seed, len(delta))
    motion = make.sail(ship(), delta, sea)
    if lost:
        motion = joined(motion, damaged(ship(lost), delta, sea, motion, onset), onset)
    write_table(path, sensors(motion, delta, seed))


def damaged(model, delta, sea, motion, onset):
    """The motion of another ship that takes over where the first one is."""
    k = round(onset / PERIOD)
    forces = {name: force[k:] for name, force in sea.items()}
    n = len(delta) - k
    signals = {"delta": delta[k:], "n": np.full(n, make.SHAFT), "u": motion["u"][k:], **forces}
    start = {name: float(x[k]) for name, x in motion.items()}
    trial = Trial("damaged", "fit", PERIOD, signals, {})
    response = respond(prepare(model, (), ("r", "phi")), trial, {}, start, sensitivities=False)
    assert response.departure is None
    return dict(zip(model.all_states, response.states.T, strict=True))


def joined(before, after, onset):
    k = round(onset / PERIOD)
    return {name: np.concatenate([x[:k], after[name]]) for name, x in before.items()}


def rudders():
    """Rudder records by name: two to fit, one to replay."""
    calm = ship()
    n = round(DURATION / PERIOD) + 1
    still = {k: 0.0 * f for k, f in make.sea(calm, 0, n).items()}

    def heading_of(delta):
        return make.sail(calm, delta, still)["psi"]

    return {
        "before": zigzag(20.0, 20.0, heading_of),
        "binary": multi_frequency_binary(15.0, 3),
        "halfway": zigzag(15.0, 10.0, heading_of),
    }


def write(folder, lost, onset, seed=0, delta=None):
    """Logs, ship and pipeline; the pipeline's path."""
    delta = delta or rudders()
    for i, (name, angle) in enumerate(delta.items()):
        share = lost if name == "halfway" else 0.0
        write_log(folder / f"{name}.csv", angle, 100 * seed + i + 1, share, onset)
    (folder / "s175q.toml").write_bytes(SHIP.read_bytes())
    (folder / "late.toml").write_text(PIPELINE, encoding="utf-8")
    return folder / "late.toml"
