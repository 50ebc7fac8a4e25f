"""What a model took is the system's again before the next is worked out."""

import subprocess
import sys
from pathlib import Path

import pytest
from quick import ADDED, diagnosed, edit, opened

from trialid.workbench import desk as desk_module

HEAP = """
import os
import numpy as np
from trialid.workbench.compute import give_back_memory

def held():
    pages = int(open("/proc/self/statm").read().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6

first = np.ones(1 << 17)
del first  # arrays of this size come from the heap from now on
kept = []
for _ in range(300):
    large = np.ones(1 << 17)
    kept.append((large, np.ones(1 << 12)))
kept = [small for _, small in kept]
del large
before = held()
give_back_memory()
print(before, held(), 300 * 8 * (1 << 17) / 1e6)
"""


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="others give it back themselves")
def test_what_nothing_holds_is_given_back() -> None:
    done = subprocess.run([sys.executable, "-c", HEAP], capture_output=True, text=True, check=True)
    before, after, freed = map(float, done.stdout.split())
    assert before - after > 0.8 * freed


@pytest.mark.study(turn="each")
def test_it_is_given_back_after_every_model(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    told: list[str] = []
    monkeypatch.setattr(desk_module, "give_back_memory", lambda: told.append("given back"))
    with opened(path) as desk:
        diagnosed(desk)
        edit(desk, do="add", effect=ADDED)
        diagnosed(desk)
    assert len(told) >= 1  # the last may still be at it
