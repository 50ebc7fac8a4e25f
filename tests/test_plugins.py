"""A package of somebody else's adds a log format, an effect and an export format."""

import json
import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent

LOG = '''
"""Logs of the tug's own recorder: `TUG1`, then a line a sample."""
import numpy as np
from trialid.ingest.adapter import Adapter, sha256
from trialid.recording import Channel, Recording

def read(path, wanted, aids):
    rows = np.loadtxt(path, skiprows=1)
    stamps = np.rint(rows[:, 0] * 1e9).astype(np.int64)
    names = {"turning": ("deg/s", 1), "wheel": ("deg", 2)}
    channels = {n: Channel(n, stamps, rows[:, k], unit=u) for n, (u, k) in names.items()}
    return Recording(path, sha256(path), "tug", channels)

ADAPTER = Adapter("tug recorder", lambda head: head.startswith(b"TUG1"), read)
'''
EFFECTS = '''
"""Effects of tugs."""
from trialid.ship.effect import Force, effect

@effect(source="the tug's builder")
def skeg_drag(v, *, Yskegvav=-0.01):
    """Y = Yskegvav |v| v: the skeg in the cross flow."""
    return Force(Y=Yskegvav * abs(v) * v)
'''
WRITER = '''
"""A file of names alone."""
def write(path, trials, provenance):
    path.write_text("\\n".join(trial.name for trial in trials))
'''
POINTS = """
[trialid.adapters]
tug = tug_tools.tug_log:ADAPTER
[trialid.effects]
tug = tug_tools.tug_effects
[trialid.exporters]
.names = tug_tools.names_file:write
"""


def wheel(folder: Path, files: dict[str, str], points: str) -> Path:
    """A wheel as a build would make it."""
    info = "tug_tools-1.2.dist-info"
    content = {
        "tug_tools/__init__.py": '"""Tools for tugs."""\n',
        **{f"tug_tools/{name}": text for name, text in files.items()},
        f"{info}/METADATA": "Metadata-Version: 2.1\nName: tug-tools\nVersion: 1.2\n",
        f"{info}/WHEEL": "Wheel-Version: 1.0\nGenerator: test\nRoot-Is-Purelib: true\n"
        "Tag: py3-none-any\n",
        f"{info}/entry_points.txt": points,
    }
    content[f"{info}/RECORD"] = "".join(f"{name},,\n" for name in [*content, f"{info}/RECORD"])
    path = folder / "tug_tools-1.2-py3-none-any.whl"
    with zipfile.ZipFile(path, "w") as packed:
        for name, text in content.items():
            packed.writestr(name, text)
    return path


def installed(folder: Path, files: dict[str, str], points: str) -> dict[str, str]:
    """The environment of a Python in which the package is installed."""
    site = folder / "site"
    pip = [sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--no-index"]
    command = [*pip, "--target", str(site), str(wheel(folder, files, points))]
    subprocess.run(command, check=True, timeout=120)
    path = os.pathsep.join(filter(None, [str(site), str(ROOT), os.environ.get("PYTHONPATH")]))
    return {**os.environ, "PYTHONPATH": path}


def trialid(words: list[str], env: dict[str, str]) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "trialid", *words]
    return subprocess.run(
        command, env=env, capture_output=True, text=True, check=False, timeout=120, cwd="/"
    )


@pytest.fixture(scope="module")
def tug(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    files = {"tug_log.py": LOG, "tug_effects.py": EFFECTS, "names_file.py": WRITER}
    return installed(tmp_path_factory.mktemp("tug"), files, POINTS)


def test_its_log_is_read(tug: dict[str, str], tmp_path: Path) -> None:
    log = tmp_path / "a.tug"
    rows = "".join(f"{k * 0.1:.1f} {k % 7} {k % 5}\n" for k in range(200))
    log.write_text("TUG1\n" + rows)
    done = trialid(["inspect", str(log), "--json", "--all"], tug)
    assert done.returncode == 0, done.stderr
    data = json.loads(done.stdout)
    assert "tug recorder" in json.dumps(data["files"])
    assert "turning" in json.dumps(data["channels"])


def test_its_effect_is_in_the_catalogue(tug: dict[str, str]) -> None:
    done = trialid(["effects", "skeg_drag"], tug)
    assert done.returncode == 0, done.stderr
    assert "the skeg in the cross flow" in done.stdout


@pytest.mark.study
def test_its_export_format_is_asked_for_by_its_suffix(tug: dict[str, str], tmp_path: Path) -> None:
    out = tmp_path / "aligned.names"
    pipeline = str(ROOT / "pipelines" / "hidden_effect.toml")
    done = trialid(["align", pipeline, "--out", str(out), "--quiet"], tug)
    assert done.returncode == 0, done.stderr
    assert out.read_text().split() == ["zigzag-10", "zigzag-20", "binary-15", "zigzag-15"]


def test_without_it_there_is_none_of_it() -> None:
    done = trialid(["effects", "skeg_drag"], {**os.environ, "PYTHONPATH": str(ROOT)})
    assert done.returncode == 2
    assert "there is no effect 'skeg_drag'" in done.stderr


@pytest.mark.parametrize(
    ("effects", "said"),
    [
        ("import nothing_of_that_name\n", "tug-tools: trialid.effects 'tug'"),
        ('"""None."""\n', "declares no effect"),
        ("import sys\n\nsys.exit(0)\n", "cannot be loaded (SystemExit: 0)"),
        (EFFECTS.replace("skeg_drag", "sway_drag_vav"), "'sway_drag_vav' is there already"),
    ],
)
def test_a_package_that_is_broken_is_one_line(tmp_path: Path, effects: str, said: str) -> None:
    points = "[trialid.effects]\ntug = tug_tools.tug_effects\n"
    done = trialid(["effects"], installed(tmp_path, {"tug_effects.py": effects}, points))
    assert done.returncode == 2
    assert len(done.stderr.splitlines()) == 1
    assert said in done.stderr
