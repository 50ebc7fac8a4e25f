"""What all tests share: the run of the sample, made once; studies in turn.

Test modules import `s175q` beside this file.
"""

import fcntl
import os
import subprocess
import sys
from pathlib import Path

import pytest
from turns import pytest_collection_modifyitems as pytest_collection_modifyitems  # noqa: PLC0414

# xdist tells its workers the width of a terminal; what is tested is what a file or a pipe gets.
os.environ.pop("COLUMNS", None)
# A worker a core: a second thread for their small matrices waits for a core more than it works, a
# fifth of all seconds. Read when numpy is first imported, which is after this.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

ROOT = Path(__file__).parent.parent
collect_ignore_glob = ["*/conftest.py"]
"""They hold no doctests, and as modules of one name they could not be given in one command."""

THREADS = {"OMP_NUM_THREADS": "2", "OPENBLAS_NUM_THREADS": "2"}


RUN = """\
import sys
from trialid.cli.main import main
try:
    main()
finally:
    with open("modules.txt", "w") as file:
        print(*sys.modules, file=file)
"""


@pytest.fixture(scope="session")
def sample_run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder that `trialid run` makes of the sample, once for all workers; for reading only.

    Made by another process, from another folder, with two threads and its own order of hashes: who
    gets the same bytes in this one has shown that none of that matters. What it imported stands in
    `modules.txt` beside the folder.
    """
    own = tmp_path_factory.getbasetemp()
    place = own.parent if "PYTEST_XDIST_WORKER" in os.environ else own
    folder = place / "sample" / "hidden_effect"
    with (place / "sample.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not folder.exists():
            _run_sample(folder)
    return folder


def _run_sample(folder: Path) -> None:
    folder.parent.mkdir()
    pipeline = ROOT / "pipelines" / "hidden_effect.toml"
    paths = os.pathsep.join([str(ROOT), *filter(None, [os.environ.get("PYTHONPATH")])])
    done = subprocess.run(
        [sys.executable, "-c", RUN, "run", str(pipeline), "--out", folder.name, "--quiet"],
        cwd=folder.parent,
        env={**os.environ, "PYTHONPATH": paths, "PYTHONHASHSEED": "7", **THREADS},
        capture_output=True,
        text=True,
        check=False,
        timeout=120,
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
