"""Aligned trials as a MATLAB file: one struct a trial."""

import json
import keyword
import re
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from trialid.export.csv_file import masked_signals, units
from trialid.names import labels
from trialid.trial import Trial

LONGEST = 63
"""Letters of a MATLAB name."""


def write_mat(path: Path, trials: Sequence[Trial], provenance: Mapping[str, Any]) -> None:
    """A struct a trial, columns as `delta_rad`, NaN where nothing was measured; version 5."""
    from scipy.io import savemat

    names = variables(trial.name for trial in trials)
    known = units(provenance)
    structs = {name: _struct(trial, known) for name, trial in zip(names, trials, strict=True)}
    text = json.dumps(provenance, ensure_ascii=True, allow_nan=False)
    savemat(path, {**structs, "provenance": text}, long_field_names=True, oned_as="column")


def _struct(trial: Trial, known: Mapping[str, str]) -> dict[str, Any]:
    measured = masked_signals(trial).items()
    columns = {labels.column(name, unit=known.get(name)): values for name, values in measured}
    remarks = np.array(trial.remarks, dtype=object)
    return {
        "name": trial.name,
        "use": trial.use,
        "period_s": trial.period,
        "t_s": trial.t,
        **columns,
        "remarks": remarks,
    }


def variables(names: Iterable[str]) -> list[str]:
    """A MATLAB name for each: a letter first, letters and digits, none twice.

    >>> variables(["zigzag-20", "zigzag 20", "10/10", "provenance"])
    ['zigzag_20', 'zigzag_20_2', 'trial_10_10', 'provenance_2']
    """
    taken = {"provenance"}
    found: list[str] = []
    for name in names:
        word = re.sub(r"\W", "_", name, flags=re.ASCII)[: LONGEST - 10]
        stem = word if word[:1].isalpha() and not keyword.iskeyword(word) else f"trial_{word}"
        word, count = stem, 1
        while word in taken:
            count += 1
            word = f"{stem}_{count}"
        taken.add(word)
        found.append(word)
    return found
