"""Logs of a small boat with two thrusters, made by a few lines that are not the program's own."""

from pathlib import Path

import numpy as np

from trialid.inspection import inspect_log
from trialid.ship.estimate import Given
from trialid.workflow.first_pipeline import Starter, starter

PERIOD = 0.1
T = np.arange(0.0, 120.0, PERIOD)


def pushes(seed: int, *, astern: float = 0.0) -> np.ndarray:
    """Shares of full of both thrusters (n, 2), held for 6 s each; some astern by as much."""
    rng = np.random.default_rng(seed)
    steps = rng.uniform(0.35, 0.9, (len(T) // 60, 2))
    steps[5::4] = (-astern, -astern) if astern else steps[5::4]
    return np.repeat(steps, 60, axis=0)


def late(orders: np.ndarray, lag: float) -> np.ndarray:
    """What motors with this time constant [s] make of orders."""
    made = orders.copy()
    for k in range(1, len(made)):
        made[k] += (made[k - 1] - orders[k]) * np.exp(-PERIOD / lag)
    return made


def sailed(acts: np.ndarray) -> dict[str, np.ndarray]:
    """Speeds, heading and rate of turn; 2 m/s of full thrust, ahead and astern alike."""
    u, r, psi = (np.zeros(len(T)) for _ in range(3))
    u[0] = 1.0
    left, right = (acts * np.abs(acts)).T
    for k in range(len(T) - 1):
        u[k + 1] = u[k] + PERIOD * (0.25 * (left[k] + right[k]) - 0.12 * u[k] * abs(u[k]))
        r[k + 1] = r[k] + PERIOD * (0.5 * (left[k] - right[k]) - 0.8 * r[k])
        psi[k + 1] = psi[k] + PERIOD * r[k]
    return {"u": u, "r": r, "psi": psi}


def table(path: Path, columns: dict[str, np.ndarray]) -> Path:
    """A log of these columns, beside the time."""
    rows = np.column_stack([T, *columns.values()])
    head = ",".join(("t [s]", *columns))
    np.savetxt(path, rows, delimiter=",", header=head, comments="", fmt="%.6g")
    return path


def log(path: Path, acts: np.ndarray, logged: np.ndarray, names: tuple[str, str]) -> Path:
    """The log of a boat: her drives as `logged`, rate of turn, speed through the water."""
    seen = sailed(acts)
    rng = np.random.default_rng(len(path.stem))
    drives = dict(zip(names, logged.T, strict=True))
    rate = np.rad2deg(seen["r"]) + 0.1 * rng.standard_normal(len(T))
    speed = seen["u"] + 0.01 * rng.standard_normal(len(T))
    return table(path, {**drives, "yaw_rate_dps": rate, "stw_mps": speed})


def begun(folder: Path, *logs: Path) -> Starter:
    """The first pipeline of logs, written."""
    given = Given(length=2.0)
    made = starter([inspect_log(one) for one in logs], folder / "p.toml", None, given)
    for path, text in made.files.items():
        path.write_text(text, encoding="utf-8")
    return made


def text_of(folder: Path, *logs: Path) -> str:
    """The text of that pipeline."""
    return begun(folder, *logs).files[folder / "p.toml"]
