"""The JSON Schema that ships is the one the rows give."""

import json
from importlib import resources

from click.testing import CliRunner

from trialid.cli.main import commands

MADE_BY = "trialid report --schema > trialid/result/result.schema.json"


def test_the_schema_that_ships_is_the_one_of_the_rows() -> None:
    shipped = resources.files("trialid.result").joinpath("result.schema.json")
    said = CliRunner().invoke(commands, ["report", "--schema"])
    assert said.exit_code == 0
    assert json.loads(shipped.read_text(encoding="utf-8")) == json.loads(said.stdout), MADE_BY


def test_a_report_of_nothing_is_refused() -> None:
    said = CliRunner().invoke(commands, ["report"])
    assert said.exit_code == 2
    assert "missing argument 'RUN_DIR...'" in said.output
