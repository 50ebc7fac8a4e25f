"""The track of a trial, measured beside predicted, and the CSV file that holds it in a run."""

import csv
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from trialid.arrays import Mask, Vector
from trialid.errors import LogError

FILE: Final = "track.csv"
PLACE: Final = ("x", "y", "psi")
UNITS: Final = {"x": "m", "y": "m", "psi": "rad"}
CURRENT: Final = ("V_cn_m/s", "V_ce_m/s")
WIND: Final = ("V_wn_m/s", "V_we_m/s")
GROUND: Final = "predicted_over"
HEADINGS: Final = (
    *("trial", "t_s"),
    *(f"{n}_{role}_{UNITS[n]}" for role in ("measured", "predicted") for n in PLACE),
    *(*CURRENT, GROUND, *WIND),
)
BEFORE_WIND: Final = HEADINGS[: -len(WIND)]
"""What a run had that knew of no wind."""


@dataclass(frozen=True)
class Way:
    """North, east [m] and heading [rad]; (N,) each, NaN where not known."""

    x: Vector
    y: Vector
    psi: Vector

    @property
    def known(self) -> Mask:
        """Where there is a position; (N,)."""
        return np.isfinite(self.x) & np.isfinite(self.y)

    @property
    def columns(self) -> Vector:
        """(3, N)."""
        return np.array([self.x, self.y, self.psi])


@dataclass(frozen=True, kw_only=True)
class TrackSeries:
    """The track of a trial on its clock [s].

    Attributes
    ----------
    measured
        NaN where there is no fix.
    predicted
        Of the fitted model, over the ground where the fit found the current, else through the
        water; NaN where she does not sail it.
    current
        Speed of the water to the north and to the east [m/s]; None where the fit knows none.
    wind
        Mean of the air's speed over the ground to the north and to the east [m/s], by what was
        recorded on board; None where it was not.
    """

    trial: str
    t: Vector
    measured: Way
    predicted: Way
    current: tuple[float, float] | None = None
    wind: tuple[float, float] | None = None
    over_ground: bool = False


def write_track_csv(path: Path, tracks: Sequence[TrackSeries]) -> None:
    """One table of all tracks, one row a sample, with all digits; what is not known is empty."""
    with path.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(HEADINGS)
        for one in tracks:
            water, air = (way or ("", "") for way in (one.current, one.wind))
            over = "ground" if one.over_ground else "water"
            columns = [one.t, *one.measured.columns, *one.predicted.columns]
            for row in np.column_stack(columns).tolist():
                numbers = ("" if math.isnan(x) else x for x in row)
                writer.writerow([one.trial, *numbers, *water, over, *air])


def read_track_csv(path: Path) -> dict[str, TrackSeries]:
    """The tracks of a file that `write_track_csv` made, by trial; empty where there is none.

    Raises
    ------
    LogError
        It is torn, or no such file.
    """
    if not path.exists():
        return {}
    try:
        with path.open(newline="", encoding="utf-8") as stream:
            headings, *rows = csv.reader(stream)
        if tuple(headings) not in (HEADINGS, BEFORE_WIND):
            raise ValueError(f"its columns are not {', '.join(HEADINGS[:4])} and so on")
        found: dict[str, list[list[str]]] = {}
        for row in rows:
            found.setdefault(row[0], []).append(row)
        return {name: _track(name, own) for name, own in found.items()}
    except (OSError, ValueError, IndexError, csv.Error) as error:
        raise LogError(f"{path}: cannot be read as the tracks of a run ({error})") from error


def _track(name: str, rows: Sequence[Sequence[str]]) -> TrackSeries:
    first = 1 + 1 + 2 * len(PLACE)
    y = np.array([[float(x or "nan") for x in row[1:first]] for row in rows])
    measured, predicted = (Way(*y[:, at : at + 3].T) for at in (1, 4))
    north, east, over, *air = rows[0][first:]
    current, wind = (
        (float(way[0]), float(way[1])) if all(way) and way else None for way in ((north, east), air)
    )
    return TrackSeries(
        trial=name,
        t=y[:, 0],
        measured=measured,
        predicted=predicted,
        current=current,
        wind=wind,
        over_ground=over == "ground",
    )
