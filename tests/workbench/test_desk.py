"""The loop by hand: every edit in the file, fitted as the command line fits, and taken back."""

import threading
from pathlib import Path
from typing import Any

import pytest
import quick
from click.testing import CliRunner
from held import Gate, add_upon
from quick import (
    ADDED,
    OTHER,
    SPARE,
    diagnosed,
    edit,
    opened,
    result,
    settled,
    steps,
    still_alone,
)

from trialid.cli import main
from trialid.errors import PipelineError
from trialid.pipeline_file import load
from trialid.result.json_file import text_of
from trialid.workbench import compute
from trialid.workbench import desk as desk_module
from trialid.workbench.desk import Desk
from trialid.workbench.shown import Shown
from trialid.workflow import history
from trialid.workflow.run import run

pytestmark = pytest.mark.usefixtures("quick_looks")


@pytest.fixture
def told(path: Path, monkeypatch: pytest.MonkeyPatch) -> list[Shown]:
    """Everything that was shown of this pipeline, in order; desks of other tests may still work."""
    shown: list[Shown] = []
    show = desk_module._Seat.show

    def showing(self: Any, one: Shown) -> None:
        show(self, one)
        shown.extend([one] if self.desk.path == path else [])

    monkeypatch.setattr(desk_module._Seat, "show", showing)
    return shown


# --- what is shown ------------------------------------------------------------------------------


def test_what_is_known_is_shown_at_once(path: Path, told: list[Shown]) -> None:
    text = path.read_bytes()
    with opened(path) as desk:
        diagnosed(desk)
        reading, first, measured, fitted, whole = told
        assert [s.stage[0] for s in told] == [*"rmmfd"]
        assert reading.model
        assert [s.name for s in (*first.series, *measured.series)] == ["early", "early", "late"]
        assert all(o.predicted.size == o.measured.size for s in measured.series for o in s.outputs)
        assert fitted.fit is not None
        assert whole.run is not None
        assert whole.run.result.fit.eps_rmsn == fitted.fit.eps_rmsn
        assert whole.before is None
        assert result(desk) == run(load(path)).result
    assert path.read_bytes() == text
    assert not history.place(path).exists()  # looking leaves no trace
    assert still_alone(path)


def test_counts_grow_with_what_a_page_should_ask_for(path: Path) -> None:
    with opened(path) as desk:
        first = diagnosed(desk)
        edit(desk, "add", effect=ADDED)
        second = diagnosed(desk)
    assert second.serial > first.serial
    assert second.screen > first.screen
    assert second.series > first.series
    assert second.version != first.version


# --- edits --------------------------------------------------------------------------------------


@pytest.mark.study(turn=4)
def test_add_and_drop_as_the_command_line_does(tmp_path: Path) -> None:
    """Bit for bit: the file, the numbers, the model before beside, and the history."""
    for folder in ("screen", "line"):
        (tmp_path / folder).mkdir()
    screen, line = (quick.write(tmp_path / folder) for folder in ("screen", "line"))
    with opened(screen) as desk:
        diagnosed(desk)
        for verb, effect in (("add", ADDED), ("drop", SPARE)):
            edit(desk, verb, effect=effect)
            version = desk.status.version
            assert screen.read_bytes() == desk.shown.pipeline.content or desk.status.working
            assert diagnosed(desk).version == version
            out = tmp_path / f"out-{verb}"
            words = [verb, str(line), effect, "--out", str(out), "--quiet"]
            done = CliRunner().invoke(main.commands, words)
            assert done.exit_code == 0, done.output
            shown = desk.shown.run
            assert shown is not None
            assert screen.read_bytes() == line.read_bytes()
            assert text_of(shown.result) == (out / "result.json").read_text()
            assert history.place(screen).read_bytes() == history.place(line).read_bytes()
            assert result(desk) == run(load(screen)).result
            assert desk.shown.pipeline == load(screen)
    assert still_alone(screen)


@pytest.mark.study(turn=2)
def test_undo_and_redo_show_again_what_was_known(path: Path, monkeypatch: Any) -> None:
    with opened(path) as desk:
        diagnosed(desk)
        texts, results = [path.read_bytes()], [result(desk)]
        for do, what in (("add", {"effect": ADDED}), ("drop", {"effect": SPARE}),
                         ("free", {"parameter": "Nrar", "free": False})):  # fmt: skip
            edit(desk, do, **what)
            status = diagnosed(desk)
            texts.append(path.read_bytes())
            results.append(result(desk))
        assert status.undo == "fix Nrar"
        monkeypatch.setattr(compute, "fit_of", _no_fit)
        monkeypatch.setattr(compute, "fit_edit", _no_fit)
        monkeypatch.setattr(compute, "examine", _no_fit)
        for i in (2, 1, 0, 1, 2, 3):
            move = desk.undo if texts.index(path.read_bytes()) > i else desk.redo
            move(desk.status.version)
            assert path.read_bytes() == texts[i]  # at once
            status = diagnosed(desk)
            assert (status.undo is None, status.redo is None) == (i == 0, i == 3)
            again = result(desk)
            for key in ("fit", "accuracy", "split", "verdict", "missing"):
                assert getattr(again, key) == getattr(results[i], key)
            model = desk.shown.model
            assert model is not None
            for row in again.accuracy.parameters:
                if row.name in model.parameters:
                    assert model.value(row.name) == row.value
    told_ = steps(path)
    assert told_[:4] == [("as written", None), ("added", ADDED), ("dropped", SPARE),
                         ("as written", None)]  # fmt: skip
    assert ("added", SPARE) in told_[4:]
    assert ("dropped", ADDED) in told_[4:]


def _no_fit(*_: object) -> Any:
    raise AssertionError("nothing is to be fitted")


def test_nothing_to_undo_is_refused(path: Path) -> None:
    with opened(path) as desk:
        status = diagnosed(desk)
        assert (status.undo, status.redo) == (None, None)
        for move in (desk.undo, desk.redo):
            with pytest.raises(PipelineError, match="nothing to"):
                move(status.version)
        assert desk.status.working is None


@pytest.mark.parametrize("stage", ["waiting", "fitted"])
def test_cancel_takes_the_edit_back_at_once(path: Path, gate: Gate, stage: str) -> None:
    text = path.read_bytes()
    with opened(path) as desk:
        first = diagnosed(desk)
        shown = result(desk)
        gate.close()
        edit(desk, "add", effect=ADDED)
        if stage == "fitted":
            assert gate.reached.wait(quick.LONGEST)
            assert desk.status.stage == "fitted"
        assert path.read_bytes() != text
        desk.cancel()
        assert path.read_bytes() == text
        status = desk.status
        assert (status.version, status.undo, status.redo) == (first.version, None, None)
        gate.open.set()
        diagnosed(desk)
        again = result(desk)
        assert again.fit == shown.fit
        assert again.history == shown.history
    assert path.read_bytes() == text
    assert not history.place(path).exists()
    assert still_alone(path)


def test_cancel_when_nothing_is_done(path: Path) -> None:
    text = path.read_bytes()
    with opened(path) as desk:
        edit(desk, "add", effect=ADDED)
        status = diagnosed(desk)
        desk.cancel()
        assert desk.status == status
    assert path.read_bytes() != text


@pytest.mark.study(turn=7)
def test_what_is_stopped_without_an_edit_is_said(path: Path, gate: Gate) -> None:
    """An undo that is cancelled leaves the file as it is: the screen then says what it shows."""
    with opened(path) as desk:
        diagnosed(desk)
        edit(desk, "add", effect=ADDED)
        diagnosed(desk)
        text = path.read_bytes()
        desk._kept.clear()
        gate.close()
        desk.undo(desk.status.version)
        assert gate.reached.wait(quick.LONGEST)
        assert path.read_bytes() != text
        desk.cancel()
        status = desk.status
        assert status.working is None
        assert status.trouble is not None
        assert status.trouble.where == "fit"
        assert "stopped" in status.trouble.words
        gate.open.set()
        desk.again()
        diagnosed(desk)
        assert result(desk) == run(load(path)).result


@pytest.mark.study(turn=5)
def test_a_second_edit_during_a_refit_keeps_both(path: Path, gate: Gate) -> None:
    with opened(path) as desk:
        diagnosed(desk)
        add_upon(desk, gate)
        status = diagnosed(desk)
        assert load(path).model.effects[-2:] == (ADDED, OTHER)
        assert desk.shown.pipeline == load(path)
        assert result(desk) == run(load(path)).result
        assert (status.undo, len(desk._document.done)) == (f"add {OTHER}", 2)
        desk.undo(status.version)
        assert load(path).model.effects[-1] == ADDED
        diagnosed(desk)
        assert result(desk) == run(load(path)).result


@pytest.mark.study(turn=1)
def test_cancel_of_the_second_edit_keeps_the_first(path: Path, gate: Gate) -> None:
    with opened(path) as desk:
        diagnosed(desk)
        gate.close()
        edit(desk, "add", effect=ADDED)
        one = path.read_bytes()
        edit(desk, "add", effect=OTHER)
        desk.cancel()
        assert path.read_bytes() == one
        gate.open.set()
        assert diagnosed(desk).undo == f"add {ADDED}"
        assert result(desk) == run(load(path)).result


def test_an_edit_that_cannot_be_fitted_is_taken_back(path: Path) -> None:
    text = path.read_bytes()
    with opened(path) as desk:
        first = diagnosed(desk)
        edit(desk, "add", effect="propeller_thrust")
        assert path.read_bytes() != text
        status = settled(desk)
        assert path.read_bytes() == text
        assert (status.version, status.undo, status.stage) == (first.version, None, "diagnosed")
        assert status.trouble is not None
        assert status.trouble.where == "fit"
        assert "add propeller_thrust: taken back" in status.trouble.words
        assert "'n'" in status.trouble.words
        assert "\n" not in status.trouble.words
        edit(desk, "add", effect=ADDED)
        assert desk.status.trouble is None  # it stood until the next edit
        diagnosed(desk)
    assert steps(path) == [("as written", None), ("added", ADDED)]


@pytest.mark.study(turn=3)
def test_an_effect_of_ones_own_that_needs_better_starts(tmp_path: Path) -> None:
    """What the search begins from is in the file then, and undone with the edit it belongs to."""
    path = quick.write(tmp_path)
    stiff = quick.OWN.replace("-0.001", "1e3").replace("N=Nx * v * abs(v)", "K=Nx * phi")
    (tmp_path / "mine.py").write_text(stiff.replace("(v, r", "(phi"), encoding="utf-8")
    text = quick.TEXT.replace("\n\n[identify]", '\neffects_from = ["mine.py"]\n\n[identify]')
    text = text.replace('"linear_rudder", ', '"linear_rudder",\n  ')
    path.write_text(text, encoding="utf-8")
    with opened(path) as desk:
        first = diagnosed(desk)
        edit(desk, "add", effect="mine")
        put = desk.status.version
        status = diagnosed(desk)
        assert status.version != put
        assert "  # start, by linearisation" in path.read_text(encoding="utf-8")
        assert abs(load(path).model.values["Nx"].value) < 1.0
        assert desk.shown.pipeline == load(path)
        assert result(desk) == run(load(path)).result
        desk.undo(status.version)
        assert path.read_text(encoding="utf-8") == text
        assert diagnosed(desk).version == first.version


# --- others at work -----------------------------------------------------------------------------


def test_nothing_is_written_after_the_end(path: Path, gate: Gate) -> None:
    with opened(path) as desk:
        diagnosed(desk)
        gate.close()
        edit(desk, "add", effect=ADDED)
        assert gate.reached.wait(quick.LONGEST)
        content = path.read_bytes()
        desk.close()
        gate.open.set()
        with desk._computing:
            assert not history.place(path).exists()
        version = desk.status.version
        for late in (
            lambda: desk.edit({"version": version, "do": "add", "effect": OTHER}),
            lambda: desk.undo(version),
            lambda: desk.redo(version),
            desk.again,
        ):
            with pytest.raises(PipelineError, match="closed"):
                late()
        desk.cancel()
        assert desk.status.working is None
    assert path.read_bytes() == content


def test_a_bug_is_said_and_takes_the_edit_back(path: Path, monkeypatch: Any) -> None:
    text = path.read_bytes()
    caught: list[Any] = []
    monkeypatch.setattr(threading, "excepthook", caught.append)
    with opened(path) as desk:
        diagnosed(desk)
        monkeypatch.setattr(compute, "fit_edit", _no_fit)
        edit(desk, "add", effect=ADDED)
        status = settled(desk)
        assert status.trouble is not None
        assert "a bug in trialid: AssertionError: nothing is to be fitted" in status.trouble.words
    assert path.read_bytes() == text
    assert [each.exc_type for each in caught] == [AssertionError]


def test_no_pipeline_to_begin_with(tmp_path: Path) -> None:
    with pytest.raises(PipelineError, match="no such pipeline"):
        Desk(tmp_path / "no.toml")
