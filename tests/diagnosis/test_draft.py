"""A drafted effect file runs as it is, and the error falls with it."""

import json
import shutil
from pathlib import Path

import pytest
from click.testing import CliRunner
from hidden_force import FIT, fit_of, rudder_in_heel

from trialid.cli.main import commands
from trialid.diagnosis.force.draft import draft, why_none
from trialid.diagnosis.force.missing_force import missing_force
from trialid.effects import from_file
from trialid.identification.fit import identify
from trialid.identification.problem import replace
from trialid.result.force_series import force_series, read_force_csv, write_force_csv

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def sample(tmp_path_factory):
    """The shipped pipeline in a folder of its own, with no catalogue to search."""
    folder = tmp_path_factory.mktemp("draft")
    for name in ("pipelines", "sample_data"):
        shutil.copytree(ROOT / name, folder / name)
    path = folder / "pipelines" / "hidden_effect.toml"
    text = path.read_text(encoding="utf-8").replace('candidates = "all"', 'candidates = "none"')
    path.write_text(text, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def hidden():
    """A fit that lacks an effect, and the force that it lacks."""
    fit, _ = fit_of(rudder_in_heel, 7)
    return fit, missing_force(fit)


def run(pipeline, *options):
    return CliRunner().invoke(commands, ["run", str(pipeline), *map(str, options)])


@pytest.mark.study(turn=5)
def test_the_file_declares_the_effect_and_the_error_falls(hidden, tmp_path):
    fit, found = hidden
    path = tmp_path / "mine.py"
    path.write_text(draft(found, 'a "quoted" name'), encoding="utf-8")
    [made] = from_file(path).values()
    assert made.name == "missing_yaw"
    free = (*FIT.free, *made.parameters)
    start = {n: p.start for n, p in made.parameters.items()}
    model = (fit.model + made).with_values(start)
    after = identify([s.trial for s in fit.scores], model, replace(fit.settings, free=free))
    fall = 1.0 - (after.eps_rmsn / fit.eps_rmsn) ** 2
    assert fall > 0.8 * found.equation("N").shape.explains
    for name, parameter in made.parameters.items():
        assert parameter.low < after.value(name) < parameter.high


@pytest.mark.study
def test_an_effect_of_the_same_name_gets_another(hidden):
    _, found = hidden
    taken = replace(
        found,
        effects=(*found.effects, "missing_yaw"),
        parameters=(*found.parameters, "N_delta_aphi"),
    )
    text = draft(taken, "again")
    assert "def missing_yaw_2(" in text
    assert "N_delta_aphi_2=Parameter(" in text


@pytest.mark.study(turn=2)
def test_nothing_missing_and_no_shape_draft_nothing():
    nothing = missing_force(fit_of(None, 8)[0])
    assert draft(nothing, "x") is None
    assert "nothing to draft: no force in any equation" in why_none(nothing)
    shapeless = missing_force(fit_of("N", 3)[0])
    assert draft(shapeless, "x") is None
    assert "follows no signal" in why_none(shapeless)
    assert "\n" not in why_none(nothing) + why_none(shapeless)


@pytest.mark.study(turn=4)
def test_series_are_read_as_written(hidden, tmp_path):
    series = force_series(hidden[1])
    write_force_csv(tmp_path / "missing_force.csv", series)
    again = read_force_csv(tmp_path / "missing_force.csv")
    assert [s.trial for s in again] == [s.trial for s in series]
    for one, other in zip(series, again, strict=True):
        for part in ("force", "error", "terms", "signals"):
            mine, read = getattr(one, part), getattr(other, part)
            assert mine.keys() == read.keys()
            for name, values in mine.items():
                assert (values == read[name]).all(), (part, name)


@pytest.mark.study(turn=7)
def test_run_drafts_what_the_pipeline_then_runs_with(sample, tmp_path):
    file = sample.parent / "mine.py"
    before = run(sample, "--out", tmp_path / "before", "--draft", file)
    assert before.exit_code == 0, before.output
    assert f"Draft: {file}" in before.output
    first = json.loads((tmp_path / "before" / "result.json").read_text(encoding="utf-8"))
    assert first["verdict"]["kind"] == "not in catalogue"
    assert first["missing_force"]["named"] == "K"
    assert (tmp_path / "before" / "missing_force.csv").is_file()
    page = (tmp_path / "before" / "report.html").read_text(encoding="utf-8")
    assert 'id="missing-force"' in page
    [made] = from_file(file).values()
    text = sample.read_text(encoding="utf-8")
    text = text.replace("effects = [", f'effects_from = ["mine.py"]\neffects = [\n  "{made.name}",')
    drafted = "".join(f'"{name}", ' for name in made.parameters)
    text = text.replace("free     = [", f"free     = [{drafted}")
    (sample.parent / "with_mine.toml").write_text(text, encoding="utf-8")
    after = run(sample.parent / "with_mine.toml", "--out", tmp_path / "after", "--quiet")
    assert after.exit_code == 0, after.output
    second = json.loads((tmp_path / "after" / "result.json").read_text(encoding="utf-8"))
    assert second["fit"]["eps_rmsn"] < 0.85 * first["fit"]["eps_rmsn"]
    assert second["fit"]["eps_rmsn_check"] < 0.85 * first["fit"]["eps_rmsn_check"]


@pytest.mark.parametrize(
    ("name", "complaint"),
    [("there.py", "exists"), ("mine.txt", "ends in .py"), ("no/mine.py", "there is no folder")],
)
def test_a_place_that_cannot_be_is_refused_before_the_work(sample, tmp_path, name, complaint):
    (tmp_path / "there.py").write_text("kept", encoding="utf-8")
    answer = run(sample, "--out", tmp_path / "out", "--draft", tmp_path / name)
    assert answer.exit_code == 2
    assert complaint in answer.output
    assert len(answer.output.strip().splitlines()) == 1
    assert (tmp_path / "there.py").read_text(encoding="utf-8") == "kept"
    assert not (tmp_path / "out").exists()
