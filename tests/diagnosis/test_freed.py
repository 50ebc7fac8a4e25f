"""Coefficients held fixed are candidates: what is in the model can be wrong too."""

import math
from pathlib import Path

import pytest
import s175q
from click.testing import CliRunner

import trialid as ti
from trialid.cli.main import commands
from trialid.diagnosis.search.freed import candidates_to_free, free_coefficient
from trialid.names.quantities import MASS_PARAMETERS
from trialid.report.pages.page import HELD, heading
from trialid.report.words.advice import advice
from trialid.ship.model import STATES, ShipModel
from trialid.ship.particulars import read_ship

TEXT = (s175q.ROOT / "pipelines" / "hidden_effect.toml").read_text(encoding="utf-8")
SHIP = read_ship(s175q.ROOT / "sample_data" / "ships" / "s175q.toml")


def written(folder: Path, **held: float) -> Path:
    """The sample with its effect in the model and coefficients held at so many times theirs."""
    text = TEXT.replace("../sample_data", str(s175q.ROOT / "sample_data"))
    text = text.replace('"roll_drag_var",', '"roll_drag_var", "righting_arm_cubic",')
    text = text.replace('"Nrar"]', '"Nrar", "GM3"]')
    lines = [f"{n} = {times * SHIP.coefficients[n]!r}" for n, times in held.items()]
    for name in held:
        text = text.replace(f'"{name}", ', "")
    text = text.replace("[identify]", "\n".join(["[model.values]", *lines, "", "[identify]"]))
    path = folder / "held.toml"
    path.write_text(text, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def wrong(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The rudder's heeling moment held at 0.88 times the true one."""
    return written(tmp_path_factory.mktemp("held"), Kdelta=0.88)


@pytest.fixture(scope="module")
def run(wrong: Path):
    return ti.run(wrong)


def test_what_is_held_wrong_is_named_and_said(run) -> None:
    verdict = run.result.verdict
    assert (verdict.kind, verdict.effect) == ("missing", "Kdelta")
    assert verdict.sentence.startswith(
        "Kdelta is held at 8.67e-05; freed, it is 9.9e-05 and the error"
    )
    row = run.result.missing[0]
    assert row.held == pytest.approx(0.88 * SHIP.coefficients["Kdelta"])
    assert row.equation.startswith("Kdelta of linear_rudder: ")
    refitted = row.parameters["Kdelta"].refitted
    assert refitted == pytest.approx(SHIP.coefficients["Kdelta"], rel=0.02)
    assert heading(run.result) == HELD
    told = " ".join(one.words for one in advice(run.result))
    assert "Free the coefficient in the pipeline" in told
    assert "Read what it stands for" not in told


@pytest.mark.study(turn=15)
def test_added_it_is_free_and_dropped_the_file_is_as_it_was(run, wrong: Path) -> None:
    before = wrong.read_bytes()
    done = CliRunner().invoke(commands, ["add", str(wrong), "Kdelta"])
    assert done.exit_code == 0, done.output
    assert "free + Kdelta" in done.output
    assert "effects + Kdelta" not in done.output
    text = wrong.read_text(encoding="utf-8")
    assert '"GM3", "Kdelta"]' in text.partition("[identify]")[2]
    assert '"Kdelta"' not in text.partition("[identify]")[0]
    better = ti.run(wrong).result
    assert better.fit.eps_rmsn < 0.85 * run.result.fit.eps_rmsn
    [found] = [p for p in better.physical if p.name == "Kdelta"]
    assert found.likely[0] < SHIP.coefficients["Kdelta"] < found.likely[1]
    assert CliRunner().invoke(commands, ["drop", str(wrong), "Kdelta"]).exit_code == 0
    assert wrong.read_bytes() == before


def test_masses_and_what_is_sought_are_no_candidates(run) -> None:
    fit = run.fit
    found = candidates_to_free(fit)
    assert "Kdelta" in found
    assert not {*MASS_PARAMETERS, *fit.settings.free} & {*found}
    assert all(name in fit.model.parameters for name in found)


def test_a_coefficient_of_the_ships_file_keeps_its_sign() -> None:
    effects = (ti.CATALOGUE["linear_hull"], ti.CATALOGUE["rudder_offset"])
    model = ShipModel(SHIP, STATES, effects).with_values({"delta_0": 0.01})
    freed = {n: free_coefficient(model, n).parameters[n] for n in ("Yv", "Nr", "Kv", "delta_0")}
    assert [SHIP.coefficients[n] > 0.0 for n in ("Yv", "Nr", "Kv")] == [False, False, True]
    assert (freed["Yv"].low, freed["Yv"].high) == (-math.inf, 0.0)
    assert freed["Nr"].high == 0.0
    assert (freed["Kv"].low, freed["Kv"].high) == (0.0, math.inf)
    assert freed["delta_0"].low < 0.0 < freed["delta_0"].high  # no file states it


def test_it_begins_where_it_is_held_and_keeps_the_effects_own_range() -> None:
    model = ShipModel(SHIP, STATES, (ti.CATALOGUE["linear_roll"],))
    effect = free_coefficient(model, "Kp")
    value, parameter = SHIP.coefficients["Kp"], effect.parameters["Kp"]
    assert (effect.held, parameter.null, parameter.start) == (value, value, value)
    assert (parameter.low, parameter.high) == (-math.inf, 0.0)
    assert model + effect is model
    signals = dict.fromkeys(effect.signals, 1.0)
    [twice], [once] = (effect({**signals, "Kp": times * value}) for times in (2.0, 1.0))
    assert pytest.approx(value) == twice.K - once.K
