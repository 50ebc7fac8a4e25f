"""One thread for linear algebra, whose matrices are tall and thin, and cores for long records.

Measured on two cores: a fit of 0.23 s with one thread takes 0.6 s with two, and many times that
beside another busy process. One thread also gives the same digits on every machine.

The limit is the whole process's, so it is counted: fits in several threads of a workbench or a
notebook share it, and the last to end gives back what the first found.
"""

import functools
import os
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from typing import TYPE_CHECKING, Final, ParamSpec, TypeVar

if TYPE_CHECKING:
    from threadpoolctl import threadpool_limits

P = ParamSpec("P")
T = TypeVar("T")

LONG: Final = 1 << 21
"""Numbers to work out from which each core has a thread. On two cores 1.5 million take 14 ms in
turn and 9 side by side, twice as many 29 and 16, half as many 9 and 5: what is over sooner leaves
the other core to whoever needs it."""


def side_by_side(work: Callable[[int], T], count: int, numbers: int) -> Iterator[T]:
    """What `work` gives for 0 to `count` - 1, in that order; of a long record on all cores at once.

    Parameters
    ----------
    numbers
        How many are worked out in all. With few it is done one after the other, as they are asked
        for.
    """
    many = min(cores(), count) if numbers >= LONG else 1
    if many < 2:
        yield from map(work, range(count))
        return
    with ThreadPoolExecutor(many) as pool:
        yield from pool.map(work, range(count))


def cores() -> int:
    """As many as this process may use; OMP_NUM_THREADS, which says so to all others, holds here."""
    stated = os.environ.get("OMP_NUM_THREADS", "")
    if stated.isdigit() and int(stated):
        return int(stated)
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def one_thread(function: Callable[P, T]) -> Callable[P, T]:
    """Run a function with BLAS held to one thread."""

    @functools.wraps(function)
    def held(*args: P.args, **kwargs: P.kwargs) -> T:
        with _LIMIT.held():
            return function(*args, **kwargs)

    return held


class _Limit:
    """One thread from the first caller's entry to the last one's end."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._callers = 0
        self._limits: threadpool_limits | None = None

    @contextmanager
    def held(self) -> Iterator[None]:
        with self._lock:
            self._callers += 1
            if self._limits is None:
                self._limits = _one()
        try:
            yield
        finally:
            with self._lock:
                self._callers -= 1
                if not self._callers and self._limits is not None:
                    _give_back(self._limits)
                    self._limits = None


def _one() -> "threadpool_limits":
    from threadpoolctl import threadpool_limits

    return threadpool_limits(limits=1, user_api="blas")


def _give_back(limits: "threadpool_limits") -> None:
    from threadpoolctl import OpenBLASController

    # only the thread that has set a limit may change it, else nothing happens and nothing is said
    OpenBLASController.clear_controlling_thread(force=True)
    limits.restore_original_limits()
    OpenBLASController.clear_controlling_thread(force=True)


_LIMIT = _Limit()
