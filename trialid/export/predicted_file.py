"""A predicted manoeuvre as a file other programs read: CSV, Parquet, MCAP, by its suffix."""

import csv
import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np

from trialid import export
from trialid.arrays import Vector
from trialid.design.prediction.ranged_motion import PredictedMotion
from trialid.errors import TrialidError
from trialid.export.tracks import About, Track, stems, write_tracks
from trialid.names import labels

METRES: Final = {"x": "m", "y": "m"}
"""The track, which no log holds yet."""
ENDS: Final = ("from", "to")
"""What the ends of a range are called behind the name of their signal."""

Write = Callable[[Path, str, PredictedMotion, Mapping[str, Any]], None]


def predicted_columns(made: PredictedMotion) -> Iterator[tuple[str, str, Vector]]:
    """Name, unit and values of every column: orders, motions, and the ends of their ranges."""
    for name, values in made.given.items():
        yield name, made.quantities[name].unit, values
    for name, values in made.motion.items():
        unit = METRES.get(name) or made.quantities[name].unit
        yield name, unit, values
        for end, one in zip(ENDS, made.ranges[name], strict=True):
            yield f"{name}_{end}", unit, one


def _write_csv(path: Path, name: str, made: PredictedMotion, about: Mapping[str, Any]) -> None:
    """One row a sample, all digits, each header with its unit; what it is goes beside it."""
    del name, about
    columns = list(predicted_columns(made))
    with path.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(["t[s]", *(f"{n}[{unit}]" for n, unit, _ in columns)])
        rows = zip(made.t.tolist(), *(_fields(x) for *_, x in columns), strict=True)
        writer.writerows(rows)


def _fields(values: Vector) -> Sequence[float | str]:
    return [value if np.isfinite(value) else "" for value in values.tolist()]


def _write_parquet(path: Path, name: str, made: PredictedMotion, about: Mapping[str, Any]) -> None:
    del name
    try:
        import pyarrow as pa
        import pyarrow.parquet as pq
    except ImportError as error:
        raise TrialidError(
            "Parquet needs pyarrow; install it with pip install 'trialid[tables]', or write .csv"
        ) from error
    columns = {"t_s": made.t}
    columns |= {f"{n}_{labels.unit_word(unit)}": x for n, unit, x in predicted_columns(made)}
    table = pa.table({n: pa.array(x, from_pandas=True) for n, x in columns.items()})
    text = json.dumps(about, ensure_ascii=False, allow_nan=False)
    pq.write_table(table.replace_schema_metadata({"trialid": text}), path)


def _write_mcap(path: Path, name: str, made: PredictedMotion, about: Mapping[str, Any]) -> None:
    [topic] = stems([name])
    t = np.rint(made.t * 1e9).astype(np.int64)
    fields = {f"{n}_{labels.unit_word(unit)}": x for n, unit, x in predicted_columns(made)}
    tracks = [Track(f"/trialid/{topic}/simulated", "trialid.Simulated", t, fields)]
    manifest = {key: str(about[key]) for key in ("schema", "version", "run")}
    with path.open("wb") as stream:
        write_tracks(
            stream, tracks, About(f"trialid {about['version']}", manifest, "about.json", about)
        )


WRITERS: Final[Mapping[str, Write]] = {
    ".csv": _write_csv,
    ".parquet": _write_parquet,
    ".mcap": _write_mcap,
}
"""What a file's suffix asks for."""


def write_motion(path: Path, name: str, made: PredictedMotion, about: Mapping[str, Any]) -> None:
    """Write a manoeuvre at one stroke; `about` says what it is and how far to trust it.

    Raises
    ------
    TrialidError
        The file cannot be written, or a package its format needs is not there.
    """
    writer = WRITERS[path.suffix.lower()]
    export.place(path, lambda ready: writer(ready, name, made, about), about)
