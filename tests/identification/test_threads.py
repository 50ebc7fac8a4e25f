"""BLAS keeps to one thread while any fit runs, whichever thread of the process ends first."""

import threading

import numpy as np
import pytest
import scipy.linalg
from threadpoolctl import threadpool_info

from trialid.threads import one_thread

PATIENCE = 20.0


def _blas() -> list[int]:
    np.dot(np.eye(2), np.eye(2)), scipy.linalg.blas.ddot([1.0], [1.0])  # both libraries are loaded
    return [pool["num_threads"] for pool in threadpool_info() if pool["user_api"] == "blas"]


@pytest.mark.parametrize("round_", range(3))
def test_the_first_to_end_leaves_the_other_alone(round_: int) -> None:
    before = _blas()
    if max(before) == 1:
        pytest.skip("one core: BLAS has one thread whatever is asked")
    first_in, second_in, first_out = (threading.Event() for _ in range(3))
    seen: dict[str, list[int]] = {}

    @one_thread
    def first() -> None:
        first_in.set()
        second_in.wait(PATIENCE)
        seen["both"] = _blas()

    @one_thread
    def second() -> None:
        second_in.set()
        first_out.wait(PATIENCE)
        seen["the second alone"] = _blas()

    other = threading.Thread(target=lambda: first_in.wait(PATIENCE) and second())
    other.start()
    first()
    first_out.set()
    other.join(PATIENCE)
    ones = [1] * len(before)
    assert seen == {"both": ones, "the second alone": ones}
    assert _blas() == before


def test_a_function_that_fails_gives_the_limit_back() -> None:
    before = _blas()

    @one_thread
    def fails() -> None:
        raise ValueError("a fit that fails")

    with pytest.raises(ValueError, match="a fit that fails"):
        fails()
    assert _blas() == before
