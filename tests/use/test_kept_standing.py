"""What a run keeps of its fit: taken up as if worked out anew, and never when anything differs."""

import json
import shutil
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from test_bad_input import trialid_

from trialid import plugins
from trialid.cache import package_digest
from trialid.progress import silent
from trialid.workflow import write_run
from trialid.workflow.use import finished_model as taking_up
from trialid.workflow.use import kept_standing
from trialid.workflow.use.finished_model import finished_model
from trialid.workflow.use.kept_standing import FILE
from trialid.workflow.use.orders import named_manoeuvre
from trialid.workflow.use.predict import predict_manoeuvre


@pytest.fixture
def copied(run_folder: Path, tmp_path: Path) -> Path:
    """The project of the run once more, free to be spoilt; its run's folder."""
    project = Path(shutil.copytree(run_folder.parents[1], tmp_path / "again"))
    return project / run_folder.relative_to(run_folder.parents[1])


@pytest.fixture
def reads(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """A word each time that the logs are read."""
    told, read = list[str](), taking_up.align_trials

    def watched(*args):
        told.append("read")
        return read(*args)

    monkeypatch.setattr(taking_up, "align_trials", watched)
    return told


def as_json(folder: Path, out: Path) -> dict:
    told = trialid_("export", str(folder), "--as", "json", "--out", str(out))
    assert told.exit_code == 0, told.stderr
    return json.loads(out.read_text(encoding="utf-8"))


@pytest.mark.study(turn="each")
def test_it_is_what_would_be_worked_out(copied: Path, tmp_path: Path, reads: list[str]) -> None:
    """The model, its covariance, and a manoeuvre's ranges, all to 1e-9; the logs are not read."""
    kept, model = as_json(copied, tmp_path / "kept.json"), finished_model(copied, silent)
    assert not reads
    (copied / FILE).unlink()
    anew, other = as_json(copied, tmp_path / "anew.json"), finished_model(copied, silent)
    assert len(reads) == 2
    covariance = [np.array(one.pop("covariance")) for one in (kept, anew)]
    assert np.abs(covariance[0] - covariance[1]).max() <= 1e-9 * np.abs(covariance[1]).max()
    assert kept == anew
    asked = named_manoeuvre(["zigzag", "20"])
    mine, theirs = (predict_manoeuvre(m, asked).motion for m in (model, other))
    for name, (value, ends) in theirs.numbers.items():
        assert mine.numbers[name][0] == pytest.approx(value, rel=1e-9)
        assert mine.numbers[name][1] == pytest.approx(ends, rel=1e-9)
    assert mine.ranges["r"][0] == pytest.approx(theirs.ranges["r"][0], rel=1e-9, abs=1e-12)
    for a, b in zip(model.done.fit.problem.trials, other.done.fit.problem.trials, strict=True):
        for said in ("name", "use", "remarks", "logs", "start", "opening"):
            assert getattr(a, said) == getattr(b, said)
        assert all((a.valid[n] == b.valid[n]).all() for n in b.valid)


def test_another_result_is_worked_out_anew(copied: Path, reads: list[str]) -> None:
    result = copied / "result.json"
    result.write_bytes(result.read_bytes() + b"\n")
    finished_model(copied, silent)
    assert reads


def test_other_sources_of_this_package_work_it_out_anew(
    copied: Path, reads: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(kept_standing, "source_digest", lambda: "another")
    finished_model(copied, silent)
    assert reads


def test_with_effects_of_another_package_nothing_is_kept(
    copied: Path, reads: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whose sources may change unseen."""
    known = finished_model(copied, silent).done
    monkeypatch.setattr(plugins, "packages", lambda: {"theirs": "1.0"})
    assert kept_standing.standing_bytes(known, b"") is None
    finished_model(copied, silent)
    assert reads


@pytest.mark.parametrize("spoilt", [b"", b"PK\x03\x04", b"half"])
def test_a_spoilt_file_is_worked_out_anew(copied: Path, reads: list[str], spoilt: bytes) -> None:
    whole = (copied / FILE).read_bytes()
    (copied / FILE).write_bytes(whole[: len(whole) // 2] if spoilt == b"half" else spoilt)
    finished_model(copied, silent)
    assert reads


def test_every_source_of_the_package_counts(tmp_path: Path, monkeypatch) -> None:
    """One letter in one of them, or its name, and it is another package."""
    assert (package_digest.SOURCES / "version.py").is_file()
    monkeypatch.setattr(package_digest, "SOURCES", tmp_path)
    found = set()
    for name, text in (("a.py", "x = 1"), ("a.py", "x = 2"), ("deep/b.py", "x = 2")):
        shutil.rmtree(tmp_path)
        (tmp_path / name).parent.mkdir(parents=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
        found.add(package_digest.source_digest.__wrapped__())
    assert len(found) == 3


def test_a_log_that_changed_is_told_all_the_same(copied: Path) -> None:
    log = copied.parents[1] / "zigzag-10.csv"
    log.write_bytes(log.read_bytes() + b"\n")
    told = trialid_("simulate", str(copied), "zigzag", "20")
    assert (told.exit_code, told.stderr.count("\n")) == (2, 1)
    assert "has changed since the run" in told.stderr


def test_with_effects_of_one_s_own_nothing_is_kept() -> None:
    asked = SimpleNamespace(model=SimpleNamespace(effects_from=(Path("mine.py"),)))
    assert write_run._standing(SimpleNamespace(pipeline=asked), b"") is None
