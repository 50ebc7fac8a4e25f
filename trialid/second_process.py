"""Two pieces of work at once: one by a second process, which begins as a copy of this one.

Most of a run is Python, of which threads do one piece at a time. A copy (`os.fork`) knows all that
this process knows, so that nothing has to be sent to it; what it finds comes back pickled. Both do
the very same arithmetic as one after the other, so that no digit depends on who did it.

A copy of a process with other threads may wait for ever for a lock that one of them held. So there
is a copy only where nobody else runs Python here, but for a `Ticker`, which is known to hold
nothing meanwhile. Linear algebra has been told to keep to one thread by whoever asks
(`one_thread`), and OpenBLAS ends its own threads before a copy is made. Where there can be none
(another system, one core, little memory, a workbench or a notebook with its threads), where the
copy dies or finds what cannot be pickled, this process does the work itself: errors are told as
without.

The copy never outlives the call: whatever ends that kills it, and Linux kills it with this process.
"""

import ctypes
import gc
import io
import os
import pickle
import resource
import signal
import sys
import threading
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from multiprocessing import parent_process
from pathlib import Path
from typing import Any, BinaryIO, Final, TypeVar

from trialid.threads import cores

T = TypeVar("T")
U = TypeVar("U")
A = TypeVar("A")

PR_SET_PDEATHSIG: Final = 1

ROOM: Final = 2
"""Times what this process has taken at most that must be free for a copy: what both write to is
there twice. Half is a process that fills the memory; twice denies a copy where one would do."""

_STILL = threading.RLock()
"""Held while a copy is made and while a `Ticker` ticks."""

_taken = threading.local()
"""Whether a copy is at work for this process, or this is one; a copy makes none."""


@contextmanager
def meanwhile(work: Callable[[], T], known: Iterable[object] = ()) -> Iterator[Callable[[], T]]:
    """Work begun by a second process where there can be one; what it finds is there for the asking.

    Where there can be none the work is done when it is asked for, and not at all where nobody asks.

    Parameters
    ----------
    work
        Changes nothing that anybody looks at later but files, for it may be done elsewhere.
    known
        What the answer may hold and need not bring along: it comes back as the same object.
    """
    if not _can_copy():
        yield work
        return
    shared = tuple(known)
    with _copy_at_work(work, shared) as answer:

        def told() -> T:
            found = _told(answer, shared)
            return work() if found is None else found[0]

        yield told


def both(
    here: Callable[[], T], there: Callable[[], U], known: Iterable[object] = ()
) -> tuple[T, U]:
    """What both give, `there` as by `meanwhile`."""
    with meanwhile(there, known) as told:
        return here(), told()


def each(work: Callable[[A], T], of: Sequence[A], known: Iterable[object] = ()) -> list[T]:
    """What `work` gives for each, in their order; every second is done as by `both`."""
    if len(of) < 2:
        return [work(one) for one in of]
    found, told = both(
        lambda: [work(one) for one in of[::2]], lambda: [work(one) for one in of[1::2]], known
    )
    every = [*found, *told]
    every[::2], every[1::2] = found, told
    return every


@contextmanager
def tick_beside(seconds: float, tick: Callable[[], None]) -> Iterator[None]:
    """Do something again and again in a thread beside which copies may be made."""
    done = threading.Event()
    thread = Ticker(done, seconds, tick)
    thread.start()
    try:
        yield
    finally:
        done.set()
        thread.join()


class Ticker(threading.Thread):
    """A thread that holds no lock while a copy of the process is made."""

    def __init__(self, done: threading.Event, seconds: float, tick: Callable[[], None]) -> None:
        super().__init__(daemon=True)
        self._done, self._seconds, self._tick = done, seconds, tick

    def run(self) -> None:
        """Tick until it is done."""
        while not self._done.wait(self._seconds):
            with _STILL:
                self._tick()


def _can_copy() -> bool:
    """Whether a copy is safe and has a core and memory of its own; one of many workers has not."""
    if sys.platform != "linux" or getattr(_taken, "by", None) or cores() < 2:
        return False
    if parent_process() is not None:
        return False
    tickers = sum(isinstance(one, Ticker) for one in threading.enumerate())
    return len(sys._current_frames()) == 1 + tickers and _has_room()


def _has_room() -> bool:
    try:
        told = Path("/proc/meminfo").read_text(encoding="ascii").split("MemAvailable:")[1]
    except (OSError, IndexError):
        return False
    taken = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return int(told.split()[0]) > ROOM * taken  # both in kB


@contextmanager
def _copy_at_work(work: Callable[[], object], shared: Sequence[object]) -> Iterator[BinaryIO]:
    """A copy that does the work and writes what it finds; it has ended when this ends."""
    reading, writing = os.pipe()
    parent = os.getpid()
    with _STILL:
        copy = os.fork()
    if not copy:
        _be_the_copy(parent, work, writing, shared)
    os.close(writing)
    _taken.by = True
    try:
        with os.fdopen(reading, "rb") as answer:
            yield answer
    finally:
        _taken.by = False
        os.kill(copy, signal.SIGKILL)  # it has told all, or nobody asks any more
        os.waitpid(copy, 0)


def _be_the_copy(
    parent: int, work: Callable[[], object], writing: int, shared: Sequence[object]
) -> None:
    """Work, write and end; nothing of what this process was about to do is done twice."""
    status = 1
    try:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
        if os.getppid() == parent:
            gc.freeze()  # else looking for garbage would copy every page
            _taken.by = True
            answer = _pickled(work(), shared)
            with os.fdopen(writing, "wb") as stream:
                stream.write(answer)
            status = 0
    except BaseException:  # noqa: BLE001 - told by the process that asked, which meets it, too
        pass
    finally:
        os._exit(status)


def _told(answer: BinaryIO, shared: Sequence[object]) -> tuple[Any] | None:
    """What a copy wrote, in a tuple; None where it did not come to that."""
    try:
        return (_Unpickler(io.BytesIO(answer.read()), shared).load(),)
    except (EOFError, pickle.UnpicklingError):
        return None


def _pickled(found: object, shared: Sequence[object]) -> bytes:
    stream = io.BytesIO()
    _Pickler(stream, shared).dump(found)
    return stream.getvalue()


class _Pickler(pickle.Pickler):
    """What both processes know is told by its place."""

    def __init__(self, stream: BinaryIO, shared: Sequence[object]) -> None:
        super().__init__(stream, pickle.HIGHEST_PROTOCOL)
        self._places = {id(one): place for place, one in enumerate(shared)}

    def persistent_id(self, obj: object) -> int | None:
        """The place of what both know."""
        return self._places.get(id(obj))


class _Unpickler(pickle.Unpickler):
    def __init__(self, stream: BinaryIO, shared: Sequence[object]) -> None:
        super().__init__(stream)
        self._shared = shared

    def persistent_load(self, pid: int) -> object:
        """What stands at a place."""
        return self._shared[pid]
