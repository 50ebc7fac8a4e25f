"""`trialid add` and `trialid drop` through the real command line, on one short trial."""

import json
import os
import stat
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import test_bad_input as spoilt
from test_bad_input import EFFECT, change, listing, trialid_, with_check
from valid_result import assert_valid

from trialid.pipeline_file import load
from trialid.workflow import history

record, _folder = spoilt.record, spoilt._folder  # the same trial, in a folder of its own
FILE = Path("short.toml")
HISTORY = Path("short.history.jsonl")
ADDED = "yaw_drag_rar"


def done(*arguments: str) -> dict[str, Any]:
    """Run a command that succeeds quietly; give its result."""
    outcome = trialid_(*arguments, "--out", "out", "--json")
    assert outcome.exception is None, repr(outcome.exception)
    assert (outcome.exit_code, outcome.stderr) == (0, "")
    result: dict[str, Any] = json.loads(outcome.stdout, parse_constant=spoilt._not_json)
    assert json.loads(Path("out/result.json").read_text(encoding="utf-8")) == result
    assert_valid(result)
    return result


def refused(*arguments: str, words: tuple[str, ...]) -> None:
    """Run a command, expect one line with these words, and the folder as it was."""
    before = listing()
    outcome = trialid_(*arguments, "--out", "out")
    assert isinstance(outcome.exception, SystemExit), repr(outcome.exception)
    assert (outcome.exit_code, outcome.stdout) == (2, "")
    assert outcome.stderr.startswith("trialid: ")
    assert outcome.stderr.count("\n") == 1
    assert len(outcome.stderr) < spoilt.LONGEST
    assert [word for word in words if word not in outcome.stderr] == [], outcome.stderr
    assert listing() == before


def steps() -> list[dict[str, Any]]:
    return [json.loads(line) for line in HISTORY.read_text(encoding="utf-8").splitlines()]


def told(result: dict[str, Any]) -> list[tuple[str, str | None]]:
    return [(row["step"], row["added"] or row["dropped"]) for row in result["history"]]


# --- what they do -------------------------------------------------------------------------------


def test_add_and_drop_and_the_file_is_as_it_was() -> None:
    change("short.toml", '"linear_roll"]', '"linear_roll"]  # a simple model')
    text = FILE.read_bytes()
    first = done("run", "short.toml")
    added = done("add", "short.toml", ADDED)
    data = tomllib.loads(FILE.read_text(encoding="utf-8"))
    assert data["model"]["effects"][-1] == ADDED
    assert data["identify"]["free"][-1] == "Nrar"
    assert "# a simple model" in FILE.read_text(encoding="utf-8")
    dropped = done("drop", "short.toml", ADDED)
    assert FILE.read_bytes() == text
    start = ("as written", None)
    assert told(first) == [start]
    assert told(added) == [start, ("added", ADDED)]
    assert told(dropped) == [start, ("added", ADDED), ("dropped", ADDED)]
    assert steps() == dropped["history"]
    assert not [p for p in Path().iterdir() if p.name.startswith(".")]


def test_the_result_is_that_of_a_run_of_the_new_file() -> None:
    added = done("add", "short.toml", ADDED)
    page = Path("out/report.html").read_text(encoding="utf-8")
    assert "Before and after adding" in page
    assert Path("out/pipeline.toml").read_bytes() == FILE.read_bytes()
    again = done("run", "short.toml")
    assert added.pop("change")
    assert again.pop("change") is None
    assert again == added


def test_what_moved_and_by_how_much() -> None:
    first = done("run", "short.toml")
    pair = done("add", "short.toml", ADDED)["change"]
    now = json.loads(Path("out/result.json").read_text(encoding="utf-8"))
    assert pair["eps_rmsn"] == [first["fit"]["eps_rmsn"], now["fit"]["eps_rmsn"]]
    assert pair["by_output"] == {"r": pair["eps_rmsn"]}  # the only output
    assert (pair["step"], pair["effect"]) == ("added", ADDED)
    assert pair["verdict"] == [first["verdict"]["kind"], now["verdict"]["kind"]]
    old = {row["name"]: row for row in first["accuracy"]["parameters"]}
    rows = {row["name"]: row for row in pair["parameters"]}
    assert list(rows) == ["Nr", "Ndelta", "Nrar"]
    for name in ("Nr", "Ndelta"):
        row = rows[name]
        assert row["before"] == old[name]["value"]
        assert row["move"] == row["after"] - row["before"]
        assert row["move_in_errors"] == pytest.approx(row["move"] / old[name]["standard_error"])
        # the effect is small here, so that the linearisation is good
        assert row["move_foreseen"] == pytest.approx(row["move"], rel=0.1)
    assert rows["Nrar"]["before"] is None
    assert rows["Nrar"]["after"] == pytest.approx(rows["Nrar"]["after_foreseen"], rel=0.1)
    assert pair["eps_rmsn_foreseen"] == pytest.approx(pair["eps_rmsn"][1], rel=1e-3)


def test_before_and_after_are_printed() -> None:
    with_check(lambda table: None)
    outcome = trialid_("add", "short.toml", ADDED)
    assert outcome.exit_code == 0
    for words in (
        f"{ADDED} added", "held-out trials", "Verdict: ", "foreseen by linearisation: error",
        "moved  foreseen", "new", "as written ", f"+ {ADDED} ",
        f"short.toml: effects + {ADDED}, free + Nrar\nUndo: trialid drop short.toml {ADDED}",
        "Report: runs/short/report.html",
    ):  # fmt: skip
        assert words in outcome.stdout
    assert max(map(len, outcome.stdout.splitlines())) <= 80
    back = trialid_("drop", "short.toml", ADDED)
    assert f"{ADDED} dropped" in back.stdout
    assert "gone" in back.stdout
    assert f"Undo: trialid add short.toml {ADDED}" in back.stdout


def test_an_earlier_run_is_used_and_changes_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    from trialid.workflow import edit_model as module

    examined = []
    whole: Callable[..., Any] = module.examine

    def examine(recipe: Any, *rest: Any, **words: Any) -> Any:
        examined.append(recipe)
        return whole(recipe, *rest, **words)

    monkeypatch.setattr(module, "examine", examine)
    text = FILE.read_bytes()
    anew = done("add", "short.toml", ADDED)
    assert len(examined) == 2
    FILE.write_bytes(text)
    HISTORY.unlink()
    done("run", "short.toml")
    assert done("add", "short.toml", ADDED) == anew
    assert len(examined) == 3
    # another ship makes another model of the same pipeline and logs
    change("ship.toml", "GM = ", "GM = 1.0 # ")
    done("drop", "short.toml", ADDED)
    assert len(examined) == 5


def test_ones_own_effect() -> None:
    Path("mine.py").write_text(EFFECT, encoding="utf-8")
    change("short.toml", '"linear_roll"]', '"linear_roll"]\neffects_from = ["mine.py"]')
    text = FILE.read_bytes()
    added = done("add", "short.toml", "mine")
    assert added["model"]["free"] == ["Nr", "Ndelta", "Nx"]
    done("drop", "short.toml", "mine")
    assert FILE.read_bytes() == text


@pytest.mark.parametrize("values", ["", "values = { Yr = 0.0 }\n", "values.Yr = 0.0\n"])
def test_a_start_far_off_gives_way_to_the_foreseen_one(values: str) -> None:
    """From the typical value no search can begin; the file then says from where this one began."""
    stiff = EFFECT.replace("-0.001", "1e3").replace("N=Nx * v * abs(v)", "K=Nx * phi")
    Path("mine.py").write_text(stiff.replace("(v, r", "(phi"), encoding="utf-8")
    own = f'"linear_roll"]\n{values}effects_from = ["mine.py"]'
    change("short.toml", '"linear_roll"]', own)
    change("short.toml", 'outputs = ["r"]', 'outputs = ["r", "phi"]')
    text = FILE.read_bytes()
    added = done("add", "short.toml", "mine")
    pair = added.pop("change")
    assert pair["eps_rmsn"][1] < pair["eps_rmsn"][0]
    assert abs(tomllib.loads(FILE.read_text())["model"]["values"]["Nx"]) < 1.0
    again = done("run", "short.toml")
    assert again.pop("change") is None
    assert again == added
    outcome = trialid_("drop", "short.toml", "mine", "--quiet")
    assert outcome.exit_code == 0
    if "{" in values:  # no line of its own is possible there, and what goes is said
        assert "taken out with mine: model.values.Nx = " in outcome.stderr
        assert tomllib.loads(FILE.read_text()) == tomllib.loads(text.decode())
    else:
        assert outcome.stderr == ""
        assert FILE.read_bytes() == text


def test_what_was_written_of_a_dropped_effect_is_said() -> None:
    change(
        "short.toml", '"linear_roll"]', f'"linear_roll", "{ADDED}"]\nvalues = {{ Nrar = -0.001 }}'
    )
    change("short.toml", '"Ndelta"]', '"Ndelta", "Nrar"]\nbounds = { Nrar = [-0.1, 0.0] }')
    outcome = trialid_("drop", "short.toml", ADDED)
    assert outcome.exit_code == 0
    assert outcome.stderr.splitlines() == [
        f"trialid: short.toml: taken out with {ADDED}: identify.bounds.Nrar = [-0.1, 0.0]",
        f"trialid: short.toml: taken out with {ADDED}: model.values.Nrar = -0.001",
    ]
    assert "Nrar" not in FILE.read_text(encoding="utf-8")


def test_an_effect_comes_back_with_what_was_free() -> None:
    """Undoing a drop: the effect was in the model with the value of the ship's file."""
    change("short.toml", '"linear_roll"]', '"linear_roll", "sway_drag_var"]')
    done("drop", "short.toml", "sway_drag_var")
    assert tomllib.loads(FILE.read_text())["identify"]["free"] == ["Nr", "Ndelta"]
    back = done("add", "short.toml", "sway_drag_var")
    assert back["model"]["free"] == ["Nr", "Ndelta"]
    assert "is not free" in back["change"]["not_foreseen"]


def test_a_model_that_cannot_be_fitted_can_be_mended() -> None:
    change("short.toml", '"linear_roll"]', '"linear_roll", "propeller_thrust"]')
    change("short.toml", '"v", "p"', '"u", "v", "p"')
    refused("run", "short.toml", words=("'n'",))
    pair = done("drop", "short.toml", "propeller_thrust")["change"]
    assert pair["eps_rmsn"][0] is None
    assert pair["eps_rmsn"][1] > 0.0
    assert "cannot be fitted" in pair["not_foreseen"]


def test_a_linked_file_with_rights_of_its_own() -> None:
    Path("real").mkdir()
    FILE.rename("real/short.toml")
    FILE.symlink_to("real/short.toml")
    FILE.chmod(0o640)
    done("add", "short.toml", ADDED)
    assert FILE.is_symlink()
    assert stat.S_IMODE(Path("real/short.toml").stat().st_mode) == 0o640
    assert ADDED in Path("real/short.toml").read_text(encoding="utf-8")


# --- what they refuse ---------------------------------------------------------------------------


@pytest.mark.parametrize(("arguments", "words"), [
    pytest.param(("add", "short.toml", "yaw_drag_rra"),
                 ("short.toml: model.effects", "no effect 'yaw_drag_rra'", "'yaw_drag_rar'"),
                 id="unknown"),
    pytest.param(("add", "short.toml", "x"), ("no effect 'x'", "trialid effects"), id="far off"),
    pytest.param(("add", "short.toml", "linear_roll"),
                 ("model.effects: 'linear_roll' is there already",), id="there already"),
    pytest.param(("drop", "short.toml", "linear_rol"),
                 ("'linear_rol' is not there", "'linear_roll'"), id="not there"),
    pytest.param(("drop", "short.toml", ADDED), (f"'{ADDED}' is not there",), id="not in it"),
    pytest.param(("add", "shrt.toml", ADDED), ("no such pipeline", "'short.toml'"), id="no file"),
    pytest.param(("drop", "short.toml", "linear_hull"), (), id="nothing free is left"),
    pytest.param(("add", "short.toml", "propeller_thrust"), ("'n'",), id="no such signal"),
])  # fmt: skip
def test_a_wrong_name_is_one_line(arguments: tuple[str, ...], words: tuple[str, ...]) -> None:
    if "nothing" in os.environ["PYTEST_CURRENT_TEST"]:
        change("short.toml", '["Nr", "Ndelta"]', '["Nr"]')
        words = ("identify.free", "must not be empty")
    refused(*arguments, words=words)


def test_a_wrong_pipeline_is_named_with_its_key() -> None:
    change("short.toml", "outputs =", "outptus =")
    refused("add", "short.toml", ADDED, words=("identify.outptus", "'outputs'"))


@pytest.mark.parametrize("arguments", [("add",), ("add", "short.toml"), ("drop", "short.toml"),
                                       ("run", "short.toml", "--write")])  # fmt: skip
def test_what_is_missing_on_the_line(arguments: tuple[str, ...]) -> None:
    before = listing()
    assert trialid_(*arguments).exit_code == 2
    assert listing() == before


def test_a_full_disk_leaves_the_file(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("trialid.workflow.write_run.write_page", spoilt.full)
    refused("add", "short.toml", ADDED, words=("out: cannot be written", "no space left"))


def test_a_crash_at_the_last_moment_leaves_the_file(monkeypatch: pytest.MonkeyPatch) -> None:
    """All is written but the pipeline file itself: it is the old one, and so is its history."""
    text, replace = FILE.read_bytes(), Path.replace

    def crash(self: Path, target: Path) -> Path:
        if target.name == FILE.name:
            raise OSError(5, "Input/output error")
        return replace(self, target)

    monkeypatch.setattr(Path, "replace", crash)
    outcome = trialid_("add", "short.toml", ADDED, "--out", "out")
    assert (outcome.exit_code, outcome.stdout) == (2, "")
    assert FILE.read_bytes() == text
    assert load(FILE)
    assert not HISTORY.exists()
    assert {p.name for p in Path().iterdir()} == {FILE.name, "log.csv", "ship.toml", "out"}


def test_a_file_changed_meanwhile_is_left(monkeypatch: pytest.MonkeyPatch) -> None:
    from trialid.workflow import edit_model as module

    whole: Callable[..., Any] = module.carry_out

    def while_somebody_types(*arguments: Any) -> Any:
        computed = whole(*arguments)
        change("short.toml", "period = 0.5", "period = 1.0")
        return computed

    monkeypatch.setattr(module, "carry_out", while_somebody_types)
    outcome = trialid_("add", "short.toml", ADDED, "--out", "out")
    assert outcome.exit_code == 2
    assert "short.toml: was changed meanwhile" in outcome.stderr
    assert "period = 1.0" in FILE.read_text(encoding="utf-8")
    assert not HISTORY.exists()
    assert not Path("out").exists()


# --- the history --------------------------------------------------------------------------------


def test_a_change_by_hand_is_a_step_of_its_own() -> None:
    done("add", "short.toml", ADDED)
    change("short.toml", '"Nr", ', "")
    shown = done("run", "short.toml")
    assert told(shown) == [("as written", None), ("added", ADDED), ("as written", None)]
    assert len(steps()) == 2  # a run writes nothing beside the pipeline
    done("drop", "short.toml", ADDED)
    assert [row["step"] for row in steps()] == ["as written", "added", "as written", "dropped"]
    assert steps()[2]["free"] == ["Ndelta", "Nrar"]


def test_lines_that_are_no_steps_are_told_and_kept() -> None:
    done("add", "short.toml", ADDED)
    whole = HISTORY.read_text(encoding="utf-8")
    torn = "\nnull\n" + whole.splitlines()[1][:-40]
    HISTORY.write_text(whole + torn, encoding="utf-8")
    outcome = trialid_("drop", "short.toml", ADDED, "--quiet")
    assert (outcome.exit_code, outcome.stdout) == (0, "")
    assert outcome.stderr == (
        "trialid: short.history.jsonl: lines 4, 5: no step of a history; passed over, and kept\n"
    )
    kept = HISTORY.read_text(encoding="utf-8")
    assert kept.startswith(whole + torn + "\n")
    found, remark = history.read(FILE)
    assert [step.step for step in found] == ["as written", "added", "dropped"]
    assert "lines 4, 5" in remark


def test_a_history_that_cannot_be_read_is_refused() -> None:
    HISTORY.mkdir()
    for command in (("run", "short.toml"), ("add", "short.toml", ADDED)):
        refused(*command, words=("short.history.jsonl", "cannot be read", "directory"))
