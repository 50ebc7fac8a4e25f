"""Aligned trials as columns, and as a CSV file that `trialid` itself reads back."""

import csv
import json
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from trialid.arrays import Vector
from trialid.names import labels
from trialid.trial import Trial


def masked_signals(trial: Trial) -> dict[str, Vector]:
    """Quantity to values in SI, NaN where nothing was measured; (N,) each."""
    return {
        name: np.where(trial.valid[name], values, np.nan) for name, values in trial.signals.items()
    }


def heading(name: str, unit: str | None = None) -> str:
    """A column of a CSV file, its unit where our own reader and people find it.

    >>> heading("r"), heading("left", "N")
    ('r[rad/s]', 'left[N]')
    """
    return f"{name}[{unit or labels.quantity(name).unit}]"


def units(provenance: Mapping[str, Any]) -> dict[str, str]:
    """The unit of each signal, as its ship has it."""
    return {n: s["unit"] for t in provenance["trials"] for n, s in t["signals"].items()}


def quantities(trials: Sequence[Trial]) -> tuple[str, ...]:
    """Every quantity any trial has, in the order of the first that has it."""
    return tuple(dict.fromkeys(name for trial in trials for name in trial.signals))


def write_csv(path: Path, trials: Sequence[Trial], provenance: Mapping[str, Any]) -> None:
    """One row a sample, all digits; a trial's time begins at zero. Provenance goes beside it."""
    names, known = quantities(trials), units(provenance)
    with path.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(["trial", "t[s]", *(heading(n, known.get(n)) for n in names)])
        for trial in trials:
            values = masked_signals(trial)
            blank = [""] * trial.samples
            columns = [_fields(values[name]) if name in values else blank for name in names]
            label = [trial.name] * trial.samples
            writer.writerows(zip(label, trial.t.tolist(), *columns, strict=True))


def _fields(values: Vector) -> Sequence[float | str]:
    return ["" if math.isnan(value) else value for value in values.tolist()]


def write_provenance(path: Path, provenance: Mapping[str, Any]) -> None:
    """The provenance as JSON."""
    text = json.dumps(provenance, indent=2, ensure_ascii=False, allow_nan=False)
    path.write_text(f"{text}\n", encoding="utf-8")
