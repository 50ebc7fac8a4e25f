"""The report of finished runs as files: pages, tables in three forms, figures."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from trialid.report import run_tables, side_by_side
from trialid.report.figures import figures
from trialid.report.force import ForceSeries, read_force_csv
from trialid.report.page import page
from trialid.report.series import TrialSeries, read_csv
from trialid.report.table import Table, as_csv, as_latex, as_markdown, document


@dataclass(frozen=True)
class Finished:
    """A run read from its folder."""

    label: str
    result: Mapping[str, Any]
    series: tuple[TrialSeries, ...]
    forces: tuple[ForceSeries, ...]


def finished(label: str, folder: Path, result: Mapping[str, Any]) -> Finished:
    """A run's result with the series beside it.

    Raises
    ------
    LogError
        A table of series is missing or torn.
    """
    forces = folder / "missing_force.csv"
    return Finished(
        label, result, read_csv(folder / "series.csv"),
        read_force_csv(forces) if forces.exists() else (),
    )  # fmt: skip


def write_one(run: Finished, place: Path, tables: Path, pictures: Path) -> tuple[Path, int]:
    """Page, tables and figures of a run: the page's path, and how many other files."""
    text = page(run.result, run.series, run.forces)
    drawn = figures(text, run.result, run.series)
    made = table_files(run_tables.tables(run.result))
    path = place / "report.html"
    _write(place, {"report.html": text})
    _write(tables, made)
    _write(pictures, {f"{stem}.svg": each for stem, each in drawn.items()})
    return path, len(made) + len(drawn)


def write_several(runs: Sequence[Finished], place: Path) -> tuple[Path, int]:
    """`compare.html` and the tables side by side: the page's path, and how many other files."""
    shown = side_by_side.named({run.label: run.result for run in runs})
    made = table_files(side_by_side.tables(shown))
    _write(place, {"compare.html": side_by_side.page(shown)})
    _write(place / "tables", made)
    return place / "compare.html", len(made)


def table_files(tables: Sequence[Table]) -> dict[str, str]:
    """Every table as CSV, Markdown and LaTeX, and the document that takes in all of the last."""
    made = {"tables.tex": document(tables)}
    for table in tables:
        made[f"{table.name}.csv"] = as_csv(table)
        made[f"{table.name}.md"] = as_markdown(table)
        made[f"{table.name}.tex"] = as_latex(table)
    return made


def _write(folder: Path, texts: Mapping[str, str]) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
