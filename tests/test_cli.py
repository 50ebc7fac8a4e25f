"""The command line: exit statuses, what goes to which stream, and what is imported when."""

import json
import os
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

import click
import pytest
from click.testing import CliRunner, Result

import trialid
from trialid import own_files
from trialid.cli import console, main
from trialid.errors import LogError
from trialid.pipeline_file import Pipeline
from trialid.result import schema
from trialid.result.json_file import text_of

RESULT = schema.Result(pipeline="zigzag")

PIPELINE = """
ship = "ship.toml"
[[trial]]
name = "zigzag-20"
logs = ["log.csv"]
[model]
states = ["v", "r"]
effects = ["linear_hull"]
[identify]
free = ["Yv"]
outputs = ["r"]
"""

STUBS = """
import sys, types
from pathlib import Path
from trialid.result.schema import Result

def run(recipe, progress, force=False):
    progress("fitting", 0.5)
    {body}
    return types.SimpleNamespace(result=Result(pipeline="x" * {size}))

def write(done, folder):
    folder.mkdir(parents=True)

chain = types.ModuleType("trialid.workflow.run")
chain.run = run
folder = types.ModuleType("trialid.workflow.write_run")
folder.write = write
summary = types.ModuleType("trialid.report.terminal.summary")
summary.summary = lambda result, file, lines: "a summary\\n" * {size}
sys.modules |= {{each.__name__: each for each in (chain, folder, summary)}}

from trialid.cli.main import main
main()
"""


@dataclass(frozen=True)
class Done:
    result: schema.Result


Stub = Callable[[Callable[[str, float | None], None]], None]


def quietly(progress: Callable[[str, float | None], None]) -> None:
    progress("reading zigzag-20", None)
    progress("fitting: iteration 4, error 12.3 %", 0.5)


def stub(monkeypatch: pytest.MonkeyPatch, working: Stub = quietly) -> None:
    """Put a stand-in for the chain and the summary where the command imports them."""

    def run(
        recipe: Pipeline, progress: Callable[[str, float | None], None], force: bool = False
    ) -> Done:
        working(progress)
        return Done(RESULT)

    def write(done: Done, folder: Path) -> None:
        with own_files.replacing(folder) as work:
            (work / "result.json").write_text(text_of(done.result), encoding="utf-8")
            (work / "run.json").write_text('{"schema": "trialid-run/1"}', encoding="utf-8")

    for name, function in {
        "trialid.workflow.run": run,
        "trialid.workflow.write_run": write,
        "trialid.report.terminal.summary": lambda result, file, lines: "fit [bold] 12.3 %",
    }.items():
        stand_in = ModuleType(name)
        called = name.rpartition(".")[2].removesuffix("_run")
        monkeypatch.setattr(stand_in, called, function, raising=False)
        monkeypatch.setitem(sys.modules, name, stand_in)


@pytest.fixture
def pipeline(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Give a readable pipeline in the current folder."""
    (tmp_path / "ship.toml").touch()
    (tmp_path / "log.csv").touch()
    (tmp_path / "zigzag.toml").write_text(PIPELINE, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    return Path("zigzag.toml")


def trialid_(*arguments: str | Path) -> Result:
    return CliRunner().invoke(main.commands, [str(a) for a in arguments], prog_name="trialid")


def spawn(*code: str, **options: Any) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, *code], capture_output=True, text=True, check=False, timeout=60, **options
    )


# --- what it says -------------------------------------------------------------------------------


def test_the_summary_and_the_report_are_shown(
    pipeline: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    stub(monkeypatch)
    outcome = trialid_("run", pipeline)
    assert (outcome.exit_code, outcome.stderr) == (0, "")
    report = Path("runs/zigzag/report.html")
    assert outcome.stdout == f"fit [bold] 12.3 %\nReport: {report}\n"
    assert Path("runs/zigzag/result.json").read_text() == text_of(RESULT)


def test_out_names_the_folder(pipeline: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    stub(monkeypatch)
    assert trialid_("run", pipeline, "--out", "there/now").exit_code == 0
    assert Path("there/now/result.json").is_file()
    assert not Path("runs").exists()


def test_json_prints_the_result_and_nothing_else(
    pipeline: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    stub(monkeypatch)
    outcome = trialid_("run", pipeline, "--json")
    assert (outcome.exit_code, outcome.stderr) == (0, "")
    assert json.loads(outcome.stdout) == json.loads(text_of(RESULT))


def test_quiet_prints_nothing(pipeline: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    stub(monkeypatch)
    outcome = trialid_("run", pipeline, "--quiet")
    assert (outcome.exit_code, outcome.output) == (0, "")
    assert Path("runs/zigzag/result.json").is_file()


def test_progress_is_shown_on_a_terminals_stderr(
    pipeline: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("FORCE_COLOR", "1")  # rich takes the captured stream for a terminal
    monkeypatch.setenv("COLUMNS", "120")
    with console.progress_bar(shown=True) as progress:
        progress("reading [odd] name", None)
        progress("fitting: iteration 4", 0.5)
    out, err = capsys.readouterr()
    assert out == ""
    assert "fitting: iteration 4" in err


def test_every_command_and_option_has_help() -> None:
    for name, command in main.commands.commands.items():
        assert command.help, name
        for option in command.params:
            assert isinstance(option, click.Argument) or getattr(option, "help", None), option.name
    assert trialid_("run", "-h").exit_code == 0


def test_the_version_is_the_packages() -> None:
    assert trialid_("--version").stdout == f"trialid, version {trialid.__version__}\n"


# --- exit statuses ------------------------------------------------------------------------------


def test_wrong_input_is_one_line_and_status_2(
    pipeline: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def working(progress: object) -> None:
        raise LogError("log.csv: no channel 'rudder'\n  known: delta")

    stub(monkeypatch, working)
    for option in ("--quiet", "--json"):
        outcome = trialid_("run", pipeline, option)
        assert (outcome.exit_code, outcome.stdout) == (2, "")
        assert outcome.stderr == "trialid: log.csv: no channel 'rudder' known: delta\n"
    assert not Path("runs").exists()


def test_a_wrong_pipeline_is_named_with_its_key(pipeline: Path) -> None:
    pipeline.write_text(PIPELINE.replace("states", "stats"), encoding="utf-8")
    outcome = trialid_("run", pipeline)
    assert outcome.exit_code == 2
    assert outcome.stderr.startswith("trialid: zigzag.toml: model.stats: unknown key; did you mean")
    assert outcome.stderr.count("\n") == 1


def test_a_missing_pipeline_is_one_line(pipeline: Path) -> None:
    outcome = trialid_("run", "zigzg.toml")
    assert outcome.exit_code == 2
    assert "did you mean 'zigzag.toml'" in outcome.stderr


@pytest.mark.parametrize("arguments", [("run",), ("rnu",), ("run", "a.toml", "--jsn")])
def test_usage_errors_have_status_2(arguments: tuple[str, ...]) -> None:
    assert trialid_(*arguments).exit_code == 2


def test_the_keyboard_stops_it_with_status_130(
    pipeline: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def working(progress: object) -> None:
        raise KeyboardInterrupt

    stub(monkeypatch, working)
    outcome = trialid_("run", pipeline)
    assert (outcome.exit_code, outcome.stdout) == (130, "")
    assert outcome.stderr == "trialid: stopped; no half-written results are left\n"
    assert not Path("runs").exists()


def test_a_bug_is_status_1_with_its_traceback(pipeline: Path) -> None:
    outcome = spawn("-c", STUBS.format(body="1 / 0", size=1), "run", str(pipeline))
    assert (outcome.returncode, outcome.stdout) == (1, "")
    assert "Traceback" in outcome.stderr
    last = outcome.stderr.splitlines()[-1]
    assert last.startswith("trialid: this is a bug in trialid")
    assert "ZeroDivisionError: division by zero" in last


def test_a_real_interrupt_is_one_line(pipeline: Path) -> None:
    body = "import os, signal as s; s.signal(2, s.default_int_handler); os.kill(os.getpid(), 2)"
    outcome = spawn("-c", STUBS.format(body=body, size=1), "run", str(pipeline))
    assert (outcome.returncode, outcome.stdout) == (130, "")
    assert outcome.stderr == "trialid: stopped; no half-written results are left\n"


@pytest.mark.parametrize("options", [["--json"], []])
def test_a_reader_that_leaves_early_is_no_error(pipeline: Path, options: list[str]) -> None:
    reading, writing = os.pipe()
    os.close(reading)
    code = STUBS.format(body="pass", size=2_000)
    command = [sys.executable, "-c", code, "run", str(pipeline), *options]
    outcome = subprocess.run(
        command, stdout=writing, stderr=subprocess.PIPE, text=True, check=False, timeout=60
    )
    os.close(writing)
    assert (outcome.returncode, outcome.stderr) == (0, "")


# --- the folder of results ----------------------------------------------------------------------


def test_an_earlier_run_is_replaced_but_no_other_folder(
    pipeline: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    stub(monkeypatch)
    assert trialid_("run", pipeline).exit_code == 0
    assert trialid_("run", pipeline).exit_code == 0
    Path("photos").mkdir()
    Path("photos/bridge.jpg").touch()
    outcome = trialid_("run", pipeline, "--out", "photos")
    assert outcome.exit_code == 2
    assert "photos: holds other files and no earlier run" in outcome.stderr
    assert list(Path("photos").iterdir()) == [Path("photos/bridge.jpg")]


def test_a_folder_with_the_runs_own_inputs_is_refused(
    pipeline: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    stub(monkeypatch)
    Path("result.json").touch()
    outcome = trialid_("run", pipeline, "--out", ".")
    assert outcome.exit_code == 2
    assert "holds zigzag.toml, which this run reads" in outcome.stderr


def test_a_file_is_no_folder_for_results(pipeline: Path) -> None:
    outcome = trialid_("run", pipeline, "--out", "log.csv")
    assert outcome.exit_code == 2
    assert "log.csv: is a file" in outcome.stderr


def test_a_folder_that_cannot_be_written_is_the_users_to_mend(
    pipeline: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    stub(monkeypatch)
    outcome = trialid_("run", pipeline, "--out", "log.csv/below")
    assert outcome.exit_code == 2
    assert "cannot be written" in outcome.stderr
    assert outcome.stderr.count("\n") == 1


# --- starting -----------------------------------------------------------------------------------


def test_python_dash_m_is_the_same_command() -> None:
    outcome = spawn("-m", "trialid", "--version")
    assert (outcome.returncode, outcome.stdout) == (0, f"trialid, version {trialid.__version__}\n")


def test_help_waits_for_nothing_heavy() -> None:
    code = (
        "import sys, trialid.cli.main\n"
        "heavy = {'numpy', 'scipy', 'pandas', 'pydantic', 'pint', 'llvmlite', 'rich', 'jinja2'}\n"
        "print(sorted(heavy & sys.modules.keys()))"
    )
    assert spawn("-c", code).stdout == "[]\n"
