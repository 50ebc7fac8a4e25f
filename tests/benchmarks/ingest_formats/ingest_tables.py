"""How quickly tables are read, against the plain library of each format in the same run.

python tests/benchmarks/ingest.py --only tables
"""

import json
import tempfile
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import python_calamine
import scipy.io
import write_tables
from ingest_timing import Row, SizedLogs, race, repeated

from trialid.ingest import Aids, read

ROWS = 400_000
EXCEL_ROWS = 20_000
RATE = 50.0
REPEATS = 7
ASKED = {"xlsx": 0.15, "parquet": 0.15}
"""Of 0.5: Excel is unpacked twice, for a bomb; of Parquet the hash takes as long as the reading."""


def measure(scale: float = 1.0) -> list[Row]:
    """One row a format; `scale` makes the tables longer or shorter."""
    with tempfile.TemporaryDirectory() as folder:
        return [_row(Path(folder), one, scale) for one in write_tables.FORMATS]


def _row(folder: Path, form: write_tables.Format, scale: float) -> Row:
    count = int(EXCEL_ROWS * max(scale, 0.5) if form.name == "xlsx" else ROWS * scale)
    path = folder / form.name
    aids = form.write(path, _series(count)).aids
    plain = PLAIN[form.name]
    ours, theirs = race(lambda: _all(path, aids, count), lambda: plain(path), REPEATS)
    return form.name, count / ours, count / theirs, ASKED.get(form.name, 0.3)


def _series(count: int) -> dict[str, write_tables.Series]:
    seconds = np.arange(count) / RATE
    t = write_tables.START_NS + np.rint(seconds * 1e9).astype(np.int64)
    rng = np.random.default_rng(7)
    return {
        name: (t, 0.1 * np.sin(0.1 * (i + 1) * seconds) + 1e-3 * rng.normal(size=count))
        for i, name in enumerate(write_tables.UNITS)
    }


def _all(path: Path, aids: Aids, count: int) -> None:
    channels = read(path, None, aids).channels
    assert all(len(one.t) == count for one in channels.values())
    assert len(channels) == len(write_tables.UNITS)


def _german(path: Path) -> pd.DataFrame:
    """What gives the same stamps and numbers; the row of means is left in."""
    rows = path.read_bytes().count(b"\n") - 4
    options = {"sep": ";", "decimal": ",", "encoding": "cp1252", "skiprows": [0, 2], "nrows": rows}
    table = pd.read_csv(path, **options)
    stamps = table["Datum"] + " " + table["Uhrzeit"].str.replace(",", ".")
    table["t"] = pd.to_datetime(stamps, format="%d.%m.%Y %H:%M:%S.%f")
    return table


def _hdf5(path: Path) -> list[object]:
    with h5py.File(path) as file:
        return [one[()] for one in file["trial"].values()]


def _archive(path: Path) -> list[object]:
    with np.load(path) as file:
        return [file[name] for name in file.files]


def _json_lines(path: Path) -> pd.DataFrame:
    with path.open(encoding="utf-8") as file:
        return pd.json_normalize([json.loads(line) for line in file])


def _excel(path: Path) -> object:
    return python_calamine.CalamineWorkbook.from_path(str(path)).get_sheet_by_index(0).to_python()


PLAIN: dict[str, Callable[[Path], object]] = {
    "csv": pd.read_csv,
    "german_csv": _german,
    "xlsx": _excel,
    "parquet": lambda path: pq.read_table(path, use_threads=False).to_pandas(),
    "mat5": scipy.io.loadmat,
    "mat73": _hdf5,
    "npz": _archive,
    "jsonl": _json_lines,
}


def sized(path: Path, size: float) -> tuple[str, ...]:
    """A CSV of that size."""
    write_tables.plain_csv(path, _series(50_000))
    head, *rows = path.read_text(encoding="utf-8").splitlines()
    lines = [row[row.index(",") :] for row in rows]
    repeated(path, lines, lambda i: f"{i / RATE:.3f}", size, f"{head}\n")
    return tuple(write_tables.UNITS)


SIZED: SizedLogs = {"CSV": sized}
