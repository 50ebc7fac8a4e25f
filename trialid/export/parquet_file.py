"""Aligned trials as a Parquet file, the provenance in its metadata."""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from trialid.errors import TrialidError
from trialid.export.csv_file import masked_signals, quantities, units
from trialid.names import labels
from trialid.trial import Trial


def write_parquet(path: Path, trials: Sequence[Trial], provenance: Mapping[str, Any]) -> None:
    """One row a sample; columns as `delta_rad`, null where nothing was measured.

    Raises
    ------
    TrialidError
        pyarrow is not installed.
    """
    try:
        import pyarrow as pa
        import pyarrow.parquet as pq
    except ImportError as error:
        raise TrialidError(
            "Parquet needs pyarrow; install it with pip install 'trialid[tables]', or write .csv"
        ) from error
    t = np.concatenate([trial.t for trial in trials])
    label = [trial.name for trial in trials for _ in range(trial.samples)]
    columns: dict[str, Any] = {"trial": pa.array(label, pa.string()).dictionary_encode(), "t_s": t}
    known = units(provenance)
    measured = [masked_signals(trial) for trial in trials]
    for name in quantities(trials):
        parts = [
            own.get(name, np.full(trial.samples, np.nan))
            for trial, own in zip(trials, measured, strict=True)
        ]
        column = labels.column(name, unit=known.get(name))
        columns[column] = pa.array(np.concatenate(parts), from_pandas=True)
    text = json.dumps(provenance, ensure_ascii=False, allow_nan=False)
    pq.write_table(pa.table(columns).replace_schema_metadata({"trialid": text}), path)
