"""A long benchmark by a scheduler's workers: the same rows as in one process."""

import csv
import subprocess
import sys
from pathlib import Path

import pytest
from generated_fleet import ROOT

pytest.importorskip("distributed")
SCRIPT = ROOT / "tests" / "benchmarks" / "hidden_effects.py"
ASKED = "--seeds 1 --noise white --trials mixed --scenarios nothing,bias_r,righting_arm_cubic"


def rows(table: Path, *options: str) -> list[dict[str, str]]:
    """What the benchmark counts, without the seconds that it took."""
    words = [*ASKED.split(), "--out", str(table), *options]
    subprocess.run([sys.executable, str(SCRIPT), *words], check=False, capture_output=True)
    with table.open(newline="", encoding="utf-8") as stream:
        found = list(csv.DictReader(stream))
    return [{n: x for n, x in row.items() if "second" not in n} for row in found]


@pytest.mark.study(turn=11)
def test_a_benchmark_on_workers_gives_the_same_rows(tmp_path: Path) -> None:
    here = rows(tmp_path / "here.csv")
    assert [row["scenario"] for row in here] == ["nothing", "bias_r", "righting_arm_cubic"]
    assert rows(tmp_path / "there.csv", "--on", "local", "--jobs", "2") == here
