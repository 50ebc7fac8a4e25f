"""BLAS keeps to one thread while any fit runs, whichever thread of the process ends first."""

import threading
from collections.abc import Iterator

import numpy as np
import pytest
import scipy.linalg
from s175q import MODEL, SETTINGS, zigzag
from threadpoolctl import threadpool_info, threadpool_limits

from trialid import threads
from trialid.identification.output_error import linearise
from trialid.identification.problem import pose_problem
from trialid.simulation.integrate import Departure
from trialid.threads import one_thread

PATIENCE = 20.0


def _blas() -> list[int]:
    np.dot(np.eye(2), np.eye(2)), scipy.linalg.blas.ddot([1.0], [1.0])  # both libraries are loaded
    return [pool["num_threads"] for pool in threadpool_info() if pool["user_api"] == "blas"]


@pytest.fixture(autouse=True)
def two_threads() -> Iterator[None]:
    """What a user has, where all other tests have one."""
    with threadpool_limits(limits=2, user_api="blas"):
        yield


@pytest.mark.parametrize("round_", range(3))
def test_the_first_to_end_leaves_the_other_alone(round_: int) -> None:
    before = _blas()
    assert max(before) > 1
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


@pytest.mark.parametrize("at_once", ["1", "2", "3"])
def test_long_trials_side_by_side_give_what_they_give_in_turn(
    at_once: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Every digit of residual and gradient, and the first departure where there are several."""
    monkeypatch.setenv("OMP_NUM_THREADS", at_once)
    problem = pose_problem([zigzag(a) for a in (5, 10, 20)], MODEL, SETTINGS)
    wild = problem.start * 30.0
    alone, alone_wild = linearise(problem, problem.start), linearise(problem, wild)
    monkeypatch.setattr(threads, "LONG", 0)
    together = linearise(problem, problem.start)
    assert not isinstance(alone, Departure)
    assert not isinstance(together, Departure)
    for a, b in zip(alone, together, strict=True):
        assert np.array_equal(a, b)
    assert isinstance(alone_wild, Departure)
    assert linearise(problem, wild) == alone_wild


def test_few_numbers_are_worked_out_as_they_are_asked_for() -> None:
    done: list[int] = []
    results = threads.side_by_side(lambda i: done.append(i) or i, 3, threads.LONG - 1)
    assert next(results) == 0
    assert done == [0]
