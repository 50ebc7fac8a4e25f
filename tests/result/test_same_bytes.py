"""A run is the same each time."""

from pathlib import Path

import pytest

from trialid.pipeline_file import load
from trialid.workflow.run import run
from trialid.workflow.write_run import write

HIDDEN_EFFECT = Path(__file__).parents[2] / "pipelines" / "hidden_effect.toml"


@pytest.mark.study(turn=7)
def test_another_process_writes_the_same_bytes(sample_run: Path, tmp_path: Path) -> None:
    """From another folder, by the command, with other threads and another order of hashes."""
    write(run(load(HIDDEN_EFFECT)), tmp_path / "again")
    for name in ("result.json", "series.csv", "predicted.mcap", "report.html"):
        assert (tmp_path / "again" / name).read_bytes() == (sample_run / name).read_bytes(), name
