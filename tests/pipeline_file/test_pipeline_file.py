"""The pipeline file: what a good one gives, and what every mistake is told."""

import pickle
from pathlib import Path

import pydantic
import pytest

from trialid.errors import PipelineError
from trialid.pipeline_file import Pipeline, load, signal_key, sources, where

SHORT = """
ship = "ships/s175.toml"

[[trial]]
name = "zigzag-20"
logs = ["logs/zigzag20.csv"]
[trial.signals]
delta = { channel = "rudder", unit = "deg", positive = "port" }
phi = { channel = "/imu:orientation", as = "roll" }
r = { channel = "gyro", unit = "deg/min" }

[model]
states = ["v", "p", "r", "phi"]
effects = ["linear_hull"]

[identify]
free = ["Yv", "Nr"]
outputs = ["r", "phi"]
"""

FULL = """
name = "container ship"
ship = "ships/s175.toml"

[signals]
delta = { channel = "rudder", unit = "deg", positive = "port" }
u = { channel = "log", unit = "kn" }

[[trial]]
name = "first"
logs = ["logs/zigzag20.csv", "logs/turn.csv"]
window = [60, 1200.0]

[[trial]]
name = "second"
logs = ["logs/turn.csv"]
use = "check"
speed = 7.5
signals.u = { channel = "gps", unit = "m/s", delay = 0.4 }

[align]
period = 1

[model]
states = ["v", "r"]
effects = ["linear_hull", "mine"]
effects_from = ["mine.py"]
values = { Yv = -0.01, T_delta = { value = 2.5, unit = "s" } }

[identify]
free = ["Yv"]
outputs = ["r"]
nuisance = ["initial_state", "bias", "rudder_offset", "delay"]
weights = { r = 2.0 }
loss = "huber"
priors = { Yv = { mean = -0.01, std = 0.002 } }
bounds = { Yv = [-inf, 0.0] }
starts = 4
spread = 0.2
seed = 7
max_iterations = 20
norm = "zero"
substeps = 2
engine = "numpy"

[diagnose]
candidates = ["cross_flow_drag"]
noise = { r = 0.05 }
refit = 1
family_cos = 0.95
level = 0.01
quiet = [{ trial = "first", window = [0.0, 30.0] }]
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for name in ("ships/s175.toml", "logs/zigzag20.csv", "logs/turn.csv", "mine.py"):
        file = tmp_path / name
        file.parent.mkdir(exist_ok=True)
        file.touch()
    return tmp_path


def written(folder: Path, text: str) -> Path:
    path = folder / "zigzag.toml"
    path.write_text(text, encoding="utf-8")
    return path


def short(folder: Path, old: str = "", new: str = "") -> Path:
    """Give the short pipeline with one thing changed."""
    assert old in SHORT
    return written(folder, SHORT.replace(old, new, 1))


def refusal(path: Path) -> str:
    """Give the message of the error, one line that begins with the file."""
    with pytest.raises(PipelineError) as caught:
        load(path)
    message = str(caught.value)
    assert "\n" not in message
    assert message.startswith(f"{path}: ")
    return message.removeprefix(f"{path}: ")


# --- good files ---------------------------------------------------------------------------------


def test_a_short_pipeline_has_defaults_for_the_rest(folder: Path) -> None:
    recipe = load(short(folder))
    assert recipe.name == "zigzag"
    assert recipe.align.period == 0.5
    (trial,) = recipe.trials
    assert (trial.use, trial.window, trial.speed) == ("fit", None, None)
    identify = recipe.identify
    assert (identify.nuisance, identify.weights, identify.priors, identify.bounds) == (
        ("initial_state",),
        {},
        {},
        {},
    )
    assert (identify.loss, identify.norm, identify.engine) == ("squares", "mean", "compiled")
    assert (identify.starts, identify.spread, identify.seed) == (1, 0.3, 0)
    assert (identify.max_iterations, identify.substeps) == (50, 1)
    diagnose = recipe.diagnose
    assert (diagnose.candidates, diagnose.noise, diagnose.quiet) == ("all", {}, ())
    assert (diagnose.refit, diagnose.family_cos, diagnose.level) == (4, 0.9, 0.05)


def test_every_key_arrives(folder: Path) -> None:
    recipe = load(written(folder, FULL))
    assert recipe.name == "container ship"
    assert recipe.align.period == 1.0
    assert recipe.trials[0].window == (60.0, 1200.0)
    assert (recipe.trials[1].use, recipe.trials[1].speed) == ("check", 7.5)
    assert recipe.model.states == ("v", "r")
    identify = recipe.identify
    assert identify.nuisance == ("initial_state", "bias", "rudder_offset", "delay")
    assert (identify.priors["Yv"].mean, identify.priors["Yv"].std) == (-0.01, 0.002)
    assert identify.bounds == {"Yv": (float("-inf"), 0.0)}
    assert (identify.loss, identify.norm, identify.engine) == ("huber", "zero", "numpy")
    assert recipe.diagnose.candidates == ("cross_flow_drag",)
    assert recipe.diagnose.noise == {"r": 0.05}
    assert recipe.diagnose.quiet[0].window == (0.0, 30.0)


def test_paths_are_relative_to_the_file(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = written(folder, FULL)
    monkeypatch.chdir(folder.parent)
    recipe = load(Path(folder.name, path.name))
    assert recipe.ship == Path(folder.name, "ships/s175.toml")
    assert recipe.model.effects_from == (Path(folder.name, "mine.py"),)
    assert all(file.is_file() for file in sources(recipe))
    assert {file.name for file in sources(recipe)} == {
        "zigzag.toml",
        "s175.toml",
        "mine.py",
        "zigzag20.csv",
        "turn.csv",
    }


def test_an_absolute_path_stays(folder: Path, tmp_path_factory: pytest.TempPathFactory) -> None:
    log = tmp_path_factory.mktemp("elsewhere") / "log.csv"
    log.touch()
    recipe = load(short(folder, '"logs/zigzag20.csv"', repr(str(log))))
    assert [one.path for one in recipe.trials[0].logs] == [log]


def test_a_signal_says_channel_unit_side_angle_and_delay(folder: Path) -> None:
    signals = load(short(folder)).trials[0].signals
    delta, phi = signals["delta"], signals["phi"]
    assert (delta.channel, delta.unit, delta.positive) == ("rudder", "deg", "port")
    assert (phi.unit, phi.positive, phi.angle, phi.delay) == (None, None, "roll", 0.0)


def test_a_trials_own_signal_replaces_the_shared_one(folder: Path) -> None:
    recipe = load(written(folder, FULL))
    first, second = recipe.trials
    assert first.signals == recipe.signals
    assert second.signals["delta"] == recipe.signals["delta"]
    assert (second.signals["u"].channel, second.signals["u"].delay) == ("gps", 0.4)


def test_a_signal_key_says_where_the_signal_is_written(folder: Path) -> None:
    recipe = load(written(folder, FULL))
    first, second = recipe.trials
    assert signal_key(recipe, first, "u") == "signals.u"
    assert signal_key(recipe, second, "delta") == "signals.delta"
    assert signal_key(recipe, second, "u") == "trial[1].signals.u"
    assert signal_key(recipe, second, "phi") == "trial[1].signals.phi"


def test_values_are_numbers_with_or_without_a_unit(folder: Path) -> None:
    values = load(written(folder, FULL)).model.values
    assert (values["Yv"].value, values["Yv"].unit) == (-0.01, None)
    assert (values["T_delta"].value, values["T_delta"].unit) == (2.5, "s")


def test_where_begins_an_error_raised_later(folder: Path) -> None:
    path = short(folder)
    assert where(load(path), "model.effects[0]") == f"{path}: model.effects[0]"


def test_a_recipe_is_frozen_and_travels_to_other_processes(folder: Path) -> None:
    recipe = load(written(folder, FULL))
    with pytest.raises(pydantic.ValidationError, match="frozen"):
        recipe.name = "other"
    copy = pickle.loads(pickle.dumps(recipe))
    assert copy == recipe
    assert copy.path == recipe.path


@pytest.mark.parametrize("none", ["none", "all"])
def test_candidates_may_be_a_word(folder: Path, none: str) -> None:
    text = SHORT + f'[diagnose]\ncandidates = "{none}"\n'
    assert load(written(folder, text)).diagnose.candidates == none


def test_a_byte_order_mark_and_windows_line_ends_are_read(folder: Path) -> None:
    path = folder / "zigzag.toml"
    path.write_bytes(b"\xef\xbb\xbf" + SHORT.replace("\n", "\r\n").encode())
    assert load(path).trials[0].name == "zigzag-20"


# --- files that are not there, or not TOML ------------------------------------------------------


def test_a_missing_pipeline_is_named_with_its_neighbours(folder: Path) -> None:
    short(folder)
    assert refusal(folder / "zigzg.toml") == ("no such pipeline file (did you mean 'zigzag.toml'?)")
    assert "no such pipeline file (there is no folder" in refusal(folder / "nowhere" / "a.toml")


def test_a_folder_is_no_pipeline(folder: Path) -> None:
    assert "is a folder; name a file in it" in refusal(folder)


def test_toml_errors_name_the_line(folder: Path) -> None:
    assert "not TOML" in refusal(written(folder, "name = \n"))
    assert "line 2" in refusal(written(folder, "a = 1\nname = = 3\n"))
    assert "line 3, the end of the file" in refusal(written(folder, "a = 1\n\nlogs = ["))


def test_text_must_be_utf8(folder: Path) -> None:
    path = folder / "zigzag.toml"
    path.write_bytes("name = 'Größe'".encode("latin-1"))
    assert refusal(path) == "not TOML: not UTF-8 text (byte 10)"


def test_a_missing_ship_log_or_effects_file_says_where_it_was_looked_for(folder: Path) -> None:
    message = refusal(short(folder, "s175.toml", "s157.toml"))
    assert message.startswith("ship: no file 'ships/s157.toml' (looked for ")
    assert str(folder / "ships" / "s157.toml") in message
    assert message.endswith("did you mean 's175.toml'?)")
    message = refusal(short(folder, "zigzag20.csv", "zigzag02.csv"))
    assert message.startswith("trial[0].logs[0]: no file 'logs/zigzag02.csv'")
    assert "did you mean 'zigzag20.csv'?" in message
    message = refusal(written(folder, FULL.replace('"mine.py"', '"my.py"')))
    assert message.startswith("model.effects_from[0]: no file 'my.py'")
    assert "mine.py" in message


def test_many_unlike_neighbours_are_counted_not_listed(folder: Path) -> None:
    for index in range(9):
        (folder / "logs" / f"{index:03d}.csv").touch()
    assert "11 .csv files there" in refusal(short(folder, "zigzag20.csv", "spiral.csv"))


def test_without_neighbours_of_its_kind_a_missing_file_says_so(folder: Path) -> None:
    assert "no .mcap file there" in refusal(short(folder, "zigzag20.csv", "zigzag20.mcap"))
    assert "there is no folder" in refusal(short(folder, "logs/", "log/"))


def test_a_folder_of_logs_is_a_log(folder: Path) -> None:
    recipe = load(short(folder, "logs/zigzag20.csv", "logs"))
    assert [one.path.name for one in recipe.trials[0].logs] == ["logs"]


def test_a_log_with_what_it_does_not_say_itself(folder: Path) -> None:
    log = '{ path = "logs/zigzag20.csv", zone = "Europe/Oslo" }'
    recipe = load(short(folder, '"logs/zigzag20.csv"', log))
    assert recipe.trials[0].logs[0].zone == "Europe/Oslo"
    message = refusal(short(folder, '"logs/zigzag20.csv"', log.replace("Oslo", "Olso")))
    assert message.startswith("trial[0].logs[0].zone: 'Europe/Olso' is no time zone; write it like")
    assert "did you mean 'Europe/Oslo'" in message


def test_effects_come_from_python_files(folder: Path) -> None:
    message = refusal(written(folder, FULL.replace('"mine.py"', '"logs/turn.csv"')))
    assert message.startswith("model.effects_from[0]: ")
    assert "not a .py file" in message


# --- wrong keys and values ----------------------------------------------------------------------


@pytest.mark.parametrize(
    ("old", "new", "key", "hint"),
    [
        ("[model]", "[modle]", "modle", "did you mean 'model'"),
        ("logs =", "log =", "trial[0].log", "did you mean 'logs'"),
        ("positive =", "positiv =", "trial[0].signals.delta.positiv", "'positive'"),
        ("as =", "angle =", "trial[0].signals.phi.angle", "known: as, channel"),
        ("free =", "fre =", "identify.fre", "did you mean 'free'"),
        ("ship =", "path = 'x'\nship =", "path", "known: "),
        ("ship =", "trials = []\nship =", "trials", "did you mean 'trial'"),
        ("ship =", "'odd name' = 1\nship =", '"odd name"', "did you mean 'name'"),
    ],
)
def test_an_unknown_key_leads_and_names_the_nearest(
    folder: Path, old: str, new: str, key: str, hint: str
) -> None:
    message = refusal(short(folder, old, new))
    assert message.startswith(f"{key}: unknown key; ")
    assert hint in message


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('"port"', '"prot"', "trial[0].signals.delta.positive: 'prot' is not allowed; did you "),
        ('"port"', '"?"', "trial[0].signals.delta.positive: is still open; write one of 'port', "),
        ('"roll"', '"rol"', "trial[0].signals.phi.as: 'rol' is not allowed; did you mean 'roll'"),
        ('name = "zigzag-20"\n', "", "trial[0].name: missing; the pipeline needs it"),
        ('logs = ["logs/zigzag20.csv"]', "logs = []", "trial[0].logs: must not be empty"),
        ("[[trial]]", "[trial]", "trial: must be a list of tables; write [[trial]]"),
        ('["r", "phi"]\n', '"r"', "identify.outputs: must be a list in square brackets, got 'r'"),
        ("[model]", "align = 3\n[model]", "trial[0].signals.align: must be a table (keys: channel"),
        ("ship =", "align = 3\nship =", "align: must be a table (keys: period, clocks), got 3"),
        ("ship =", "align = { period = '1' }\nship =", "align.period: must be a valid number, got"),
        ("ship =", "align = { period = true }\nship =", "align.period: must be a valid number, go"),
        ("ship =", "align = { period = nan }\nship =", "align.period: must be a finite number"),
        ("ship =", "align = { period = 0 }\nship =", "align.period: must be greater than 0, got 0"),
        ("free =", "starts = 0\nfree =", "identify.starts: must be greater than or equal to 1"),
        ("free =", "starts = 1.5\nfree =", "identify.starts: must be a valid integer, got 1.5"),
        ("free =", "nuisance = ['bais']\nfree =", "identify.nuisance[0]: 'bais' is not allowed; "),
        ("free =", "bounds = { Yv = [1, 1] }\nfree =", "identify.bounds.Yv: [1, 1] runs backwards"),
        ("free =", "bounds = { Yv = [1] }\nfree =", "identify.bounds.Yv[1]: missing"),
        ("free =", "priors = { Yv = { mean = 1 } }\nfree =", "identify.priors.Yv.std: missing"),
        ("states =", "values = { Yv = 'x' }\nstates =", "model.values.Yv.value: must be a valid n"),
        ("states =", "values = { Yv = { valu = 1 } }\nstates =", "model.values.Yv.valu: unknown k"),
        ("logs =", "window = [9, 3]\nlogs =", "trial[0].window: [9, 3] runs backwards; write [lo"),
        ("logs =", "window = [1, 2, 3]\nlogs =", "trial[0].window: too long, got [1, 2, 3]"),
    ],
)
def test_a_wrong_value_is_named_by_its_full_key(
    folder: Path, old: str, new: str, message: str
) -> None:
    assert refusal(short(folder, old, new)).startswith(message)


def test_candidates_are_a_word_or_a_list(folder: Path) -> None:
    text = SHORT + '[diagnose]\ncandidates = "al"\n'
    assert refusal(written(folder, text)) == (
        'diagnose.candidates: must be "all", "none" or a list of effects, got \'al\' '
        "(did you mean 'all'?)"
    )


def test_more_mistakes_are_counted(folder: Path) -> None:
    text = SHORT.replace("positive", "positiv").replace("outputs =", "output =")
    # Two misspelt keys, and the `outputs` that is missing for it.
    assert refusal(written(folder, text)).endswith("(and 2 more)")


# --- contradictions -----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("delta =", "dleta =", "trial[0].signals.dleta: unknown quantity; did you mean 'delta'?"),
        ("delta =", "rudder =", "trial[0].signals.rudder: unknown quantity; did you mean 'delta'?"),
        (', positive = "port"', "", "trial[0].signals.delta.positive: missing; write the side"),
        ("r = {", "u = {", "trial[0].signals.u.unit: unit 'deg/min' cannot become 'm/s'; units "),
        ("deg/min", "deg/mn", "trial[0].signals.r.unit: unit 'deg/mn' is not known (did you mean "),
        ("deg/min", "deg//s", "trial[0].signals.r.unit: 'deg//s' is not a unit; write it like "),
        ("deg/min", "", "trial[0].signals.r.unit: '' is not a unit; write it like "),
        ('["r", "phi"]', '["r", "fi"]', "identify.outputs[1]: unknown quantity 'fi'; "),
        ('["r", "phi"]', '["r", "r"]', "identify.outputs: 'r' stands there 2 times"),
        ('["Yv", "Nr"]', '["Yv", "Yv"]', "identify.free: 'Yv' stands there 2 times; once is "),
        ('["linear_hull"]', '["a", "a"]', "model.effects: 'a' stands there 2 times"),
        ("logs =", 'use = "check"\nlogs =', "trial: no trial to fit; at least one must have use"),
        ("free =", "weights = { p = 1 }\nfree =", "identify.weights.p: not one of identify.outpu"),
    ],
)
def test_a_contradiction_is_named_by_its_full_key(
    folder: Path, old: str, new: str, message: str
) -> None:
    assert refusal(short(folder, old, new)).startswith(message)


def test_noise_belongs_to_an_output(folder: Path) -> None:
    message = refusal(written(folder, SHORT + "[diagnose]\nnoise = { ph = 0.1 }\n"))
    assert message == "diagnose.noise.ph: not one of identify.outputs; did you mean 'phi'?"


def test_only_what_has_sides_can_be_positive_to_one(folder: Path) -> None:
    text = FULL.replace('unit = "kn"', 'unit = "kn", positive = "port"')
    message = refusal(written(folder, text))
    assert message.startswith("signals.u.positive: 'u' has no port or starboard (surge speed")


def test_trial_names_are_unique(folder: Path) -> None:
    message = refusal(written(folder, FULL.replace('name = "second"', 'name = "first"')))
    assert message == "trial[1].name: 'first' is already the name of trial[0]"


def test_a_quiet_stretch_lies_in_a_trial(folder: Path) -> None:
    message = refusal(written(folder, FULL.replace('trial = "first"', 'trial = "fist"')))
    assert message == "diagnose.quiet[0].trial: no trial 'fist'; did you mean 'first'?"
    message = refusal(written(folder, FULL.replace("[0.0, 30.0]", "[30.0, 0.0]")))
    assert message.startswith("diagnose.quiet[0].window: [30, 0] runs backwards")


def test_an_error_is_one_line_whatever_the_key(folder: Path) -> None:
    assert "unknown key" in refusal(short(folder, "ship =", '"two\\nlines" = 1\nship ='))


def test_every_section_forbids_unknown_keys() -> None:
    sections: list[type[pydantic.BaseModel]] = [Pipeline]
    while sections:
        section = sections.pop()
        assert section.model_config["extra"] == "forbid"
        assert section.model_config["frozen"] is True
        sections += [
            field.annotation
            for field in section.model_fields.values()
            if isinstance(field.annotation, type)
            and issubclass(field.annotation, pydantic.BaseModel)
        ]
