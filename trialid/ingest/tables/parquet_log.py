"""Parquet logs: a time column, one column of numbers a channel; others by a template."""

import contextlib
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from trialid.errors import LogError, reason_of
from trialid.ingest.adapter import NO_AIDS, Adapter, Aids, Wanted, is_wanted
from trialid.ingest.packages import require
from trialid.ingest.tables.clock import table_clock
from trialid.ingest.tables.long_table import key_columns
from trialid.ingest.tables.table import Table, blank_out, check_width, head
from trialid.ingest.tables.table_channels import recording
from trialid.ingest.tables.templates import template
from trialid.ingest.tables.templates.template import Template
from trialid.ingest.tables.written.hemispheres import beside_position
from trialid.recording import Recording

if TYPE_CHECKING:
    import pyarrow as pa

MOST_VALUES = 50_000_000
"""In one reading; 400 MB of numbers, which a file of a few kilobytes can declare."""


def recognises(start: bytes) -> bool:
    """The magic number of Parquet."""
    return start.startswith(b"PAR1")


def read(path: Path, wanted: Wanted = None, aids: Aids = NO_AIDS) -> Recording:
    """Read the wanted columns; LogError for a damaged file and for what cannot be read."""
    told = None if aids.template is None else template.load(aids.template)
    with _opened(path) as file:
        table = _table(path, file, wanted, told)
    return recording(table, ADAPTER.name, wanted, aids, told)


def kinds(path: Path) -> dict[str, str]:
    """Its columns by name: what they hold, in a word, where it is no plain number."""
    with _opened(path) as file:
        schema = file.schema_arrow
        pairs = zip(schema.names, schema.types, strict=True)
        return {name: "" if _numeric(kind) else str(kind)[:40] for name, kind in pairs}


@contextlib.contextmanager
def _opened(path: Path) -> Iterator[Any]:
    arrow = require("pyarrow", path, "Parquet")
    parquet = require("pyarrow.parquet", path, "Parquet")
    try:
        with parquet.ParquetFile(path) as file:
            check_width(path, file.metadata.num_columns)
            yield file
    except (arrow.ArrowException, OSError, ValueError, OverflowError, MemoryError) as error:
        raise LogError(
            f"{path}: is no Parquet file that can be read ({reason_of(error)}); copy it again, or "
            "export it anew"
        ) from error


def _table(path: Path, file: Any, wanted: Wanted, told: Template | None) -> Table:
    schema = file.schema_arrow
    heads = tuple(head(text) for text in schema.names)
    if len(set(schema.names)) < len(heads):
        raise LogError(f"{path}: a name stands twice among its columns; rename one")
    if told is not None:
        template.check_header(path, [one.text for one in heads], told)
        timed = set(told.time.columns)
    else:
        needed = {*table_clock.columns_of_time(heads), *key_columns(heads)}
        timed = {heads[i].text for i in needed}
    sides = {i for i in beside_position(heads) if is_wanted(heads[i - 1].name, wanted)}
    remarks, chosen = [], []
    for i, (one, kind) in enumerate(zip(heads, schema.types, strict=True)):
        renamed = told.columns[one.text].rename if told and one.text in told.columns else None
        if (
            one.text in timed
            or i in sides
            or (is_wanted(renamed or one.name, wanted) and _numeric(kind))
        ):
            chosen.append(i)
        elif is_wanted(renamed or one.name, wanted):
            remarks.append(f"column {one.name!r} holds {str(kind)[:40]}, left out")
    columns, utc = _columns(path, file, [schema.names[i] for i in chosen])
    columns = tuple(blank_out(one, told.missing if told else ()) for one in columns)
    kept = tuple(heads[i] for i in chosen)
    return Table(path, kept, columns, _row, remarks=tuple(remarks), utc=utc)


def _row(row: int) -> str:
    return f"row {row + 1}"


def _numeric(kind: "pa.DataType") -> bool:
    import pyarrow as pa

    return pa.types.is_integer(kind) or pa.types.is_floating(kind) or pa.types.is_decimal(kind)


def _columns(path: Path, file: Any, chosen: Sequence[str]) -> tuple[tuple[NDArray[Any], ...], bool]:
    rows = file.metadata.num_rows
    if rows * len(chosen) > MOST_VALUES:
        raise LogError(
            f"{path}: {rows} rows of {len(chosen)} columns are more than {MOST_VALUES // 10**6} "
            "million numbers; name fewer channels, or export a shorter time"
        )
    if not rows:
        raise LogError(f"{path}: a header but no rows; check that the log was exported")
    table = file.read(columns=list(chosen), use_threads=False)
    found = [_values(table.column(name)) for name in chosen]
    return tuple(values for values, _ in found), any(aware for _, aware in found)


def _values(column: "pa.ChunkedArray") -> tuple[NDArray[Any], bool]:
    """Numbers, dates, or objects as they stand; and True for dates that are instants of UTC."""
    import pyarrow as pa

    kind = column.type
    if pa.types.is_timestamp(kind):
        nanos = column.cast(pa.timestamp("ns", kind.tz)).cast(pa.int64())
        stamps = nanos.fill_null(np.iinfo(np.int64).min).to_numpy()
        return stamps.astype("datetime64[ns]"), kind.tz is not None
    if pa.types.is_duration(kind):
        nanos = column.cast(pa.duration("ns")).cast(pa.int64())
        return nanos.cast(pa.float64(), safe=False).to_numpy() / 1e9, False
    if pa.types.is_float32(kind):
        return column.to_numpy().astype(np.float32), False
    if _numeric(kind):
        return column.cast(pa.float64(), safe=False).to_numpy().astype(np.float64), False
    objects = np.empty(len(column), object)
    objects[:] = column.to_pylist()
    return objects, False


ADAPTER = Adapter(
    "parquet", recognises, read, frozenset({"template", "zone"}), by_template=recognises
)
