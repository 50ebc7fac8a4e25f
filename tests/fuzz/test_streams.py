"""The command with streams closed, full or left early, and hostile names on a terminal."""

import os
import select
import subprocess
import sys
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(ROOT)}
COMMANDS = {
    "help": "--help", "effects": "effects", "guide": "guide streams.md", "inspect":
    "inspect log.csv", "json": "inspect log.csv --json", "no such file": "inspect nofile",
    "no pipeline": "run nosuch.toml", "usage": "run --write",
    "init": "inspect log.csv --init new.toml --length 100 --speed 10",
}  # fmt: skip
WRONG = {"no such file": 2, "no pipeline": 2, "usage": 2, "guide": 2}
STREAMS = {
    "": 0, ">&-": 0, "2>&-": 0, ">&- 2>&-": 0, "<&-": 0, "<&- >&- 2>&-": 0, "2>/dev/full": 0,
    ">/dev/full": 2, ">/dev/full 2>/dev/full": 2, "| head -c 1": 0,
}  # fmt: skip
"""How a command ends that prints something and meets no mistake."""

posix = pytest.mark.skipif(not Path("/dev/full").exists(), reason="no such device here")


def table(folder, name="log.csv"):
    rows = [f"{0.1 * k:.1f},{k % 7},{k % 5}" for k in range(300)]
    (folder / name).write_text("\n".join(["t [s],rudder [deg],rot [deg/s]", *rows, ""]), "utf-8")


@posix
@pytest.mark.parametrize("streams", STREAMS)
@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.study(turn="each")
def test_streams(tmp_path, command, streams):
    table(tmp_path)
    keep = "" if "2>" in streams else "2>err"
    line = f"set -o pipefail; {sys.executable} -m trialid {COMMANDS[command]} {streams} {keep}"
    if "|" in streams:
        line = line.replace(streams, f"2>err {streams}").replace("2>err  2>err", "2>err")
    done = subprocess.run(
        ["bash", "-c", line], cwd=tmp_path, env=ENVIRONMENT, capture_output=True, timeout=60,
        check=False,
    )  # fmt: skip
    said = (tmp_path / "err").read_text("utf-8") if keep and (tmp_path / "err").exists() else ""
    assert "Traceback" not in said
    assert "Exception ignored" not in said
    assert done.returncode == WRONG.get(command, STREAMS[streams]), said
    if command == "init" and STREAMS[streams] == 0:
        assert (tmp_path / "new.toml").read_text("utf-8").startswith("#")


def test_a_file_takes_the_place_of_no_closed_stream(tmp_path):
    """Opened first, a file would have number 2, and what is complained would be written into it."""
    table(tmp_path)
    line = f"{sys.executable} -m trialid inspect log.csv --init new.toml --length 90 --speed 9 2>&-"
    subprocess.run(["bash", "-c", line], cwd=tmp_path, env=ENVIRONMENT, check=False)
    assert "Written:" not in (tmp_path / "new.toml").read_text("utf-8")


NAME = "l\x1b[31mo\x1b]0;owned\x07g\u202e.csv"


def on_a_terminal(words, folder):
    """What a terminal is sent."""
    pty = pytest.importorskip("pty")
    ours, theirs = pty.openpty()
    process = subprocess.Popen(
        [sys.executable, "-m", "trialid", *words], cwd=folder, stdin=theirs, stdout=theirs,
        stderr=theirs, env={**ENVIRONMENT, "TERM": "xterm-256color", "COLUMNS": "100"},
    )  # fmt: skip
    os.close(theirs)
    sent, end = b"", time.monotonic() + 60
    while time.monotonic() < end:
        ready, _, _ = select.select([ours], [], [], 0.2)
        if ready:
            try:
                piece = os.read(ours, 65536)
            except OSError:
                break
            if not piece:
                break
            sent += piece
        elif process.poll() is not None:
            break
    process.wait(10)
    os.close(ours)
    return sent.decode("utf-8", "replace")


@pytest.mark.parametrize(
    "words",
    [
        ("inspect", NAME), ("inspect", NAME, "--all"), ("inspect", NAME, "bad" + NAME),
        ("inspect", NAME, "--init", "p\x1b[31m.toml", "--length", "100"),
        ("inspect", NAME, "--template", "x\x1b[31m.toml"), ("run", "no\x1b[31m.toml"),
        ("effects", "\x1b[31m"), ("guide", "\x1b]0;owned\x07"), ("report", "no\x1b[31m"),
    ],
    ids=lambda words: " ".join(words[::2]).encode("unicode_escape").decode(),
)  # fmt: skip
@pytest.mark.study(turn="each")
def test_names_steer_no_terminal(tmp_path, words):
    table(tmp_path, NAME)
    sent = on_a_terminal(words, tmp_path)
    assert "\\x1b" in sent
    for hostile in ("\x1b[31mo", "\x1b]0;owned", "\x1b[31m.toml", "\u202e", "\x07", "no\x1b[31m"):
        assert hostile not in sent


def test_colours_of_ours_are_still_there(tmp_path):
    """Else nothing would be told apart from what is escaped."""
    table(tmp_path)
    assert "\x1b[" in on_a_terminal(("inspect", "log.csv"), tmp_path)


@pytest.mark.parametrize("columns", ["0", "1", "7", "-3", "x", "100000"])
@pytest.mark.parametrize("command", ["inspect", "effects"])
@pytest.mark.study(turn="each")
def test_a_terminal_of_any_width(tmp_path, command, columns):
    table(tmp_path)
    done = subprocess.run(
        [sys.executable, "-m", "trialid", *COMMANDS[command].split()], cwd=tmp_path,
        env={**ENVIRONMENT, "COLUMNS": columns}, capture_output=True, timeout=60, check=False,
    )  # fmt: skip
    assert (done.returncode, done.stderr) == (0, b"")
    assert len(done.stdout) > 300
