"""Long sea trials with a hidden effect, for the workbench: made on the spot, by seed."""

from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.sample import hidden_effect as sample

ROOT: Final = Path(__file__).resolve().parents[2]

Vector = NDArray[np.float64]
PERIOD: Final = 0.1
RATE: Final = np.deg2rad(2.5)

HEAD: Final = """name = "long trials, hidden effect"
ship = "s175q.toml"
[align]
period = 0.1
"""
TRIAL: Final = """
[[trial]]
name = "{name}"
logs = ["{name}.csv"]
use = "{use}"
[trial.signals]
delta = {{ channel = "rudder", unit = "deg", positive = "starboard" }}
r = {{ channel = "rate", unit = "deg/s" }}
phi = {{ channel = "roll", unit = "deg" }}
u = {{ channel = "speed", unit = "m/s" }}
"""


def written(folder: Path, trials: int, samples: int) -> Path:
    """A pipeline of so many trials of so many samples, the last held out; its path."""
    (folder / "s175q.toml").write_bytes((ROOT / "sample_data/ships/s175q.toml").read_bytes())
    text = (ROOT / "pipelines/hidden_effect.toml").read_text(encoding="utf-8")
    model = text[text.index("[model]") :]
    tables = []
    for k in range(trials):
        name = f"long-{k + 1}"
        use = "check" if k == trials - 1 else "fit"
        tables.append(TRIAL.format(name=name, use=use))
        _write_log(folder / f"{name}.csv", samples, seed=k)
    place = folder / "long.toml"
    place.write_text(HEAD + "".join(tables) + "\n" + model, encoding="utf-8")
    return place


def _write_log(place: Path, samples: int, seed: int) -> None:
    """The true motion under a random binary rudder, as sensors log it."""
    rng = np.random.default_rng(seed)
    delta = rudder(samples, np.deg2rad(8.0 + 2.0 * seed), rng)
    ship = sample.ship_model(ROOT / "sample_data/ships/s175q.toml")
    forces = sample.sea(ship, 50 + seed, samples)
    motion = sample.sail(ship, delta, forces)
    deg = np.rad2deg(1.0)
    columns = {
        "time": np.arange(samples) * PERIOD,
        "rudder": deg * delta + 0.02 * rng.standard_normal(samples),
        "rate": deg * motion["r"] + 0.05 * rng.standard_normal(samples),
        "roll": deg * motion["phi"] + 0.1 * rng.standard_normal(samples),
        "speed": motion["u"] + 0.02 * rng.standard_normal(samples),
    }
    table = np.column_stack(list(columns.values()))
    head = ",".join(columns)
    np.savetxt(place, table, fmt="%.5f", delimiter=",", header=head, comments="")


def rudder(samples: int, angle: float, rng: np.random.Generator) -> Vector:
    """Plus or minus one angle, held for 20 to 80 s, turned at the steering gear's rate."""
    holds = rng.uniform(20.0, 80.0, int(samples * PERIOD / 20.0) + 1)
    switches = np.searchsorted(np.cumsum(holds), np.arange(samples) * PERIOD)
    order = angle * np.where(switches % 2, 1.0, -1.0) * (switches > 1)
    made = np.zeros(samples)
    for k in range(1, samples):
        step = np.clip(order[k] - made[k - 1], -RATE * PERIOD, RATE * PERIOD)
        made[k] = made[k - 1] + step
    return made
