"""One thread for linear algebra: the matrices here are tall and thin, and two threads only wait.

Measured on two cores: a fit of 0.23 s with one thread takes 0.6 s with two, and many times that
beside another busy process. One thread also gives the same digits on every machine.

The limit is the whole process's, so it is counted: fits in several threads of a workbench or a
notebook share it, and the last to end gives back what the first found.
"""

import functools
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, ParamSpec, TypeVar

if TYPE_CHECKING:
    from threadpoolctl import threadpool_limits

P = ParamSpec("P")
T = TypeVar("T")


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
