"""A run as its folder keeps it: what `trialid add` begins from, without reading or searching."""

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from trialid.pipeline_file import Pipeline, load
from trialid.progress import silent
from trialid.workflow import edit_model
from trialid.workflow.edit_pipeline import add_to_pipeline
from trialid.workflow.read_trials import align_trials
from trialid.workflow.use import kept_standing
from trialid.workflow.use.kept_run import kept_run
from trialid.workflow.use.kept_standing import FILE


@pytest.fixture
def copied(run_folder: Path, tmp_path: Path) -> Path:
    """The project of the run once more, free to be spoilt; its run's folder."""
    project = Path(shutil.copytree(run_folder.parents[1], tmp_path / "again"))
    return project / run_folder.relative_to(run_folder.parents[1])


@pytest.fixture
def asked(copied: Path) -> Pipeline:
    """The pipeline of the run."""
    [path] = [one for one in copied.parents[1].glob("*.toml") if "[identify]" in one.read_text()]
    return load(path)


def test_trials_and_fit_are_those_of_the_run(copied: Path, asked: Pipeline) -> None:
    kept = kept_run(copied, asked)
    assert kept is not None
    for mine, read in zip(kept.trials, align_trials(asked, silent), strict=True):
        assert list(mine.signals) == list(read.signals)
        assert all(np.array_equal(mine.signals[n], read.signals[n]) for n in read.signals)
        assert all(np.array_equal(mine.valid[n], read.valid[n]) for n in read.valid)
    for row in kept.result.accuracy.parameters:
        assert kept.fit.value(row.name) == row.value


def test_where_a_window_begins_is_kept(copied: Path, asked: Pipeline) -> None:
    trial = replace(align_trials(asked, silent)[0], opening=600.0)
    arrays = {f"0 signal {n}": x for n, x in trial.signals.items()}
    arrays |= {f"0 valid {n}": x for n, x in trial.valid.items()}
    kept = kept_standing._trial(0, kept_standing._without_arrays(trial), arrays)
    assert kept.opening == 600.0


def test_what_changed_since_is_not_taken(copied: Path, asked: Pipeline) -> None:
    log = copied.parents[1] / "zigzag-10.csv"
    content = log.read_bytes()
    log.write_bytes(content + b"\n")
    assert kept_run(copied, asked) is None
    log.write_bytes(content)
    assert kept_run(copied, asked) is not None
    asked.path.write_bytes(asked.content + b"# another\n")
    assert kept_run(copied, load(asked.path)) is None


@pytest.mark.study(turn="each")
def test_an_effect_is_added_without_reading_and_with_the_same_result(
    copied: Path, asked: Pipeline, monkeypatch: pytest.MonkeyPatch
) -> None:
    edit = add_to_pipeline(asked, "yaw_cubic_rrr")
    with monkeypatch.context() as patch:
        patch.delattr(edit_model, "align_trials")
        quick = edit_model.carry_out(edit, copied, silent).run.result
    (copied / FILE).unlink()
    assert edit_model.carry_out(edit, copied, silent).run.result == quick
