"""The fleet file: every mistake is one line with the key; what it names is found."""

from datetime import date
from pathlib import Path

import pytest
from click.testing import CliRunner

from trialid.cli.main import commands
from trialid.errors import PipelineError
from trialid.fleet.plan import plan, voyages
from trialid.pipeline_file.fleet_file import load_fleet


def changed(folder: Path, old: str, new: str) -> Path:
    path = folder / "fleet.toml"
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new), encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("voyages =", "voyage =", "fleet.alpha.voyage: unknown key; did you mean 'voyages'?"),
        ('"alpha/*"', '"beta/*"', "fleet.alpha.voyages[0]: 'beta/*' names nothing that is there"),
        ('"ship-3.toml"', '"ship-4.toml"', "fleet.alpha.file: no file 'ship-4.toml'"),
        ("template =", "# template =", "fleet.alpha.voyages: need a pipeline to be fitted"),
        ('voyages = "alpha/*"', "", "fleet.alpha: names neither voyages nor pipelines"),
        ("name =", 'logs = "copy"\nname =', "logs: 'copy' is not allowed; "),
        ('"alpha/*"', '"alpha/*"\ndates = {x = 2025-01-01}', "fleet.alpha.dates.x: no such voyage"),
        ('"alpha/*"', '"alpha/*"\n[vary]\nseeds = [1]', "vary.seeds: unknown key; did you mean"),
        ('"alpha/*"', '"alpha/*"\n[vary]\nbootstrap = -1', "vary.bootstrap: "),
        ("[fleet.alpha]", "[ships.alpha]", "ships: unknown key"),
    ],
)
def test_a_mistake_is_one_line_with_its_key(
    fleet_folder: Path, old: str, new: str, said: str
) -> None:
    path = changed(fleet_folder, old, new)
    with pytest.raises(PipelineError) as caught:
        load_fleet(path)
    assert str(caught.value).startswith(f"{path}: {said}")
    assert "\n" not in str(caught.value)


def test_a_fleet_that_is_not_there_is_one(fleet_folder: Path) -> None:
    with pytest.raises(PipelineError, match=r"flet\.toml: no such fleet file .*'fleet\.toml'"):
        load_fleet(fleet_folder / "flet.toml")


def test_a_fleet_given_for_a_pipeline_is_told_where_it_belongs(fleet_folder: Path) -> None:
    for wrong, right in (("run", "batch"), ("batch", "run")):
        file = "fleet.toml" if wrong == "run" else "template-csv.toml"
        told = CliRunner().invoke(commands, [wrong, str(fleet_folder / file)])
        assert told.exit_code == 2
        assert f"trialid {right} {fleet_folder / file}" in told.stderr
        assert told.stderr.count("\n") == 1


def test_dates_are_stated_never_made(fleet_folder: Path) -> None:
    (fleet_folder / "alpha" / "2025-02-10").rename(fleet_folder / "alpha" / "february")
    path = fleet_folder / "fleet.toml"
    assert [v.date for v in voyages(load_fleet(path))] == [
        date(2025, 1, 10),
        date(2025, 3, 10),
        None,
    ]
    changed(fleet_folder, '"alpha/*"', '"alpha/*"\ndates = {february = 2025-02-11}')
    found = list(voyages(load_fleet(path)))
    assert [v.voyage for v in found] == ["2025-01-10", "february", "2025-03-10"]
    assert found[1].date == date(2025, 2, 11)


def test_one_voyage_without_a_date_takes_the_order_from_no_other(fleet_folder: Path) -> None:
    """It stands behind them, though its name comes first."""
    (fleet_folder / "alpha" / "2025-02-10").rename(fleet_folder / "alpha" / "0 unknown")
    path = changed(fleet_folder, '"alpha/*"', '"alpha/*"\ndates = {2025-01-10 = 2025-12-24}')
    found = [v.voyage for v in voyages(load_fleet(path))]
    assert found == ["2025-03-10", "2025-01-10", "0 unknown"]


def test_names_are_in_the_order_of_the_numbers_in_them(fleet_folder: Path) -> None:
    names = ["leg 2 trip 10", "leg 2 trip 3", "leg 10 trip 1"]
    for old, new in zip(("01", "02", "03"), names, strict=True):
        (fleet_folder / "alpha" / f"2025-{old}-10").rename(fleet_folder / "alpha" / new)
    found = [v.voyage for v in voyages(load_fleet(fleet_folder / "fleet.toml"))]
    assert found == ["leg 2 trip 3", "leg 2 trip 10", "leg 10 trip 1"]


def test_a_voyage_without_its_log_is_a_row_and_not_the_end(
    fleet_folder: Path, tmp_path: Path
) -> None:
    (fleet_folder / "alpha" / "2025-02-10" / "steps-20.csv").rename(
        fleet_folder / "alpha" / "2025-02-10" / "20 degrees.csv"
    )
    path = fleet_folder / "fleet.toml"
    tasks = plan(load_fleet(path), tmp_path / "out")
    assert [bool(task.problem) for task in tasks] == [False, True, False]
    assert "holds none of the one log 'steps-20.csv' of trial 'steps-20'" in tasks[1].problem
    changed(fleet_folder, "[fleet.alpha]", '[files]\nsteps-20 = "*20*.csv"\n[fleet.alpha]')
    assert [task.problem for task in plan(load_fleet(path), tmp_path / "out")] == ["", "", ""]
    changed(fleet_folder, "steps-20 =", "step-20 =")
    with pytest.raises(PipelineError, match=r"files\.step-20: .*did you mean 'steps-20'"):
        plan(load_fleet(path), tmp_path / "out")


def test_a_pattern_that_two_logs_fit_takes_neither(fleet_folder: Path, tmp_path: Path) -> None:
    folder = fleet_folder / "alpha" / "2025-02-10"
    (folder / "steps-20 again.csv").write_bytes((folder / "steps-20.csv").read_bytes())
    path = changed(fleet_folder, "[fleet.alpha]", '[files]\nsteps-20 = "steps-20*"\n[fleet.alpha]')
    tasks = plan(load_fleet(path), tmp_path / "out")
    assert [bool(task.problem) for task in tasks] == [False, True, False]
    assert "holds 2 of the one log 'steps-20*' of trial 'steps-20'" in tasks[1].problem
