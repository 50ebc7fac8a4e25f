"""Numbers that the model holds and that do as well as an effect are free before any is added."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from world import changed, loop, no_fit, steps

from trialid.cli.grow_loop import _loop_ended
from trialid.pipeline_file.prior_section import OfTheShip
from trialid.workflow import grow

WORLD = {"": (0.10, 0.2), "h": (0.06, 0.15), "a": (0.06, 0.16), "ah": (0.03, 0.1)}
"""Of which h is held, and not known well."""


def as_well(findings: Any) -> None:
    """The verdict that is given where what is held does as well as a."""
    findings.verdict = SimpleNamespace(
        kind="cannot tell", effect=None, sentence="so does h", held_as_well=("h",)
    )
    findings.together = None


def grown(monkeypatch: pytest.MonkeyPatch, world: Any, priors: Any) -> list[grow.Stage]:
    loop(monkeypatch, world)  # sets the stubs
    return changed(monkeypatch, "", as_well, priors)


def test_they_are_free_first_and_then_it_goes_on(monkeypatch: pytest.MonkeyPatch) -> None:
    done = grown(monkeypatch, WORLD, OfTheShip())
    assert steps(done) == ["+h", "+a"]
    assert [bool(s.end) for s in done] == [False, False, True]
    assert [s.run.findings.before.fit.effects for s in done] == ["", "h", "ah"]
    assert done[-1].worths[0].effect == "a"  # h is her own: it never has to pay for its place


def test_where_nothing_says_how_well_they_are_known_they_stay(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    (only,) = grown(monkeypatch, WORLD, {})
    assert only.end == "the verdict is `cannot tell`"


@pytest.mark.parametrize("check", [0.2001, 0.5])
def test_what_makes_the_held_out_trials_worse_is_not_kept(
    monkeypatch: pytest.MonkeyPatch, check: float
) -> None:
    first, last = grown(monkeypatch, WORLD | {"h": (0.06, check)}, OfTheShip())
    assert (first.end, last.kept, last.end) == ("", False, last.refused)
    assert last.refused == "the held-out error rises with h free"
    assert last.run.findings.before.fit.effects == ""


def test_nor_what_cannot_be_fitted(monkeypatch: pytest.MonkeyPatch) -> None:
    lost = {names: left for names, left in WORLD.items() if names != "h"}
    *_, last = grown(monkeypatch, lost, OfTheShip())
    assert (last.kept, last.refused) == (False, "with h free: lost with h at t = 3 s")
    grown(monkeypatch, WORLD, OfTheShip())
    *_, last = changed(monkeypatch, "h", no_fit, OfTheShip())
    assert (last.kept, last.refused) == (False, "with h free: no fit: x")


def test_what_was_set_free_is_told_apart_from_effects(monkeypatch: pytest.MonkeyPatch) -> None:
    *_, last = done = grown(monkeypatch, WORLD, OfTheShip())
    last.pipeline.identify.free = ("a", "h")
    last.pipeline.model.effects = "a"
    said = " ".join(_loop_ended(done, Path("p.toml"), keep=False).split())
    assert "Free now, about her file's values: h." in said
    assert "the dearest to leave out first: a." in said
    assert "in the place of what the file had" not in said
