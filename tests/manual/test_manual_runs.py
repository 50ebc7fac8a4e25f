"""Every block of README and guide does what stands there, in a copy of the sample project.

The first line of a fence says what is done with it: `sh` is run by a shell in which `trialid` is
this one, `python` is executed, the blocks of a page one after another in one namespace, `toml` is a
pipeline, `toml part` a part of one, `toml ship` and `toml design` the other files; `text printed`
is what the `sh` before it prints, `text` is only shown.
"""

import re
import shutil
import tomllib
from pathlib import Path
from typing import Any

import pytest
from printed import (
    DOCUMENTS,
    PRINTED,
    SAMPLE,
    Block,
    blocks,
    sample_project,
    shell,
    to_run,
    told,
)
from turns import TURNS

import trialid
from trialid import effects, pipeline_file
from trialid.pipeline_file.design_file import load_design
from trialid.report.terminal.terminal import SCREEN
from trialid.ship.particulars import read_ship

FILES = ("toml", "toml part", "toml ship", "toml design", "toml fleet")
BATCH = ("sh batch", "python batch")
"""What needs Dask and DuckDB: `test_batch_page` runs it."""
KINDS = ("sh", "python", "python front-door", "text", "yaml", PRINTED, *BATCH, *FILES)
ONE_SCREEN = re.compile(r"trialid (?:run|add|drop|design) [^\n]*\n?")
"""A block of one command whose answer is one screen."""

NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[-+]\d+)?")
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
    printed = sample_project(folder)
    (folder / "printed.txt").write_text(printed, encoding="utf-8")
    assert "righting_arm_cubic is missing" in " ".join(printed.split())
    return folder


@pytest.fixture(scope="module")
def sample(project: Path) -> str:
    """What the run of the sample printed."""
    return (project / "printed.txt").read_text(encoding="utf-8")


@pytest.fixture
def copy(project: Path, tmp_path: Path) -> Path:
    """The same for one page, which may write into it."""
    return Path(shutil.copytree(project, tmp_path / "project"))


def in_turn(documents: list[str]) -> list[Any]:
    """One page after another."""
    return [
        pytest.param(document, marks=pytest.mark.study(turn=k % TURNS))
        for k, document in enumerate(documents)
    ]


@pytest.mark.parametrize("document", in_turn(with_any("sh")))
def test_its_commands_run_and_print_what_is_shown(document: str, copy: Path, sample: str) -> None:
    last = ""
    for block in blocks(document):
        if block.kind == "sh":
            last = told(copy, block.text, sample)
            if ONE_SCREEN.fullmatch(block.text):
                assert_one_screen(last)
        if block.kind == PRINTED:
            where = f"{document}, line {block.line}"
            assert block.text == last, f"{where}: stale; run: python tests/manual/printed.py"


@pytest.mark.study(turn=7)
def test_the_readme_shows_the_first_screen_whole(sample: str) -> None:
    """80 columns of 40 lines, one of them for the prompt, and it is the one that comes out."""
    [shown] = [block.text for block in blocks("README") if block.kind == PRINTED]
    assert NUMBER.split(shown) == NUMBER.split(sample)
    found, printed = (list(map(float, NUMBER.findall(text))) for text in (sample, shown))
    assert found == pytest.approx(printed, rel=1e-4)  # processors differ in a fifth digit
    assert_one_screen(sample)
    lines = sample.splitlines()
    assert lines[1].startswith("righting_arm_cubic is missing: ")
    assert lines[-1] == "Report: runs/hidden_effect/report.html"


def assert_one_screen(printed: str) -> None:
    lines = printed.splitlines()
    assert len(lines) <= SCREEN[0] < 40  # and the prompt
    assert max(map(len, lines)) <= SCREEN[1]


def test_commands_of_one_screen_are_found() -> None:
    """A run, a change, the loop and a design are among what the documents show."""
    texts = [b.text.strip() for d in DOCUMENTS for b in blocks(d) if b.kind == "sh"]
    found = [text for text in texts if ONE_SCREEN.fullmatch(text)]
    words = {word for text in found for word in text.split()}
    assert {"run", "add", "drop", "design", "--auto"} <= words


def test_what_is_left_of_a_block() -> None:
    assert to_run("python3 -m venv .venv && .venv/bin/pip install . && .venv/bin/trialid x\n") == (
        "trialid x"
    )
    assert to_run(f"a\n{SAMPLE}\nb \\\n  c\n") == "a\nb    c"


@pytest.mark.study(turn=5)
def test_a_command_that_fails_is_found(project: Path) -> None:
    with pytest.raises(AssertionError, match="no such pipeline"):
        shell(project, "trialid run nothing.toml | cat")


# --- Python -------------------------------------------------------------------------------------


@pytest.mark.parametrize("document", in_turn(with_any("python", "python front-door")))
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
