"""No file that is not ours is ever replaced or removed, whatever `--out` says."""

import hashlib
import json
import shutil
from pathlib import Path

import pytest
from click.testing import CliRunner

from trialid import own_files
from trialid.cli.main import commands
from trialid.errors import TrialidError

ROOT = Path(__file__).parent.parent
PIPELINE = ROOT / "pipelines" / "hidden_effect.toml"
DESIGN = ROOT / "pipelines" / "design_rivals.toml"
THEIRS = {
    "result.json": '{"theirs": true}\n',
    "thesis.tex": "\\documentclass{book}\n",
    "tables/parameters.csv": "mine,1\n",
    "notes/day one.md": "calm\n",
}


def state(folder: Path) -> dict[str, str]:
    return {
        path.relative_to(folder).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


def fill(folder: Path, files: dict[str, str]) -> None:
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")


def put(folder: Path, files: dict[str, str], **how) -> None:
    with own_files.replacing(folder, **how) as work:
        fill(work, files)


def run_folder(folder: Path) -> Path:
    done = CliRunner().invoke(commands, ["run", str(PIPELINE), "--quiet", "--out", str(folder)])
    assert done.exit_code == 0, done.output
    return folder


def test_ours_is_replaced_and_what_is_not_made_again_goes(tmp_path: Path) -> None:
    put(tmp_path, {"a.txt": "1", "b/c.txt": "2"})
    put(tmp_path, {"a.txt": "3"})
    assert (tmp_path / "a.txt").read_text() == "3"
    assert not (tmp_path / "b" / "c.txt").exists()


def test_what_goes_is_only_below_the_names_given(tmp_path: Path) -> None:
    put(tmp_path, {"a.txt": "1", "tables/old.csv": "2"})
    put(tmp_path, {"tables/new.csv": "3"}, below=("tables/",))
    assert (tmp_path / "a.txt").exists()
    assert not (tmp_path / "tables" / "old.csv").exists()


@pytest.mark.parametrize("name", ["a.txt", "b/c.txt"])
def test_a_strangers_file_stops_all_of_it(tmp_path: Path, name: str) -> None:
    put(tmp_path, {"z.txt": "old"})
    fill(tmp_path, {name: "theirs"})
    before = state(tmp_path)
    with pytest.raises(TrialidError, match=r"is no file of trialid's.*choose another --out"):
        put(tmp_path, {"z.txt": "new", name: "ours"})
    assert state(tmp_path) == before


def test_a_file_of_ours_that_was_edited_is_no_longer_ours(tmp_path: Path) -> None:
    put(tmp_path, {"order.csv": "1", "gone.csv": "2"})
    fill(tmp_path, {"order.csv": "by hand", "gone.csv": "by hand too"})
    with pytest.raises(TrialidError, match=r"order\.csv: was changed since it was written"):
        put(tmp_path, {"order.csv": "3"})
    put(tmp_path, {"other.csv": "4"})
    assert (tmp_path / "gone.csv").read_text() == "by hand too"


@pytest.mark.parametrize("kind", ["folder", "link", "file in the way"])
def test_what_is_no_plain_file_is_not_replaced(tmp_path: Path, kind: str) -> None:
    target = tmp_path / "target.txt"
    target.write_text("theirs")
    place = tmp_path / "out"
    place.mkdir()
    if kind == "folder":
        (place / "b").mkdir()
    elif kind == "link":
        (place / "b").symlink_to(target)
    else:
        (place / "b").write_text("theirs")
    with pytest.raises(TrialidError):
        put(place, {"b": "ours"} if kind != "file in the way" else {"b/c": "ours"})
    assert target.read_text() == "theirs"
    assert [path.name for path in place.iterdir()] == ["b"]


def test_what_is_broken_off_leaves_the_folder_as_it_was(tmp_path: Path) -> None:
    put(tmp_path / "out", {"a.txt": "1"})
    before = state(tmp_path)

    def break_off(folder: Path) -> None:
        with own_files.replacing(folder) as work:
            fill(work, {"a.txt": "2"})
            raise RuntimeError

    with pytest.raises(RuntimeError):
        break_off(tmp_path / "out")
    assert state(tmp_path) == before
    with pytest.raises(RuntimeError):
        break_off(tmp_path / "new" / "deep")
    assert not (tmp_path / "new").exists()


@pytest.mark.parametrize("text", ["", "[]", '{"schema": "x"}', '{"schema": "trialid-files/1"}'])
def test_a_list_that_is_none_owns_nothing(tmp_path: Path, text: str) -> None:
    fill(tmp_path, {own_files.LIST: text, "a.txt": "theirs"})
    with pytest.raises(TrialidError):
        put(tmp_path, {"a.txt": "ours"})
    assert (tmp_path / "a.txt").read_text() == "theirs"


COMMANDS = (
    ["run", str(PIPELINE), "--quiet"],
    ["run", str(PIPELINE), "--quiet", "--auto"],
    ["add", "{pipeline}", "righting_arm_cubic", "--quiet"],
    ["drop", "{pipeline}", "yaw_drag_rar", "--quiet"],
    ["design", str(DESIGN), "--quiet"],
    ["report", "{run}", "--quiet"],
    ["report", "{run}", "{run}", "--quiet"],
)


@pytest.mark.parametrize("command", COMMANDS, ids=lambda c: " ".join(c[:1] + c[2:]))
def test_a_strangers_folder_is_the_same_after_every_command(
    command: list[str], tmp_path: Path, sample_run: Path
) -> None:
    shutil.copytree(ROOT / "pipelines", tmp_path / "pipelines")
    shutil.copytree(ROOT / "sample_data", tmp_path / "sample_data")
    out = tmp_path / "theirs"
    out.mkdir()
    fill(out, THEIRS)
    before = state(out)
    named = {"pipeline": tmp_path / "pipelines" / "hidden_effect.toml", "run": sample_run}
    words = [word.format(**named) for word in command]
    done = CliRunner().invoke(commands, [*words, "--out", str(out)])
    if command[0] == "report":  # writes beside what is there, or says which file is in the way
        assert {name: state(out)[name] for name in before} == before
        assert done.exit_code == 2
        return
    assert done.exit_code == 2, done.output
    assert state(out) == before


@pytest.mark.parametrize("suffix", [".mcap", ".foxglove.json", ".plotjuggler.xml"])
def test_a_replay_replaces_nothing_unasked(tmp_path: Path, sample_run: Path, suffix: str) -> None:
    out = tmp_path / "r.mcap"
    (tmp_path / f"r{suffix}").write_text("theirs")
    words = ["replay", str(PIPELINE), "--run", str(sample_run), "--fast", "--quiet", "--out"]
    done = CliRunner().invoke(commands, [*words, str(out)])
    assert done.exit_code == 2
    assert "add --force" in done.output
    assert [p.read_text() for p in tmp_path.iterdir()] == ["theirs"]


@pytest.mark.study(turn=9)
def test_notes_in_a_runs_own_folder_stay(tmp_path: Path, sample_run: Path) -> None:
    folder = tmp_path / "run"
    shutil.copytree(sample_run, folder)
    fill(folder, {"notes.txt": "calm", "tables/mine.csv": "1"})
    assert CliRunner().invoke(commands, ["report", str(folder), "--quiet"]).exit_code == 0
    assert (folder / "figures" / "split.svg").exists() or any((folder / "figures").iterdir())
    run_folder(folder)
    assert (folder / "notes.txt").read_text() == "calm"
    assert (folder / "tables" / "mine.csv").read_text() == "1"
    assert not (folder / "tables" / "parameters.csv").exists(), "of the run that was replaced"
    assert json.loads((folder / "result.json").read_text())["schema"] == "trialid-result/1"


@pytest.mark.study(turn=7)
def test_a_run_folder_of_an_earlier_version_is_replaced(tmp_path: Path, sample_run: Path) -> None:
    folder = tmp_path / "run"
    shutil.copytree(sample_run, folder)
    (folder / own_files.LIST).unlink()
    fill(folder, {"notes.txt": "calm"})
    run_folder(folder)
    assert (folder / "notes.txt").read_text() == "calm"
