"""Work by a second process is the same work, and whatever befalls it the answer comes."""

import os
import pickle
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from trialid.effects import CATALOGUE
from trialid.ship.effect import Force, effect

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="copies are made on Linux alone")

ROOT = Path(__file__).parents[2]
BEGIN = """
import os, signal, sys, threading, time
from trialid.second_process import both, each, meanwhile, tick_beside
own = os.getpid()
def here(): return os.getpid() == own
"""


def begun(code: str, cores: int = 2) -> subprocess.Popen[str]:
    """A process with no threads but its own, which those of a test's worker may have."""
    paths = os.pathsep.join([str(ROOT), *filter(None, [os.environ.get("PYTHONPATH")])])
    several = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"), str(cores))
    env = {**os.environ, "PYTHONPATH": paths, **several}
    command = [sys.executable, "-c", BEGIN + code]
    return subprocess.Popen(command, env=env, stdout=subprocess.PIPE, text=True)


def said(code: str, cores: int = 2) -> str:
    told, _ = begun(code, cores).communicate(timeout=60)
    return told.strip()


def test_another_process_does_it_where_there_is_a_core() -> None:
    assert said("print(both(here, here))") == "(True, False)"
    assert said("print(both(here, here))", cores=1) == "(True, True)"


def test_only_where_nobody_else_runs_python() -> None:
    beside = "threading.Thread(target=time.sleep, args=(2,), daemon=True).start()\n"
    assert said(beside + "print(both(here, here))") == "(True, True)"
    ticked = "with tick_beside(0.001, lambda: None): print(both(here, here))"
    assert said(ticked) == "(True, False)"


def test_a_worker_of_several_makes_none() -> None:
    """Its neighbours have the other cores: two workers with a copy each shared two."""
    code = (
        "import multiprocessing\n"
        "def one(_): return len({*both(os.getpid, os.getpid)})\n"
        "with multiprocessing.get_context('fork').Pool(1) as pool: print(pool.map(one, [0]))\n"
        "print(one(0))"
    )
    assert said(code) == "[1]\n2"


def test_a_copy_makes_none_and_neither_does_who_has_one() -> None:
    assert said("print(both(lambda: both(here, here), lambda: 0)[0])") == "(True, True)"
    once = "def pair(): return both(os.getpid, os.getpid)\n"
    assert said(once + "a, b = both(lambda: 0, pair)[1]; print(a == b != own)") == "True"
    assert said("both(here, here); print(both(here, here))") == "(True, False)"


@pytest.mark.parametrize(
    "ends",
    [
        "os._exit(0)",
        "os.kill(os.getpid(), signal.SIGSEGV)",
        "sys.exit(3)",
        "1 / 0",
    ],
)
def test_where_the_copy_dies_the_work_is_done_here(ends: str) -> None:
    work = f"def work():\n    if not here(): {ends}\n    return 7\n"
    assert said(work + "print(both(here, work))") == "(True, 7)"


def test_what_cannot_be_pickled_is_found_here() -> None:
    assert said("print(both(here, lambda: (lambda: 7))[1]())") == "7"


def test_an_error_is_told_as_without() -> None:
    code = """
def work(): raise ValueError("no such log")
try: both(here, work)
except ValueError as error: print(error)
"""
    assert said(code) == "no such log"


def test_an_answer_may_be_larger_than_a_pipe() -> None:
    assert said("print(len(both(here, lambda: bytes(10**7))[1]))") == str(10**7)


def test_what_both_know_comes_back_as_the_same() -> None:
    code = "one = [1]; print(both(here, lambda: (one, here()), [one])[1][0] is one)"
    assert said(code) == "True"


def test_each_keeps_their_order() -> None:
    code = "print(each(lambda n: (n, here()), range(3)), each(here, ()), each(str, (1,)))"
    assert said(code) == "[(0, True), (1, False), (2, True)] [] ['1']"


def test_nothing_is_left_where_an_error_ends_it() -> None:
    code = """
def fail(): raise KeyboardInterrupt
try: both(fail, lambda: time.sleep(60))
except KeyboardInterrupt: pass
try: os.waitpid(-1, 0)
except ChildProcessError: print("none")
"""
    began = time.monotonic()
    assert said(code) == "none"
    assert time.monotonic() - began < 30.0


def test_it_ends_with_the_process_that_asked() -> None:
    code = """
def work(): print(os.getpid(), flush=True); time.sleep(60)
both(lambda: time.sleep(60), work)
"""
    with begun(code) as process:
        assert process.stdout is not None
        copy = int(process.stdout.readline())
        process.send_signal(signal.SIGKILL)
    for _ in range(100):
        if not _runs(copy):
            return
        time.sleep(0.1)
    os.kill(copy, signal.SIGKILL)
    pytest.fail("the copy is still there")


def _runs(process: int) -> bool:
    """Whether it is there, and not only because nobody has asked how it ended."""
    try:
        return ") Z " not in Path(f"/proc/{process}/stat").read_text(encoding="ascii")
    except (FileNotFoundError, ProcessLookupError):
        return False


def test_effects_are_pickled_by_where_they_stand() -> None:
    standing = next(iter(CATALOGUE.values()))
    assert pickle.loads(pickle.dumps(standing)) is standing
    sized = CATALOGUE["righting_arm_cubic"].of_ship(1.0)
    again = pickle.loads(pickle.dumps(sized))
    assert again == sized
    assert again.function is sized.function


def test_an_effect_that_stands_nowhere_is_not_pickled() -> None:
    @effect(source="a test")
    def nowhere(r, *, Nr=-0.002):  # type: ignore[no-untyped-def]
        """N' = Nr r'."""
        return Force(N=Nr * r)

    with pytest.raises(pickle.PicklingError, match="stands in no module"):
        pickle.dumps(nowhere)
