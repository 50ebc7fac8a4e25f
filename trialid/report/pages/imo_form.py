"""The form a yard hands in: a ship, her trials and her model, on paper.

MSC/Circ.1053 Appendix 6 and ITTC 7.5-04-02-01 say what it asks for. What no record and no ship file
holds is left open, to be filled in by hand.
"""

import base64
from pathlib import Path
from typing import Final

from trialid.errors import TrialidError
from trialid.names import wording
from trialid.report.pages.folder import Finished, table_files, write_texts
from trialid.report.pages.page import environment, heading
from trialid.report.pictures.figures import courses
from trialid.report.pictures.input_course import input_courses
from trialid.report.pictures.track_picture import TrackPicture, track_picture
from trialid.report.tables import form_tables, imo_tables
from trialid.report.tables.rounded_table import Cell, numeric
from trialid.report.words import doubt

OPEN: Final = (
    *("Ship's name, IMO number", "Flag, class, yard, hull number", "Date and place of the trials"),
    *("Draught forward and aft, trim, displacement on trial", "Metacentric height on trial"),
    *("Rudder: type, number, total area", "Propeller: type, number, diameter, pitch"),
    *("Main engine: type, power, revolutions", "Sea state, swell, wind by the observers"),
    *("Measuring instruments and their calibration", "Signed for the yard, date"),
)
"""What a yard fills in by hand."""


def write_form(run: Finished, place: Path) -> tuple[Path, int]:
    """`imo.html` and its tables as CSV, Markdown and LaTeX below `imo/`: the path, how many others.

    Raises
    ------
    TrialidError
        The run was not asked for standard measures, or a file that is not ours is in the way.
    """
    if run.result.imo is None:
        raise TrialidError(
            f"{run.label}: holds no standard measures; write imo = true into its pipeline, above "
            "the first section, and run it again (a model that no rudder steers has none)"
        )
    made = table_files(form_tables.tables(run.result, _winds(run)))
    texts = {"imo.html": form(run), **{f"imo/{name}": each for name, each in made.items()}}
    write_texts(place, texts, below=("imo/",))
    return place / "imo.html", len(made)


def form(run: Finished) -> str:
    """The form as text."""
    result = run.result
    return (
        environment()
        .get_template("imo_form.html.j2")
        .render(
            run=result,
            heading=heading(result),
            tables=[(table, numeric(table)) for table in form_tables.tables(result, _winds(run))],
            tracks=_tracks(run),
            pictures=_pictures(run),
            blanks=OPEN,
            lacking=doubt.missing_words(result.verdict),
            corrections=imo_tables.corrections(result),
            cell=_cell,
        )
    )


def _winds(run: Finished) -> dict[str, tuple[float, float]]:
    tracks = {one.name: one.track for one in run.series}
    return {name: track.wind for name, track in tracks.items() if track and track.wind}


def _tracks(run: Finished) -> list[tuple[str, TrackPicture]]:
    size = run.result.model.particulars
    drawn = ((one.name, track_picture(one.track, size)) for one in run.series)
    return [(name, picture) for name, picture in drawn if picture is not None]


def _pictures(run: Finished) -> list[str]:
    """Every input and output of every trial against time, each a picture of its own."""
    texts = [
        text for trial in run.series for text in (*input_courses(trial), *courses([trial]).values())
    ]
    return [base64.b64encode(text.encode()).decode("ascii") for text in texts]


def _cell(cell: Cell) -> str:
    return cell if isinstance(cell, str) else wording.number(cell.value, cell.digits)
