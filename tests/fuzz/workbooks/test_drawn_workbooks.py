"""Workbooks drawn from a grammar, read in a process of their own: it lives, nothing offends."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

HERE = Path(__file__).parent


def drawn(folder, seed, count):
    """What became of so many: the lines the process printed, and how it ended."""
    script = [sys.executable, str(HERE / "drawn_workbooks.py"), str(folder), str(seed), str(count)]
    home = {**os.environ, "PYTHONPATH": str(HERE.parents[2])}
    home |= dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"), "1")  # each asks for room
    done = subprocess.run(script, env=home, capture_output=True, text=True, check=False)
    return done.stdout.splitlines(), done.returncode


def check(tmp_path, seed, count):
    lines, status = drawn(tmp_path, seed, count)
    assert status == 0, (status, lines[-1:])  # a signal is a negative number
    assert len(lines) == count
    assert [line for line in lines if "offends" in line] == []
    read = sum(line.endswith("read") for line in lines)
    assert 0.1 * count < read < 0.9 * count


@pytest.mark.study(turn="each")
def test_some_drawn_workbooks(tmp_path):
    check(tmp_path, 1, 60)


@pytest.mark.study(turn="each")
@pytest.mark.parametrize("seed", range(2, 7))
def test_many_drawn_workbooks(tmp_path, seed):
    check(tmp_path, seed, 400)
