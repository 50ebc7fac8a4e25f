"""Workers by Dask: on this machine, behind a scheduler's address, or as a file describes them."""

import logging
import os
import signal
import threading
from collections.abc import Callable, Iterable, Iterator
from contextlib import ExitStack, contextmanager
from importlib import import_module
from itertools import islice
from pathlib import Path
from typing import Any, Final, TypeVar

from trialid.errors import TrialidError, reason_of
from trialid.fleet.do_run import Done, Parcel, do_run, failure_row
from trialid.fleet.inputs import OtherVersion
from trialid.fleet.task import Task
from trialid.user_files import text

BACKLOG: Final = 64
"""Runs sent ahead of those that are done, beside two for each thread: contents take memory."""
ANSWER: Final = "20s"
"""How long a scheduler is waited for."""
LOCAL: Final = "local"

LIGHT: Final = {
    "distributed.worker.profile.enabled": False,  # a look into the workers every 10 ms
    "distributed.nanny.pre-spawn-environ.MALLOC_TRIM_THRESHOLD_": None,
    "distributed.admin.tick.interval": "1s",
    "distributed.worker.memory.monitor-interval": "1s",
}
"""Dask's settings for workers of this machine. Its own threshold gives every array of 128 kB back
to the system at once, and 150 000 pages of a run are asked for anew: an eighth of its processor
time. A tick of 20 ms and a look at memory every 100 ms take 2 % of a core in each process."""

Pack = Callable[[Task], Parcel]
Item = TypeVar("Item")


@contextmanager
def connect(on: str, jobs: int | None, tasks: int) -> Iterator[Any]:
    """A client of the workers that were asked for; those of this machine stop at the end.

    Parameters
    ----------
    on
        `local`, the address of a scheduler, or a YAML file with `module`, `class` and `kwargs` of a
        cluster, as dask-ctl has them.
    jobs
        Worker processes on this machine; a core each where nothing is said.

    Raises
    ------
    TrialidError
        Dask is not installed, no scheduler answers, or the file is none.
    """
    distributed = _distributed()
    with ExitStack() as stack:
        where: Any = on
        if on == LOCAL:
            number = min(jobs or os.cpu_count() or 1, max(tasks, 1))
            stack.enter_context(_light())
            with _keyboard_for_us():
                where = stack.enter_context(
                    distributed.LocalCluster(
                        n_workers=number,
                        threads_per_worker=1,
                        host="127.0.0.1",
                        dashboard_address="127.0.0.1:0",
                        silence_logs=logging.CRITICAL,
                    )
                )
        elif "://" not in on:
            where = stack.enter_context(_described_cluster(Path(on)))
        try:
            client = stack.enter_context(distributed.Client(where, timeout=ANSWER))
        except (OSError, ValueError) as error:
            raise TrialidError(
                f"--on {on}: no scheduler answers there ({reason_of(error)}); start one by: "
                "dask scheduler"
            ) from error
        yield client


@contextmanager
def _keyboard_for_us() -> Iterator[None]:
    """Ctrl-C for none of the processes that begin now: this one stops them, without their traces.

    They have it as it is when they begin, and a shell sends it to all of a command's.
    """
    if threading.current_thread() is not threading.main_thread():
        yield  # only that one may say what a signal does
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


def _distributed() -> Any:
    try:
        import distributed
    except ImportError as error:
        raise TrialidError(
            "this needs Dask, which is not installed; install it by: pip install 'trialid[batch]'"
        ) from error
    return distributed


def _light() -> Any:
    """What Dask does beside the runs, at its least: it takes their time and memory."""
    from dask import config

    return config.set(LIGHT)


def _described_cluster(path: Path) -> Any:
    """The cluster that a YAML file describes.

    Raises
    ------
    TrialidError
        In one line: the file, the key, and what was expected.
    """
    import yaml

    try:
        found = yaml.safe_load(text(path))
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        said = "write local, tcp://HOST:PORT or a YAML file"
        why = (error.strerror or "").lower() if isinstance(error, OSError) else ""
        why = why or reason_of(error)
        raise TrialidError(f"--on {path}: cannot be read ({why}); {said}") from error
    if not isinstance(found, dict) or not {"module", "class"} <= found.keys():
        raise TrialidError(
            f"--on {path}: lacks module and class of a cluster; see: trialid guide batch"
        )
    try:
        made = getattr(import_module(found["module"]), found["class"])
        return made(*found.get("args", ()), **found.get("kwargs", {}))
    except (ImportError, AttributeError, TypeError, ValueError) as error:
        raise TrialidError(
            f"--on {path}: {found['module']}.{found['class']} cannot be made ({reason_of(error)})"
        ) from error


def check_threads(client: Any) -> None:
    """Refuse workers of several threads: a run takes one process, and they would share it.

    Raises
    ------
    TrialidError
        In one line, with what to do.
    """
    for worker, threads in client.nthreads().items():
        if threads > 1:
            raise TrialidError(
                f"--on: worker {worker} has {threads} threads; start workers by: "
                "dask worker --nthreads 1"
            )


def answers(
    client: Any,
    does: Callable[[Any], Any],
    items: Iterable[Item],
    key: Callable[[Item], str],
    pack: Callable[[Item], Any],
) -> Iterator[tuple[Item, Any]]:
    """Each item with the future that holds what `does` made of its parcel, as they are done.

    Raises
    ------
    TrialidError
        The scheduler is lost.
    """
    pool: Any = _distributed().as_completed()
    waiting, todo = dict[str, Item](), iter(items)

    def send(some: Iterable[Item]) -> None:
        for item in some:
            future = client.submit(does, pack(item), key=key(item), pure=False)
            waiting[future.key] = item
            pool.add(future)

    send(islice(todo, BACKLOG + 2 * sum(client.nthreads().values())))
    for future in pool:
        if future.status not in ("finished", "error"):
            raise TrialidError(
                "the scheduler is lost; what was done is kept: give the command again"
            )
        yield waiting.pop(future.key), future
        del future
        send(islice(todo, 1))


def trouble(future: Any) -> str:
    """Why nothing came of a task, in one line: the worker's own trouble, or a bug."""
    error = future.exception()
    name = type(error).__name__
    if name == "KilledWorker":
        return "its workers died, each of several that tried it; out of memory?"
    if isinstance(error, TrialidError):
        return str(error)
    if isinstance(error, OtherVersion | OSError | ImportError):
        return reason_of(error)
    return f"this is a bug in trialid, not a mistake of yours: {name}: {error}"


def results(client: Any, tasks: Iterable[Task], pack: Pack) -> Iterator[tuple[Task, Done]]:
    """Every run with what came of it, as they are done.

    What came of a worker's own trouble is not kept, and done anew next time.
    """
    for task, future in answers(client, do_run, tasks, _name, pack):
        if future.status == "finished":
            yield task, future.result()
        else:
            said = str(TrialidError(trouble(future)))
            yield task, Done(row=failure_row(task.label, task.key, said), kept=False)


def _name(task: Task) -> str:
    return f"{task.label.run}-{task.key}"
