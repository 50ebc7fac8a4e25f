"""The table of planted errors fits the package as it is, and the script tells what survives."""

import ast
from pathlib import Path

import pytest
from plant import Outcome, page, verdict
from planted_errors import ROOT, Planted, chosen, planted_errors

ERRORS = planted_errors()
PACKAGES = [f.name for f in (ROOT / "trialid").iterdir() if (f / "__init__.py").is_file()]


@pytest.mark.parametrize("error", ERRORS, ids=lambda e: e.name.replace(" ", "_"))
def test_every_error_finds_its_place_and_changes_what_is_done(error: Planted) -> None:
    """Not only words: the program is another one with it, and one that Python can read."""
    text = error.path(ROOT).read_text(encoding="utf-8")
    planted = error.planted(text)
    if error.file.endswith(".py"):
        assert ast.dump(ast.parse(planted)) != ast.dump(ast.parse(text))
    for target in error.tests:
        path, _, test = target.partition("::")
        assert (ROOT / path).exists(), target
        assert not test or f"def {test.partition('[')[0]}(" in (ROOT / path).read_text("utf-8")


def test_there_are_many_of_different_names_in_every_package() -> None:
    assert len(ERRORS) >= 120
    assert len({e.name for e in ERRORS}) == len(ERRORS)
    assert {e.package.removesuffix(".py") for e in ERRORS} >= {*PACKAGES}


def test_an_error_without_one_place_is_refused() -> None:
    error = Planted(name="sign", file="x.py", old="a + b", new="a - b", tests=())
    assert error.planted("c = a + b") == "c = a - b"
    for text in ("c = a", "c = a + b + a + b"):
        with pytest.raises(ValueError, match="once is needed"):
            error.planted(text)


def test_some_can_be_asked_for_by_name() -> None:
    assert [e.name for e in chosen(ERRORS, [ERRORS[3].name])] == [ERRORS[3].name]
    with pytest.raises(ValueError, match="no planted error"):
        chosen(ERRORS, ["nothing of the sort"])


def test_what_survives_stands_out_on_the_page() -> None:
    lost = Planted(name="a|b", file="ship/x.py", old="1", new="2", tests=())
    known = Planted(name="c", file="ship/x.py", old="1", new="2", tests=(), explained="only words")
    passed = Outcome(passed=True, failed="", seconds=1.0)
    failed = Outcome(passed=False, failed="tests/test_x.py::test_y", seconds=1.0)
    assert [verdict(e, o) for e, o in ((lost, failed), (lost, passed), (known, passed))] == [
        "noticed",
        "survived",
        "explained",
    ]
    text = page([(lost, passed), (known, passed), (lost, failed)], 90.0, "0123abc")
    assert "commit 0123abc: 3 planted, 1 noticed, 1\nsurvived, 1 explained; 2 min" in text
    assert "| ship | a\\|b | **survived** |" in text
    assert "| ship | c | explained: only words |" in text
    assert "`tests/test_x.py::test_y`" in text


def test_tables_lie_beside_this_test() -> None:
    assert list(Path(__file__).parent.glob("*.toml"))
