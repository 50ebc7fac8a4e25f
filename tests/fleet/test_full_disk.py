"""A disk full at any moment: what was done is kept whole, and a rerun lacks and doubles nothing."""

import errno
import io
import os
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner
from generated_fleet import contents

from trialid.cli.main import commands
from trialid.fleet import batch as batch_module
from trialid.fleet.batch import batch
from trialid.fleet.do_run import Done
from trialid.fleet.finished_runs import keep_run, kept_run
from trialid.fleet.rows_of_run import run_row
from trialid.pipeline_file.fleet_file import load_fleet
from trialid.result.fleet_rows import RunLabel
from trialid.result.schema import Result

pytest.importorskip("pyarrow")

OPEN = io.open


class Disk:
    """Counts what is written, made and moved; the one `at` that number finds no room."""

    def __init__(self, patch: pytest.MonkeyPatch, at: int = -1) -> None:
        self.count, self.at = 0, at
        for name, counts in (("mkdir", is_new), ("rename", any_call), ("replace", any_call)):
            patch.setattr(os, name, self.counted(getattr(os, name), counts))
        patch.setattr(os, "open", self.counted(os.open, creates))
        patch.setattr(io, "open", self.counted(io.open, writes))

    def counted(self, does: Callable[..., Any], counts: Callable[..., bool]) -> Callable[..., Any]:
        def counted(*given: Any, **named: Any) -> Any:
            if counts(*given):
                self.count += 1
                if self.count == self.at:
                    begin(given[0], does)
                    raise OSError(errno.ENOSPC, "No space left on device")
            return does(*given, **named)

        return counted


def any_call(*given: Any) -> bool:
    return True


def is_new(path: Any, *more: Any) -> bool:
    return not Path(path).exists()


def creates(path: Any, flags: int, *more: Any) -> bool:
    return bool(flags & os.O_CREAT)


def writes(path: Any, mode: str = "r", *more: Any) -> bool:
    return mode[0] in "wx"


def begin(path: Any, does: Callable[..., Any]) -> None:
    """A file that finds no room is there, and not whole."""
    if does is OPEN:
        with OPEN(path, "wb") as stream:
            stream.write(b"hal")


def made_up(key: str, content: bytes) -> Done:
    """What comes of a run, without doing it."""
    row = run_row(RunLabel(run="a", ship="a", voyage="a"), key, Result())
    return Done(row=row, files={"result.json": content, "series.csv": content * 2})


def times(does: Callable[[], None]) -> int:
    """How often something writes."""
    with pytest.MonkeyPatch.context() as patch:
        disk = Disk(patch)
        does()
        return disk.count


def fails(at: int, does: Callable[[], None]) -> None:
    """Do something on a disk that is full at this write."""
    with pytest.MonkeyPatch.context() as patch:
        Disk(patch, at)
        with pytest.raises(OSError, match="No space"):
            does()


def test_a_run_that_cannot_be_kept_leaves_the_earlier_one(tmp_path: Path) -> None:
    """At whichever write: the earlier folder is there with every bit, or the new one is."""
    old, new = made_up("old", b"1"), made_up("new", b"2")
    keep_run(old, tmp_path / "old" / "run")
    keep_run(new, tmp_path / "new" / "run")
    shutil.copytree(tmp_path / "old", tmp_path / "counted")
    number = times(lambda: keep_run(new, tmp_path / "counted" / "run"))
    assert number >= 10
    for at in range(1, number + 1):
        runs = Path(shutil.copytree(tmp_path / "old", tmp_path / f"{at}"))
        fails(at, lambda runs=runs: keep_run(new, runs / "run"))
        assert contents(runs) == contents(tmp_path / "old"), at
        assert kept_run(runs / "run", "old") is not None
        assert [path.name for path in runs.iterdir()] == ["run"], at
        keep_run(new, runs / "run")
        assert contents(runs) == contents(tmp_path / "new"), at


def all_made_up(tasks, packed):
    """Runs that take no time."""
    for task in tasks:
        row = run_row(task.label, task.key, Result())
        yield task, Done(row=row, files={"result.json": task.key.encode()})


@pytest.fixture
def began(fleet_folder: Path) -> Path:
    """A fleet whose runs were done with another ship file."""
    batch(load_fleet(fleet_folder / "fleet.toml"), fleet_folder / "out", all_made_up)
    ship = fleet_folder / "ship-3.toml"
    ship.write_text(ship.read_text(encoding="utf-8") + "\n", encoding="utf-8")
    return fleet_folder


@pytest.mark.study(turn=3)
def test_a_batch_on_a_full_disk_loses_and_doubles_nothing(began: Path, tmp_path: Path) -> None:
    """At any write: rows and runs are the old ones or the new ones, each whole."""
    made = Path(shutil.copytree(began / "out", tmp_path / "old"))
    shutil.rmtree(began / "out")
    fleet = load_fleet(began / "fleet.toml")

    def again() -> None:
        batch(fleet, began / "out", all_made_up)

    shutil.copytree(made, began / "out")
    number = times(again)
    old, new = contents(made), contents(began / "out")
    assert old.keys() == new.keys()
    assert number >= 40
    for at in range(1, number + 1):
        shutil.rmtree(began / "out")
        shutil.copytree(made, began / "out")
        fails(at, again)
        for name, content in contents(began / "out").items():
            assert content in (old[name], new[name]), (at, name)
        assert contents(began / "out").keys() == old.keys(), at
        again()
        assert contents(began / "out") == new, at


def test_the_command_says_it_in_one_line(began: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(done: Done, folder: Path) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("trialid.fleet.batch.by_dask", lambda on, jobs, tell: all_made_up)
    monkeypatch.setattr(batch_module, "keep_run", full)
    words = ["batch", str(began / "fleet.toml"), "--out", str(began / "out"), "--quiet"]
    told = CliRunner().invoke(commands, words)
    assert told.exit_code == 2
    why = "cannot be written (no space left on device); choose another --out"
    assert told.stderr == f"trialid: {began / 'out'}: {why}\n"
