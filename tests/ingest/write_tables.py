"""Tables of every kind with one trial in them, written by the libraries that users write them with.

Text by Python's csv and `str`, Excel by openpyxl, Parquet by pyarrow, MATLAB v5 by scipy, v7.3 by
h5py in the manner of MATLAB (arrays transposed, a class beside each), archives by NumPy, JSON by
Python's json.
"""

import csv
import json
from collections.abc import Iterable, Mapping
from datetime import UTC, datetime, timedelta
from pathlib import Path

import h5py
import numpy as np
import openpyxl
import pyarrow as pa
import pyarrow.parquet as pq
import scipy.io
from numpy.typing import NDArray
from written import Format, Series, Written

from trialid.alignment import SignalSource
from trialid.ingest import Aids

UNITS = {"delta": "deg", "r": "deg/s", "phi": "deg", "u": "m/s", "psi": "deg"}
IN_SI = {"deg": np.pi / 180, "deg/s": np.pi / 180, "m/s": 1.0}
GERMAN = {"delta": "Ruder", "r": "Drehrate", "phi": "Krängung", "u": "Fahrt", "psi": "Kurs"}
START_NS = 1_700_000_000_000_000_000
DECIMALS = 6


def columns(series: Mapping[str, Series]) -> tuple[NDArray[np.int64], dict[str, NDArray]]:
    """One table of all series at the stamps of the first, in the units users write."""
    t = next(iter(series.values()))[0]
    table = {}
    for name, (stamps, y) in series.items():
        shown = np.unwrap(y) if name == "psi" else y
        table[name] = np.interp(t, stamps, shown) / IN_SI[UNITS[name]]
    return t, table


def _written(
    series: Mapping[str, Series], decimals: int | None, clock: float, aids: Aids | None = None
) -> Written:
    sources = tuple(
        SignalSource(name, name, UNITS[name], "starboard" if name == "delta" else None)
        for name in series
    )
    step = 1e-12 if decimals is None else 10.0**-decimals
    resolution = {name: step * IN_SI[UNITS[name]] for name in series}
    return Written(sources, resolution, clock, aids or Aids())


def _seconds(t: NDArray[np.int64]) -> list[str]:
    return [f"{one / 1e9:.3f}" for one in t - START_NS]


def _save(path: Path, rows: Iterable[Iterable[str]], separator: str, encoding: str) -> None:
    with path.open("w", newline="", encoding=encoding) as file:
        csv.writer(file, delimiter=separator).writerows(rows)


def plain_csv(path: Path, series: Mapping[str, Series]) -> Written:
    """Comma, point, UTF-8, seconds."""
    t, table = columns(series)
    head = ["t[s]", *(f"{name}[{UNITS[name]}]" for name in table)]
    body = zip(_seconds(t), *([f"{x:.6f}" for x in y] for y in table.values()), strict=True)
    _save(path, [head, *body], ",", "utf-8")
    return _written(series, DECIMALS, 0.001)


def german_csv(path: Path, series: Mapping[str, Series]) -> Written:
    """Semicolon, comma, Windows code page, a row of units, dates day first, a row of means."""
    t, table = columns(series)
    stamps = [datetime.fromtimestamp(one / 1e9, UTC) for one in t]
    head = ["Datum", "Uhrzeit", *(GERMAN[name] for name in table)]
    units = ["", "", *(f"[{UNITS[name]}]".replace("deg", "°") for name in table)]
    text = ([f"{x:.6f}".replace(".", ",") for x in y] for y in table.values())
    days = [one.strftime("%d.%m.%Y") for one in stamps]
    hours = [one.strftime("%H:%M:%S,") + f"{one.microsecond // 1000:03d}" for one in stamps]
    means = ["Mittelwert", "", *("0,0" for _ in table)]
    _save(
        path,
        [["Messung 7"], head, units, *zip(days, hours, *text, strict=True), means],
        ";",
        "cp1252",
    )
    header = ", ".join(f'"{name}"' for name in head)
    lines = [
        f'{GERMAN[name]} = {{ rename = "{name}", unit = "{UNITS[name]}" }}'.replace(
            GERMAN[name], f'"{GERMAN[name]}"', 1
        )
        for name in table
    ]
    template = path.with_name(path.name + ".template.toml")
    template.write_text(
        f"""reviewed = true
separator = ";"
decimal = ","
encoding = "cp1252"
skip = 1
units_row = true
end = "Mittelwert"
header = [{header}]
[time]
columns = ["Datum", "Uhrzeit"]
format = "%d.%m.%Y %H:%M:%S.%f"
zone = "UTC"
[columns]
"""
        + "\n".join(lines),
        encoding="utf-8",
    )
    return _written(series, DECIMALS, 0.001, Aids(template=template))


def excel(path: Path, series: Mapping[str, Series]) -> Written:
    """One sheet, dates as Excel has them."""
    t, table = columns(series)
    book = openpyxl.Workbook(write_only=True)
    sheet = book.create_sheet("Run 1")
    sheet.append(["Time", *(f"{name} [{UNITS[name]}]" for name in table)])
    start = datetime(1970, 1, 1)
    for i, stamp in enumerate(t):
        when = start + timedelta(microseconds=int(stamp) // 1000)
        sheet.append([when, *(float(y[i]) for y in table.values())])
    book.save(path)
    return _written(series, None, 0.001)


def parquet(path: Path, series: Mapping[str, Series]) -> Written:
    """Stamps of nanoseconds."""
    t, table = columns(series)
    stamps = pa.array(t, pa.timestamp("ns", "UTC"))
    pq.write_table(pa.table({"time": stamps, **{n: pa.array(y) for n, y in table.items()}}), path)
    return _written(series, None, 1e-9)


def matlab_5(path: Path, series: Mapping[str, Series]) -> Written:
    """Column vectors in the workspace, packed."""
    t, table = columns(series)
    vectors = {"t": (t - START_NS) / 1e9, **table}
    whole = {name: y[:, np.newaxis] for name, y in vectors.items()}
    with path.open("wb") as file:
        scipy.io.savemat(file, whole | {"L": 160.0}, do_compression=True)
    return _written(series, None, 1e-6)


def numpy_archive(path: Path, series: Mapping[str, Series]) -> Written:
    """Vectors by `np.savez`, dates as NumPy has them."""
    t, table = columns(series)
    with path.open("wb") as file:
        np.savez(file, time=t.view("datetime64[ns]"), **table)
    return _written(series, None, 1e-9)


def matlab_73(path: Path, series: Mapping[str, Series]) -> Written:
    """A struct in MATLAB's manner in HDF5."""
    t, table = columns(series)
    with h5py.File(path, "w", userblock_size=512) as file:
        group = file.create_group("trial")
        group.attrs["MATLAB_class"] = np.bytes_("struct")
        for name, y in {"t": (t - START_NS) / 1e9, **table}.items():
            one = group.create_dataset(name, data=y[np.newaxis, :], compression="gzip")
            one.attrs["MATLAB_class"] = np.bytes_("double")
    with path.open("r+b") as file:
        file.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(124) + b"\x00\x02IM")
    written = _written(series, None, 1e-6)
    named = tuple(
        SignalSource(s.quantity, f"trial.{s.channel}", s.unit, s.positive) for s in written.sources
    )
    return Written(named, written.resolution, written.clock_resolution)


def json_lines(path: Path, series: Mapping[str, Series]) -> Written:
    """A record a line, each value in an object of its own."""
    t, table = columns(series)
    with path.open("w", encoding="utf-8") as file:
        for i, stamp in enumerate(t):
            values = {name: {"value": float(y[i])} for name, y in table.items()}
            file.write(json.dumps({"t": (int(stamp) - START_NS) / 1e9, **values}) + "\n")
    written = _written(series, None, 1e-6)
    named = tuple(
        SignalSource(s.quantity, f"{s.channel}.value", s.unit, s.positive) for s in written.sources
    )
    return Written(named, written.resolution, written.clock_resolution)


FORMATS: tuple[Format, ...] = (
    Format("csv", plain_csv),
    Format("german_csv", german_csv),
    Format("xlsx", excel),
    Format("parquet", parquet),
    Format("mat5", matlab_5),
    Format("mat73", matlab_73),
    Format("npz", numpy_archive),
    Format("jsonl", json_lines),
)
