"""The guide's page of actuators: its ship and its pipeline make a model, its list a screen."""

import json
from pathlib import Path
from typing import Any

import pytest
from boats import ship_with
from click.testing import CliRunner

from trialid import guide, pipeline_file
from trialid.cli.main import commands
from trialid.effects.actuators import actuator_effects
from trialid.effects.actuators.push_kinds import PUSHES
from trialid.errors import PipelineError
from trialid.ship.actuators import Actuator
from trialid.workflow.build_model import available, build_model

TRIAL = 'ship = "ship.toml"\n[[trial]]\nname = "a"\nlogs = ["a.csv"]\n'


def block(kind: str) -> str:
    """The first fence of this kind."""
    return guide.page("actuators").split(f"```{kind}\n")[1].split("```")[0]


def test_a_new_kind_is_ten_lines_and_brings_all_that_kinds_have(monkeypatch) -> None:
    """The guide's kind, with the word in `Kind` the tenth line; its moment is that of its place."""
    code = guide.page("contributing").split("## A kind of actuator")[1].split("```")[1]
    own = code.removeprefix("python").partition("\n\n\n")[2]
    assert len([line for line in own.splitlines() if line]) + 1 == 10
    known: dict[str, Any] = {}
    exec(code.removeprefix("python"), known)
    monkeypatch.setitem(PUSHES, "airscrew", known["AIRSCREW"])
    two = [
        Actuator(name=n, kind="airscrew", x=-2.0, y=y) for n, y in (("left", -1.0), ("right", 1.0))
    ]
    made = actuator_effects(ship_with(tuple(two)), ("left",))
    push = made["airscrews"]({"left": 3.0, "right": -2.0, "k_air": 5.0})[0]
    assert pytest.approx((45.0, 0.0, 0.0, 45.0)) == push
    assert {f"airscrews_{n}" for n in ("lag", "deadband", "saturation")} < {*made}
    assert {f"left_{n}" for n in ("weak", "late", "reversed", "misaligned")} < {*made}
    assert "left_right_exchanged" in made


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "ship.toml").write_text(block("toml ship"), encoding="utf-8")
    (tmp_path / "p.toml").write_text(TRIAL + block("text"), encoding="utf-8")
    (tmp_path / "a.csv").touch()
    return tmp_path


def test_its_pipeline_is_a_model_of_its_ship(folder: Path) -> None:
    asked = pipeline_file.load(folder / "p.toml")
    model = build_model(asked, available(asked))
    assert model.all_states == ("u", "r", "left", "right")
    assert model.recorded == ("left_order", "right_order")


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("left_order ", "lift_order ", "lift_order: unknown quantity; did you mean 'left_order'?"),
        ('"rpm_left", unit = "rpm"', '"l", unit = "N"', "left_order.unit: unit 'N' cannot become"),
        ('"rpm_left", unit = "rpm"', '"l", unit = "%"', r'or say .* command = "share"$'),
        ('"rpm_left",', '"rpm_left", positive = "port",', "'left_order' has no port or starboard"),
    ],
)
def test_a_signal_that_no_actuator_has_is_refused(
    folder: Path, old: str, new: str, says: str
) -> None:
    path = folder / "p.toml"
    path.write_text(path.read_text(encoding="utf-8").replace(old, new), encoding="utf-8")
    with pytest.raises(PipelineError, match=says) as caught:
        pipeline_file.load(path)
    assert "\n" not in str(caught.value)


def test_the_effects_of_a_ship_are_listed_and_told(folder: Path) -> None:
    ship = str(folder / "ship.toml")
    listed = CliRunner().invoke(commands, ["effects", "--ship", ship])
    assert listed.exit_code == 0, listed.output
    for name in ("thrusters", "left_weak", "left_right_exchanged", "munk_moment"):
        assert f"\n{name} " in listed.stdout
    assert "\nactuator faults: What may be wrong with one actuator of several" in listed.stdout
    one = CliRunner().invoke(commands, ["effects", "left_weak", "--ship", ship])
    assert "force of left times 1 - weak_left" in " ".join(one.stdout.split())
    data = CliRunner().invoke(commands, ["effects", "thrusters", "--ship", ship, "--json"])
    assert json.loads(data.stdout)["name"] == "thrusters"
    assert CliRunner().invoke(commands, ["effects", "left_weak"]).exit_code == 2
