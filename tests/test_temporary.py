"""Files on their way: whole or not at all, told before the work, and swept when left behind."""

import errno
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from trialid import own_files, temporary
from trialid.cli import main
from trialid.errors import TrialidError
from trialid.pipeline_file.rewrite import rewriting

ROOT = Path(__file__).parents[1]
posix = pytest.mark.skipif(os.name != "posix", reason="processes have no such signals here")

KILLED = """
import os, signal, sys
from pathlib import Path
from trialid import own_files, temporary
from trialid.pipeline_file.rewrite import rewriting
number, folder, count = int(sys.argv[1]), Path(sys.argv[2]), 0
EVENTS = ("open", "os.rename", "os.remove", "os.mkdir", "os.rmdir", "shutil.rmtree", "os.chmod",
          "os.scandir", "os.listdir", "tempfile.mkdtemp", "tempfile.mkstemp")
def hook(event, arguments):
    global count
    if event in EVENTS:
        count += 1
        if count == number:
            os.kill(os.getpid(), signal.SIGKILL)
def replace():
    with own_files.replacing(folder / "run") as place:
        (place / "a.txt").write_text("new")
        (place / "more").mkdir()
        (place / "more" / "b.txt").write_text("new")
def rewrite():
    with rewriting(folder / "p.toml", b"old", b"new") as stroke:
        stroke()
def export():
    with temporary.replace_whole(folder / "out.csv") as ready:
        ready.write_text("new")
act = {"replace": replace, "rewrite": rewrite, "export": export}[sys.argv[3]]
sys.addaudithook(hook)
act()
"""


def killed(number, folder, act):
    """The act, killed at its `number`-th event of files; whether it was."""
    done = subprocess.run(
        [sys.executable, "-c", KILLED, str(number), str(folder), act],
        env={**os.environ, "PYTHONPATH": str(ROOT)}, capture_output=True, check=False,
    )  # fmt: skip
    assert done.returncode in (0, -9), done.stderr.decode()
    return done.returncode == -9


def prepared(folder):
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    (folder / "p.toml").write_text("old")
    (folder / "out.csv").write_text("old")
    (folder / "theirs.txt").write_text("somebody else's")
    (folder / ".trialid-notes").write_text("somebody else's, too")
    with own_files.replacing(folder / "run") as place:
        (place / "a.txt").write_text("old")
        (place / "c.txt").write_text("old")


def replace(folder):
    with own_files.replacing(folder / "run") as place:
        (place / "a.txt").write_text("newer")


def rewrite(folder):
    with rewriting(folder / "p.toml", b"old", b"new") as stroke:
        stroke()


def export(folder):
    with temporary.replace_whole(folder / "out.csv") as ready:
        ready.write_text("newer")


ACTS = {"replace": replace, "rewrite": rewrite, "export": export}
PLACES = {"replace": "run", "rewrite": ".", "export": "."}


@posix
@pytest.mark.parametrize("act", PLACES)
@pytest.mark.study(turn="each")
def test_killed_at_every_file_event_it_leaves_nothing_to_the_next(tmp_path, act):
    number, left = 0, 0
    while True:
        number += 1
        prepared(tmp_path / "w")
        was_killed = killed(number, tmp_path / "w", act)
        place = tmp_path / "w" / PLACES[act]
        left += any(temporary.NAME.fullmatch(path.name) for path in place.iterdir())
        for name in ("p.toml", "out.csv", "run/a.txt"):
            assert (tmp_path / "w" / name).read_text() in ("old", "new"), (number, name)
        if (tmp_path / "w" / "p.toml").read_text() == "new":
            (tmp_path / "w" / "p.toml").write_text("old")
        ACTS[act](tmp_path / "w")  # it goes through, whatever the first left
        names = sorted(path.name for path in place.iterdir())
        assert not any(temporary.NAME.fullmatch(name) for name in names), (number, names)
        assert (tmp_path / "w" / "theirs.txt").read_text() == "somebody else's"
        assert (tmp_path / "w" / ".trialid-notes").is_file()
        if not was_killed:
            break
    assert number > 4
    assert left > 0  # else nothing was swept


def test_what_another_process_is_writing_stays(tmp_path):
    mine = tmp_path / f"{temporary.prefix()}abcdefgh"
    mine.mkdir()
    temporary.sweep(tmp_path)
    assert mine.is_dir()


LIMITED = """
import resource, sys
from pathlib import Path
resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))
from trialid import temporary
path = Path(sys.argv[1])
try:
    if sys.argv[2] == "new":
        temporary.write_new(path, "x" * 5000)
    else:
        with temporary.replace_whole(path) as ready:
            ready.write_text("x" * 5000)
except OSError as error:
    sys.exit(error.errno)
"""


@posix
@pytest.mark.parametrize("kind", ["new", "replace"])
def test_where_there_is_no_room_nothing_is_left(tmp_path, kind):
    if kind == "replace":
        (tmp_path / "f.toml").write_text("old")
    done = subprocess.run(
        [sys.executable, "-c", LIMITED, str(tmp_path / "f.toml"), kind],
        env={**os.environ, "PYTHONPATH": str(ROOT)}, capture_output=True, check=False,
    )  # fmt: skip
    assert done.returncode == errno.EFBIG, done.stderr
    held = {path.name: path.read_text() for path in tmp_path.iterdir()}
    assert held == ({"f.toml": "old"} if kind == "replace" else {})


def test_a_name_that_is_no_text_is_written_all_the_same(tmp_path):
    temporary.write_new(tmp_path / "p.toml", "log = 'a\udcff.csv'")
    assert (tmp_path / "p.toml").read_text("utf-8") == "log = 'a\\udcff.csv'"


COMMANDS = {
    "run": ("run", "p.toml"), "auto": ("run", "p.toml", "--auto"), "add": ("add", "p.toml", "x"),
    "align": ("align", "p.toml", "--out", "x.csv"),
    "replay": ("replay", "p.toml", "--out", "x.mcap"),
    "init": ("inspect", "log.csv", "--init", "x.toml", "--length", "9"),
    "template": ("inspect", "log.csv", "--template", "x.toml"),
}  # fmt: skip


@pytest.mark.parametrize("why", ["read only", "full"])
@pytest.mark.parametrize("words", COMMANDS.values(), ids=COMMANDS)
def test_a_place_that_cannot_be_written_is_told_before_the_work(tmp_path, monkeypatch, words, why):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "log.csv").write_text("t,u\n0,1\n1,2\n2,4\n")
    pipeline = (ROOT / "pipelines/hidden_effect.toml").read_text("utf-8")
    (tmp_path / "p.toml").write_text(pipeline.replace("../sample", f"{ROOT.as_posix()}/sample"))
    if why == "full":
        usage = shutil.disk_usage(tmp_path)
        monkeypatch.setattr(shutil, "disk_usage", lambda path: usage._replace(free=0))
    else:
        monkeypatch.setattr(os, "access", lambda path, mode, **kind: not mode & os.W_OK)
    monkeypatch.setattr("trialid.ingest.read", lambda *a: pytest.fail("the work has begun"))
    done = CliRunner().invoke(main.commands, list(words), prog_name="trialid")
    assert done.exit_code == 2, done.output
    assert "cannot be written" in done.stderr
    assert sorted(path.name for path in tmp_path.iterdir()) == ["log.csv", "p.toml"]


def test_a_place_that_can_be_written_is_let_through(tmp_path):
    temporary.check_writable(tmp_path / "runs" / "new")
    with pytest.raises(TrialidError, match="cannot be written"):
        temporary.check_writable(Path("/proc/nothing") if os.name == "posix" else Path("Z:/no"))
