"""`trialid run --auto`: what is missing is added until the evidence ends."""

import json
import math
from dataclasses import dataclass, replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from test_bad_input import trialid_

from trialid import auto
from trialid.change import Edit
from trialid.diagnosis import likelihood
from trialid.errors import SimulationError
from trialid.recipe import load

ROOT = Path(__file__).parent.parent
ADDED = "righting_arm_cubic"


@pytest.fixture
def hidden(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A copy of the shipped pipeline, in the current folder."""
    text = (ROOT / "pipelines" / "hidden_effect.toml").read_text(encoding="utf-8")
    text = text.replace('"../sample_data', f'"{(ROOT / "sample_data").as_posix()}')
    (tmp_path / "hidden.toml").write_text(text, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    return Path("hidden.toml")


def test_the_hidden_effect_is_added_and_the_verdict_is_nothing_missing(hidden: Path) -> None:
    text = hidden.read_bytes()
    outcome = trialid_("run", str(hidden), "--auto")
    assert (outcome.exit_code, outcome.stderr) == (0, "")
    head, first, then, end, left, *_ = outcome.stdout.splitlines()
    assert head.split() == ["step", "fitted", "held", "out", "noise", "model", "verdict"]
    assert first.startswith("as written   ")
    assert first.endswith("missing")
    assert then.startswith(f"+ {ADDED} ")
    assert then.endswith("nothing missing")
    assert end == "Added no more: the verdict is `nothing missing`."
    assert left == f"hidden.toml is as it was; --write puts {ADDED} into it."
    assert hidden.read_bytes() == text
    assert sorted(p.name for p in Path().iterdir()) == ["hidden.toml", "runs"]
    result = json.loads(Path("runs/hidden/result.json").read_text(encoding="utf-8"))
    assert result["verdict"]["kind"] == "nothing missing"
    assert result["model"]["effects"][-1] == ADDED
    assert [(row["step"], row["added"]) for row in result["history"]] == [
        ("as written", None), ("added", ADDED),
    ]  # fmt: skip
    errors = [row["eps_rmsn"] for row in result["history"]]
    assert errors[1] < 0.75 * errors[0]


def test_what_was_added_is_written_when_asked_and_a_run_then_gives_the_same(hidden: Path) -> None:
    text = hidden.read_text(encoding="utf-8")
    outcome = trialid_("run", str(hidden), "--auto", "--write", "--json")
    assert (outcome.exit_code, outcome.stderr) == (0, "")
    result = json.loads(outcome.stdout)
    written = hidden.read_text(encoding="utf-8")
    assert load(hidden).model.effects[-1] == ADDED
    assert [line for line in text.splitlines() if "#" in line and line not in written] == []
    lines = Path("hidden.history.jsonl").read_text(encoding="utf-8").splitlines()
    assert [json.loads(line) for line in lines] == result["history"]
    again = trialid_("run", str(hidden), "--json")
    assert json.loads(again.stdout) == result
    # and once more finds nothing to add, and writes nothing
    once_more = trialid_("run", str(hidden), "--auto", "--write")
    assert "Added no more" in once_more.stdout
    assert hidden.read_text(encoding="utf-8") == written
    assert len(Path("hidden.history.jsonl").read_text(encoding="utf-8").splitlines()) == 2


# --- where it stops, on made-up fits ------------------------------------------------------------


@dataclass(frozen=True)
class Model:
    """Stands for a run: what it names, and its errors."""

    named: str | None
    eps: float
    check: float | None = None
    free: int = 5

    @property
    def findings(self) -> Any:
        kind = "missing" if self.named else "nothing missing"
        fit = SimpleNamespace(
            eps_rmsn=self.eps, eps_check=self.check,
            settings=SimpleNamespace(free=tuple(range(self.free))),
        )  # fmt: skip
        verdict = SimpleNamespace(kind=kind, effect=self.named)
        effect = SimpleNamespace(name=self.named)
        ranking = (SimpleNamespace(effect=effect, inflation=1.0),)
        return SimpleNamespace(before=SimpleNamespace(fit=fit), verdict=verdict, ranking=ranking)


def loop(monkeypatch: pytest.MonkeyPatch, *models: Model | Exception) -> list[auto.Stage]:
    """The stages of a loop that meets these models one after another."""
    coming = iter(models)

    def examine(*_: Any) -> Any:
        model = next(coming)
        if isinstance(model, Exception):
            raise model
        return model

    def adding(recipe: Any, name: str) -> Edit:
        return Edit("added", SimpleNamespace(name=name), recipe, recipe)  # type: ignore[arg-type]

    monkeypatch.setattr(auto, "align_trials", lambda *_: ())
    monkeypatch.setattr(auto, "examine", examine)
    monkeypatch.setattr(auto, "adding", adding)
    monkeypatch.setattr(auto, "foresee_adding", lambda *_: "")
    monkeypatch.setattr(auto, "fitted_after", lambda edit, *_: (edit, None))
    monkeypatch.setattr(likelihood, "misfits", misfits)
    monkeypatch.setattr(likelihood, "check_gain", check_gain)
    return list(auto.stages(SimpleNamespace(), lambda words, share: None))  # type: ignore[arg-type]


def misfits(fits: Any) -> Any:
    return [1000.0 * (fit.eps_rmsn / fits[0].eps_rmsn) ** 2 for fit in fits], None, 1000


def check_gain(old: Any, new: Any, colour: None) -> tuple[float, float] | None:
    return None if old.eps_check is None else (old.eps_check - new.eps_check, 0.01)


def test_it_goes_on_while_something_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    done = loop(monkeypatch, Model("a", 0.1), Model("b", 0.08), Model(None, 0.05))
    assert [(s.added, s.kept) for s in done] == [(None, True), ("a", True), ("b", True)]
    assert [bool(s.end) for s in done] == [False, False, True]


@pytest.mark.parametrize(("worse", "words"), [
    (Model(None, 0.05, 0.3), "the held-out error rises with a"),
    (Model(None, 0.05, math.inf), "the held-out error rises with a"),
    (Model(None, 0.0999, 0.1, free=6), "does not fall by the price of the parameters with a"),
    (Model(None, 0.095, 0.1, free=40), "the price of the parameters"),
    (SimulationError("lost at t = 3 s"), "with a: lost at t = 3 s"),
])  # fmt: skip
def test_a_model_that_is_no_better_is_not_kept(
    monkeypatch: pytest.MonkeyPatch, worse: Model | Exception, words: str
) -> None:
    start = Model("a", 0.1, 0.2)
    first, last = loop(monkeypatch, start, worse)
    assert (first.run, last.run) == (start, start)
    assert (last.added, last.kept) == ("a", False)
    assert words in last.end


def test_nothing_is_added_twice(monkeypatch: pytest.MonkeyPatch) -> None:
    done = loop(monkeypatch, Model("a", 0.1), Model("a", 0.05))
    assert done[-1].end == "a was added already"


def test_it_ends_at_twelve(monkeypatch: pytest.MonkeyPatch) -> None:
    models = [Model(f"e{k}", 0.1 * 0.8**k) for k in range(30)]
    done = loop(monkeypatch, *models)
    assert [s.added for s in done] == [None, *(f"e{k}" for k in range(auto.MOST))]
    assert "the most" in done[-1].end


def test_what_cannot_be_told_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    (only,) = loop(monkeypatch, Model(None, 0.1))
    assert only.end == "the verdict is `nothing missing`"
    assert replace(only, end="").kept
