"""What a run does not ask for is not imported: a module of somebody's takes up to two seconds."""

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
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
TOLD = f"""
import sys
from trialid.cli.main import main
sys.argv = ["trialid", "run", sys.argv[1], "--out", sys.argv[2], "--quiet"]
try:
    main()
finally:
    print(*({UNASKED!r} & sys.modules.keys()))
"""


def test_a_run_of_the_sample_imports_no_more_than_it_asks_for(tmp_path):
    asked = str(ROOT / "pipelines" / "hidden_effect.toml")
    command = [sys.executable, "-c", TOLD, asked, str(tmp_path / "run")]
    done = subprocess.run(command, check=True, text=True, stdout=subprocess.PIPE)
    assert done.stdout.split() == []
