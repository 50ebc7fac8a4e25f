"""What `trialid demo` writes is what the project ships, and it needs nothing but the wheel."""

import hashlib
import os
import re
import shutil
import subprocess
import sys
import tomllib
import venv
from importlib import util
from pathlib import Path
from urllib.request import HTTPCookieProcessor, build_opener

import pytest
from click.testing import CliRunner, Result

from trialid import own_files
from trialid.cli import demo_command, main
from trialid.sample import SHIPPED, write
from trialid.sample.demo_folder import LOG_FILES, LOGS

ROOT = Path(__file__).parents[2]
HIDDEN_EFFECT = "pipelines/hidden_effect.toml"


def demo(*arguments: str | Path) -> Result:
    return CliRunner().invoke(main.commands, ["demo", *map(str, arguments)])


def state(folder: Path) -> dict[str, str]:
    """Hashes of all files by name."""
    return {
        path.relative_to(folder).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("demo") / "made"
    write(folder)
    return folder


@pytest.fixture
def copy(made: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(made, tmp_path / "copy"))


def shipped() -> dict[str, str]:
    """Hashes of what the project ships: the texts and the logs."""
    found = {
        **{f"pipelines/{n}": h for n, h in state(ROOT / "pipelines").items()},
        **{f"sample_data/{n}": h for n, h in state(ROOT / "sample_data").items()},
    }
    return {n: h for n, h in found.items() if not n.endswith(".png")}


@pytest.mark.study(turn=6)
def test_it_writes_the_bytes_that_are_shipped(made: Path) -> None:
    """The logs come from the simulator, so that this also says the shipped ones do."""
    written = state(made)
    assert written.pop(own_files.LIST)
    assert written == shipped()
    assert {f"{LOGS}/{file}" for file in LOG_FILES} < set(written)


def test_the_wheel_is_told_of_every_text() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    wheel = project["tool"]["hatch"]["build"]["targets"]["wheel"]
    assert wheel["force-include"] == {name: f"trialid/sample/shipped/{name}" for name in SHIPPED}


@pytest.mark.study(turn=12)
def test_once_more_is_the_same(copy: Path) -> None:
    before = state(copy)
    told = demo(copy)
    assert told.exit_code == 0
    assert state(copy) == before


@pytest.mark.study(turn=0)
def test_what_to_try_is_said(copy: Path) -> None:
    told = demo(copy).stdout
    assert f"  cd {copy}\n" in told
    for command in ("run", "add", "workbench"):
        assert f"\n  trialid {command} {HIDDEN_EFFECT}" in told


@pytest.mark.study(turn=6)
def test_a_missing_extra_is_named(copy: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(demo_command, "find_spec", lambda name: util.find_spec("json"))
    assert "pip install" not in demo(copy).stdout
    monkeypatch.setattr(demo_command, "find_spec", lambda name: None)
    assert "pip install 'trialid[workbench]'" in demo(copy).stdout


@pytest.mark.parametrize("name", [HIDDEN_EFFECT, "sample_data/ships/s175q.toml"])
def test_an_edited_file_is_not_replaced(copy: Path, name: str) -> None:
    with (copy / name).open("a", encoding="utf-8") as stream:
        stream.write("# mine\n")
    before = state(copy)
    told = demo(copy)
    assert (told.exit_code, told.stdout, told.stderr.count("\n")) == (2, "", 1)
    assert f"{name}: was changed since it was written and is not replaced" in told.stderr
    assert "choose another DIR" in told.stderr
    assert state(copy) == before


def test_a_strangers_folder_is_left_alone(tmp_path: Path) -> None:
    theirs = tmp_path / "sample_data" / "README.md"
    theirs.parent.mkdir()
    theirs.write_text("theirs")
    told = demo(tmp_path)
    assert (told.exit_code, told.stderr.count("\n")) == (2, 1)
    assert "is no file of trialid's" in told.stderr
    assert list(state(tmp_path)) == ["sample_data/README.md"]
    assert demo(theirs).exit_code == 2
    assert theirs.read_text() == "theirs"


# --- the wheel alone ----------------------------------------------------------------------------


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The command of a fresh environment that holds the wheel and what it asks for, no more."""
    place = tmp_path_factory.mktemp("wheel")
    build = [sys.executable, "-m", "build", "--wheel", "--outdir", str(place), str(ROOT)]
    subprocess.run(build, check=True, capture_output=True, timeout=300)
    (wheel,) = place.glob("*.whl")
    venv.create(place / "venv", with_pip=True)
    pip = [str(place / "venv" / "bin" / "python"), "-m", "pip", "install", "--quiet", str(wheel)]
    subprocess.run(pip, check=True, capture_output=True, timeout=600, env=without_python_path())
    return place / "venv" / "bin" / "trialid"


def without_python_path() -> dict[str, str]:
    return {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}


@pytest.mark.study(turn=13)
def test_a_wheel_is_enough(installed: Path, tmp_path: Path) -> None:
    """In a fresh environment: demo, run, add, drop, report, start; an extra is named, and works."""

    def trialid(*arguments: str, status: int = 0) -> str:
        done = subprocess.run(
            [str(installed), *arguments],
            cwd=tmp_path if arguments == ("demo",) else tmp_path / "trialid-demo",
            env=without_python_path(),
            capture_output=True,
            text=True,
            check=False,
            timeout=300,
        )
        assert done.returncode == status, done.stdout + done.stderr
        return " ".join((done.stderr if status else done.stdout).split())

    assert "trialid[workbench]" in trialid("demo")
    place = tmp_path / "trialid-demo"
    texts = {name: digest for name, digest in shipped().items() if name in SHIPPED}
    assert {n: h for n, h in state(place).items() if n in SHIPPED} == texts
    pipeline = (place / HIDDEN_EFFECT).read_bytes()
    assert "righting_arm_cubic is missing" in trialid("run", HIDDEN_EFFECT)
    added = trialid("add", HIDDEN_EFFECT, "righting_arm_cubic")
    assert "missing (righting_arm_cubic) -> nothing missing" in added
    assert (place / HIDDEN_EFFECT).read_bytes() != pipeline
    trialid("drop", HIDDEN_EFFECT, "righting_arm_cubic")
    assert (place / HIDDEN_EFFECT).read_bytes() == pipeline
    assert "Report: runs/hidden_effect/report.html" in trialid("report", "runs/hidden_effect")
    started = trialid("start", f"{LOGS}/zigzag-15.csv", "--length", "175", "--pipeline", "own.toml")
    assert "Report: runs/own/report.html" in started
    assert "'trialid[workbench]'" in trialid("workbench", HIDDEN_EFFECT, status=2)
    parquet = ("align", HIDDEN_EFFECT, "--out", "series.parquet")
    assert "'trialid[tables]'" in trialid(*parquet, status=2)
    with_extra(installed, "workbench")
    assert answered([str(installed), "workbench", HIDDEN_EFFECT, "--port", "0"], place) == 200


def with_extra(installed: Path, extra: str) -> None:
    """Install what an extra asks for; its names stand in the wheel."""
    (wheel,) = installed.parents[2].glob("*.whl")
    pip = [str(installed.with_name("python")), "-m", "pip", "install", "--quiet"]
    subprocess.run([*pip, f"{wheel}[{extra}]"], check=True, env=without_python_path(), timeout=600)


def answered(command: list[str], folder: Path) -> int:
    """The status that the printed address is answered with."""
    with subprocess.Popen(
        command, cwd=folder, env=without_python_path(), stdout=subprocess.PIPE, text=True
    ) as server:
        assert server.stdout is not None
        try:
            said = next(found for x in server.stdout if (found := re.search(r"http://\S+", x)))
            with build_opener(HTTPCookieProcessor()).open(said[0], timeout=60) as page:
                return int(page.status)
        finally:
            server.kill()
