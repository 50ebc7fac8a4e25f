"""The report of a fleet: verdicts, what is missing, changes, parameters over voyages and ships."""

from collections import Counter
from collections.abc import Callable, Sequence

from trialid.names import wording
from trialid.report.pages.page import VERDICTS, assets, environment
from trialid.report.pictures.voyage_picture import VoyagePicture, voyage_picture
from trialid.report.tables.rounded_table import Cell, Figure, Table, numeric, percent
from trialid.result.fleet_rows import ChangeRow, FittedRow, Remark, RunRow

FAILED = "No result"
Group = tuple[str, list[VoyagePicture]]


def fleet_page(
    name: str,
    runs: Sequence[RunRow],
    fitted: Sequence[FittedRow],
    changes: Sequence[ChangeRow],
    remarks: Sequence[Remark],
) -> str:
    """`fleet.html` as text; it stands beside the folder `runs`, whose reports it leads to."""
    told = [_verdicts(runs), _missing(runs), _changes(changes), _remarks(remarks)]
    tables = [*told, _failures(runs)]
    found = [row for row in changes if row.form != "varies"]
    return (
        environment()
        .get_template("fleet.html.j2")
        .render(
            name=name,
            runs=runs,
            ships=len({row.ship for row in runs}),
            failures=sum(row.failure is not None for row in runs),
            changes=found,
            tables=[(table, numeric(table)) for table in tables if table.rows],
            over_voyages=over_voyages(fitted, found),
            over_ships=over_ships(fitted),
            cell=_cell,
            verdict=_verdict,
            assets=assets(),
        )
    )


def _verdict(row: RunRow) -> str:
    """A run's verdict as the page heads it."""
    return VERDICTS.get(row.verdict or "", FAILED)


def _verdicts(runs: Sequence[RunRow]) -> Table:
    counted = Counter(map(_verdict, runs))
    rows = tuple(
        (words, Figure(number), percent(number / len(runs)))
        for words, number in counted.most_common()
    )
    return Table("counts", "Verdicts", ("verdict", "runs", "share [%]"), rows)


def _missing(runs: Sequence[RunRow]) -> Table:
    """How often each effect is named, and how often it cannot be told from the one named."""
    named = Counter(row.effect for row in runs if row.effect and row.verdict == "missing")
    possible = Counter(
        name for row in runs if row.verdict == "missing" for name in (row.family or "").split(", ")
    )
    ships = {name: len({row.ship for row in runs if row.effect == name}) for name in named}
    rows = tuple(
        (name, Figure(named[name]), Figure(ships[name]), Figure(possible[name]))
        for name, _ in sorted(named.items(), key=lambda each: (-each[1], each[0]))
    )
    headings = ("effect", "named in runs", "of ships", "named or not to be told from it")
    return Table("missing", "What is missing, in how many", headings, rows)


def _changes(changes: Sequence[ChangeRow]) -> Table:
    headings = (
        *("ship", "parameter", "what", "from voyage", "date", "between, 95 %", "size", "unit"),
        *("grows by [%]", "p over the fleet", "exceeds likely ranges"),
    )
    return Table("changes", "Changes", headings, tuple(map(_change, changes)))


def _change(row: ChangeRow) -> tuple[Cell, ...]:
    unit, factor = wording.shown_unit(row.unit)
    when = row.date.isoformat() if row.date else ""
    return (
        *(row.ship, row.parameter, row.form, row.voyage, when, f"{row.earliest} to {row.latest}"),
        *(Figure(row.size * factor, 3), unit, percent(row.relative), Figure(row.p_value, 2)),
        "yes" if row.beyond_likely else "no",
    )


def _remarks(remarks: Sequence[Remark]) -> Table:
    rows = tuple((each.ship, each.words) for each in remarks)
    return Table("remarks", "To be known of the changes", ("ship", "what"), rows)


def _failures(runs: Sequence[RunRow]) -> Table:
    rows = tuple((row.run, row.failure) for row in runs if row.failure is not None)
    return Table("failures", "Runs without a result", ("run", "why"), rows)


def over_voyages(fitted: Sequence[FittedRow], changes: Sequence[ChangeRow]) -> list[Group]:
    """A picture for each parameter of each ship with two voyages or more, done as written."""
    found: dict[str, list[VoyagePicture]] = {}
    for (ship, parameter), rows in _by(fitted, lambda row: (row.ship, row.parameter)).items():
        own = [each for each in changes if (each.ship, each.parameter) == (ship, parameter)]
        if len(rows) > 1:
            picture = voyage_picture(parameter, rows, [row.voyage for row in rows], own)
            found.setdefault(ship, []).append(picture)
    return list(found.items())


def over_ships(fitted: Sequence[FittedRow]) -> list[VoyagePicture]:
    """A picture for each parameter that several ships have: all runs, ship after ship."""
    return [
        voyage_picture(parameter, rows, [row.ship for row in rows], ())
        for (parameter,), rows in _by(fitted, lambda row: (row.parameter,)).items()
        if len({row.ship for row in rows}) > 1
    ]


def _by(
    fitted: Sequence[FittedRow], key: Callable[[FittedRow], tuple[str, ...]]
) -> dict[tuple[str, ...], list[FittedRow]]:
    """The ship's own parameters of runs done as written, by what is asked."""
    found: dict[tuple[str, ...], list[FittedRow]] = {}
    for row in fitted:
        if row.kind == "physical" and row.value is not None and row.as_written:
            found.setdefault(key(row), []).append(row)
    return found


def _cell(cell: Cell) -> str:
    return cell if isinstance(cell, str) else wording.number(cell.value, cell.digits)
