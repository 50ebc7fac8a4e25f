"""A batch: only what is new is done, what is done is kept, failures are rows, no bit differs."""

import shutil
from pathlib import Path

import pandas as pd
import pytest
from click.testing import CliRunner
from generated_fleet import contents, one_by_one

from trialid.cli.main import commands
from trialid.errors import TrialidError
from trialid.fleet.batch import Batch, batch
from trialid.pipeline_file.fleet_file import load_fleet
from trialid.report.pictures.voyage_picture import voyage_picture
from trialid.result.fleet_rows import FittedRow, RunLabel
from trialid.result.json_file import read
from trialid.workflow.repeat import earlier, repeat

pytest.importorskip("pyarrow")


def done(folder: Path, compute=one_by_one, out: str = "out") -> Batch:
    return batch(load_fleet(folder / "fleet.toml"), folder / out, compute)


@pytest.fixture(scope="module")
def finished(made_fleet: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The fleet, its second voyage with a damaged log, and the batch of it, undisturbed."""
    folder = Path(shutil.copytree(made_fleet, tmp_path_factory.mktemp("finished") / "fleet"))
    log = folder / "alpha" / "2025-02-10" / "steps-20.csv"
    log.write_bytes(b"\x00\xff" * 500)
    done(folder)
    return folder


def test_a_damaged_log_is_a_row_with_its_line(finished: Path) -> None:
    runs = pd.read_parquet(finished / "out" / "runs.parquet")
    assert list(runs["voyage"]) == ["2025-01-10", "2025-02-10", "2025-03-10"]
    assert list(runs["verdict"].isna()) == [False, True, False]
    (failure,) = runs["failure"].dropna()
    assert "steps-20.csv" in failure
    assert str(finished) not in failure
    assert "\n" not in failure


def test_rows_are_what_the_runs_say(finished: Path) -> None:
    runs = pd.read_parquet(finished / "out" / "runs.parquet").set_index("run")
    fitted = pd.read_parquet(finished / "out" / "parameters.parquet")
    for name in runs.index[runs["failure"].isna()]:
        result = read(finished / "out" / "runs" / name / "result.json")
        assert runs.loc[name, "eps_rmsn"] == result.fit.eps_rmsn
        assert runs.loc[name, "verdict"] == result.verdict.kind
        own = fitted[(fitted["run"] == name) & (fitted["kind"] == "physical")]
        for row in result.physical:
            (found,) = own[own["parameter"] == row.name].to_dict("records")
            assert found["value"] == row.value
            assert (found["likely_low"], found["likely_high"]) == row.likely


def test_a_run_of_a_fleet_is_a_run(finished: Path) -> None:
    """Its folder can be repeated, digit for digit."""
    before = earlier(finished / "out" / "runs" / "alpha-2025-03-10")
    _, compared = repeat(before, lambda words, share: None)
    assert compared.same


def test_broken_off_and_gone_on_with_is_as_undisturbed(finished: Path, tmp_path: Path) -> None:
    folder = Path(shutil.copytree(finished, tmp_path / "fleet"))
    undisturbed = contents(folder / "out")
    shutil.rmtree(folder / "out")

    def breaks_off(tasks, packed):
        yield next(one_by_one(tasks, packed))
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        done(folder, breaks_off)
    assert [path.name for path in (folder / "out" / "runs").iterdir()] == ["alpha-2025-01-10"]
    assert not (folder / "out" / "runs.parquet").exists()
    assert done(folder).anew == 2
    assert contents(folder / "out") == undisturbed
    assert done(folder).anew == 0
    assert contents(folder / "out") == undisturbed


def test_only_what_is_new_is_done(finished: Path, tmp_path: Path, made_fleet: Path) -> None:
    folder = Path(shutil.copytree(finished, tmp_path / "fleet"))
    voyage = Path("alpha", "2025-02-10", "steps-20.csv")
    shutil.copy(made_fleet / voyage, folder / voyage)
    found = done(folder)
    assert found.anew == 1
    assert [row.failure for row in found.runs] == [None, None, None]
    assert (folder / "out" / "runs" / "alpha-2025-02-10" / "report.html").is_file()


def test_by_content_and_by_path_no_bit_differs(finished: Path, tmp_path: Path) -> None:
    folder = Path(shutil.copytree(finished, tmp_path / "fleet"))
    by_path = contents(folder / "out")
    shutil.rmtree(folder / "out")
    path = folder / "fleet.toml"
    text = path.read_text(encoding="utf-8")
    path.write_text('logs = "content"\n' + text, encoding="utf-8")
    done(folder)
    by_content = contents(folder / "out")
    assert by_content.pop("fleet.toml") != by_path.pop("fleet.toml")
    assert by_content == by_path


def test_what_is_not_ours_in_a_runs_folder_is_never_lost(finished: Path, tmp_path: Path) -> None:
    folder = Path(shutil.copytree(finished, tmp_path / "fleet"))
    run = folder / "out" / "runs" / "alpha-2025-01-10"
    (run / "notes.txt").write_text("mine")
    assert done(folder).anew == 0
    (folder / "ship-3.toml").write_text((folder / "ship-3.toml").read_text() + "\n")
    before = contents(run)
    with pytest.raises(TrialidError, match=r"notes\.txt: is no file of trialid's"):
        done(folder)
    assert contents(run) == before
    (run / "notes.txt").unlink()
    assert done(folder).anew == 3


def test_a_folder_of_others_is_refused(finished: Path, tmp_path: Path) -> None:
    (tmp_path / "thesis.txt").write_text("mine")
    with pytest.raises(TrialidError, match="holds other files and no earlier batch"):
        batch(load_fleet(finished / "fleet.toml"), tmp_path, one_by_one)
    assert contents(tmp_path) == {"thesis.txt": b"mine"}


def test_the_page_leads_to_the_runs_and_holds_what_is_found(finished: Path) -> None:
    page = (finished / "out" / "fleet.html").read_text(encoding="utf-8")
    assert 'href="runs/alpha-2025-01-10/report.html"' in page
    assert 'href="runs/alpha-2025-02-10/report.html"' not in page
    assert page.count('<a href="runs/alpha-2025-03-10/report.html"><title>') == 2  # her parameters
    assert "No result" in page
    assert "http" not in page.replace("http-equiv", "").replace("http://www.w3.org", "")


def test_a_picture_over_ships_parts_them_and_tells_ranges() -> None:
    def row(ship: str, voyage: int) -> FittedRow:
        label = RunLabel(run=f"{ship}-{voyage}", ship=ship, voyage=f"{voyage}")
        fitted = {"kind": "physical", "unit": "m", "value": 0.3, "standard_error": 0.01}
        return FittedRow(**vars(label), parameter="GM", **fitted, likely_low=0.25, likely_high=0.4)

    rows = [row(ship, voyage) for ship in ("a", "b") for voyage in (1, 2)]
    picture = voyage_picture("GM", rows, [each.ship for each in rows], ())
    assert picture.borders == (280.0,)
    assert picture.whiskers[0].words == "a-1: 0.300 m, likely 0.250 to 0.400"
    assert voyage_picture("GM", rows, [each.run for each in rows], ()).borders == ()
    assert picture.names == ("a", "a", "b", "b")
    many = [row(f"{n}", 1) for n in range(50) for _ in (1, 2)]
    crowded = voyage_picture("GM", many, [each.ship for each in many], ())
    assert (crowded.borders, crowded.names) == ((), ())


def test_without_dask_one_line_says_how_to_get_it(
    finished: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(__import__("sys").modules, "distributed", None)
    words = ["batch", str(finished / "fleet.toml"), "--out", str(tmp_path / "out")]
    told = CliRunner().invoke(commands, words)
    assert told.exit_code == 2
    assert told.stderr.count("\n") == 1
    assert "pip install 'trialid[batch]'" in told.stderr
