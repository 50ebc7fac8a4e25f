"""The workflow from Python: what `import trialid` gives, and the same numbers as the command."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from click.testing import CliRunner

import trialid as ti
from trialid.cli.main import commands
from trialid.errors import AlignmentError, TrialidError
from trialid.result.json_file import plain

ROOT = Path(__file__).parent.parent
PIPELINE = ROOT / "pipelines" / "hidden_effect.toml"
EFFECT = "righting_arm_cubic"
UNITS = {"delta": "deg", "r": "deg/s", "phi": "deg", "u": "kn"}
TO_SHOWN = {"delta": 180 / np.pi, "r": 180 / np.pi, "phi": 180 / np.pi, "u": 3600 / 1852}


def command(*words: str) -> dict:
    done = CliRunner().invoke(commands, [*words, "--json", "--quiet"])
    assert done.exit_code == 0, done.output
    return json.loads(done.stdout)


@pytest.fixture(scope="module")
def run():
    return ti.run(PIPELINE)


@pytest.fixture(scope="module")
def better(run):
    return run.add(EFFECT)


@pytest.fixture(scope="module")
def copy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The pipeline where a command may change it, with its logs and ship."""
    folder = tmp_path_factory.mktemp("copy")
    (folder / "sample_data").symlink_to(ROOT / "sample_data")
    (folder / "pipelines").mkdir()
    path = folder / "pipelines" / PIPELINE.name
    path.write_bytes(PIPELINE.read_bytes())
    return path


def same(found, told) -> bool:
    """Whether a result of Python's is that of the command, digit for digit."""
    return json.loads(json.dumps(plain(found))) == told


def test_the_names_are_the_workflow_and_all_can_be_had() -> None:
    for name in ti.__all__:
        assert getattr(ti, name) is not None
    assert {"read", "align", "Trial", "read_ship", "ShipModel", "effect", "Force", "Parameter",
            "CATALOGUE", "identify", "diagnose", "run", "simulate", "Fit", "Result"} <= {
        *ti.__all__}  # fmt: skip
    assert set(ti.__all__) <= set(dir(ti))
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        _ = ti.nothing


def test_nothing_heavy_comes_before_it_is_asked_for() -> None:
    code = "import sys, trialid; print(sorted({'numpy', 'scipy', 'pandas'} & {*sys.modules}))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


@pytest.mark.study(turn=12)
def test_a_run_is_the_commands_digit_for_digit(run, sample_run: Path) -> None:
    assert same(run.result, json.loads((sample_run / "result.json").read_text(encoding="utf-8")))


@pytest.mark.study(turn=15)
def test_an_added_effect_is_the_commands_digit_for_digit(better, copy, tmp_path: Path) -> None:
    told = command("add", str(copy), EFFECT, "--out", str(tmp_path / "added"))
    found = json.loads(json.dumps(plain(better.result)))
    for part in ("fit", "split", "accuracy", "missing", "verdict", "change"):
        assert found[part] == told[part], part


@pytest.mark.study(turn=12)
def test_add_and_drop_write_nothing_and_undo_one_another(run, better) -> None:
    assert EFFECT not in PIPELINE.read_text(encoding="utf-8")
    assert not PIPELINE.with_name("hidden_effect.history.jsonl").exists()
    assert better.error < 0.8 * run.error
    assert better.drop(EFFECT).error == pytest.approx(run.error, rel=1e-6)


def test_the_tables_hold_what_the_result_holds(run) -> None:
    row = run.parameters.loc["GM"]
    said = next(p for p in run.result.physical if p.name == "GM")
    assert (row["value"], row["standard_error"]) == (said.value, said.standard_error)
    assert run.ranking.loc[1, "effect"] == run.verdict.effect == EFFECT
    assert len(run.ranking) == len(run.result.missing)
    assert run.history["step"].tolist() == ["as written", "proposed"]
    assert [t.name for t in run.trials] == [t.name for t in run.result.trials]


@pytest.mark.study(turn=3)
def test_two_runs_compared(run, better) -> None:
    table = better.compare(run)
    assert table.loc["error, fitted", "this"] == better.error
    assert table.loc["error, fitted", "other"] == run.error
    assert table.loc["GM", "apart"] > 10.0
    assert np.isnan(table.loc["GM3", "other"])


def test_a_run_shows_itself_offline(run) -> None:
    card = run._repr_html_()
    assert "An effect is missing" in card
    assert EFFECT in card
    assert all(f">{name}</td>" in card for name in run.parameters.index)
    assert "<script" not in card
    assert "src=" not in card
    assert 'href="http' not in card


def test_a_plot_is_of_the_series_and_is_saved_once(run, tmp_path: Path) -> None:
    drawn = run.plot("phi")
    assert drawn._repr_html_().count("<path") == 3 * len(run.trials)
    assert drawn.save(tmp_path / "phi.svg").read_text(encoding="utf-8") == drawn.svg
    with pytest.raises(TrialidError, match="exists; name another"):
        drawn.save(tmp_path / "phi.svg")
    with pytest.raises(TrialidError, match="no output 'psi' was compared"):
        run.plot("psi")


def test_a_run_is_written_as_the_command_writes_it(run, sample_run: Path, tmp_path: Path) -> None:
    report = run.write(tmp_path / "here")
    assert report.read_bytes() == (sample_run / "report.html").read_bytes()


@pytest.mark.skipif(sys.platform != "linux", reason="a place that nobody can write into")
def test_a_place_that_cannot_be_written_is_said(run):
    with pytest.raises(TrialidError, match=r"/proc/x: cannot be written .*choose another"):
        run.write("/proc/x")


# --- without any file


def frames(run) -> list[tuple[str, str, pd.DataFrame]]:
    """The trials as somebody's tables, in the units people log."""
    return [
        (
            t.name,
            t.use,
            pd.DataFrame(
                {"t": t.t, **{n: t.signals[n] * TO_SHOWN[n] for n in UNITS if n in t.signals}}
            ),
        )
        for t in run.trials
    ]


@pytest.fixture(scope="module")
def trials(run) -> list[ti.Trial]:
    side = {"delta": "starboard"}
    return [
        ti.Trial.from_frame(name, frame, units=UNITS, positive=side, use=use)
        for name, use, frame in frames(run)
    ]


@pytest.fixture(scope="module")
def model(run) -> ti.ShipModel:
    ship = ti.read_ship(str(ROOT / "sample_data" / "ships" / "s175q.toml"))
    asked = run.result.model
    return ti.ShipModel(ship, asked.states, tuple(ti.CATALOGUE[e] for e in asked.effects))


@pytest.fixture(scope="module")
def fit(run, trials, model) -> ti.Fit:
    asked = run.result.model
    return ti.identify(
        trials, model, free=asked.free, outputs=asked.outputs, nuisance=asked.nuisance
    )


def test_trials_from_tables_are_those_of_the_pipeline(run, trials) -> None:
    for made, read in zip(trials, run.trials, strict=True):
        assert made.period == pytest.approx(read.period)
        for name in made.signals:
            np.testing.assert_allclose(made.signals[name], read.signals[name], atol=1e-12)


def test_arrays_give_the_pipelines_numbers(run, fit) -> None:
    """Gaps are filled in another way, which moves nothing that is compared by much."""
    assert fit.eps_rmsn == pytest.approx(run.error, rel=1e-4)
    for row in run.result.physical:
        assert abs(fit.value(row.name) - row.value) < 0.05 * row.standard_error


@pytest.mark.study(turn=15)
def test_a_fit_from_arrays_is_diagnosed_and_grows(fit) -> None:
    found = ti.diagnose(fit, name="arrays")
    assert (found.verdict.kind, found.verdict.effect) == ("missing", EFFECT)
    grown = found.add(EFFECT)
    assert grown.verdict.kind == "nothing missing"
    assert "arrays" in grown._repr_html_()
    with pytest.raises(TrialidError, match="in the model already"):
        grown.add(EFFECT)
    with pytest.raises(TrialidError, match="is not in the model"):
        found.drop(EFFECT)


def test_identify_has_the_safeguard_against_coarse_steps(trials, model) -> None:
    """A record sampled so coarsely that the integration would err takes finer steps by itself."""
    coarse = [
        ti.Trial.from_arrays(
            t.name, t.t[::8], {n: y[::8] for n, y in t.signals.items() if n in UNITS},
            units={"delta": "rad", "r": "rad/s", "phi": "rad", "u": "m/s"},
            positive={"delta": "starboard"}, use=t.use,
        )
        for t in trials
    ]  # fmt: skip
    free = ["Yv", "Nv", "Nr", "Ndelta", "Kp", "GM"]
    found = ti.identify(coarse, model, free=free, outputs=["r", "phi"])
    assert found.settings.substeps > 1


def test_a_simulation_is_that_of_the_fit(fit, trials) -> None:
    made = ti.simulate(fit, trials[0])
    assert list(made.columns) == ["r", "phi"]
    np.testing.assert_array_equal(made.to_numpy(), fit.scores[0].response.y)


def test_a_model_is_simulated_without_a_fit(model, trials) -> None:
    made = ti.simulate(model, trials[0], outputs=("r", "v"))
    again = ti.simulate(model, trials[0], outputs=("r", "v"), start={"r": 0.01})
    assert made.index.name == "t"
    assert again["r"].iloc[0] == pytest.approx(0.01)
    assert made["r"].iloc[0] != pytest.approx(0.01)


def arrays(**change):
    t = np.arange(50) * 0.5
    given = {
        "t": t, "signals": {"delta": np.sin(t), "r": np.cos(t)},
        "units": {"delta": "deg", "r": "deg/s"}, "positive": {"delta": "port"},
    }  # fmt: skip
    return ti.Trial.from_arrays("mine", **(given | change))


def test_sides_and_units_become_ours() -> None:
    made = arrays()
    t = np.arange(50) * 0.5
    np.testing.assert_allclose(made.signals["delta"], -np.radians(np.sin(t)), atol=1e-15)
    np.testing.assert_allclose(made.signals["r"], np.radians(np.cos(t)), atol=1e-15)
    assert made.period == 0.5


def test_what_was_not_measured_is_masked() -> None:
    y = np.arange(50.0)
    y[10:13] = np.nan
    made = arrays(signals={"r": y, "delta": y})
    assert not made.valid["r"][10:13].any()
    assert made.valid["r"].sum() == 47
    np.testing.assert_allclose(np.degrees(made.signals["r"][9:14]), [9, 10, 11, 12, 13])


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"t": np.r_[np.arange(49) * 0.5, 30.0]}, "t is not uniform"),
        ({"t": -np.arange(50.0)}, "t runs backwards"),
        ({"t": np.full(50, np.nan)}, "finite times"),
        ({"signals": {"r": np.zeros(49)}}, "49 values for 50 times"),
        ({"signals": {"rudder": np.zeros(50)}}, "no signal 'rudder'"),
        ({"units": {"delta": "deg"}}, "the unit of 'r' is not stated"),
        ({"units": {"delta": "deg", "r": "m"}}, "cannot become"),
        ({"positive": {}}, "the sign of a rudder is never guessed"),
        ({"signals": {"r": np.full(50, np.nan)}}, "no value is a number"),
    ],
)
def test_what_cannot_be_a_trial_is_one_line(change: dict, said: str) -> None:
    with pytest.raises(TrialidError, match=said):
        arrays(**change)


def test_a_table_by_dates_and_a_column_that_is_not_there() -> None:
    stamps = pd.date_range("2026-01-01", periods=20, freq="500ms")
    frame = pd.DataFrame({"r": np.arange(20.0)}, index=stamps)
    assert ti.Trial.from_frame("a", frame, units={"r": "deg/s"}).period == 0.5
    with pytest.raises(AlignmentError, match="no column 'phi'"):
        ti.Trial.from_frame("a", frame, units={"phi": "deg"})


def test_a_setting_that_is_none_is_one_line(trials, model) -> None:
    with pytest.raises(TrialidError, match="no setting 'start'; did you mean"):
        ti.identify(trials, model, free=["Nr"], outputs=["r"], start=3)
