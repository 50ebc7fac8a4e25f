"""`python -O` and `-OO` strip assertions and docstrings, NumPy warns: the program is the same."""

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


def test_what_numpy_warns_of_does_not_reach_the_user() -> None:
    """A process of its own, as the tests themselves take every warning for an error."""
    code = (
        "import numpy as np\n"
        "from trialid.cli import main\n"
        "main.commands = lambda **options: print(np.float64(1e308) * 10)\n"
        "main.main()\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "inf\n", "")
