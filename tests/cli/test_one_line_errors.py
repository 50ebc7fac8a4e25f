"""A wrong word on the command line is one line with the nearest right one, exit status 2."""

import shutil
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from trialid.cli.main import commands
from trialid.effects import CATALOGUE
from trialid.errors import nearest
from trialid.guide import TOPICS

ROOT = Path(__file__).parents[2]


def trialid(*arguments: str) -> Result:
    return CliRunner().invoke(commands, arguments, prog_name="trialid")


def refused(*arguments: str) -> str:
    """The one line that a wrong command is answered with."""
    told = trialid(*arguments)
    assert (told.exit_code, told.stdout) == (2, ""), told.output
    assert told.stderr.startswith("trialid: ")
    assert told.stderr.count("\n") == 1
    return told.stderr.removeprefix("trialid: ").rstrip("\n")


COMMANDS = {
    "rnu": "run",
    "repot": "report",
    "effect": "effects",
    "ad": "add",
    "RUN": "run",
    "insepct": "inspect",
    "work-bench": "workbench",
    "desing": "design",
}
EFFECTS = {
    "righting_arm_qubic": "righting_arm_cubic",
    "gyro": "gyro_cross_axis",
    "backlash": "rudder_backlash",
    "rudder-offset": "rudder_offset",
    "Static_List": "static_list",
    "tank": "anti_roll_tank",
}
TOPIC = {
    "ferst_trail": "first_trial",
    "verdict": "verdicts",
    "acuracy": "accuracy",
    "pipeline": "pipeline_file",
}


@pytest.mark.parametrize(("wrong", "right"), COMMANDS.items())
def test_a_wrong_command_has_the_nearest_first(wrong: str, right: str) -> None:
    said = refused(wrong, "x.toml")
    assert said.startswith(f"there is no command {wrong!r}; did you mean {right!r}")


def test_a_command_like_none_has_them_all() -> None:
    assert refused("zzzzzz").endswith("known: " + ", ".join(sorted(commands.commands)))


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("run",), "missing argument 'PIPELINE'; see trialid run --help"),
        (("run", "a", "b"), "got unexpected extra argument (b); see trialid run --help"),
        (("add", "a.toml"), "missing argument 'EFFECT'; see trialid add --help"),
        (("report",), "missing argument 'RUN_DIR...'; see trialid report --help"),
    ],
)
def test_wrong_arguments_lead_to_the_help(arguments: tuple[str, ...], said: str) -> None:
    assert refused(*arguments) == said


@pytest.mark.parametrize(
    ("arguments", "option"), [(("run", "--ot", "x"), "--out"), (("--vrsion",), "--version")]
)
def test_a_wrong_option_has_the_nearest(arguments: tuple[str, ...], option: str) -> None:
    said = refused(*arguments)
    assert "no such option" in said
    assert repr(option) in said
    assert said.endswith("--help")


@pytest.mark.parametrize(("wrong", "right"), EFFECTS.items())
def test_a_wrong_effect_has_the_nearest_first(wrong: str, right: str) -> None:
    pipeline = str(ROOT / "pipelines" / "hidden_effect.toml")
    for command in (("effects", wrong), ("add", pipeline, wrong)):
        said = refused(*command)
        assert f"there is no effect {wrong!r}; did you mean {right!r}" in said


def test_a_number_below_zero_is_no_option() -> None:
    said = refused("simulate", "nowhere", "circle", "-20")
    assert said.startswith("-2...: a number below zero reads as an option; none is asked for")


def test_an_effect_of_a_boats_actuators_says_where_it_comes_from() -> None:
    assert refused("effects", "still_water_yaw") == (
        "still_water_yaw comes with a boat's own actuators: add --ship SHIP.toml"
    )


def test_a_name_like_none_is_no_list_to_scroll() -> None:
    said = refused("effects", "zzz")
    assert f"of {len(CATALOGUE)} known the nearest are " in said
    assert len(said) < 120


@pytest.mark.parametrize(("wrong", "right"), TOPIC.items())
def test_a_wrong_topic_has_the_nearest(wrong: str, right: str) -> None:
    assert right in TOPICS
    assert f"did you mean {right!r}" in refused("guide", wrong)


# --- files --------------------------------------------------------------------------------------


@pytest.fixture
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The sample's small files, and two finished runs by name."""
    shutil.copytree(ROOT / "pipelines", tmp_path / "pipelines")
    shutil.copytree(ROOT / "sample_data", tmp_path / "sample_data")
    for name in ("hidden_effect", "ferry"):
        run = tmp_path / "runs" / name
        run.mkdir(parents=True)
        (run / "result.json").touch()
    monkeypatch.chdir(tmp_path)
    return tmp_path


HIDDEN = "pipelines/hidden_effect.toml"


FILES = [
    (("run", "pipelines/hiden_effect.toml"), "did you mean 'hidden_effect.toml'"),
    (("run", "pipelines"), "pipelines: is a folder; name a file in it; there are design_"),
    (("run", "runs"), "runs: is a folder; name a file in it"),
    (("report", "runs/hiden_effect"), "did you mean 'hidden_effect'"),
    (("inspect", "sample_data/hidden_effect/zigzag-10.mcp"), "did you mean 'zigzag-10.mcap'"),
    (
        ("run", "pipelines/design_rivals.toml"),
        "is a design of tests; to rate them: trialid design pipelines/design_rivals.toml",
    ),
    (("design", HIDDEN), f"is a pipeline; to fit it: trialid run {HIDDEN}"),
    (("design", "sample_data/ships/s175q.toml"), "is the file of a ship; a pipeline names it"),
    (
        ("run", "sample_data/hidden_effect/zigzag-15.csv"),
        "a log is looked into by trialid inspect sample_data/hidden_effect/zigzag-15.csv",
    ),
    (("run", "sample_data/hidden_effect/zigzag-10.mcap"), "trialid inspect sample_data/hid"),
    ((HIDDEN,), f"for that file: trialid run {HIDDEN}"),
    (("sample_data/hidden_effect/zigzag-15.csv",), "for that file: trialid inspect sample_da"),
]


@pytest.mark.usefixtures("place")
@pytest.mark.parametrize(("arguments", "words"), FILES)
def test_a_wrong_file_leads_to_the_right_one(arguments: tuple[str, ...], words: str) -> None:
    assert words in refused(*arguments)


def test_what_is_hidden_is_not_proposed(place: Path) -> None:
    (place / ".secret").touch()
    said = refused("inspect", "nothing.mcap")
    assert "the folder holds: pipelines, runs, sample_data" in said


# --- likeness -----------------------------------------------------------------------------------


def test_a_part_of_a_name_counts_less_than_the_whole() -> None:
    known = ["heel_yaw", "yaw", "sway"]
    assert nearest("yaw", known) == "did you mean 'yaw'?"
    assert nearest("yow", ["heel_yaw", "way"]) == "did you mean 'heel_yaw'?"


def test_help_is_no_mistake() -> None:
    told = trialid("--help")
    assert told.exit_code == 0
    rows = told.stdout.partition("Commands:\n")[2].splitlines()
    assert len(rows) == len(commands.commands)
    assert [row for row in rows if row.endswith("...") or len(row) > 80] == []
