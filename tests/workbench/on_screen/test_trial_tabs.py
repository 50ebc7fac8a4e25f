"""The tabs of trials with long names."""

import re
from pathlib import Path

import quick

from trialid.pipeline_file import load
from trialid.workbench import screen
from trialid.workbench.shown import Shown
from trialid.workflow.build_model import available


def test_long_names_differ_where_they_do(tmp_path: Path) -> None:
    """The whole name is there for who hears it, and under the pointer."""
    names = ["zigzag_31-Jul-2020_13_04_24", "zigzag_31-Jul-2020_13_14_02"]
    text = quick.TEXT.replace("early", names[0]).replace("late", names[1])
    recipe = load(quick.write(tmp_path, text))
    tabs = screen.parts(Shown(recipe, available(recipe)))["tabs"]
    seen = re.findall(r'<span aria-hidden="true">(.*?)</span>', tabs)
    assert seen == ["zigzag_31-…2020_13_04_24", "zigzag_31-…2020_13_14_02"]
    assert re.findall(r'<span class="unseen">(.*?)</span>', tabs) == names
