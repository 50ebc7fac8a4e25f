"""One thread for linear algebra: the matrices here are tall and thin, and two threads only wait.

Measured on two cores: a fit of 0.23 s with one thread takes 0.6 s with two, and many times that
beside another busy process. One thread also gives the same digits on every machine.
"""

import functools
from collections.abc import Callable
from typing import ParamSpec, TypeVar

P = ParamSpec("P")
T = TypeVar("T")


def one_thread(function: Callable[P, T]) -> Callable[P, T]:
    """Run a function with BLAS held to one thread."""

    @functools.wraps(function)
    def held(*args: P.args, **kwargs: P.kwargs) -> T:
        from threadpoolctl import threadpool_limits

        with threadpool_limits(limits=1, user_api="blas"):
            return function(*args, **kwargs)

    return held
