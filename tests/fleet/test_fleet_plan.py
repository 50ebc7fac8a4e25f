"""What is planned: pipelines that stand by themselves, ways of doing them, keys of all inputs."""

import shutil
import tomllib
from dataclasses import replace
from pathlib import Path

import pytest
from generated_fleet import ROOT

from trialid.errors import PipelineError
from trialid.fleet import task as task_module
from trialid.fleet.parcels import pack
from trialid.fleet.plan import plan
from trialid.fleet.task import Task
from trialid.pipeline_file import read
from trialid.pipeline_file.fleet_file import load_fleet
from trialid.result.change_rows import StepRow
from trialid.workflow.history import append_steps


def planned(folder: Path, more: str = "") -> tuple[Task, ...]:
    path = folder / "fleet.toml"
    if more:
        path.write_text(path.read_text(encoding="utf-8") + more, encoding="utf-8")
    return plan(load_fleet(path), folder / "out")


def test_a_voyage_has_a_pipeline_that_stands_by_itself(fleet_folder: Path) -> None:
    first, second, third = planned(fleet_folder)
    assert second.pipeline == fleet_folder / "out" / "pipelines" / "alpha-2025-02-10.toml"
    assert b"# the wider one" in second.content
    pipeline = read(second.content, second.pipeline)
    logs = [log.path.resolve() for trial in pipeline.trials for log in trial.logs]
    voyage = fleet_folder.resolve() / "alpha" / "2025-02-10"
    assert logs == [voyage / "steps-10.csv", voyage / "steps-20.csv"]
    assert pipeline.ship is not None
    assert pipeline.ship.resolve() == fleet_folder.resolve() / "ship-3.toml"
    assert len({first.key, second.key, third.key}) == 3
    assert first.content != second.content


def test_each_way_of_a_run_says_in_its_pipeline_what_its_row_says(fleet_folder: Path) -> None:
    text = (fleet_folder / "template-csv.toml").read_text(encoding="utf-8")
    for later in ("2025-02-10", "2025-03-10"):
        shutil.rmtree(fleet_folder / "alpha" / later)
    lists = '\n[structures]\nplain = []\ndrag = ["sway_drag_vav"]\n'
    (fleet_folder / "template-csv.toml").write_text(text + lists, encoding="utf-8")
    tasks = planned(
        fleet_folder,
        '[vary]\ntrial = "leave one out"\nstructure = "each"\nseed = [3, 4]\nbootstrap = 1\n',
    )
    # 2 structures, 2 trials left out and none, 2 seeds, 1 draw and none
    assert len(tasks) == 2 * 3 * 2 * 2
    assert len({task.label.run for task in tasks}) == len(tasks)
    for task in tasks:
        assert task.problem == ""
        pipeline, label = read(task.content, task.pipeline), task.label
        held = [trial.name for trial in pipeline.trials if trial.use == "check"]
        assert held == ([label.left_out] if label.left_out else [])
        assert pipeline.identify.seed == label.seed
        assert ("sway_drag_vav" in pipeline.model.effects) == (label.structure == "drag")
        fitted = [trial.name.split(" ")[0] for trial in pipeline.trials if trial.use == "fit"]
        assert len(fitted) == 2 - bool(label.left_out)
        assert label.left_out not in fitted
        if label.draw is None:
            assert len({*fitted}) == len(fitted)
    draws = {task.label.run: task.content for task in tasks if task.label.draw}
    assert draws == {t.label.run: t.content for t in planned(fleet_folder) if t.label.draw}


def test_one_trial_cannot_be_left_out_of_one(fleet_folder: Path) -> None:
    path = fleet_folder / "template-csv.toml"
    text = path.read_text(encoding="utf-8").replace(
        'name = "steps-20"\n', 'name = "steps-20"\nuse = "check"\n'
    )
    path.write_text(text, encoding="utf-8")
    tasks = planned(fleet_folder, '[vary]\ntrial = "leave one out"\n')
    assert {task.problem for task in tasks} == {
        "fits one trial; to leave one out it takes two or more"
    }


def test_a_wrong_template_stops_the_plan(fleet_folder: Path) -> None:
    path = fleet_folder / "template-csv.toml"
    path.write_text(path.read_text(encoding="utf-8").replace("[align]", "[aligned]"))
    with pytest.raises(PipelineError, match="aligned: unknown key"):
        planned(fleet_folder)


@pytest.mark.parametrize(
    "changed", ["ship-3.toml", "template-csv.toml", "alpha/2025-01-10/steps-10.csv"]
)
def test_the_key_follows_every_input(fleet_folder: Path, changed: str) -> None:
    before = [task.key for task in planned(fleet_folder)]
    assert before == [task.key for task in planned(fleet_folder)]
    path = fleet_folder / changed
    path.write_bytes(path.read_bytes() + b"\n")
    after = [task.key for task in planned(fleet_folder)]
    others = after[1:] == before[1:]
    assert after[0] != before[0]
    assert others == changed.startswith("alpha")


def test_the_key_follows_the_version_the_history_and_a_folder_of_logs(
    fleet_folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (fleet_folder / "fleet.toml").write_text(
        '[fleet.alpha]\npipelines = "template-csv.toml"\n', encoding="utf-8"
    )
    path = fleet_folder / "template-csv.toml"
    path.write_text(path.read_text(encoding="utf-8").replace("/steps-10.csv", ""))
    keys = [planned(fleet_folder)[0].key]
    (fleet_folder / "alpha" / "2025-01-10" / "late.csv").write_text("t[s],x\n0,1\n")
    keys.append(planned(fleet_folder)[0].key)
    (fleet_folder / "template-csv.history.jsonl").write_text("{}\n")
    keys.append(planned(fleet_folder)[0].key)
    monkeypatch.setattr(task_module, "VERSION", "9.9.9")
    keys.append(planned(fleet_folder)[0].key)
    assert len({*keys}) == 4


def test_a_date_stated_later_changes_no_key(fleet_folder: Path) -> None:
    before = planned(fleet_folder)
    after = planned(fleet_folder, "dates = {2025-01-10 = 2024-12-31}\n")
    assert [task.key for task in before] == [task.key for task in after]
    assert replace(after[0].label, date=before[0].label.date) == before[0].label


def test_the_shipped_pipeline_is_planned_as_it_is(tmp_path: Path) -> None:
    pipeline = ROOT / "pipelines" / "hidden_effect.toml"
    (tmp_path / "fleet.toml").write_text(f'[fleet.s175]\npipelines = "{pipeline}"\n')
    (task,) = planned(tmp_path)
    assert (task.made, task.pipeline, task.content) == (False, pipeline, pipeline.read_bytes())
    assert not (tmp_path / "out").exists()


def test_what_is_made_of_a_template_that_has_grown_has_grown(fleet_folder: Path) -> None:
    before = planned(fleet_folder)
    text = (fleet_folder / "template-csv.toml").read_text(encoding="utf-8")
    effect = tomllib.loads(text)["model"]["effects"][-1]
    steps = [StepRow(step="added", added=effect, eps_rmsn=0.1)]
    for name in ("template-csv.toml", "template-other.toml"):
        with append_steps(fleet_folder / name, steps):
            pass
    after = planned(fleet_folder)
    assert not any(task.grown for task in before)
    assert all(task.grown for task in after)
    assert {task.key for task in before}.isdisjoint({task.key for task in after})
    assert all(pack(task, fleet_folder / "out", "path").grown for task in after)
