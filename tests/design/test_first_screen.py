"""What a design says on a terminal: on one screen, the best test first, every letter explained."""

from pathlib import Path

import pytest
from rich.console import Console

from trialid.pipeline_file.design_file import load_design
from trialid.report.tables.design_tables import tables
from trialid.report.terminal.terminal import SCREEN
from trialid.workflow.design.design_run import plan
from trialid.workflow.design.plan_data import plain

PIPELINES = Path(__file__).parents[2] / "pipelines"
QUICK = ("design_rivals", "design_s175q")
OTHERS = sorted(p.stem for p in PIPELINES.glob("design_*.toml") if p.stem not in QUICK)


def shown(design):
    console = Console(width=80, color_system=None)
    with console.capture() as capture:
        for part in tables(design):
            console.print(part, markup=False, highlight=False)
    return capture.get().splitlines()


@pytest.mark.parametrize(
    "name", [*QUICK, *(pytest.param(n, marks=pytest.mark.study(turn="each")) for n in OTHERS)]
)
def test_a_shipped_design_is_one_screen(name):
    design = plain(plan(load_design(PIPELINES / f"{name}.toml"), lambda words, share: None))
    lines = shown(design)
    assert len(lines) + 1 <= SCREEN[0]  # the line that names the page for the bridge
    assert max(map(len, lines)) <= SCREEN[1]
    assert design["best"] in lines[0]
    assert lines[1].startswith("test  ")
    for test, line in zip(design["tests"], lines[2:], strict=False):
        assert f"  {test['rating']['S_min']:#.2g}  " in line  # numbers are never cut
    words = " ".join(" ".join(lines).split())
    for letter in ("S_imin", "R_i", "R", "error", "partner"):
        assert f"{letter}: " in words


def test_where_no_test_may_run_that_is_said_first():
    limit = {"limit": "heel", "sentence": "16 deg, 15 are allowed"}
    failed = {"name": "wide", "programme": [], "remarks": [], "feasible": False}
    failed |= {"rating": None, "limits": [limit]}
    design = {"tests": [failed], "wanted": ["Nr"], "best": None, "separation": None, "imo": []}
    lines = shown(design)
    assert lines[0] == "No test keeps the limits."
    assert "wide: heel binds: 16 deg, 15 are allowed" in lines
