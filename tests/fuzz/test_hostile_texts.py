"""Pipelines, ships, histories, effects and results that do harm: a line, within time and memory."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from limits import bounded

from trialid.effects import from_file
from trialid.errors import TrialidError
from trialid.ingest import draft_template
from trialid.ingest.tables.templates import template
from trialid.pipeline_file import load
from trialid.pipeline_file.design_file import load_design
from trialid.pipeline_file.place import data_of, with_entry
from trialid.progress import silent
from trialid.result import json_file
from trialid.ship.particulars import read_ship
from trialid.workflow import history
from trialid.workflow.read_trials import align_trials

ROOT = Path(__file__).parents[2]
TEXTS = {
    "nested arrays": "x = " + "[" * 50_000 + "]" * 50_000,
    "nested not so deeply": "x = " + "[" * 250 + "]" * 250,
    "inline tables": "x = " + "{a=" * 5000 + "1" + "}" * 5000,
    "digits": "x = " + "9" * 5000,
    "fewer digits": "x = " + "9" * 4000,
    "digits of a float": "x = " + "9" * 500_000 + ".0",
    "dotted keys": ".".join("a" * 20_000) + " = 1",
    "dotted keys with quotes": ".".join(['"a"'] * 20_000) + " = 1",
    "dotted header": "[" + " . ".join("a" * 20_000) + "]",
    "dotted in a table": "x = {b = 1, " + ".".join("a" * 20_000) + " = 1}",
    "NUL": "x = \0",
    "a long line": "x = '" + "a" * 3_000_000 + "'",
}
READERS = {
    "pipeline": load,
    "design": load_design,
    "ship": read_ship,
    "template": template.load,
    "effects": from_file,
    "result": json_file.read,
    "an edit": lambda path: data_of(path.read_text(encoding="utf-8")),
}


@pytest.mark.parametrize("reader", READERS)
@pytest.mark.parametrize("text", TEXTS.values(), ids=TEXTS)
def test_a_text_that_does_harm(tmp_path, text, reader):
    path = tmp_path / "a.toml"
    path.write_text(text, encoding="utf-8")
    found = bounded(lambda: READERS[reader](path), 300)
    assert isinstance(found, str) or reader == "an edit"


@pytest.mark.parametrize("name", [n for n in TEXTS if not n.startswith("dotted")])
def test_an_edit_of_it(name):
    found = bounded(lambda: with_entry(TEXTS[name], ("model", "bounds"), "Yv", [0.0, 1.0]), 300)
    assert isinstance(found, str)


JSONS = {
    "nested": "[" * 100_000 + "]" * 100_000, "nested objects": '{"a":' * 50_000,
    "digits": "9" * 5000, "digits inside": '{"schema": ' + "9" * 100_000 + "}", "NUL": "\0",
}  # fmt: skip


@pytest.mark.parametrize("text", JSONS.values(), ids=JSONS)
def test_a_history_that_does_harm_is_passed_over(tmp_path, text):
    (tmp_path / "a.history.jsonl").write_text(text + "\n", encoding="utf-8")
    steps, remark = bounded(lambda: history.read(tmp_path / "a.toml"), 300)
    assert steps == ()
    assert "line 1" in remark


@pytest.mark.parametrize("text", JSONS.values(), ids=JSONS)
def test_a_result_that_does_harm(tmp_path, text):
    (tmp_path / "result.json").write_text(text, encoding="utf-8")
    assert "result.json" in bounded(lambda: json_file.read(tmp_path / "result.json"), 300)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes with names here")
@pytest.mark.parametrize("reader", [name for name in READERS if name != "an edit"])
@pytest.mark.parametrize("kind", ["pipe", "device", "folder", "long path"])
def test_what_is_no_file(tmp_path, kind, reader):
    path = tmp_path / "a.toml"
    if kind == "pipe":
        os.mkfifo(path)
    elif kind == "folder":
        path.mkdir()
    elif kind == "device":
        path.symlink_to("/dev/zero")
    else:
        path = tmp_path / ("a" * 5000) / "b.toml"
    message = bounded(lambda: READERS[reader](path), 100)
    assert isinstance(message, str)
    assert len(message) < 900


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes with names here")
@pytest.mark.parametrize("kind", ["pipe", "device"])
def test_a_history_that_is_no_file(tmp_path, kind):
    path = tmp_path / "a.history.jsonl"
    if kind == "pipe":
        os.mkfifo(path)
    else:
        path.symlink_to("/dev/zero")
    message = bounded(lambda: history.read(tmp_path / "a.toml"), 100)
    assert "no file but a device or a pipe" in message


def asked(*words, cwd):
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "COLUMNS": "200"}
    return subprocess.run(
        [sys.executable, "-m", "trialid", *map(str, words)],
        cwd=cwd, env=environment, capture_output=True, timeout=120, check=False,
    )  # fmt: skip


LONG = "a" * 5000
LONG_PATHS = {
    "run": ("run", LONG), "run --out": ("run", "p.toml", "--out", LONG), "add": ("add", LONG, "e"),
    "inspect": ("inspect", LONG), "template": ("inspect", "log.csv", "--template", LONG),
    "with-template": ("inspect", "log.csv", "--with-template", LONG),
    "dbc": ("inspect", "log.csv", "--dbc", LONG),
    "init": ("inspect", "log.csv", "--init", LONG + ".toml"),
    "init, a folder": ("inspect", "log.csv", "--init", LONG + "/p.toml"),
    "ship": ("inspect", "log.csv", "--init", "new.toml", "--ship", LONG),
    "align": ("align", "p.toml", "--out", LONG + ".csv"), "design": ("design", LONG),
    "report": ("report", LONG), "repeat": ("run", "--repeat", LONG),
    "replay": ("replay", "p.toml", "--run", LONG), "effects": ("effects", "--from", LONG),
    "replay --out": ("replay", "p.toml", "--out", LONG + ".mcap"), "report --out":
    ("report", "run", "--out", LONG), "draft": ("run", "p.toml", "--draft", LONG + ".py"),
    "workbench": ("workbench", LONG), "effect": ("effects", LONG), "guide": ("guide", LONG),
    "zone": ("inspect", "log.csv", "--zone", LONG),
}  # fmt: skip


@pytest.mark.parametrize("words", LONG_PATHS.values(), ids=LONG_PATHS)
@pytest.mark.study(turn="each")
def test_a_word_of_thousands_of_letters(tmp_path, words):
    (tmp_path / "log.csv").write_text("t,u\n0,1\n1,2\n2,4\n", encoding="utf-8")
    (tmp_path / "run").mkdir()
    shutil.copy(ROOT / "pipelines" / "hidden_effect.toml", tmp_path / "p.toml")
    done = asked(*words, cwd=tmp_path)
    said = done.stderr.decode()
    assert done.returncode == 2, said[-800:]
    assert "Traceback" not in said
    assert len(said) < 2000
    assert sorted(p.name for p in tmp_path.iterdir()) == ["log.csv", "p.toml", "run"]


def test_long_messages_are_cut_in_the_middle():
    error = str(TrialidError(f"{'a' * 5000}: no such file; name one that is there"))
    assert len(error) < 500
    assert error.endswith("a: no such file; name one that is there")
    assert len(str(TrialidError("word " * 5000))) < 2000


NUMBERS = ("1e300", "-1e300", "5e-324", "-1e15", "1e15", "1e10", "3600.0")
PLACES = {
    "delay": "delay = {}", "gain": "gain = {}", "offset": "offset = {}",
    "clock offset": "CLOCK clock = {{ offset = {} }}",
    "drift": "CLOCK clock = {{ offset = 0.0, drift = {} }}",
    "window": "WINDOW [0, {}]", "window from": "WINDOW [{}, 1e301]", "period": "PERIOD {}",
    "speed": "SPEED {}",
}  # fmt: skip


def _pipeline(tmp_path, place):
    """One trial of a table, with a number put where it does harm."""
    t = range(200)
    rows = [f"{0.5 * k},{k % 7},{k % 5}" for k in t]
    (tmp_path / "log.csv").write_text("\n".join(["t,d,r", *rows, ""]), encoding="utf-8")
    word, _, rest = place.partition(" ")
    special = word.isupper()
    path = tmp_path / "p.toml"
    path.write_text(
        f'ship = "{(ROOT / "sample_data/ships/s175q.toml").as_posix()}"\n'
        "[align]\n"
        + (f"period = {rest}\n" if word == "PERIOD" else "")
        + '[model]\nstates = ["v", "r"]\neffects = ["linear_hull", "linear_rudder"]\n'
        '[identify]\nfree = ["Nr"]\noutputs = ["r"]\n[[trial]]\nname = "a"\n'
        'logs = [{ path = "log.csv"'
        + (f", {rest}" if word == "CLOCK" else "")
        + " }]\n"
        + (f"window = {rest}\n" if word == "WINDOW" else "")
        + f"speed = {rest if word == 'SPEED' else '5.0'}\n"
        '[trial.signals]\ndelta = { channel = "d", unit = "deg", positive = "starboard" }\n'
        'r = { channel = "r", unit = "deg/s"' + ("" if special else f", {place}") + " }\n",
        encoding="utf-8",
    )
    return path


@pytest.mark.parametrize("number", NUMBERS)
@pytest.mark.parametrize("place", PLACES.values(), ids=PLACES)
def test_a_number_far_out(tmp_path, place, number):
    path = _pipeline(tmp_path, place.format(number))
    found = bounded(lambda: align_trials(load(path), silent), 300)
    assert not isinstance(found, str) or str(tmp_path) in found or "trial 'a'" in found


@pytest.mark.parametrize("key", ["starts", "max_iterations", "substeps"])
def test_a_count_far_out(tmp_path, key):
    path = _pipeline(tmp_path, "delay = 0.0")
    text = path.read_text(encoding="utf-8").replace("[identify]", f"[identify]\n{key} = 1000000000")
    path.write_text(text, encoding="utf-8")
    assert f"identify.{key}" in bounded(lambda: load(path))


def test_a_draft_is_toml_whatever_the_names_hold(tmp_path):
    """TOML forbids DEL and escapes, in comments too."""
    odd = "a\x7f\x1b]b"
    path = tmp_path / f"{odd}.csv"
    path.write_text(f"time,{odd},x\n" + "".join(f"{i},{i},1\n" for i in range(30)))
    told = template.parse(draft_template(path), tmp_path / "draft")
    assert told.header == ("time", odd, "x")
