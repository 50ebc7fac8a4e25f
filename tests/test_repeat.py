"""A run done again from its folder: the logs held against their hashes, the numbers compared."""

import json
import re
import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from test_bad_input import PIPELINE, Table, record, trialid_

import trialid as ti
from trialid.diagnosis.diagnose import diagnose
from trialid.errors import TrialidError
from trialid.result.schema import Result
from trialid.workflow import findings
from trialid.workflow.repeat import compare, comparison_words, earlier, repeat

ROOT = Path(__file__).parent.parent

__all__ = ["record"]


@pytest.fixture(scope="module")
def made(record: Table, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a pipeline, its log, its ship, and a finished run two folders further."""
    place = tmp_path_factory.mktemp("ferry")
    ship = ROOT / "sample_data" / "ships" / "s175q.toml"
    (place / "ship.toml").write_bytes(ship.read_bytes())
    (place / "short.toml").write_text(PIPELINE, encoding="utf-8")
    record.to_csv(place / "log.csv", index=False)
    outcome = trialid_("run", str(place / "short.toml"), "--quiet", "--out",
                       str(place / "runs" / "first"))  # fmt: skip
    assert outcome.exit_code == 0, outcome.stderr
    return place


@pytest.fixture
def place(made: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The same, moved to another place as a whole, to be spoilt."""
    monkeypatch.chdir(tmp_path)
    shutil.copytree(made, tmp_path / "copy")
    return tmp_path / "copy"


def run_of(place: Path) -> Path:
    return place / "runs" / "first"


def files(place: Path) -> dict[str, bytes]:
    return {str(p.relative_to(place)): p.read_bytes() for p in place.rglob("*") if p.is_file()}


def test_a_run_gives_the_same_numbers_wherever_it_was_moved(place: Path) -> None:
    before = files(place)
    outcome = trialid_("run", "--repeat", str(run_of(place)))
    assert (outcome.exit_code, outcome.stderr) == (0, "")
    found = re.fullmatch(r"same numbers: (\d+) compared, every digit\n", outcome.stdout)
    assert found
    assert int(found[1]) > 50
    assert files(place) == before


def test_the_pipeline_of_the_run_counts_not_the_one_beside_the_logs(place: Path) -> None:
    (place / "short.toml").write_text("changed = true\n", encoding="utf-8")
    outcome = trialid_("run", "--repeat", str(run_of(place)), "--json")
    assert outcome.exit_code == 0
    assert json.loads(outcome.stdout)["fit"] == json.loads(
        (run_of(place) / "result.json").read_text(encoding="utf-8")
    )["fit"]  # fmt: skip


def test_the_copy_in_the_folder_finds_what_the_pipeline_named(place: Path) -> None:
    """Nobody could build on a grown model that was not written: no ship was beside its copy."""
    copy = run_of(place) / "pipeline.toml"
    outcome = trialid_("run", str(copy), "--quiet", "--out", str(place / "runs" / "again"))
    assert outcome.exit_code == 0, outcome.stderr
    old, new = (
        json.loads((one / "result.json").read_text(encoding="utf-8"))["fit"]
        for one in (run_of(place), place / "runs" / "again")
    )
    assert new == old
    copy.with_name("run.json").unlink()
    outcome = trialid_("run", str(copy), "--quiet")
    assert outcome.exit_code == 2
    assert "no file 'ship.toml'" in outcome.stderr


@pytest.mark.parametrize(
    "words", [("add", "{}", "yaw_cubic_rrr"), ("run", "{}", "--auto", "--write")]
)
def test_the_copy_is_what_ran_and_is_not_edited(place: Path, words: tuple[str, ...]) -> None:
    before = files(place)
    outcome = trialid_(*(word.format(run_of(place) / "pipeline.toml") for word in words))
    assert (outcome.exit_code, outcome.stderr.count("\n")) == (2, 1)
    assert (
        "is what a finished run was made from, and stays as it is; copy it, or ch" in outcome.stderr
    )
    assert outcome.stderr.rstrip().endswith("short.toml")
    assert files(place) == before


def test_other_numbers_are_told_with_the_largest(place: Path) -> None:
    path = run_of(place) / "result.json"
    result = json.loads(path.read_text(encoding="utf-8"))
    result["accuracy"]["parameters"][0]["value"] *= 1.5
    path.write_text(json.dumps(result), encoding="utf-8")
    outcome = trialid_("run", "--repeat", str(run_of(place)))
    assert outcome.exit_code == 1
    assert "other numbers: 1 of" in outcome.stderr
    assert "accuracy.parameters[0].value" in outcome.stderr
    assert "33 %" in outcome.stderr


@pytest.mark.parametrize(("name", "words"), [
    ("log.csv", ("log.csv", "has changed since the run", "SHA-256")),
    ("ship.toml", ("ship.toml", "has changed since the run")),
])  # fmt: skip
def test_a_changed_file_is_one_line(place: Path, name: str, words: tuple[str, ...]) -> None:
    with (place / name).open("a", encoding="utf-8") as stream:
        stream.write("\n")
    one_line(place, *words)


def test_a_missing_log_is_one_line(place: Path) -> None:
    (place / "log.csv").unlink()
    one_line(place, "log.csv, which the run read, is not at", "put it back")


def test_an_edited_pipeline_is_one_line(place: Path) -> None:
    (run_of(place) / "pipeline.toml").write_text(PIPELINE + "# other\n", encoding="utf-8")
    one_line(place, "is not the pipeline the run was made from")


def test_a_folder_of_an_older_version_is_one_line(place: Path) -> None:
    (run_of(place) / "run.json").unlink()
    one_line(place, "run.json: cannot be read", "older trialid")


@pytest.mark.parametrize("text", ["[]", "{", '{"schema": 1}', '{"schema": "trialid-run/1"}'])
def test_a_torn_origin_is_one_line(place: Path, text: str) -> None:
    (run_of(place) / "run.json").write_text(text, encoding="utf-8")
    one_line(place, "run.json")


def test_a_folder_that_is_no_run_is_one_line(tmp_path: Path) -> None:
    with pytest.raises(TrialidError, match=r"result\.json: cannot be read"):
        earlier(tmp_path)


def one_line(place: Path, *words: str) -> None:
    outcome = trialid_("run", "--repeat", str(run_of(place)))
    assert (outcome.exit_code, outcome.stdout) == (2, "")
    (line,) = outcome.stderr.splitlines()
    for word in words:
        assert word in line


@pytest.mark.parametrize("more", [("short.toml",), ("--auto",), ("--out", "x"), ("--write",)])
def test_what_makes_no_sense_with_it_is_refused(place: Path, more: tuple[str, ...]) -> None:
    outcome = trialid_("run", "--repeat", str(run_of(place)), *more)
    assert outcome.exit_code == 2
    assert "--repeat takes its pipeline from RUN_DIR" in outcome.stderr


def test_a_run_needs_a_pipeline() -> None:
    outcome = trialid_("run")
    assert outcome.exit_code == 2
    assert "missing argument 'PIPELINE'" in outcome.stderr


def test_a_last_digit_is_the_same_number_and_is_told() -> None:
    found = compare({"fit": {"V": 1.0}}, {"fit": {"V": 1.0 + 1e-9}})
    assert found.same
    assert comparison_words(found, Result(), Result()).startswith(
        "same numbers to 1e-06: 1 of 1 differ"
    )


def test_another_length_or_word_is_no_same_run() -> None:
    found = compare({"where": [1.0], "verdict": {"kind": "a"}},
                    {"where": [], "verdict": {"kind": "b"}})  # fmt: skip
    assert not found.same
    assert found.other == ("where", "verdict.kind")


def test_a_number_that_became_unknown_is_told() -> None:
    assert compare({"fit": {"V": 1.0}}, {"fit": {"V": None}}).other == ("fit.V",)


def test_other_versions_are_named() -> None:
    found = compare({"fit": {"V": 1.0}}, {"fit": {"V": 2.0}})
    words = comparison_words(found, Result(version="0.1", versions={"numpy": "2.0"}),
                 Result(version="0.1", versions={"numpy": "2.1"}))  # fmt: skip
    assert words.endswith("other versions: numpy 2.0 then, 2.1 now")


def test_the_library_gives_the_same(place: Path) -> None:
    _, found = repeat(earlier(run_of(place)), lambda words, share: None)
    assert found.same
    assert found.differing == 0


@pytest.mark.study(turn="each")
def test_what_an_effect_joined_is_judged_by_add_as_by_the_run_of_its_file(
    made: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of one fit `add` named a current that `run` did not: to `add` the model had not grown."""
    file, asked = shutil.copytree(made, tmp_path / "again") / "short.toml", []

    def noted(*given: Any, grown: bool, **more: Any) -> Any:
        asked.append(grown)
        return diagnose(*given, grown=grown, **more)

    monkeypatch.setattr(findings, "diagnose", noted)
    for command in ("run", "add", "run", "drop", "run"):
        effect = ["yaw_drag_rar"] * (command in ("add", "drop"))
        outcome = trialid_(command, str(file), *effect, "--quiet", "--out", str(tmp_path / "out"))
        assert outcome.exit_code == 0, outcome.stderr
    assert asked == [False, True, True, False, False]
    run = ti.run(file)
    asked.clear()
    run.add("yaw_drag_rar").add("yaw_drag_vav")
    assert asked == [True, True]


def test_a_run_done_again_is_judged_as_it_was(made: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Effects that `--auto` added in memory have no history beside the pipeline."""
    folder, asked = made / "runs" / "first", []
    origin = json.loads((folder / "run.json").read_text(encoding="utf-8"))
    assert origin["grown"] is False

    def noted(*given: Any, grown: bool, **more: Any) -> Any:
        asked.append(grown)
        return diagnose(*given, grown=grown, **more)

    monkeypatch.setattr(findings, "diagnose", noted)
    for grown in (False, True):
        repeat(replace(earlier(folder), grown=grown), lambda words, share: None)
    assert asked == [False, True]
