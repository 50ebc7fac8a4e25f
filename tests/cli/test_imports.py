"""What a run does not ask for is not imported: a module of somebody's takes up to two seconds."""

from pathlib import Path

UNASKED = {
    "can",
    "dask",
    "distributed",
    "h5py",
    "matplotlib",
    "openpyxl",
    "pandas",
    "pint",
    "pyarrow",
    "pymavlink",
    "scipy.io",
    "scipy.optimize",
    "scipy.signal",
    "scipy.sparse",
    "scipy.stats",
}


def test_a_run_of_the_sample_imports_no_more_than_it_asks_for(sample_run: Path) -> None:
    imported = {*(sample_run.parent / "modules.txt").read_text(encoding="utf-8").split()}
    assert "trialid.diagnosis.diagnose" in imported
    assert not UNASKED & imported
