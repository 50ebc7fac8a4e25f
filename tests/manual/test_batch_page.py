"""The page about batches does what stands there: commands, Python, queries of both kinds."""

from pathlib import Path
from typing import Any

import pytest
from printed import blocks, lay_out, shell

from trialid.pipeline_file.fleet_file import load_fleet

HIDDEN = "righting_arm_cubic"
"""What the ship of the sample has and its model lacks."""


def test_its_fleets_are_read(tmp_path: Path) -> None:
    (fleet,) = [block.text for block in blocks("batch") if block.kind == "toml fleet"]
    for name in ("template.toml", "astrid.toml", "birgit.toml"):
        (tmp_path / name).touch()
    for name in ("logs/astrid/2025-03-01", "logs/birgit/trip-7"):
        (tmp_path / name).mkdir(parents=True)
    (tmp_path / "fleet.toml").write_text(fleet, encoding="utf-8")
    assert set(load_fleet(tmp_path / "fleet.toml").ships) == {"astrid", "birgit"}


def test_its_clusters_say_what_a_cluster_needs() -> None:
    yaml = pytest.importorskip("yaml")
    found = [yaml.safe_load(block.text) for block in blocks("batch") if block.kind == "yaml"]
    assert [each["class"] for each in found] == ["SLURMCluster", "KubeCluster"]
    assert all({"module", "class", "kwargs"} == set(each) for each in found)


@pytest.mark.study(turn=15)
@pytest.mark.filterwarnings("ignore")  # Dask's own
def test_its_commands_and_queries_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for module in ("distributed", "pyarrow", "duckdb"):
        pytest.importorskip(module)
    folder = tmp_path / "project"
    folder.mkdir()
    lay_out(folder)
    monkeypatch.chdir(folder)
    names: dict[str, Any] = {}
    for block in blocks("batch"):
        if block.kind == "sh batch":
            assert "4 runs, 4 done now, 0 failed" in shell(folder, block.text)
        if block.kind == "python batch":
            exec(compile("\n" * block.line + block.text, "batch.md", "exec"), names)
    assert names["fleet"].batch.anew == 0
    assert list(names["fleet"].runs["left_out"]) == ["", "zigzag-10", "zigzag-20", "binary-15"]
    assert_names_what_is_hidden(names["fleet"].runs, names["named"])
    fitted = names["fitted"]
    likely = fitted[(fitted["left_out"] == "") & (fitted["kind"] == "physical")]
    for row in names["moved"].to_dict("records"):
        (whole,) = likely[likely["parameter"] == row["parameter"]].to_dict("records")
        assert not whole["likely_low"] <= row["value"] <= whole["likely_high"]
    assert len(names["spread"]) == len(likely)


def assert_names_what_is_hidden(runs: Any, named: Any) -> None:
    """Whole, the sample names it; a trial left out may leave open what, but not that something is.

    The query counts what the rows say, no more and no less.
    """
    whole = runs[runs["left_out"] == ""].iloc[0]
    assert (whole["verdict"], whole["effect"]) == ("missing", HIDDEN)
    assert set(runs["verdict"]) <= {"missing", "cannot tell"}
    assert all("something is missing" in s for s in runs["sentence"][runs["effect"].isna()])
    assert all(HIDDEN in sentence for sentence in runs["sentence"])
    told = runs[runs["verdict"] == "missing"]
    assert named.set_index("effect")["runs"].to_dict() == told["effect"].value_counts().to_dict()
    for row in named.to_dict("records"):
        mine = told["eps_rmsn_check"][told["effect"] == row["effect"]]
        assert row["held_out"] == pytest.approx(mine.mean())
