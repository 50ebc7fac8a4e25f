"""How long something takes and how much memory it takes, and an end to what takes too long."""

import re
import resource
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType
from typing import TypeVar

from trialid.errors import TrialidError

T = TypeVar("T")

MOST_SECONDS = 10.0
"""Of the processor: another process may have it in between."""

LONGEST_WAIT = 6.0
"""Times as long by the clock: it waits for something that does not come."""

MOST_MEGABYTES = 1000.0
LONGEST_MESSAGE = 2000
"""Letters."""


class Hang(BaseException):
    """Nobody may catch it by accident."""


@contextmanager
def time_limit(seconds: float = MOST_SECONDS) -> Iterator[None]:
    """Hang is raised inside when it takes longer than so much of the processor's time."""

    def late(number: int, frame: FrameType | None) -> None:
        raise Hang

    alarms = (signal.SIGALRM, signal.SIGPROF)
    before = [signal.signal(each, late) for each in alarms]
    signal.setitimer(signal.ITIMER_REAL, LONGEST_WAIT * seconds)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.setitimer(signal.ITIMER_PROF, 0)
        for each, handler in zip(alarms, before, strict=True):
            signal.signal(each, handler)


def forget_peak() -> None:
    """Forget the most memory so far, where the system can."""
    try:
        Path("/proc/self/clear_refs").write_text("5", encoding="ascii")
    except OSError:
        return


def peak_memory() -> float:
    """Most memory of this process [MB], since `forget_peak` where the system can tell."""
    try:
        status = Path("/proc/self/status").read_text(encoding="ascii")
    except OSError:
        scale = 1 if sys.platform == "darwin" else 1024
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * scale / 1e6
    found = re.search(r"VmHWM:\s*(\d+) kB", status)
    return int(found[1]) * 1024 / 1e6 if found else 0.0


def bounded(call: Callable[[], T], megabytes: float = 400.0) -> T | str:
    """What the call gives, or the line with which it is refused; within so much more memory."""
    forget_peak()
    before = peak_memory()
    found: T | str
    with time_limit():
        try:
            found = call()
        except TrialidError as error:
            found = str(error)
    assert peak_memory() - before < megabytes
    if isinstance(found, str):
        assert found.isprintable()
        assert len(found) < LONGEST_MESSAGE
    return found
