"""Studies in turn: all of them within twenty-four commits, none by another word."""

import os
import subprocess
import sys
import zlib
from pathlib import Path

import pytest
import turns

CI = Path(__file__).parents[2] / ".ci"
INI = f"""\
[pytest]
pythonpath = {CI}
addopts = -p no:cacheprovider
markers = study: long
"""
TESTS = """\
import pytest

def test_plain(): pass

@pytest.mark.study
def test_short(): pass

@pytest.mark.study(turn=0)
def test_first(): pass

@pytest.mark.study(turn=3)
def test_fourth(): pass

@pytest.mark.study(turn="each")
@pytest.mark.parametrize(("a", "b"), [(k, -k) for k in range(20)])
def test_case(a, b): pass
"""


def ran(folder: Path, turn: str, *options: str) -> set[str]:
    """The tests that run of a folder with studies."""
    (folder / "pytest.ini").write_text(INI)
    (folder / "test_all.py").write_text(TESTS)
    (folder / "conftest.py").write_text("from turns import pytest_collection_modifyitems\n")
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-v", *options],
        cwd=folder,
        env={**os.environ, turns.VARIABLE: turn, "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"},
        capture_output=True,
        text=True,
        check=True,
    )
    passed = (line for line in done.stdout.splitlines() if " PASSED" in line)
    return {line.partition("::")[2].partition(" ")[0] for line in passed}


def test_the_long_studies_run_when_it_is_their_turn_and_the_rest_each_time(tmp_path: Path) -> None:
    cases = [f"test_case[{k}-{-k}]" for k in range(20)]
    first, every = zlib.crc32(b"test_case"), range(turns.TURNS)  # where the cases of it begin
    at = [{cases[k] for k in range(20) if (k + first) % turns.TURNS == turn} for turn in every]
    assert sorted(map(len, at)) == [0] * 4 + [1] * 20
    each_time = {"test_plain", "test_short"}
    assert ran(tmp_path, "") == each_time | {"test_first", "test_fourth", *cases}
    assert ran(tmp_path, "0") == each_time | {"test_first"} | at[0]
    assert ran(tmp_path, "1") == each_time | at[1]
    assert ran(tmp_path, "short") == each_time
    assert ran(tmp_path, "3", "-m", "study") == {"test_short", "test_fourth"} | at[3]


def test_these_tests_are_drawn_so(pytestconfig: pytest.Config) -> None:
    hooks = pytestconfig.pluginmanager.hook.pytest_collection_modifyitems.get_hookimpls()
    assert turns.pytest_collection_modifyitems in [each.function for each in hooks]


def test_each_study_comes_up_within_as_many_commits() -> None:
    for own in (None, *range(turns.TURNS)):
        times = sum(turns.comes_up(own, commit % turns.TURNS) for commit in range(355, 379))
        assert times == (turns.TURNS if own is None else 1)


def test_the_turn_is_the_number_of_commits() -> None:
    assert [turns.asked("turn", lambda n=n: n) for n in range(360, 385)] == [*range(24), 0]
    assert turns.asked("", lambda: pytest.fail("not asked for")) is None
    assert turns.asked("3", lambda: pytest.fail("not asked for")) == 3
    for word in ("24", "-1", "all", "Turn"):
        with pytest.raises(pytest.UsageError, match=word):
            turns.asked(word, lambda: 0)


def test_a_turn_that_never_comes_is_refused() -> None:
    assert turns.of_study(None) is None
    assert turns.of_study(pytest.mark.study.mark) is None
    assert turns.of_study(pytest.mark.study(turn=4).mark) == 4
    each = pytest.mark.study(turn="each").mark
    assert [turns.of_study(each, k) for k in (0, 23, 24)] == [0, 23, 0]
    with pytest.raises(pytest.UsageError, match="turn=24"):
        turns.of_study(pytest.mark.study(turn=24).mark)
