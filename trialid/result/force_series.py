"""The missing force as plain data and as a table of time series."""

import csv
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from trialid.arrays import Vector
from trialid.diagnosis.force.force_shape import ShapeTerm
from trialid.diagnosis.force.missing_force import Equation, MissingForce
from trialid.errors import LogError
from trialid.names import labels
from trialid.result.finding_rows import ForceEquationRow, MissingForcePart, ShapeTermRow

SHOWN = ("delta", "v", "r", "p", "phi", "u", "psi")
"""Signals that a force is shown against."""

UNITS = {"X": "N", "Y": "N", "K": "N m", "N": "N m"}


@dataclass(frozen=True)
class ForceSeries:
    """One trial's missing force by equation [SI], its standard error, its terms, and signals."""

    trial: str
    t: Vector
    force: Mapping[str, Vector]
    error: Mapping[str, Vector]
    terms: Mapping[str, Vector]
    signals: Mapping[str, Vector]


def missing_force_part(found: MissingForce) -> MissingForcePart:
    """What goes into `result.json`."""
    return MissingForcePart(
        equations=tuple(_equation(e) for e in found.equations),
        named=found.named,
        possible=tuple(found.possible),
        effects=tuple(found.effects),
        sentence=found.sentence,
    )


def _equation(e: Equation) -> ForceEquationRow:
    return ForceEquationRow(
        equation=e.row,
        unit=UNITS[e.row],
        explains=e.explains,
        log_likelihood_ratio=0.5 * e.gain,
        p_value=e.p_value,
        shape=tuple(_term(t) for t in e.shape.terms),
        symmetry=e.shape.symmetry if e.shape.terms else None,
        signals=tuple(e.shape.signals),
        shape_explains=e.shape.explains if e.shape.terms else None,
        terms_tried=len(e.shape.tried),
        sentence=e.shape.sentence if e.shape.tried else "no more than noise would show",
    )


def _term(t: ShapeTerm) -> ShapeTermRow:
    return ShapeTermRow(
        name=t.name,
        term=t.term.words,
        coefficient=t.coefficient,
        standard_error=t.error,
        share=t.share,
        p_value=t.p_value,
        symmetry=t.term.mirror,
        rivals=tuple(r.words for r in t.rivals),
    )


def force_series(found: MissingForce) -> tuple[ForceSeries, ...]:
    """The missing force of every equation, trial by trial."""
    made = []
    for i, course in enumerate(found.equations[0].courses):
        mine = {e.row: e.courses[i] for e in found.equations}
        made.append(
            ForceSeries(
                course.trial,
                course.t,
                {row: c.force for row, c in mine.items()},
                {row: c.error for row, c in mine.items()},
                {row: c.terms for row, c in mine.items()},
                {s: course.signals[s] for s in SHOWN if s in course.signals},
            )
        )
    return tuple(made)


def write_force_csv(path: str | Path, series: Sequence[ForceSeries]) -> None:
    """`missing_force.csv`: the force, its standard error and its terms by equation, and signals.

    One row a tick of the force's clock [s], SI throughout.
    """
    tables = [_columns(each) for each in series]
    headings = dict.fromkeys(heading for table in tables for heading in table)
    with Path(path).open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(headings)
        for table in tables:
            blank = [""] * len(table["trial"])
            writer.writerows(zip(*(table.get(each, blank) for each in headings), strict=True))


def _columns(one: ForceSeries) -> dict[str, list[Any]]:
    columns: dict[str, list[Any]] = {"trial": [one.trial] * len(one.t), "t_s": one.t.tolist()}
    for row, force in one.force.items():
        columns[_heading(row, "force")] = force.tolist()
        columns[_heading(row, "error")] = one.error[row].tolist()
        columns[_heading(row, "terms")] = one.terms[row].tolist()
    return columns | {labels.column(s): x.tolist() for s, x in one.signals.items()}


def _heading(row: str, role: str) -> str:
    return f"{row}_{role}_{UNITS[row].replace(' ', '')}"


def read_force_csv(path: str | Path) -> tuple[ForceSeries, ...]:
    """The series of a file made by `write_force_csv`.

    Raises
    ------
    LogError
        The file cannot be read as such a table.
    """
    try:
        with Path(path).open(newline="", encoding="utf-8") as stream:
            headings, *rows = csv.reader(stream)
        names = list(dict.fromkeys(row[headings.index("trial")] for row in rows))
        return tuple(
            _series(name, headings, [r for r in rows if r[headings.index("trial")] == name])
            for name in names
        )
    except (OSError, ValueError, IndexError, csv.Error) as error:
        raise LogError(f"{path}: not a missing-force file of trialid ({error})") from error


def _series(name: str, headings: Sequence[str], rows: Sequence[Sequence[str]]) -> ForceSeries:
    columns = {
        h: np.array([float(row[i]) for row in rows])
        for i, h in enumerate(headings)
        if h != "trial" and rows[0][i]
    }

    def by_row(role: str) -> dict[str, Vector]:
        found = {row: columns.get(_heading(row, role)) for row in UNITS}
        return {row: x for row, x in found.items() if x is not None}

    signals = {s: columns[labels.column(s)] for s in SHOWN if labels.column(s) in columns}
    return ForceSeries(
        name, columns["t_s"], by_row("force"), by_row("error"), by_row("terms"), signals
    )
