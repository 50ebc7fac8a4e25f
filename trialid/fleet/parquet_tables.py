"""A fleet's tables as Parquet files, for DuckDB, pandas and whatever else reads them."""

from collections.abc import Sequence
from dataclasses import asdict, fields
from datetime import date
from pathlib import Path
from types import UnionType
from typing import Any, Final, get_args, get_origin, get_type_hints

from trialid.errors import TrialidError
from trialid.result.fleet_rows import ChangeRow, FittedRow, RunRow

RUNS_TABLE: Final = "runs.parquet"
PARAMETERS: Final = "parameters.parquet"
CHANGES: Final = "changes.parquet"


def write_tables(
    folder: Path,
    runs: Sequence[RunRow],
    fitted: Sequence[FittedRow],
    changes: Sequence[ChangeRow],
) -> None:
    """All tables; one without a row has its columns nevertheless."""
    _write(folder / RUNS_TABLE, RunRow, runs)
    _write(folder / PARAMETERS, FittedRow, fitted)
    _write(folder / CHANGES, ChangeRow, changes)


def check_parquet() -> None:
    """Refuse, before the work, where no table could be written.

    Raises
    ------
    TrialidError
        What writes Parquet is not installed.
    """
    try:
        import pyarrow.parquet
    except ImportError as error:
        raise TrialidError(
            "a batch writes Parquet by pyarrow, which is not installed; install it by: "
            "pip install 'trialid[batch]'"
        ) from error
    assert pyarrow.parquet


def _write(path: Path, kind: type, rows: Sequence[Any]) -> None:
    import pyarrow as pa
    import pyarrow.parquet as pq

    hints = get_type_hints(kind)
    schema = pa.schema([pa.field(each.name, _column(hints[each.name])) for each in fields(kind)])
    pq.write_table(pa.Table.from_pylist([asdict(row) for row in rows], schema=schema), path)


def _column(hint: Any) -> Any:
    """The type of a column that holds what a field may be."""
    import pyarrow as pa

    plain = next(k for k in get_args(hint) if k is not type(None)) if _union(hint) else hint
    kinds = {float: pa.float64(), int: pa.int64(), bool: pa.bool_(), date: pa.date32()}
    return kinds.get(plain, pa.string())


def _union(hint: Any) -> bool:
    return get_origin(hint) is UnionType
