"""The model in use on the report's page: equations, numbers, K and T, commands that answer."""

import html
import json
import re
from dataclasses import replace
from pathlib import Path

import pytest
from test_bad_input import trialid_

from trialid.report.tables.use_tables import commands, equations
from trialid.result.json_file import read
from trialid.result.schema import Result


@pytest.fixture(scope="module")
def result(run_folder: Path) -> Result:
    return read(run_folder / "result.json")


def test_the_page_holds_equations_numbers_and_nomoto(
    run_folder: Path, result: Result, tmp_path: Path
) -> None:
    page = (run_folder / "report.html").read_text(encoding="utf-8")
    [section] = re.findall(r'<section id="use".*?</section>', page, re.DOTALL)
    said = html.unescape(re.sub(r"<[^>]+>", " ", section))
    assert "K = Kp p - rho g nabla GM phi" in said
    assert result.imo is not None
    numbers = {row.name: row for row in result.imo.steering}
    assert {*numbers} == {"K", "T", "K_prime", "T_prime", "T1", "T2", "T3"}
    low, high = numbers["K"].likely
    assert low < numbers["K"].value < high
    assert f"{numbers['K'].value:.3g}" in said
    for row in commands(result):
        assert row.command in said
    out = tmp_path / "k.json"
    told = trialid_("export", str(run_folder), "--as", "nomoto", "--out", str(out))
    assert told.exit_code == 0
    found = json.loads(out.read_text(encoding="utf-8"))
    assert found["at"][0]["numbers"]["K"]["value"] == pytest.approx(numbers["K"].value)


def test_numbers_stand_with_the_effect_that_has_them(result: Result) -> None:
    rows = {row.effect: row for row in equations(result)}
    assert [p.name for p in rows["linear_roll"].parameters] == ["GM"]
    assert {p.name for row in rows.values() for p in row.parameters} == {
        p.name for p in result.physical
    }


def test_without_a_verdict_commands_ask_for_more(result: Result) -> None:
    spoilt = replace(result, verdict=replace(result.verdict, kind="no fit"))
    assert all("--anyway" in row.command for row in commands(spoilt))
    assert not any("--anyway" in row.command for row in commands(result))


def test_the_command_for_an_autopilot_asks_for_what_steers(result: Result) -> None:
    """A full rudder; the full command where thrusters steer and no rudder does."""
    steered = [row.command for row in commands(result)]
    assert "trialid export . --as ardupilot --full-rudder 35" in steered
    model = replace(result.model, effects=("thrusters",), inputs=("left_order", "right_order"))
    by_both = [row.command for row in commands(replace(result, model=model))]
    assert "trialid export . --as ardupilot --full-command 1000" in by_both
    mixed = replace(model, inputs=("delta", *model.inputs))
    assert [row.command for row in commands(replace(result, model=mixed))] == steered
