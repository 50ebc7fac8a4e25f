"""The time series of a run, measured beside predicted, and the CSV file they are kept in."""

import csv
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

import numpy as np

from trialid.arrays import Mask, Vector
from trialid.errors import LogError
from trialid.names import labels
from trialid.names.quantities import SIGNALS, Quantity
from trialid.result.track_series import TrackSeries
from trialid.ship.actuators import SHOWN

_OUTPUT = re.compile(r"(?P<name>.+)_predicted_[^_]+", re.DOTALL)
_INPUT = re.compile(r"(?P<name>.+)_(?P<unit>[^_]+)", re.DOTALL)
WORDS = {labels.unit_word(unit): unit for unit in SHOWN}
"""Units of actuators by how a header writes them; another one stays as it is written."""
KEYS = ("trial", "use", "t_s")


@dataclass(frozen=True)
class OutputSeries:
    """One output of a trial in SI; `compared` is False in gaps, where `measured` means nothing."""

    name: str
    measured: Vector
    predicted: Vector
    compared: Mask

    def __post_init__(self) -> None:
        for array in (self.measured, self.predicted, self.compared):
            array.setflags(write=False)

    @property
    def observed(self) -> Vector:
        """What was measured, NaN in gaps; (N,)."""
        return np.where(self.compared, self.measured, np.nan)

    @property
    def residual(self) -> Vector:
        """Measured minus predicted, NaN in gaps; (N,)."""
        return self.observed - self.predicted


@dataclass(frozen=True, kw_only=True)
class TrialSeries:
    """One trial's clock [s], inputs and outputs in SI; (N,) each; its track where it has one.

    `units` are those of inputs that no dictionary has: of an actuator, or of one's own.
    """

    name: str
    use: Literal["fit", "check"]
    t: Vector
    inputs: Mapping[str, Vector]
    outputs: tuple[OutputSeries, ...]
    track: TrackSeries | None = None
    units: Mapping[str, str] = field(default_factory=dict)

    def quantity(self, name: str) -> Quantity:
        """What an input is: the dictionary's entry, or its name and unit."""
        if name in SIGNALS or name not in self.units:
            return labels.quantity(name)
        unit = self.units[name]
        return Quantity(name, name, unit, SHOWN.get(unit, unit), name)

    def __post_init__(self) -> None:
        for array in (self.t, *self.inputs.values()):
            array.setflags(write=False)


def write_csv(path: str | Path, series: Sequence[TrialSeries]) -> None:
    """One table of all trials, one row a sample; measured and residual are empty in gaps.

    Numbers are written with all their digits, so that a page made from the file is the page made
    from the run.
    """
    tables = [_columns(trial) for trial in series]
    headings = dict.fromkeys([*KEYS, *(heading for table in tables for heading in table)])
    with Path(path).open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(headings)
        for table in tables:
            blank = [""] * len(table["trial"])
            writer.writerows(zip(*(table.get(each, blank) for each in headings), strict=True))


def _columns(trial: TrialSeries) -> dict[str, Sequence[object]]:
    """A trial's part of the table, heading to fields."""
    samples = len(trial.t)
    columns: dict[str, Sequence[object]] = {
        "trial": [trial.name] * samples,
        "use": [trial.use] * samples,
        "t_s": _fields(trial.t),
    }
    columns |= {
        labels.column(name, unit=trial.quantity(name).unit): _fields(values)
        for name, values in trial.inputs.items()
    }
    for output in trial.outputs:
        columns[labels.column(output.name, "measured")] = _fields(output.observed)
        columns[labels.column(output.name, "predicted")] = _fields(output.predicted)
        columns[labels.column(output.name, "residual")] = _fields(output.residual)
    return columns


def _fields(values: Vector) -> list[float | str]:
    return ["" if math.isnan(value) else value for value in values.tolist()]


def read_csv(path: str | Path) -> tuple[TrialSeries, ...]:
    """The trials of a file made by `write_csv`, in its order."""
    headings, rows = _table(Path(path))
    place = headings.index("trial")
    trials: dict[str, list[list[str]]] = {}
    for row in rows:
        trials.setdefault(row[place], []).append(row)
    return tuple(
        _trial(dict(zip(headings, zip(*own, strict=True), strict=True)), str(path))
        for own in trials.values()
    )


def _table(path: Path) -> tuple[list[str], list[list[str]]]:
    """Headings and rows as text, every row as long as the headings."""
    try:
        with path.open(newline="", encoding="utf-8") as stream:
            headings, *rows = csv.reader(stream)
    except (OSError, ValueError, csv.Error) as error:
        raise LogError(f"{path}: cannot be read as a table of time series ({error})") from error
    missing = [key for key in KEYS if key not in headings]
    if missing:
        wanted, found = ", ".join(missing), ", ".join(headings[:8])
        raise LogError(f"{path}: not a series file of trialid: no column {wanted}; found {found}")
    for line, row in enumerate(rows, start=2):
        if len(row) != len(headings):
            expected = f"expected {len(headings)} fields, found {len(row)}"
            raise LogError(f"{path}: row {line} is cut or torn: {expected}")
    return headings, rows


def _trial(columns: Mapping[str, Sequence[str]], path: str) -> TrialSeries:
    """A trial of the signals whose columns hold anything."""
    present = [each for each, fields in columns.items() if each not in KEYS and any(fields)]
    outputs = [match["name"] for each in present if (match := _OUTPUT.fullmatch(each))]
    roles = ("measured", "predicted", "residual")
    spent = {labels.column(output, role) for output in outputs for role in roles}
    others = [each for each in present if each not in spent]
    inputs = {match["name"]: match for each in others if (match := _INPUT.fullmatch(each))}
    own = {n: WORDS.get(m["unit"], m["unit"]) for n, m in inputs.items() if n not in SIGNALS}
    return TrialSeries(
        name=columns["trial"][0],
        use="check" if columns["use"][0] == "check" else "fit",
        t=_values(columns, "t_s", path),
        inputs={
            name: _values(columns, labels.column(name, unit=own.get(name)), path) for name in inputs
        },
        outputs=tuple(_output(columns, name, path) for name in outputs),
        units=own,
    )


def _output(columns: Mapping[str, Sequence[str]], name: str, path: str) -> OutputSeries:
    measured = _values(columns, labels.column(name, "measured"), path)
    predicted = _values(columns, labels.column(name, "predicted"), path)
    return OutputSeries(name, measured, predicted, compared=~np.isnan(measured))


def _values(columns: Mapping[str, Sequence[str]], heading: str, path: str) -> Vector:
    if heading not in columns:
        raise LogError(f"{path}: no column {heading!r}; the units of a series file are SI")
    try:
        return np.array([float(field or "nan") for field in columns[heading]])
    except ValueError as error:
        raise LogError(f"{path}: column {heading!r}: {error}") from error
