"""Every block of README and guide does what stands there, in a copy of the sample project.

The first line of a fence says what is done with it: `sh` is run by a shell in which `trialid` is
this one, `python` is executed, the blocks of a page one after another in one namespace, `toml` is a
pipeline, `toml part` a part of one, `toml ship` and `toml design` the other files; `text` is only
shown.
"""

import os
import re
import shutil
import stat
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

import trialid
from trialid import effects, pipeline_file
from trialid.guide import TOPICS
from trialid.pipeline_file.design_file import load_design
from trialid.ship.particulars import read_ship

ROOT = Path(__file__).parent.parent
DOCUMENTS = {
    "README": ROOT / "README.md",
    **{topic: ROOT / "trialid" / "guide" / f"{topic}.md" for topic in TOPICS},
}
KINDS = (
    "sh", "python", "python front-door", "toml", "toml part", "toml ship", "toml design", "text",
)  # fmt: skip
LONGEST = 300
"""A page whose commands need more hangs [s]."""

SAMPLE = "trialid run pipelines/hidden_effect.toml"
"""What is run once, and not again by every page that begins with it."""

FRONT_DOOR = hasattr(trialid, "run")

BASE = """
name = "base"
ship = "ship.toml"
[[trial]]
name = "zigzag"
logs = ["bridge.mcap"]
[signals]
delta = { channel = "rudder", unit = "deg", positive = "port" }
[model]
states = ["v", "r"]
effects = ["linear_hull"]
[identify]
free = ["Nr"]
outputs = ["r"]
"""
"""What a part of a pipeline is put into."""


@dataclass(frozen=True)
class Block:
    """One fence of a document: what kind it says it is, its text, the line it begins on."""

    kind: str
    text: str
    line: int


def blocks(document: str) -> Iterator[Block]:
    """Every fence of a document, in order."""
    text = DOCUMENTS[document].read_text(encoding="utf-8")
    for found in re.finditer(r"^```([^\n]*)\n(.*?)^```$", text, re.DOTALL | re.MULTILINE):
        yield Block(found[1], found[2], text.count("\n", 0, found.start()) + 1)


def of_kind(*kinds: str) -> list[Any]:
    """Blocks of these kinds, for a test each."""
    return [
        pytest.param(block, id=f"{document}:{block.line}")
        for document in DOCUMENTS
        for block in blocks(document)
        if block.kind in kinds
    ]


def with_any(*kinds: str) -> list[str]:
    """Documents that hold a block of these kinds."""
    return [d for d in DOCUMENTS if any(block.kind in kinds for block in blocks(d))]


@pytest.mark.parametrize("document", DOCUMENTS)
def test_every_block_says_what_it_is(document: str) -> None:
    unknown = [(b.line, b.kind) for b in blocks(document) if b.kind not in KINDS]
    assert unknown == [], f"the first line of a fence is one of {', '.join(KINDS)}"
    text = DOCUMENTS[document].read_text(encoding="utf-8")
    assert len(re.findall(r"^```", text, re.MULTILINE)) == 2 * len(list(blocks(document)))


# --- commands -----------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def project(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Samples and pipelines, a `trialid` of this interpreter, and the run of the sample, once."""
    folder = tmp_path_factory.mktemp("manual") / "project"
    for name in ("pipelines", "sample_data"):
        shutil.copytree(ROOT / name, folder / name)
    shim = folder / "bin" / "trialid"
    shim.parent.mkdir()
    shim.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m trialid "$@"\n', encoding="utf-8")
    shim.chmod(shim.stat().st_mode | stat.S_IXUSR)
    told = shell(folder, SAMPLE)
    assert "righting_arm_cubic is missing" in " ".join(told.split())
    return folder


@pytest.fixture
def copy(project: Path, tmp_path: Path) -> Path:
    """The same for one page, which may write into it."""
    return Path(shutil.copytree(project, tmp_path / "project"))


def shell(folder: Path, commands: str) -> str:
    """What commands print; the first that fails is shown with all it says."""
    paths = f"{folder / 'bin'}{os.pathsep}{os.environ['PATH']}"
    done = subprocess.run(
        ["bash", "-euo", "pipefail", "-c", commands],
        cwd=folder,
        env={**os.environ, "PATH": paths, "PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        check=False,
        timeout=LONGEST,
    )
    assert done.returncode == 0, f"{commands}\n{done.stdout[-2000:]}{done.stderr[-2000:]}"
    return done.stdout


def to_run(text: str) -> str:
    """A block without what installs, and without what was run for all pages already.

    A line that installs ends with what is to be run; the tests are those that are running.
    """
    lines = []
    for line in text.replace("\\\n", " ").splitlines():
        last = line.rpartition("&&")[2].strip().removeprefix(".venv/bin/")
        if last not in ("pytest", SAMPLE):
            lines.append(last if "pip install" in line else line)
    return "\n".join(lines)


def in_turn(documents: list[str]) -> list[Any]:
    """What a stranger reads first each time, the other pages one after another."""
    first = ("README", "first_trial")
    later = [d for d in documents if d not in first]
    cases = [pytest.param(d, marks=pytest.mark.study(turn=k % 5)) for k, d in enumerate(later)]
    return [*(d for d in first if d in documents), *cases]


@pytest.mark.parametrize("document", in_turn(with_any("sh")))
def test_its_commands_run(document: str, copy: Path) -> None:
    for block in blocks(document):
        if block.kind == "sh":
            shell(copy, to_run(block.text))


def test_what_is_left_of_a_block() -> None:
    assert to_run("python3 -m venv .venv && .venv/bin/pip install . && .venv/bin/trialid x\n") == (
        "trialid x"
    )
    assert to_run(f"a\n{SAMPLE}\nb \\\n  c\n") == "a\nb    c"


def test_a_command_that_fails_is_found(project: Path) -> None:
    with pytest.raises(AssertionError, match="no such pipeline"):
        shell(project, "trialid run nothing.toml | cat")


# --- Python -------------------------------------------------------------------------------------


@pytest.mark.parametrize("document", with_any("python", "python front-door"))
def test_its_python_runs(document: str, copy: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """In one namespace, so that a page can go on from what stands above."""
    monkeypatch.chdir(copy)
    names: dict[str, Any] = {"__name__": f"guide_{document}"}
    for block in blocks(document):
        ready = block.kind == "python" or (block.kind == "python front-door" and FRONT_DOOR)
        if ready:
            lines = "\n" * block.line + block.text  # so that an error has the page's own line
            exec(compile(lines, str(DOCUMENTS[document]), "exec"), names)


@pytest.mark.parametrize("block", of_kind("python", "python front-door"))
def test_its_python_is_python(block: Block) -> None:
    """What waits for the front door can at least be read."""
    compile(block.text, "block", "exec")


@pytest.mark.parametrize("block", [b for b in of_kind("python") if "@effect" in b.values[0].text])
def test_its_effects_are_effects(block: Block, tmp_path: Path) -> None:
    path = tmp_path / "my_effects.py"
    path.write_text(block.text, encoding="utf-8")
    found = effects.from_file(path)
    assert found
    assert not set(found) & set(effects.CATALOGUE)


# --- files --------------------------------------------------------------------------------------


def touched(folder: Path, table: dict[str, Any]) -> None:
    """Files that a table names, empty, where only their being there is checked."""
    for name in re.findall(r"'([\w.-]+\.(?:toml|mcap|csv|txt|py))'", repr(table)):
        (folder / name).touch()


@pytest.mark.parametrize("block", of_kind("toml", "toml part"))
def test_its_pipelines_are_read(block: Block, tmp_path: Path) -> None:
    """Every key in them is a key, every unit a unit, every effect one of the catalogue or own."""
    table = tomllib.loads(block.text)
    touched(tmp_path, {**tomllib.loads(BASE), **table})
    text = block.text
    if block.kind == "toml part":
        tables = re.split(r"^(?=\[)", BASE, flags=re.MULTILINE)
        instead = re.compile(rf"\[+({'|'.join(table)})\]")
        text = "".join(t for t in tables if not instead.match(t)) + text
    (tmp_path / "block.toml").write_text(text, encoding="utf-8")
    read = pipeline_file.load(tmp_path / "block.toml")
    unknown = [name for name in read.model.effects if name not in effects.CATALOGUE]
    assert not unknown or read.model.effects_from


@pytest.mark.parametrize("block", of_kind("toml ship"))
def test_its_ships_are_read(block: Block, tmp_path: Path) -> None:
    (tmp_path / "ship.toml").write_text(block.text, encoding="utf-8")
    assert read_ship(tmp_path / "ship.toml").name == tomllib.loads(block.text)["name"]


@pytest.mark.parametrize("block", of_kind("toml design"))
def test_its_designs_are_read(block: Block, tmp_path: Path) -> None:
    pipeline = re.search(r'^pipeline = "(.*)"$', block.text, re.MULTILINE)
    if pipeline is not None:
        touched(tmp_path, tomllib.loads(BASE))
        (tmp_path / pipeline[1]).write_text(BASE, encoding="utf-8")
    (tmp_path / "design.toml").write_text(block.text, encoding="utf-8")
    assert load_design(tmp_path / "design.toml").tests
