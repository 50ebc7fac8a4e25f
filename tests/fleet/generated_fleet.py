"""Ships drawn about S175Q, their voyages sailed by the simulator, logged in several formats."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pandas as pd

from trialid.effects import CATALOGUE
from trialid.fleet.do_run import do_run
from trialid.sample.log_writers import write_csv, write_json_mcap
from trialid.ship.model import ShipModel
from trialid.ship.particulars import read_ship
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial

ROOT = Path(__file__).parents[2]
SHIP = ROOT / "sample_data" / "ships" / "s175q.toml"
EFFECTS = (
    "linear_hull",
    "linear_rudder",
    "linear_roll",
    "heel_roll",
    "heel_sway",
    "heel_yaw",
    "roll_rate_yaw",
    "sway_drag_vav",
    "yaw_drag_rar",
    "centripetal_added_mass",
    "propeller_thrust",
    "surge_resistance",
    "surge_turning",
    "surge_rudder",
)
STATES = ("u", "v", "p", "r", "phi")
OUTPUTS = ("u", "r", "phi")
DEG = np.deg2rad(1.0)
NOISE = {"u": 0.03, "r": 0.02 * DEG, "phi": 0.1 * DEG}
"""Sensors: m/s, rad/s, rad."""
PERIOD, DURATION = 1.0, 400.0
FORMATS = ("csv", "mcap", "parquet")
ANGLES = {"steps-10": 10.0, "steps-20": 20.0}

TEMPLATE = """name = "steps of the rudder"
ship = "{ship}"

[[trial]]
name = "steps-10"
logs = ["{logs}/steps-10.{form}"]

[[trial]]
name = "steps-20"
logs = ["{logs}/steps-20.{form}"]  # the wider one

[signals]
delta = {{ channel = "{delta}", unit = "rad", positive = "starboard" }}
n = {{ channel = "{n}", unit = "rad/s" }}
u = {{ channel = "{u}", unit = "m/s" }}
r = {{ channel = "{r}", unit = "rad/s" }}
phi = {{ channel = "{phi}", unit = "rad" }}

[align]
period = {period}

[model]
states = ["u", "v", "p", "r", "phi"]
effects = {effects}

[identify]
free = {free}
outputs = ["u", "r", "phi"]
nuisance = ["initial_state"]

[diagnose]
candidates = {candidates}
"""


def drawn_ship(folder: Path, seed: int) -> Path:
    """The file of a ship of drawn size: S175Q to another scale, at the same Froude number."""
    scale = float(np.random.default_rng([seed, 1]).uniform(0.5, 1.6))
    text = SHIP.read_text(encoding="utf-8").replace('"S175Q"', f'"ship {seed}"')
    lengths = {"L = 175.0": 175.0, "B = 25.40": 25.4, "T = 8.5": 8.5, "D_P = 6.533": 6.533}
    for line, value in lengths.items():
        text = text.replace(line, f"{line.partition('=')[0]}= {value * scale:.6g}")
    text = text.replace("nabla = 21222.0", f"nabla = {21222.0 * scale**3:.8g}")
    text = text.replace("U0 = 7.33", f"U0 = {7.33 * scale**0.5:.6g}")
    text = text.replace("GM = 0.3", f"GM = {0.3 * scale:.6g}")
    path = folder / f"ship-{seed}.toml"
    path.write_text(text, encoding="utf-8")
    return path


def write_voyage(
    folder: Path,
    ship: Path,
    seed: int,
    form: str = "csv",
    values: Mapping[str, float] | None = None,
    hidden: str | None = None,
) -> None:
    """The logs of a voyage: both trials of a ship with these values and an effect more."""
    folder.mkdir(parents=True)
    names = (*EFFECTS, *([hidden] if hidden else []))
    model = ShipModel(read_ship(ship), STATES, tuple(CATALOGUE[name] for name in names))
    model = model.with_values(values or {})
    for name, angle in ANGLES.items():
        rng = np.random.default_rng([seed, *name.encode()])
        columns = _sailed(model, angle, rng)
        _write(folder / f"{name}.{form}", columns)


def _sailed(model: ShipModel, angle: float, rng: np.random.Generator) -> dict[str, np.ndarray]:
    p = model.ship.particulars
    speed, long = p["U0"], p["L"]
    count = round(DURATION / PERIOD)
    hold = long / speed  # a ship's length
    t = np.arange(count) * PERIOD
    change = np.floor(np.maximum(t - 2.0 * hold, 0.0) / (2.0 * hold)).astype(int)
    sides = np.where(np.arange(change.max() + 1) % 2, 1.0, -1.0)
    order = np.where(t < 2.0 * hold, 0.0, angle * DEG * sides[change])
    delta = np.zeros(count)
    for k in range(1, count):
        delta[k] = delta[k - 1] + np.clip(order[k] - delta[k - 1], -2.5 * DEG, 2.5 * DEG)
    n = np.full(count, 70.0 * 2.0 * np.pi / 60.0 / (long / 175.0) ** 0.5)
    blank = Trial("", "fit", PERIOD, {"delta": delta, "n": n}, {})
    motion = respond(prepare(model, (), OUTPUTS), blank, {}, {"u": speed}, sensitivities=False)
    assert motion.departure is None, motion.departure
    noisy = {
        c: motion.y[:, i] + NOISE[c] * rng.standard_normal(count) for i, c in enumerate(OUTPUTS)
    }
    return {"t": t, "delta": delta, "n": n, **noisy}


def _write(path: Path, columns: dict[str, np.ndarray]) -> None:
    t, signals = columns["t"], {name: y for name, y in columns.items() if name != "t"}
    if path.suffix == ".csv":
        write_csv(path, t, signals)
    elif path.suffix == ".parquet":
        pd.DataFrame(columns).to_parquet(path, index=False)
    else:
        stamps = (t * 1e9).astype(np.int64) + 1_700_000_000 * 10**9
        write_json_mcap(path, {f"/{name}": (stamps, y) for name, y in signals.items()})


def template(
    folder: Path,
    ship: str,
    logs: str,
    form: str = "csv",
    *,
    free: str = '["Nr", "Ndelta"]',
    candidates: str = '"none"',
    effects: tuple[str, ...] = EFFECTS,
) -> Path:
    """A pipeline for voyages of one format."""
    shown = {
        name: f"/{name}:value" if form == "mcap" else name for name in ("delta", "n", *OUTPUTS)
    }
    text = TEMPLATE.format(
        ship=ship,
        logs=logs,
        form=form,
        period=PERIOD,
        free=free,
        candidates=candidates,
        effects=str(list(effects)).replace("'", '"'),
        **shown,
    )
    path = folder / f"template-{form}.toml"
    path.write_text(text, encoding="utf-8")
    return path


def one_by_one(tasks, packed):
    """Runs done in this process, one after another."""
    for task in tasks:
        yield task, do_run(packed(task))


def contents(folder: Path) -> dict[str, bytes]:
    """Every file below a folder by its name from there, the lists of files apart."""
    return {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file() and path.name != ".trialid-files.json"
    }
