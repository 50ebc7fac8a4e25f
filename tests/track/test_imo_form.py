"""The form that is handed in: its numbers are the run's, and what is doubtful is said first."""

import csv
import re
import shutil
from dataclasses import replace
from pathlib import Path

import pytest
from click.testing import CliRunner

from trialid.cli.main import commands
from trialid.design.imo.trial_numbers import TurnMeasure
from trialid.errors import TrialidError
from trialid.pipeline_file.design_file import load_design
from trialid.report.pages.folder import Finished
from trialid.report.pages.imo_form import form, write_form
from trialid.result import json_file
from trialid.result.fit_rows import ModelPart, TrialRow
from trialid.result.imo import UNRELIABLE
from trialid.result.imo_rows import ConditionRow, ImoPart, MeasureRow
from trialid.result.schema import Result
from trialid.workflow.design.design_run import plan

DESIGN = """
name = "what next"
pipeline = "pipelines/asked.toml"
run = "run"
imo = true
wanted = ["Nr"]
noise = { r = 0.05, phi = 0.1 }
[[test]]
name = "zig-zag"
kind = "zigzag"
duration = 300.0
set = { angle = 20.0, heading = 20.0 }
"""
ROOT = Path(__file__).parents[2]
SIZE = {"L": 175.0, "B": 25.4, "T": 8.5, "nabla": 21222.0, "U0": 7.33, "rho": 1025.0, "g": 9.81}
TURN = TurnMeasure(
    trial="circle",
    t=30.0,
    rudder=0.6109,
    name="advance",
    measured=522.61,
    interval=(514.03, 531.19),
    predicted=501.81,
    predicted_interval=(501.1, 502.9),
)
MEASURE = MeasureRow(
    name="advance",
    unit="m",
    value=501.83,
    interval=(500.1, 505.4),
    allowed=787.5,
    kept=True,
    manoeuvre="turning circle, 35 deg",
)
RESULT = Result(
    pipeline="tracked",
    trials=(TrialRow(name="circle", use="fit"),),
    model=ModelPart(ship="S175 <b>", particulars=SIZE, effects=("linear_hull",), free=("Nv",)),
    imo=ImoPart(measures=(MEASURE,), turns=(TURN,), sailed="Sailed by simulation."),
)


def finished(result: Result = RESULT) -> Finished:
    return Finished("run", result, (), ())


def column(file: Path, name: str) -> list[str]:
    with file.open(newline="", encoding="utf-8") as stream:
        return [row[name] for row in csv.DictReader(stream)]


def test_its_numbers_are_those_of_the_run(tmp_path: Path) -> None:
    page, count = write_form(finished(), tmp_path)
    text = page.read_text(encoding="utf-8")
    assert count == 5 * 3 + 1
    assert column(tmp_path / "imo" / "manoeuvres.csv", "manoeuvre") == ["none"]
    assert [float(x) for x in column(tmp_path / "imo" / "imo.csv", "predicted")] == [502.0]
    assert column(tmp_path / "imo" / "turns.csv", "measured [m]") == ["522.6"]
    assert column(tmp_path / "imo" / "turns.csv", "model [m]") == ["501.8"]
    for number in ("522.6", "514.0", "531.2", "501.8", "0.5617"):
        assert number in text
    assert "S175 &lt;b&gt;" in text
    assert "no fit" not in text
    assert not re.search(r"<script|https?://", text)


@pytest.mark.parametrize("causes", ["", "current", "wind", "current and wind"])
def test_the_page_says_what_is_corrected_for_and_what_not(causes: str) -> None:
    assert RESULT.imo is not None
    turn = replace(TURN, corrected=500.0, corrected_for=causes)
    wind = ConditionRow(trial="circle", signal="V_aw", median=5.0, interval=(4.0, 6.0))
    told = form(
        finished(replace(RESULT, imo=replace(RESULT.imo, turns=(turn,), conditions=(wind,))))
    )
    for cause in ("current", "wind"):
        assert (f"Corrected for {cause}:" in told) == (cause in causes)
        assert (f"Not corrected for {cause}:" in told) == (cause not in causes)
    assert ("The wind was recorded: an effect of it" in told) == ("wind" not in causes)
    assert "holds by how much the same test differs on another day" in told


def test_a_fit_without_a_verdict_says_so_first(tmp_path: Path) -> None:
    assert RESULT.imo is not None
    doubtful = replace(RESULT, imo=replace(RESULT.imo, doubt=UNRELIABLE))
    text = form(finished(doubtful))
    assert text.index("no fit: ") < text.index("522.6")
    assert UNRELIABLE in text


def test_what_the_model_lacks_is_said_first() -> None:
    """A form that called all criteria kept kept silent about the verdict."""
    said = "missing; this is the model without it."
    named = replace(RESULT, verdict=replace(RESULT.verdict, kind="missing", effect="static_list"))
    text = form(finished(named))
    assert text.index(f"The run says that static_list is {said}") < text.index("522.6")
    found = replace(RESULT, verdict=replace(RESULT.verdict, kind="nothing missing", effect=None))
    assert said not in form(finished(found))


def test_a_run_without_measures_is_one_line(tmp_path: Path) -> None:
    with pytest.raises(TrialidError, match="write imo = true into its pipeline"):
        write_form(finished(replace(RESULT, imo=None)), tmp_path)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.study(turn=11)
def test_run_report_and_design_say_one_number(tmp_path: Path) -> None:
    """The sample run with its standard measures: terminal, form, report, and the design of it."""
    shutil.copytree(ROOT / "sample_data", tmp_path / "sample_data")
    (tmp_path / "pipelines").mkdir()
    text = (ROOT / "pipelines" / "hidden_effect.toml").read_text(encoding="utf-8")
    pipeline = tmp_path / "pipelines" / "asked.toml"
    pipeline.write_text("imo = true\n" + text, encoding="utf-8")
    out = tmp_path / "run"
    told = CliRunner().invoke(commands, ["run", str(pipeline), "--out", str(out)])
    assert told.exit_code == 0, told.output
    result = json_file.read(out / json_file.NAME)
    assert result.imo is not None
    assert CliRunner().invoke(commands, ["report", str(out), "--imo"]).exit_code == 0
    assert CliRunner().invoke(commands, ["report", str(out)]).exit_code == 0
    assert (out / "imo" / "imo.csv").read_text() == (out / "tables" / "imo.csv").read_text()
    found = [float(x or "nan") for x in column(out / "imo" / "imo.csv", "predicted")]
    assert found == pytest.approx([m.value or 0.0 for m in result.imo.measures], rel=5e-3)
    design = tmp_path / "design.toml"
    design.write_text(DESIGN, encoding="utf-8")
    planned = plan(load_design(design))
    assert planned.imo is not None
    for mine, theirs in zip(result.imo.measures, planned.imo.measures, strict=True):
        assert (theirs.criterion.name, theirs.interval) == (mine.name, mine.interval)
        assert theirs.value == pytest.approx(mine.value, rel=1e-6)
