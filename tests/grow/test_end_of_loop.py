"""What the loop says when it ends: what it refused, and what of its own nobody held against it."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from world import changed, loop, no_fit, steps

from trialid.cli.grow_loop import _loop_ended
from trialid.diagnosis.search.backward import Worth
from trialid.diagnosis.search.carried import Carried, Errors
from trialid.workflow import grow

WORLD = {"": (0.10, 0.2), "a": (0.05, 0.1), "b": (0.06, 0.12), "ab": (0.04, 0.09)}


def worth(name: str, costs: float) -> Worth:
    less, more = Errors((costs,) * 6, (costs,) * 6), Errors((1.0,) * 6, (1.0,) * 6)
    return Worth(name, (name,), None, Carried.between(less, more))


def ended(done: list[grow.Stage]) -> str:
    return " ".join(_loop_ended(done, Path("p.toml"), keep=False).split())


def test_what_was_named_and_not_kept_is_told_before_what_took_its_place(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """With a drag that was named her gyro was fitted 3 s late: heel was added, and no word said."""
    loop(monkeypatch, WORLD)
    done = changed(monkeypatch, "a", no_fit)
    assert [stage.kept for stage in done] == [True, False, True]
    assert f"Tried and not kept: {done[1].refused}." in ended(done)
    assert done[1].refused.startswith("with a: ")


def test_what_is_named_is_added_whatever_else_stands_every_check(monkeypatch) -> None:
    """The screen names it and tells how to add it: another would be without a word."""
    assert steps(loop(monkeypatch, WORLD))[0] == "+a"

    def of_b(findings: Any) -> None:
        findings.verdict = SimpleNamespace(
            kind="missing", effect="b", sentence="b is missing", held_as_well=()
        )

    assert steps(changed(monkeypatch, "", of_b))[0] == "+b"


def test_a_gear_in_the_place_of_another_is_worth_what_nobody_asked(monkeypatch) -> None:
    """A slow gear halved the error, and was called worth less than a tenth."""
    (*_, last) = done = loop(monkeypatch, WORLD)
    found = (worth("b", 1.5), worth("c", 1.05))
    monkeypatch.setattr("trialid.workflow.grow.survivors", lambda done: ("a", "b", "c"))
    said = ended([*done[:-1], last.__class__(**{**vars(last), "worths": found})])
    assert "the dearest to leave out first: b; each worth less than a tenth" in said
    assert "may be: c; in the place of what the file had: a." in said
    assert np.isclose(found[0].costs, 1.5)
