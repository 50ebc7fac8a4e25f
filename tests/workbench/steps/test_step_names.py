"""What an edit changed in few words, and how the steps of a desk are called."""

from pathlib import Path
from typing import Any

import pytest
import quick
from quick import ADDED, TEXT, diagnosed, edit, opened

from trialid.names.wording import MINUS
from trialid.pipeline_file import load
from trialid.workbench import compute, screen
from trialid.workbench.desk import Desk
from trialid.workbench.steps.step_names import change_words
from trialid.workbench.steps.step_rows import steps
from trialid.workflow.build_model import available
from trialid.workflow.run import examine

FREE = '"Nrar"]'
EDITS = [
    ('"roll_drag_var",\n]', '"roll_drag_var", "righting_arm_cubic",\n]', "+ righting_arm_cubic"),
    ('"heel_roll", ', "", f"{MINUS} heel_roll"),
    ('"heel_roll", ', '"sway_froude", ', f"+ sway_froude, {MINUS} heel_roll"),
    (FREE, '"Nrar", "Yvar"]', "free Yvar"),
    (', "Nrar"]', "]", "fix Nrar"),
    ('use = "check"', 'use = "fit"', "late fitted"),
    ("window = [0, 600]", "window = [0, 500]", "other trials"),
    ("[identify]", "[model.values]\nYv = -0.014\n[identify]", "Yv = -0.014"),
    ("outputs ", "bounds = { Yv = [-0.1, 0.0] }\noutputs ", "bounds of Yv"),
    ("period = 1.0", "period = 0.5", "as edited"),
]


def written(folder: Path, text: str):
    return load(quick.write(folder, text))


@pytest.mark.parametrize(("old", "new", "words"), EDITS)
def test_an_edit_is_named_by_what_it_changes(
    tmp_path: Path, old: str, new: str, words: str
) -> None:
    assert old in TEXT
    before, after = written(tmp_path, TEXT), written(tmp_path, TEXT.replace(old, new))
    assert change_words(before, after, available(before)) == words


def test_what_is_taken_away_is_named(tmp_path: Path) -> None:
    said = "[model.values]\nYr = 0.1\n[identify]\nbounds = { Yv = [-0.1, 0.0], Nrar = [-1.0, 0.0] }"
    bare = TEXT.replace(FREE, "]")
    before, after = written(tmp_path, TEXT.replace("[identify]", said)), written(tmp_path, bare)
    words = change_words(before, after, available(before))
    assert words == "fix Nrar, no value of Yr, no bounds of Yv"


def words_of(desk: Desk) -> list[str]:
    diagnosed(desk)
    shown = desk.shown
    assert shown.run is not None
    found = steps(shown, shown.run.result)
    return [row.words for row in (*found.earlier, *found.rows) if row.kind != "proposed"]


@pytest.mark.study(turn="each")
def test_every_step_at_a_desk_has_the_name_of_its_edit(path: Path) -> None:
    with opened(path) as desk:
        diagnosed(desk)
        edit(desk, "add", effect=ADDED)
        diagnosed(desk)
        desk.undo(desk.status.version)
        begun = ["as written", f"+ {ADDED}", f"{MINUS} {ADDED}"]
        assert words_of(desk) == begun
        edit(desk, "use", trial="late", use="fit")
        assert words_of(desk) == [*begun, "late fitted"]
        assert "Other trials or outputs are fitted" in (error := screen.parts(desk.shown)["error"])
        assert not [word for word in ('class="fell"', 'class="rose"') if word in error]
        desk.undo(desk.status.version)
        assert words_of(desk) == [*begun, "late fitted", "late held out"]
        assert quick.steps(path)[2:] == [("dropped", ADDED), *[("as written", None)] * 2]
        edit(desk, "free", parameter="Nrar", free=False)
        assert words_of(desk) == [*begun, "late fitted", "late held out", "fix Nrar"]
        error = screen.parts(desk.shown)["error"]
        assert "Other trials" not in error
        assert 'class="rose"' in error


@pytest.mark.study(turn="each")
def test_a_model_that_an_effect_joined_has_grown(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = []

    def noted(*given: Any, grown: bool) -> Any:
        asked.append(grown)
        return examine(*given, grown=grown)

    monkeypatch.setattr(compute, "examine", noted)
    with opened(path) as desk:
        diagnosed(desk)
        edit(desk, "add", effect=ADDED)
        diagnosed(desk)
    assert asked == [False, True]


@pytest.mark.study(turn="each")
def test_the_model_before_the_first_edit_stays_in_the_history(path: Path) -> None:
    with opened(path) as desk:
        diagnosed(desk)
        edit(desk, "use", trial="late", use="fit")
        assert words_of(desk) == ["as written", "late fitted"]
