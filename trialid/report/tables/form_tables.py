"""The tables of a form that is handed in: the ship, the conditions, what the model is worth."""

from collections.abc import Iterator, Mapping
from typing import Final

import numpy as np

from trialid.names import labels
from trialid.names.quantities import PARTICULARS
from trialid.report.pictures.track_picture import CALM
from trialid.report.tables import imo_tables, run_tables
from trialid.report.tables.rounded_table import Cell, Figure, Table, percent
from trialid.result.fit_rows import ParameterRow
from trialid.result.imo_rows import ImoPart
from trialid.result.schema import Result

CURRENT: Final = {"V_cn": "current to the north", "V_ce": "current to the east"}


Winds = Mapping[str, tuple[float, float]]
"""Mean wind of a trial over the ground, to the north and to the east [m/s]."""


def tables(run: Result, winds: Winds | None = None) -> tuple[Table, ...]:
    """Every table of the form that the run has something for."""
    made = (
        particulars(run),
        conditions(run, winds or {}),
        imo_tables.measures(run),
        imo_tables.manoeuvres(run),
        imo_tables.turns(run),
        imo_tables.track_numbers(run),
        imo_tables.manoeuvre_numbers(run),
        imo_tables.overshoots(run),
        validity(run),
    )
    return tuple(table for table in made if table.rows)


def particulars(run: Result) -> Table:
    """The ship as her file states her, and the ratios that follow."""
    known = run.model.particulars
    rows: list[tuple[Cell, ...]] = [
        (
            PARTICULARS[n].meaning.partition(",")[0],
            _sign(n),
            Figure(x),
            _raised(PARTICULARS[n].unit),
        )
        for n, x in known.items()
        if n in PARTICULARS
    ]
    rows += [(words, sign, Figure(x), "") for words, sign, x in _ratios(run)]
    return Table("particulars", "Particulars", ("particular", "", "value", "unit"), tuple(rows))


def _sign(name: str) -> str:
    return {"nabla": "\u2207", "rho": "\u03c1"}.get(name, PARTICULARS[name].symbol)


def _raised(unit: str) -> str:
    return unit.replace("^2", "\u00b2").replace("^3", "\u00b3")


def _ratios(run: Result) -> Iterator[tuple[str, str, float]]:
    p = run.model.particulars
    L, B, T, nabla = (p.get(n) for n in ("L", "B", "T", "nabla"))
    if L and B:
        yield "length over beam", "L/B", L / B
    if B and T:
        yield "beam over draught", "B/T", B / T
    if L and B and T and nabla:
        yield "block coefficient", "C_B", nabla / (L * B * T)


def conditions(run: Result, winds: Winds) -> Table:
    """What each trial was sailed in: recorded signals, the wind, the current that the fit found.

    A wind on board has no direction in the middle: it goes round with the ship.
    """
    rows: list[tuple[Cell, ...]] = []
    for each in (run.imo or ImoPart()).conditions:
        if each.signal == "gamma_aw":
            continue
        factor = labels.shown_factor(each.signal)
        numbers = (Figure(x * factor, 3) for x in (each.median, *each.interval))
        unit = labels.shown_unit(each.signal)
        rows.append((each.trial, f"{labels.meaning(each.signal)}, recorded", *numbers, unit))
    rows += [row for trial, wind in winds.items() for row in _wind(trial, wind)]
    rows += [row for p in run.nuisance if (row := _current(p)) is not None]
    places = {trial.name: k for k, trial in enumerate(run.trials)}
    rows.sort(key=lambda row: places.get(str(row[0]), len(places)))
    headings = ("trial", "condition", "median or estimate", "95 % from", "to", "unit")
    return Table("conditions", "Conditions", headings, tuple(rows))


def _wind(trial: str, wind: tuple[float, float]) -> Iterator[tuple[Cell, ...]]:
    """Speed, and where it comes from."""
    speed, towards = float(np.hypot(*wind)), float(np.degrees(np.arctan2(wind[1], wind[0])))
    ends = Figure(None), Figure(None)
    shown = Figure(speed if speed >= CALM else 0.0, 3)
    yield trial, "mean wind over the ground, recorded", shown, *ends, "m/s"
    if speed >= CALM:
        yield trial, "where it comes from", Figure((towards + 180.0) % 360.0, 3), *ends, "deg"


def _current(row: ParameterRow) -> tuple[Cell, ...] | None:
    name, _, trial = row.name.partition(" [")
    if name not in CURRENT or row.value is None:
        return None
    reach = row.reach
    ends = [None, None] if reach is None else [row.value - reach, row.value + reach]
    numbers = (Figure(x, 3) for x in (row.value, *ends))
    return trial.removesuffix("]"), f"{CURRENT[name]}, estimated", *numbers, "m/s"


def validity(run: Result) -> Table:
    """How far the model left each trial, and whether that trial was fitted."""
    outputs = run_tables.outputs_of(run)
    headings = (
        "trial",
        "use",
        *(f"error of {labels.symbol(n)} [%]" for n in outputs),
    )
    rows: list[tuple[Cell, ...]] = []
    for trial in run.trials:
        errors = (percent(trial.eps_rmsn.get(n)) for n in outputs)
        rows.append((trial.name, run_tables.USES[trial.use], *errors))
    return Table("validity", "The model against every trial", headings, tuple(rows))
