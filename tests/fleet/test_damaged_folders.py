"""What has happened to a batch's folder is seen, is the row of its run, and stops no other."""

import shutil
from pathlib import Path

import pytest
from generated_fleet import contents, one_by_one

from trialid.fleet.batch import Batch, batch
from trialid.pipeline_file.fleet_file import load_fleet
from trialid.result.fleet_rows import RunRow

pytest.importorskip("pyarrow")
FIRST = "alpha-2025-01-10"
LAST = "alpha-2025-03-10"


def done(folder: Path) -> Batch:
    return batch(load_fleet(folder / "fleet.toml"), folder / "out", one_by_one)


@pytest.fixture(scope="module")
def finished(made_fleet: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = Path(shutil.copytree(made_fleet, tmp_path_factory.mktemp("finished") / "fleet"))
    assert done(folder).anew == 3
    return folder


@pytest.fixture
def fleet(finished: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(finished, tmp_path / "fleet"))


def failed(found: Batch) -> list[RunRow]:
    return [row for row in found.runs if row.failure is not None]


@pytest.mark.parametrize("name", ["result.json", "report.html", "fleet_run.json"])
def test_a_run_that_lost_a_file_is_done_again(fleet: Path, name: str) -> None:
    before = contents(fleet / "out")
    (fleet / "out" / "runs" / FIRST / name).unlink()
    found = done(fleet)
    assert (found.anew, failed(found)) == (1, [])
    assert contents(fleet / "out") == before


@pytest.mark.parametrize("name", ["result.json", "report.html", "fleet_run.json"])
def test_a_file_that_was_cut_off_is_told(fleet: Path, name: str) -> None:
    file = fleet / "out" / "runs" / FIRST / name
    file.write_bytes(file.read_bytes()[:500])
    found = done(fleet)
    [row] = failed(found)
    assert (found.anew, row.run) == (0, FIRST)
    assert row.failure.startswith(f"runs/{FIRST}/{name}: was changed since it was written")
    file.unlink()
    assert (done(fleet).anew, failed(done(fleet))) == (1, [])


def test_a_run_that_cannot_be_done_now_does_not_show_its_former_success(fleet: Path) -> None:
    """And has it back without work when its inputs are again what they were."""
    before, log = contents(fleet / "out"), fleet / "alpha" / "2025-03-10" / "steps-20.csv"
    log.rename(fleet / "elsewhere.csv")
    found = done(fleet)
    assert [row.run for row in failed(found)] == [LAST]
    assert not (fleet / "out" / "runs" / LAST).exists()
    assert (fleet / "out" / "set_aside" / LAST / "result.json").is_file()
    (fleet / "elsewhere.csv").rename(log)
    again = done(fleet)
    assert (again.anew, failed(again)) == (0, [])
    assert contents(fleet / "out") == before


def test_what_was_set_aside_and_changed_since_is_done_anew(fleet: Path) -> None:
    log = fleet / "alpha" / "2025-03-10" / "steps-20.csv"
    log.rename(fleet / "elsewhere.csv")
    done(fleet)
    aside = fleet / "out" / "set_aside" / LAST / "result.json"
    aside.write_bytes(aside.read_bytes()[:500])
    (fleet / "elsewhere.csv").rename(log)
    again = done(fleet)
    assert (again.anew, failed(again)) == (1, [])
    assert aside.stat().st_size == 500


def test_one_pipeline_changed_by_hand_stops_no_other(fleet: Path) -> None:
    shutil.rmtree(fleet / "out" / "runs")
    file = fleet / "out" / "pipelines" / f"{FIRST}.toml"
    file.write_text(file.read_text(encoding="utf-8") + "# mine\n", encoding="utf-8")
    found = done(fleet)
    [row] = failed(found)
    assert (found.anew, row.run) == (2, FIRST)
    assert row.failure.startswith(f"pipelines/{FIRST}.toml: was changed since it was written")
    assert "# mine" in file.read_text(encoding="utf-8")
    file.unlink()
    assert (done(fleet).anew, failed(done(fleet))) == (1, [])
