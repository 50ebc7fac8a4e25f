"""A ship of known structure and her trials, compared once for all tests here."""

import shutil

import known_truth
import pytest
from compared import LISTS, run

from trialid.identification import fit as search
from trialid.workflow.structures import leave_out


@pytest.fixture(scope="session")
def turning(tmp_path_factory):
    """Four trials of a ship with cross-flow drag and her rudder in the race; the pipeline."""
    folder = tmp_path_factory.mktemp("turning")
    return known_truth.write_trials(
        folder, "cross-flow, race", 101, trials=4, checks=1, added=LISTS
    )


@pytest.fixture(scope="session")
def done(turning, tmp_path_factory):
    """The folder of its comparison, made by the command, and what was printed."""
    folder = tmp_path_factory.mktemp("compared")
    said = run(turning, "--out", folder)
    assert said.exit_code == 0, said.output
    return folder, said.stdout


@pytest.fixture
def copy(turning, tmp_path):
    """The same files where a test may change them."""
    return shutil.copytree(turning.parent, tmp_path / "copy") / turning.name


@pytest.fixture
def count(monkeypatch):
    """How many fits are made; with `stop` at which the keyboard interrupts."""
    made = {"fits": 0, "stop": None}

    def counted(*given, **named):
        if made["fits"] == made["stop"]:
            raise KeyboardInterrupt
        made["fits"] += 1
        return search.identify(*given, **named)

    monkeypatch.setattr(leave_out, "identify", counted)
    return made
