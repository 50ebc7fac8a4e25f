"""The desk beside an editor: files that change under it, are broken, mended, taken over."""

from pathlib import Path
from typing import Any

import pytest
import quick
from held import Gate, Looks
from quick import ADDED, OTHER, diagnosed, edit, opened, result, until

from trialid.errors import TrialidError
from trialid.pipeline_file import load
from trialid.workbench import desk as desk_module
from trialid.workbench.document import Outdated
from trialid.workflow.run import run

pytestmark = pytest.mark.usefixtures("quick_looks")


@pytest.mark.study(turn="each")
def test_a_second_window_loses_nothing(path: Path) -> None:
    with opened(path) as desk:
        seen_by_both = diagnosed(desk).version
        desk.edit({"version": seen_by_both, "do": "add", "effect": ADDED})
        content = path.read_bytes()
        for late in (
            lambda: desk.edit({"version": seen_by_both, "do": "add", "effect": OTHER}),
            lambda: desk.undo(seen_by_both),
            lambda: desk.redo(seen_by_both),
        ):
            with pytest.raises(Outdated):
                late()
            assert path.read_bytes() == content
        assert diagnosed(desk).undo == f"add {ADDED}"


def test_an_edit_in_an_editor_is_not_overwritten(path: Path) -> None:
    """Not even before the change was noticed."""
    with opened(path) as desk:
        version = diagnosed(desk).version
        theirs = quick.TEXT.replace('"Nrar"]', '"Kphi"]')
        path.write_text(theirs, encoding="utf-8")
        with pytest.raises(TrialidError):
            desk.edit({"version": version, "do": "add", "effect": ADDED})
        assert path.read_text(encoding="utf-8") == theirs


@pytest.mark.study(turn="each")
def test_an_edit_made_elsewhere_is_taken_over(path: Path) -> None:
    text = path.read_bytes()
    with opened(path) as desk:
        first = diagnosed(desk)
        path.write_bytes(text.replace(b', "Nrar"]', b"]"))
        until(lambda: desk.status.version != first.version, "the edit to be seen")
        status = diagnosed(desk)
        assert desk.shown.pipeline == load(path)
        assert desk.shown.before is not None
        assert result(desk) == run(load(path)).result
        assert status.undo == "the edit made outside"
        desk.undo(status.version)
        assert path.read_bytes() == text
        diagnosed(desk)


@pytest.mark.study(turn=4)
def test_an_edit_made_elsewhere_ends_a_refit(path: Path, gate: Gate) -> None:
    with opened(path) as desk:
        diagnosed(desk)
        gate.close()
        edit(desk, "add", effect=ADDED)
        assert gate.reached.wait(quick.LONGEST)
        version = desk.status.version
        theirs = path.read_bytes().replace(b'"Nrar", ', b"")
        path.write_bytes(theirs)
        until(lambda: desk.status.version != version, "the edit to be seen")
        gate.open.set()
        diagnosed(desk)
        assert path.read_bytes() == theirs
        assert result(desk) == run(load(path)).result


@pytest.mark.parametrize("broken", ["[model", "name = 3\n", None])
@pytest.mark.study(turn="each")
def test_a_broken_file_keeps_the_screen(path: Path, broken: str | None) -> None:
    text = path.read_text(encoding="utf-8")
    with opened(path) as desk:
        first = diagnosed(desk)
        shown = result(desk)
        path.unlink() if broken is None else path.write_text(broken, encoding="utf-8")
        status = until(lambda: (s := desk.status).trouble and s, "the trouble to be seen")
        assert status.trouble is not None
        assert status.trouble.where == "pipeline"
        assert "quick.toml" in status.trouble.words
        assert (status.stage, status.version) == ("diagnosed", first.version)
        assert result(desk) == shown
        with pytest.raises(Outdated):
            edit(desk, "add", effect=ADDED)
        assert (path.read_text() if path.exists() else None) == broken
        path.write_text(text.replace('"Nrar"]', '"Nrar", "Kphi"]'), encoding="utf-8")
        until(lambda: desk.status.version != first.version, "the mended file to be seen")
        diagnosed(desk)
        assert result(desk) == run(load(path)).result


@pytest.mark.study(turn="each")
def test_a_file_mended_to_what_it_was(path: Path) -> None:
    text = path.read_bytes()
    with opened(path) as desk:
        first = diagnosed(desk)
        path.write_bytes(b"[model")
        until(lambda: desk.status.trouble, "the trouble to be seen")
        path.write_bytes(text)
        until(lambda: desk.status.trouble is None, "the trouble to go")
        assert diagnosed(desk).version == first.version
        edit(desk, "add", effect=ADDED)
        diagnosed(desk)


@pytest.mark.study(turn=1)
def test_an_effect_file_edited_broken_and_mended(tmp_path: Path) -> None:
    path, mine = quick.with_own(tmp_path), tmp_path / "mine.py"
    with opened(path) as desk:
        serial = diagnosed(desk).serial
        first = result(desk)
        mine.write_text(quick.OWN.replace("v * abs(v)", "r * abs(r)"), encoding="utf-8")
        until(lambda: desk.status.serial > serial, "the effect file to be seen")
        diagnosed(desk)
        second = result(desk)
        assert second == run(load(path)).result
        assert second.fit.eps_rmsn != first.fit.eps_rmsn
        mine.write_text("def\n", encoding="utf-8")
        status = until(lambda: (s := desk.status).trouble and s, "the trouble to be seen")
        assert status.trouble is not None
        assert status.trouble.where == "effects"
        assert "mine.py" in status.trouble.words
        assert result(desk) == second
        with pytest.raises(TrialidError, match=r"mine\.py"):
            edit(desk, "add", effect=ADDED)
        mine.write_text(quick.OWN, encoding="utf-8")
        until(lambda: desk.status.trouble is None, "the trouble to go")
        diagnosed(desk)
        assert result(desk).fit == first.fit


@pytest.mark.study(turn=9)
def test_an_undo_while_the_effect_file_is_broken(tmp_path: Path) -> None:
    """The file is as it was before the edit; what cannot be fitted now is, once it is mended."""
    path, mine = quick.with_own(tmp_path), tmp_path / "mine.py"
    text = path.read_bytes()
    with opened(path) as desk:
        diagnosed(desk)
        edit(desk, "drop", effect="mine")
        diagnosed(desk)
        mine.write_text("def\n", encoding="utf-8")
        desk.undo(desk.status.version)
        assert path.read_bytes() == text
        status = until(
            lambda: (s := desk.status).trouble and s.working is None and s, "the trouble"
        )
        assert status.trouble is not None
        assert status.trouble.where == "effects"
        mine.write_text(quick.OWN, encoding="utf-8")
        until(lambda: desk.status.trouble is None, "the trouble to go")
        diagnosed(desk)
        assert result(desk) == run(load(path)).result
        assert path.read_bytes() == text


@pytest.mark.study(turn=9)
def test_an_effect_file_edited_with_the_pipeline(tmp_path: Path, monkeypatch: Any) -> None:
    """Between the same two looks as an edit on the screen: it is seen all the same."""
    path, mine = quick.with_own(tmp_path), tmp_path / "mine.py"
    looks = Looks(desk_module.watch_list, path)
    monkeypatch.setattr(desk_module, "watch_list", looks.watched)
    with opened(path) as desk:
        diagnosed(desk)
        looks.stop()
        edit(desk, "free", parameter="Nrar", free=False)
        diagnosed(desk)
        mine.write_text(quick.OWN.replace("v * abs(v)", "r * abs(r)"), encoding="utf-8")
        serial = desk.status.serial
        looks.go()
        until(lambda: desk.status.serial > serial, "the effect file to be seen")
        diagnosed(desk)
        assert result(desk) == run(load(path)).result


@pytest.mark.study(turn=9)
def test_a_file_edited_while_it_is_taken_over(path: Path, monkeypatch: Any) -> None:
    """The second of two edits elsewhere, made while the first is being read, is seen too."""
    text = path.read_bytes()
    second = text.replace(b', "Nrar"]', b', "Kphi"]')
    reread = desk_module.Document.reread
    late = [second]

    def rereading(self: Any) -> bool:
        found = reread(self)
        if found and late:
            path.write_bytes(late.pop())
        return found

    monkeypatch.setattr(desk_module.Document, "reread", rereading)
    with opened(path) as desk:
        diagnosed(desk)
        path.write_bytes(text.replace(b', "Nrar"]', b"]"))
        until(lambda: desk._document.pipeline.content == second, "the second edit to be seen")
        diagnosed(desk)
        assert result(desk) == run(load(path)).result


@pytest.mark.study(turn=5)
def test_a_log_that_grew_is_not_shown_as_it_was(path: Path) -> None:
    """An undo shows again what was known, but not of another record."""
    log = path.with_name("log.csv")
    with opened(path) as desk:
        diagnosed(desk)
        edit(desk, "free", parameter="Nrar", free=False)
        diagnosed(desk)
        lines = log.read_text(encoding="utf-8").splitlines(keepends=True)
        log.write_text("".join([lines[0], *lines[500:]]), encoding="utf-8")
        desk.undo(desk.status.version)
        diagnosed(desk)
        assert result(desk) == run(load(path)).result


# --- the end ------------------------------------------------------------------------------------
