"""`python -OO` strips assertions and docstrings; the program is the same without them."""

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def printed(*flags: str) -> str:
    command = [sys.executable, *flags, "-m", "trialid", "effects", "righting_arm_cubic", "--json"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout


@pytest.mark.parametrize("flag", ["-O", "-OO"])
def test_an_effect_is_there_without_its_words(flag: str) -> None:
    whole, stripped = printed(), printed(flag)
    assert '"righting_arm_cubic"' in stripped
    assert (stripped == whole) is (flag == "-O")
