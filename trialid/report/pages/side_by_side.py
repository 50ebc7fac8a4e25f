"""Several runs beside one another: parameters, errors, models, verdicts; a page and its tables."""

import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from trialid.names import labels, wording
from trialid.report.pages.page import assets, environment, heading
from trialid.report.pictures.overlays import overlays
from trialid.report.tables import run_tables
from trialid.report.tables.rounded_table import Cell, Figure, Table, numeric, percent
from trialid.result.fit_rows import ParameterRow, Part
from trialid.result.schema import Result
from trialid.result.series import TrialSeries

APART: Final = 1.96
"""Joint standard errors from which on two values differ, at 95 % for one pair."""


@dataclass(frozen=True)
class Shown:
    """A run under the name it has on the page."""

    label: str
    run: Result
    series: tuple[TrialSeries, ...] = ()


def shown_runs(
    results: Mapping[str, Result], series: Mapping[str, Sequence[TrialSeries]] | None = None
) -> tuple[Shown, ...]:
    """Runs by their labels, with the series that are laid over one another."""
    found = series or {}
    return tuple(
        Shown(label, result, tuple(found.get(label, ()))) for label, result in results.items()
    )


def joint_distance(values: Sequence[tuple[float | None, float | None]]) -> float | None:
    """The largest difference of any two in their joint standard errors; None where none is known.

    >>> joint_distance([(1.0, 0.3), (2.0, 0.4), (None, None)])
    2.0
    """
    known = [(x, s) for x, s in values if x is not None and s is not None and math.hypot(s) > 0.0]
    pairs = itertools.combinations(known, 2)
    return max((abs(a - b) / math.hypot(s, t) for (a, s), (b, t) in pairs), default=None)


def tables(runs: Sequence[Shown]) -> tuple[Table, ...]:
    """Tables of what differs, then every table of the runs, one below the other."""
    made = (_verdicts(runs), _parameters(runs), _errors(runs), _effects(runs), *_stacked(runs))
    return tuple(table for table in made if table.rows)


def _verdicts(runs: Sequence[Shown]) -> Table:
    rows = tuple(
        (
            each.label, each.run.pipeline or "", each.run.version or "",
            heading(each.run),
            each.run.verdict.effect or "", each.run.verdict.sentence or "",
        )
        for each in runs
    )  # fmt: skip
    headings = ("run", "pipeline", "version", "verdict", "effect", "in words")
    return Table("verdicts", "Verdicts", headings, rows)


def _parameters(runs: Sequence[Shown]) -> Table:
    """Values with their errors by run; the rows are every physical parameter of any run."""
    found = [
        {row.name: row for row in run_tables.rows_of_kind(each.run, nuisance=False)}
        for each in runs
    ]
    headings = ["parameter", "unit", "differ", "apart, in joint errors"]
    for each in runs:
        label = each.label
        headings += [label, f"+- ({label})", f"likely from ({label})", f"likely to ({label})"]
    names = dict.fromkeys(name for rows in found for name in rows)
    fits = [each.run.verdict.kind != "no fit" for each in runs]
    rows = tuple(_parameter(name, [rows.get(name) for rows in found], fits) for name in names)
    return Table("parameters", "Parameters by run, with standard errors and likely ranges",
                 tuple(headings), rows)  # fmt: skip


def _parameter(
    name: str, rows: Sequence[ParameterRow | None], fits: Sequence[bool]
) -> tuple[Cell, ...]:
    """A parameter of each run; whether it differs runs with a fit say, if two have it."""
    known = [row for row in rows if row is not None]
    units = list(dict.fromkeys(wording.shown_unit(row.unit)[0] for row in known))
    cells: list[Cell] = []
    for row in rows:
        value = Figure(None) if row is None else run_tables.value(row)
        error = None if row is None else run_tables.in_shown_unit(row, "standard_error")
        ends = (Figure(None), Figure(None)) if row is None else run_tables.likely(row)
        cells += [value, Figure(error, 2), *ends]
    if len(units) > 1:
        return name, " or ".join(units), "other units", Figure(None), *cells
    if len(known) < 2:
        return name, units[0], "in one run", Figure(None), *cells
    sound = [row for fit, row in zip(fits, rows, strict=True) if fit and row is not None]
    if len(sound) < 2:
        return name, units[0], "cannot tell: no fit", Figure(None), *cells
    distance = joint_distance([(row.value, row.standard_error) for row in sound])
    return name, units[0], _differ(distance, sound), Figure(distance, 2), *cells


def _differ(distance: float | None, rows: Sequence[ParameterRow]) -> str:
    """Whether by noise, and by all else that may move them: what one model lacks, the other does.

    Of an outsider's boat that had lost rudder her GM was said to differ, by 3 %, and it had not.
    """
    if distance is None:
        return "cannot tell"
    if distance <= APART:
        return "no"
    ranges = [row.likely for row in rows if row.likely is not None]
    apart = len(ranges) > 1 and max(low for low, _ in ranges) > min(high for _, high in ranges)
    return "yes" if apart else "by more than noise"


def _errors(runs: Sequence[Shown]) -> Table:
    """Errors, noise and model parts, one column a run."""
    fits = [each.run.fit for each in runs]
    splits = [each.run.split for each in runs]
    ends = [[run_tables.ends(s.ends(part)) for s in splits] for part in _PARTS]
    rows: list[tuple[Cell, ...]] = [
        ("error, fitted", *(percent(f.eps_rmsn) for f in fits)),
        ("error, held out", *(percent(f.eps_rmsn_check) for f in fits)),
    ]
    for part, intervals in zip(_PARTS, ends, strict=True):
        rows.append((f"{_PARTS[part]} part", *(percent(getattr(s, part)) for s in splits)))
        rows.append((f"{_PARTS[part]}, 95 % from", *(low for low, _ in intervals)))
        rows.append((f"{_PARTS[part]}, 95 % to", *(high for _, high in intervals)))
    for name in dict.fromkeys(n for f in fits for n in f.eps_rmsn_by_output):
        each = (percent(f.eps_rmsn_by_output.get(name)) for f in fits)
        rows.append((f"error, {labels.label(name)}", *each))
    headings = ("share of the measured RMS [%]", *(each.label for each in runs))
    return Table("errors", "Errors by run", headings, tuple(rows))


_PARTS: Final[Mapping[Part, str]] = {"noise": "noise", "undermodelling": "model"}


def _effects(runs: Sequence[Shown]) -> Table:
    """What not every run has: effects, free parameters, what is simulated and fitted, the ship."""
    held = [{*_parts(each.run)} for each in runs]
    names = sorted(held[0].union(*held) - held[0].intersection(*held))
    rows = tuple((name, *("yes" if name in own else "no" for own in held)) for name in names)
    return Table("models", "What the models differ in", ("of the model", *_of(runs)), rows)


def _parts(run: Result) -> Iterator[str]:
    """Of a model, each in words."""
    model = run.model
    named = {"effect": model.effects, "free": model.free, "simulated": model.states}
    named |= {"fitted": model.outputs, "ship": (model.ship,) if model.ship else ()}
    return (f"{what} {name}" for what, names in named.items() for name in names)


def _of(runs: Sequence[Shown]) -> tuple[str, ...]:
    return tuple(each.label for each in runs)


STACKED: Final = (
    "history", "validation", "missing", "imo", "stability", "weak_directions", "change", "logs",
    "signals",
)  # fmt: skip


def _stacked(runs: Sequence[Shown]) -> list[Table]:
    """The same table of every run with the run before each row; columns are matched by heading."""
    found: dict[str, list[tuple[str, Table]]] = {name: [] for name in STACKED}
    for each in runs:
        for table in run_tables.tables(each.run):
            if table.name in found:
                found[table.name].append((each.label, table))
    return [_stack(name, own) for name, own in found.items() if own]


def _stack(name: str, own: Sequence[tuple[str, Table]]) -> Table:
    headings = tuple(dict.fromkeys(h for _, table in own for h in table.headings))
    rows = []
    for label, table in own:
        for row in table.rows:
            cells = dict(zip(table.headings, row, strict=True))
            rows.append((label, *(cells.get(h, Figure(None)) for h in headings)))
    title = own[0][1].title if name != "change" else "Before and after"
    return Table(name, title, ("run", *headings), tuple(rows))


def shared_logs(runs: Sequence[Shown]) -> int:
    """How many logs, by their hashes, more than one run rests on."""
    held = [
        {log.sha256 for trial in each.run.trials for log in trial.logs if log.sha256}
        for each in runs
    ]
    return len(set[str]().union(*(a & b for a, b in itertools.combinations(held, 2))))


def page(runs: Sequence[Shown]) -> str:
    """`compare.html`: the runs side by side, everything inside the file."""
    laid_over = overlays({each.label: each.series for each in runs})
    return (
        environment()
        .get_template("compare.html.j2")
        .render(
            runs=runs,
            tables=tables(runs),
            shared=shared_logs(runs),
            threshold=APART,
            cell=_cell,
            numeric=numeric,
            overlays=laid_over,
            plots=[each.panels for each in laid_over],
            assets=assets(),
        )
    )


def _cell(cell: Cell) -> tuple[str, bool]:
    """A cell's words, and whether it is a number."""
    if isinstance(cell, Figure):
        return wording.number(cell.value, cell.digits), True
    return cell, False
