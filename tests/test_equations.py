"""Every numbered equation of Blanke & Knudsen (1999) has exactly one home in the code."""

import ast
import re
from pathlib import Path

import pytest

HOME = Path(__file__).parent.parent / "trialid"


def claims(file: Path) -> list[int]:
    """Numbers of the equations a file's docstrings open with, from its top to its end."""
    text = file.read_text(encoding="utf-8")
    if '"Eq. ' not in text:  # what takes the time is parsing
        return []
    found = []
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            match = re.match(r"Eq\. (\d+):", ast.get_docstring(node) or "")
            if match:
                found.append((node.lineno, int(match[1])))
    return [number for _, number in sorted(found)]


CLAIMS = {f.relative_to(HOME).as_posix(): claims(f) for f in sorted(HOME.rglob("*.py"))}
HOMES = [file for file, numbers in CLAIMS.items() if numbers]


@pytest.mark.parametrize("number", range(1, 17))
def test_one_home(number: int) -> None:
    assert len([f for f, numbers in CLAIMS.items() for n in numbers if n == number]) == 1


def test_nothing_beyond_the_paper_and_nothing_twice() -> None:
    numbers = [n for found in CLAIMS.values() for n in found]
    assert set(numbers) <= set(range(1, 20))
    assert len(numbers) == len(set(numbers))


@pytest.mark.parametrize("file", HOMES)
def test_a_file_reads_in_the_order_of_the_paper(file: str) -> None:
    assert CLAIMS[file] == sorted(CLAIMS[file])


def test_neighbours_live_together() -> None:
    """Eq. 8 to 14 are the accuracy, Eq. 15 and 16 the stability, Eq. 1 the rigid body."""
    home = {n: f for f, numbers in CLAIMS.items() for n in numbers}
    assert {home[n] for n in range(8, 15)} == {"accuracy/equations.py"}
    assert home[15] == home[16] == "ship/stability.py"
    assert home[1] == "ship/rigid_body.py"
