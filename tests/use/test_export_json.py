"""The model as JSON: of its schema, no more sure than the run, marked where it must not be used."""

import json
import shutil
from pathlib import Path

import jsonschema
import numpy as np
import pytest
from test_bad_input import trialid_

from trialid.names.model_kinds import KINDS
from trialid.workflow.use.hand_over import WRITERS

AS_JSON = ("--as", "json", "--out")


def written(run: Path, out: Path, *more: str) -> dict:
    told = trialid_("export", str(run), *AS_JSON, str(out), *more)
    assert told.exit_code == 0, told.stderr
    return json.loads(out.read_text(encoding="utf-8"))


def test_it_is_of_its_schema(run_folder: Path, tmp_path: Path) -> None:
    found = written(run_folder, tmp_path / "model.json")
    schema = json.loads(trialid_("export", "--schema").stdout)
    jsonschema.Draft202012Validator.check_schema(schema)
    jsonschema.Draft202012Validator(schema).validate(found)
    assert found["schema"] == "trialid-model/1"
    assert [s["name"] for s in found["states"]] == ["v", "p", "r", "phi"]
    assert found["inputs"][0]["seen"] == pytest.approx([-0.349, 0.349], abs=0.01)
    mass = found["parameters"][0]
    assert (mass["name"], mass["value"], mass["fitted"], mass["likely"]) == (
        "m",
        0.00792,
        False,
        None,
    )


def test_its_covariance_is_as_wide_as_the_likely_ranges(run_folder: Path, tmp_path: Path) -> None:
    """And as a covariance has to be; noise alone would be more sure."""
    found = written(run_folder, tmp_path / "model.json")
    rows = json.loads((run_folder / "result.json").read_text("utf-8"))["accuracy"]["parameters"]
    errors = {p["name"]: p for p in rows}
    C = np.array(found["covariance"])
    assert found["covariance_of"] == ["Nv", "Nr", "Ndelta", "GM"]
    assert np.linalg.eigvalsh(C / np.sqrt(np.outer(np.diag(C), np.diag(C)))).min() > 0.0
    for name, variance in zip(found["covariance_of"], np.diag(C), strict=True):
        p = errors[name]
        far = max(abs(end - p["value"]) for end in p["likely"])
        assert 1.96 * np.sqrt(variance) == pytest.approx(far)
        assert np.sqrt(variance) >= 0.99 * p["standard_error"]


@pytest.mark.study(turn=14)
def test_a_fit_without_a_verdict_is_marked(run_folder: Path, tmp_path: Path) -> None:
    shutil.copytree(run_folder.parents[1], tmp_path / "copy")
    spoilt = tmp_path / "copy" / run_folder.relative_to(run_folder.parents[1])
    text = json.loads((spoilt / "result.json").read_text(encoding="utf-8"))
    text["verdict"] |= {"kind": "no fit", "sentence": "no fit: the search did not end"}
    (spoilt / "result.json").write_text(json.dumps(text), encoding="utf-8")
    refused = trialid_("export", str(spoilt), *AS_JSON, str(tmp_path / "x.json"))
    assert (refused.exit_code, refused.stderr.count("\n")) == (2, 1)
    assert not (tmp_path / "x.json").exists()
    found = written(spoilt, tmp_path / "model.json", "--anyway")
    assert found["verdict"] == "no fit"
    assert found["words"][0] == "no fit: the search did not end"
    for kind in ("c", "python", "ship", "nomoto", "ardupilot", "gazebo"):
        out = tmp_path / f"marked-{kind}{KINDS[kind].suffixes[0]}"
        options = ("--as", kind, "--out", str(out), "--anyway", *KINDS[kind].needs.split())
        trialid_("export", str(spoilt), *options)
        assert "no fit: the search did not end" in out.read_text(encoding="utf-8")


def test_every_kind_is_one_of_the_command() -> None:
    """The command knows them by name without what writes them: it answers at once."""
    assert WRITERS.keys() == KINDS.keys()
    told = trialid_("export")
    assert (told.exit_code, told.stderr.count("\n")) == (2, 1)
