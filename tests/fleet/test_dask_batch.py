"""A batch by Dask: workers killed, a scheduler and workers apart, no row lost, no bit different."""

import os
import random
import shutil
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from apart import processes
from generated_fleet import contents, one_by_one, write_voyage

from trialid.errors import TrialidError
from trialid.fleet import dask_workers
from trialid.fleet.batch import batch, by_dask
from trialid.fleet.dask_workers import check_threads, connect, results
from trialid.fleet.do_run import Done, failure_row
from trialid.pipeline_file.fleet_file import load_fleet

distributed = pytest.importorskip("distributed")
pytest.importorskip("pyarrow")

pytestmark = pytest.mark.filterwarnings("ignore")  # Dask's own
DAMAGED = Path("alpha", "2025-02-10", "steps-20.csv")
VOYAGES = 8


@pytest.fixture(scope="module")
def many(made_fleet: Path, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict]:
    """Eight voyages, a damaged log among them, and what an undisturbed batch makes of them."""
    folder = Path(shutil.copytree(made_fleet, tmp_path_factory.mktemp("many") / "fleet"))
    for number in range(4, VOYAGES + 1):
        write_voyage(folder / "alpha" / f"2025-{number:02}-10", folder / "ship-3.toml", number)
    (folder / DAMAGED).write_bytes(b"\x00\xff" * 500)
    batch(load_fleet(folder / "fleet.toml"), folder / "out", one_by_one)
    return folder, contents(folder / "out")


@pytest.fixture
def fresh(many: tuple[Path, dict], tmp_path: Path) -> Path:
    """The same without any result."""
    folder = Path(shutil.copytree(many[0], tmp_path / "fleet"))
    shutil.rmtree(folder / "out")
    return folder


@pytest.mark.study(turn=15)
def test_workers_killed_at_random_lose_and_double_nothing(
    many: tuple[Path, dict], fresh: Path
) -> None:
    killed: list[int] = []

    def compute(tasks, packed):
        with (
            distributed.LocalCluster(
                n_workers=2,
                threads_per_worker=1,
                host="127.0.0.1",
                dashboard_address="127.0.0.1:0",
                silence_logs=60,
            ) as cluster,
            distributed.Client(cluster) as client,
            kills(cluster, killed),
        ):
            client.run_on_scheduler(
                lambda dask_scheduler: setattr(dask_scheduler, "allowed_failures", 100)
            )
            yield from results(client, tasks, packed)

    first = batch(load_fleet(fresh / "fleet.toml"), fresh / "out", compute)
    print(f"{len(killed)} workers killed")
    assert len(killed) >= 2
    assert len(first.runs) == VOYAGES
    assert contents(fresh / "out") == many[1]
    assert batch(load_fleet(fresh / "fleet.toml"), fresh / "out", one_by_one).anew == 0


@contextmanager
def kills(cluster, killed: list[int]) -> Iterator[None]:
    """A worker process killed every now and then, at times drawn."""
    over, draw = threading.Event(), random.Random(5)

    def kill() -> None:
        while not over.wait(draw.uniform(0.3, 1.5)) and len(killed) < 6:
            nannies = list(cluster.workers.values())
            pid = draw.choice(nannies).pid
            if pid is not None:
                killed.append(pid)
                os.kill(pid, signal.SIGKILL)

    thread = threading.Thread(target=kill)
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join()


DEADLY = """import os, signal
from trialid import Force, Parameter, effect

os.kill(os.getpid(), signal.SIGKILL)
"""


@pytest.mark.study(turn=14)
def test_a_run_that_kills_its_workers_is_a_row_and_is_done_anew(fresh: Path) -> None:
    """The effect that its pipeline brings along does; the other run is none the worse."""
    text = (fresh / "template-csv.toml").read_text(encoding="utf-8")
    (fresh / "deadly.py").write_text(DEADLY, encoding="utf-8")
    with_it = text.replace("[model]", '[model]\neffects_from = ["deadly.py"]')
    (fresh / "2025-02-01.toml").write_text(with_it, encoding="utf-8")
    (fresh / "2025-01-01.toml").write_text(text, encoding="utf-8")
    fleet = '[fleet.alpha]\npipelines = "2025-*.toml"\n'
    (fresh / "fleet.toml").write_text(fleet, encoding="utf-8")
    found = batch(load_fleet(fresh / "fleet.toml"), fresh / "out", by_dask("local", 1, print))
    assert [row.failure is None for row in found.runs] == [True, False]
    assert "its workers died" in (found.runs[1].failure or "")
    todo: list[str] = []
    batch(load_fleet(fresh / "fleet.toml"), fresh / "out", notes(todo))
    assert todo == ["alpha-2025-02-01"]


def notes(todo: list[str]):
    """What does no run, and notes what it was given."""

    def compute(tasks, packed):
        for task in tasks:
            todo.append(task.label.run)
            yield task, Done(row=failure_row(task.label, task.key, "not done"), kept=False)

    return compute


@pytest.mark.study(turn=15)
def test_a_scheduler_and_two_workers_with_folders_of_their_own(
    many: tuple[Path, dict], fresh: Path, tmp_path: Path
) -> None:
    """By content: what the workers are given is all they can see of the fleet."""
    path = fresh / "fleet.toml"
    path.write_text('logs = "content"\n' + path.read_text(encoding="utf-8"), encoding="utf-8")
    told: list[str] = []
    (tmp_path / "apart").mkdir()
    with processes(tmp_path / "apart") as apart:
        found = batch(load_fleet(path), fresh / "out", by_dask(apart.address, None, told.append))
    assert found.anew == VOYAGES
    made, expected = contents(fresh / "out"), dict(many[1])
    assert made.pop("fleet.toml") != expected.pop("fleet.toml")
    assert made == expected
    assert told[0].startswith("Dask: http://")


@pytest.mark.study(turn=12)
def test_a_scheduler_killed_and_started_again(
    many: tuple[Path, dict], fresh: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What was done is kept and is not done again; in the end no bit differs."""
    monkeypatch.setattr(dask_workers, "ANSWER", "5s")
    fleet, done = load_fleet(fresh / "fleet.toml"), list[float]()
    (tmp_path / "apart").mkdir()
    with processes(tmp_path / "apart") as apart:

        def kill_it(words: str, share: float | None) -> None:
            if share and not done:
                done.append(share)
                apart.kill("scheduler")

        with pytest.raises(TrialidError, match="the scheduler is lost; what was done is kept"):
            batch(fleet, fresh / "out", by_dask(apart.address, None, lambda words: None), kill_it)
        kept = {path.name for path in (fresh / "out" / "runs").glob("alpha-*")}
        apart.end()
        apart.begin_all(1)
        again = batch(fleet, fresh / "out", by_dask(apart.address, None, lambda words: None))
    assert 1 <= len(kept) < VOYAGES
    assert again.anew == VOYAGES - len(kept)
    assert len(again.runs) == len({row.run for row in again.runs}) == VOYAGES
    assert contents(fresh / "out") == many[1]


@pytest.mark.study(turn=11)
def test_workers_of_several_threads_are_refused(tmp_path: Path) -> None:
    with (
        processes(tmp_path, threads=2) as apart,
        connect(apart.address, None, 1) as client,
        pytest.raises(TrialidError, match="has 2 threads; start workers by"),
    ):
        check_threads(client)


@pytest.mark.study(turn=11)
def test_no_scheduler_is_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(dask_workers, "ANSWER", "2s")
    with (
        pytest.raises(TrialidError, match="no scheduler answers there"),
        connect("tcp://127.0.0.1:9", None, 1),
    ):
        pass


@pytest.mark.study(turn=12)
def test_a_cluster_described_in_a_file(fresh: Path, tmp_path: Path) -> None:
    for later in sorted((fresh / "alpha").iterdir())[1:]:
        shutil.rmtree(later)
    described = tmp_path / "cluster.yaml"
    described.write_text(
        "module: distributed\nclass: LocalCluster\nkwargs:\n  n_workers: 1\n"
        "  threads_per_worker: 1\n  host: 127.0.0.1\n  dashboard_address: '127.0.0.1:0'\n"
    )
    compute = by_dask(str(described), None, lambda words: None)
    assert batch(load_fleet(fresh / "fleet.toml"), fresh / "out", compute).anew == 1
    for text in ("a: [", "module: distributed\n", "module: distributed\nclass: Nothing\n"):
        described.write_text(text)
        with pytest.raises(TrialidError, match=r"cluster\.yaml"), connect(str(described), None, 1):
            pass


def test_ctrl_c_is_for_the_command_and_not_for_its_workers() -> None:
    """A shell sends it to both; a worker that begins does as it finds it."""
    asks = "import signal; print(signal.getsignal(signal.SIGINT) is signal.SIG_IGN)"
    found = signal.signal(signal.SIGINT, signal.default_int_handler)  # a job behind has it ignored
    with dask_workers._keyboard_for_us():
        inside = subprocess.run([sys.executable, "-c", asks], capture_output=True, check=True)
    after = subprocess.run([sys.executable, "-c", asks], capture_output=True, check=True)
    assert (inside.stdout.strip(), after.stdout.strip()) == (b"True", b"False")
    assert signal.signal(signal.SIGINT, found) is signal.default_int_handler
