"""The report of finished runs as files: pages, tables in three forms, figures."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from trialid import own_files
from trialid.report.pages import side_by_side
from trialid.report.pages.page import page
from trialid.report.pictures.figures import figures
from trialid.report.tables import run_tables
from trialid.report.tables.rounded_table import Table, as_csv, as_latex, as_markdown, document
from trialid.result.force_series import ForceSeries, read_force_csv
from trialid.result.schema import Result
from trialid.result.series import TrialSeries, read_csv
from trialid.result.track_series import FILE, read_track_csv


@dataclass(frozen=True)
class Finished:
    """A run read from its folder."""

    label: str
    result: Result
    series: tuple[TrialSeries, ...]
    forces: tuple[ForceSeries, ...]


def read_run(label: str, folder: Path, result: Result) -> Finished:
    """A run's result with the series beside it.

    Raises
    ------
    LogError
        A table of series is missing or torn.
    """
    forces, tracks = folder / "missing_force.csv", read_track_csv(folder / FILE)
    series = read_csv(folder / "series.csv")
    return Finished(
        label, result, tuple(replace(one, track=tracks.get(one.name)) for one in series),
        read_force_csv(forces) if forces.exists() else (),
    )  # fmt: skip


def write_one(run: Finished, place: Path) -> tuple[Path, int]:
    """Page, tables and figures of a run: the page's path, and how many other files.

    Raises
    ------
    TrialidError
        A file that is not ours stands in the way; nothing was written.
    """
    text = page(run.result, run.series, run.forces)
    tables = table_files(run_tables.tables(run.result))
    made = {f"tables/{name}": each for name, each in tables.items()}
    drawn = figures(text, run.result, run.series)
    made |= {f"figures/{stem}.svg": each for stem, each in drawn.items()}
    write_texts(place, {"report.html": text, **made})
    return place / "report.html", len(made)


def write_several(runs: Sequence[Finished], place: Path) -> tuple[Path, int]:
    """`compare.html` and the tables side by side: the page's path, and how many other files."""
    series = {run.label: run.series for run in runs}
    shown = side_by_side.shown_runs({run.label: run.result for run in runs}, series)
    made = table_files(side_by_side.tables(shown))
    tables = {f"tables/{name}": each for name, each in made.items()}
    write_texts(place, {"compare.html": side_by_side.page(shown), **tables})
    return place / "compare.html", len(made)


def table_files(tables: Sequence[Table]) -> dict[str, str]:
    """Every table as CSV, Markdown and LaTeX, and the document that takes in all of the last."""
    made = {"tables.tex": document(tables)}
    for table in tables:
        made[f"{table.name}.csv"] = as_csv(table)
        made[f"{table.name}.md"] = as_markdown(table)
        made[f"{table.name}.tex"] = as_latex(table)
    return made


def write_texts(
    folder: Path, texts: Mapping[str, str], below: tuple[str, ...] = ("tables/", "figures/")
) -> None:
    """Texts by their names below the folder; ours of an earlier report that are not made go."""
    with own_files.replacing(folder, below=below) as work:
        for name, text in texts.items():
            (work / name).parent.mkdir(parents=True, exist_ok=True)
            (work / name).write_text(text, encoding="utf-8")
