"""Long trials: the first is there to be looked at while the others are read."""

import threading
from pathlib import Path
from typing import Any

import pytest
import quick
from quick import diagnosed, opened

from trialid.workbench import compute, screen, shelf

pytestmark = pytest.mark.usefixtures("quick_looks")


def test_the_first_trial_is_there_while_the_next_is_read(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """All are named from the beginning; its curves are not asked for again with the next."""
    late, fit = Door(shelf.align_trial), Door(compute.fit_of)
    monkeypatch.setattr(shelf, "align_trial", lambda *given: late(*given, held=given[1].name))
    monkeypatch.setattr(compute, "fit_of", lambda *given: fit(*given, held="late"))
    with opened(path) as desk:
        assert late.reached.wait(quick.LONGEST)
        first, shown = desk.status, desk.shown
        assert first.stage == "measured"
        assert screen.panels(shown, 0)["name"] == "early"
        tabs = screen.parts(shown)["tabs"]
        assert 0 < tabs.index('data-trial="early"') < tabs.index('data-trial="late"')
        late.open.set()
        assert fit.reached.wait(quick.LONGEST)
        assert [s.name for s in desk.shown.series] == ["early", "late"]
        assert desk.status.series == first.series > 0
        assert desk.status.screen > first.screen
        fit.open.set()
        assert diagnosed(desk).series > first.series


class Door:
    """Lets calls for `late` through when it is opened, and says that one has come."""

    def __init__(self, does: Any) -> None:
        self.does, self.open, self.reached = does, threading.Event(), threading.Event()

    def __call__(self, *given: Any, held: str) -> Any:
        if held == "late":
            self.reached.set()
            assert self.open.wait(quick.LONGEST)
        return self.does(*given)
