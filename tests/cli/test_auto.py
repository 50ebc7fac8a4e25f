"""`trialid run --auto` on the shipped pipeline: added, told, and written when asked."""

import json
from pathlib import Path

import pytest
from test_bad_input import trialid_

from trialid.pipeline_file import load

ROOT = Path(__file__).parents[2]
ADDED = "righting_arm_cubic"


@pytest.fixture
def hidden(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A copy of the shipped pipeline, in the current folder."""
    text = (ROOT / "pipelines" / "hidden_effect.toml").read_text(encoding="utf-8")
    text = text.replace('"../sample_data', f'"{(ROOT / "sample_data").as_posix()}')
    (tmp_path / "hidden.toml").write_text(text, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    return Path("hidden.toml")


@pytest.mark.study
def test_the_hidden_effect_is_added_and_the_verdict_is_nothing_missing(hidden: Path) -> None:
    text = hidden.read_bytes()
    outcome = trialid_("run", str(hidden), "--auto")
    assert (outcome.exit_code, outcome.stderr) == (0, "")
    head, first, then, blank, *_, end, what, left, report = outcome.stdout.splitlines()
    assert (blank, report) == ("", "Report: runs/hidden/report.html")
    assert head.split() == ["step", "fitted", "held", "out", "noise", "model", "verdict"]
    assert first.startswith("as written   ")
    assert first.endswith("missing")
    assert then.startswith(f"+ {ADDED} ")
    assert then.endswith("nothing missing")
    assert end == "Added no more: the verdict is `nothing missing`."
    assert what == f"What was added, the dearest to leave out first: {ADDED}."
    assert left == f"hidden.toml is as it was; --write puts {ADDED} into it."
    assert hidden.read_bytes() == text
    assert sorted(p.name for p in Path().iterdir()) == ["hidden.toml", "runs"]
    result = json.loads(Path("runs/hidden/result.json").read_text(encoding="utf-8"))
    assert result["verdict"]["kind"] == "nothing missing"
    assert result["model"]["effects"][-1] == ADDED
    steps = [(row["step"], row["added"]) for row in result["history"]]
    assert steps == [("as written", None), ("added", ADDED)]
    errors = [row["eps_rmsn"] for row in result["history"]]
    assert errors[1] < 0.75 * errors[0]


@pytest.mark.study(turn=2)
def test_what_was_added_is_written_when_asked_and_a_run_then_gives_the_same(hidden: Path) -> None:
    text = hidden.read_text(encoding="utf-8")
    outcome = trialid_("run", str(hidden), "--auto", "--write", "--json")
    assert (outcome.exit_code, outcome.stderr) == (0, "")
    result = json.loads(outcome.stdout)
    written = hidden.read_text(encoding="utf-8")
    assert load(hidden).model.effects[-1] == ADDED
    assert [line for line in text.splitlines() if "#" in line and line not in written] == []
    lines = Path("hidden.history.jsonl").read_text(encoding="utf-8").splitlines()
    assert [json.loads(line) for line in lines] == result["history"]
    again = trialid_("run", str(hidden), "--json")
    (grown,) = result.pop("grown")  # what leaving it out again costs is the loop's to know
    assert (grown["effect"], grown["named"], grown["left_out_with_it"]) == (ADDED, True, [])
    assert grown["costs"] > 1.5
    assert json.loads(again.stdout) == result | {"grown": []}
    # and once more finds nothing to add, and writes nothing
    once_more = trialid_("run", str(hidden), "--auto", "--write")
    assert "Added no more" in once_more.stdout
    assert hidden.read_text(encoding="utf-8") == written
    assert len(Path("hidden.history.jsonl").read_text(encoding="utf-8").splitlines()) == 2
