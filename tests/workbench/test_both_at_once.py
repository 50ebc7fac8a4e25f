"""Two effects that are missing at once: one button adds both, and the history keeps where from."""

import re
from dataclasses import replace
from pathlib import Path

import pytest
from held import Gate, add_upon
from quick import ADDED, OTHER, diagnosed, opened, steps
from turn import TRIED, WITH_CHECK, turned, write_folder

from trialid.result.json_file import plain, result_of
from trialid.workbench import screen
from trialid.workbench.shown import Shown
from trialid.workflow import history


@pytest.fixture(scope="module")
def before(tmp_path_factory: pytest.TempPathFactory) -> Shown:
    return turned(write_folder(tmp_path_factory.mktemp("turn"), WITH_CHECK)).before


def with_both(shown: Shown, *names: str) -> str:
    """The verdict's part of the screen where these are missing together."""
    assert shown.run is not None
    result = plain(shown.run.result)
    told = {"kind": "cannot tell", "effect": None, "sentence": "two", "together": [*names]}
    result["verdict"] = {**result["verdict"], **told}
    run = replace(shown.run, result=result_of(result))
    return screen.parts(replace(shown, run=run))["verdict"]


def test_one_button_adds_both(before: Shown) -> None:
    """It is gone as soon as one of them is in the model."""
    [button] = re.findall(r"<button.*?</button>", with_both(before, *TRIED[:2]))
    assert 'data-do="add"' in button
    assert f'data-effect="{TRIED[0]} {TRIED[1]}"' in button
    assert "Add both" in button
    assert "Add all 3" in with_both(before, *TRIED[:3])
    assert "<button" not in with_both(before, TRIED[0], before.pipeline.model.effects[0])
    assert "<button" not in screen.parts(before)["verdict"]


@pytest.mark.study(turn="each")
@pytest.mark.usefixtures("quick_looks")
def test_the_history_keeps_what_two_edits_began_with(path: Path, gate: Gate) -> None:
    """The one comes while the other is worked out, which is let go."""
    with opened(path) as desk:
        diagnosed(desk)
        add_upon(desk, gate)
        diagnosed(desk)
    assert steps(path) == [("as written", None), ("added", f"{ADDED}, {OTHER}")]
    first, second = (row.eps_rmsn or 0.0 for row in history.read(path)[0])
    assert 0.0 < second < first
