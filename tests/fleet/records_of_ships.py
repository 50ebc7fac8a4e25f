"""Records of one parameter made up: rows of a ship's voyages, and estimates with odd ones."""

from collections.abc import Sequence
from datetime import date, timedelta

import numpy as np

from trialid.fleet.changes.courses import Estimates
from trialid.result.fleet_rows import FittedRow, RunRow

WIDE = 0.05
"""Half of each likely range."""
FIRST = date(2023, 1, 10)


def estimates(x: np.ndarray, seed: int, scatter: float = 0.5) -> Estimates:
    """Estimates about these, scattering by a share of what their likely ranges stand for."""
    noise = np.random.default_rng(seed).standard_normal(len(x))
    return Estimates(x + scatter * noise, np.ones(len(x)), least=0.1 * scatter**2)


def rows_of(
    x: Sequence[float] | np.ndarray,
    days: Sequence[int] | None = None,
    seed: int = 0,
    **own: str,
) -> tuple[list[RunRow], list[FittedRow]]:
    """Rows of a ship whose GM is so, voyage by voyage, on these days after the first."""
    noise = 0.1 * WIDE * np.random.default_rng(seed).standard_normal(len(x))
    runs, fitted = [], []
    for k, value in enumerate(np.asarray(x) + noise):
        when = None if days is None else FIRST + timedelta(days=days[k])
        label = {"run": f"ann {k}", "ship": "ann", "voyage": f"trip {k}", "date": when}
        runs.append(RunRow(**label, **{"verdict": "nothing missing", **own}))
        ends = {"likely_low": value - WIDE, "likely_high": value + WIDE}
        kind = {"parameter": "GM", "kind": "physical", "unit": "m", "standard_error": 0.1 * WIDE}
        fitted.append(FittedRow(**label, **kind, value=value, **ends))
    return runs, fitted
