"""What the tests of compared structures share: the lists, the command, its result."""

import json

from click.testing import CliRunner

from trialid.cli.main import commands
from trialid.result.json_file import row_of
from trialid.result.structure_rows import Structures

LISTS = """
[structures]
linear = []
"cross-flow" = ["cross_flow_drag"]
"cross-flow, race" = ["cross_flow_drag", "rudder_slipstream"]
"""
FITS = 3 * (1 + 4 + 6)
"""Of three structures: all of four trials, all but one, all but two."""


def silent(words, share):
    pass


def run(*words):
    return CliRunner().invoke(commands, ["structures", *map(str, words)], prog_name="trialid")


def result_in(folder) -> Structures:
    """What `structures.json` in a folder holds."""
    return row_of(Structures, json.loads((folder / "structures.json").read_text(encoding="utf-8")))
