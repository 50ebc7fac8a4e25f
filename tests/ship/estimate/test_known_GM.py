"""A roll tells the ratio of GM and inertia: who knows GM learns the inertia, and of no other GM."""

from dataclasses import replace
from pathlib import Path

import pytest
from click.testing import CliRunner
from published import published_ships
from sailed_zigzags import fit, sailed

import trialid as ti
from trialid.cli.main import commands
from trialid.report.words.beforehand import contradictions
from trialid.result.fit_rows import ParameterRow
from trialid.ship.estimate import Given, estimate
from trialid.workflow.first_pipeline.pipeline_text import ROLL

ROOT = Path(__file__).parents[3]
INERTIA = ("I_xx", "Kpdot")


@pytest.fixture(scope="module")
def made():
    """A container ship whose GM is known, and her inertia in roll two thirds of what she has."""
    found = sailed(next(ship for ship in published_ships() if ship.name == "S-175"))
    ship, true = found.begun.ship, found.truth.value
    mass = ship.mass | {n: true(n) / 1.5 for n in INERTIA}
    known = {n: true(n) for n in ROLL}
    ship = replace(
        ship,
        mass=mass,
        coefficients={**ship.coefficients, **known},
        uncertainty={**ship.uncertainty, "GM": 0.1, "I_xx": 0.5},
    )
    return replace(found, begun=replace(found.begun, ship=ship))


def test_beside_a_known_GM_the_inertia_is_found(made):
    GM = made.truth.value("GM")
    true = sum(abs(made.truth.value(n)) for n in INERTIA)
    alone, both = fit(made, True), fit(made, True, ("I_xx",))
    assert alone.value("GM") < 0.6 * GM
    assert both.value("GM") == pytest.approx(GM, rel=0.25)  # the hull's numbers are estimates, too
    assert both.eps_rmsn < 0.7 * alone.eps_rmsn
    found = both.value("I_xx") - made.begun.value("Kpdot")
    assert found == pytest.approx(true, rel=0.15)


def test_what_may_be_off_as_far_as_that_is_not_contradicted():
    known = {"prior": (0.0323, 0.0032), "prior_share": 0.01}
    row = ParameterRow(name="GM", value=0.052, likely=(0.028, 0.053), **known)
    [away] = contradictions([row])
    assert away.startswith("The fit ends far from what was known of GM: 0.052")
    assert away.endswith("what was known stands.")
    sure = contradictions([replace(row, likely=(0.045, 0.053))])
    assert sure[0].startswith("The record contradicts what was known of GM: 0.052")
    assert contradictions([replace(row, likely=None)])


@pytest.mark.parametrize(("given", "freed"), [(["--gm", "0.9"], True), ([], False)])
def test_start_frees_the_inertia_where_GM_is_the_surer(given, freed, tmp_path):
    logs = ROOT / "sample_data" / "hidden_effect"
    names = [str(logs / f"{n}.mcap") for n in ("zigzag-10", "zigzag-20")]
    path = tmp_path / "mine.toml"
    asked = ["inspect", *names, "--init", str(path), "--length", "175", *given]
    done = CliRunner().invoke(commands, asked)
    assert done.exit_code == 0, done.output
    text = path.read_text(encoding="utf-8")
    assert ('"GM", "I_xx", "Kvdot", "Ypdot"]' in text) == freed
    assert ("# Kvdot and Ypdot weigh roll moments against GM" in text) == freed
    assert ("# GM is known, and a roll tells its ratio to I_xx" in text) == freed
    assert ti.read_ship(tmp_path / "mine_ship.toml").coefficients.keys() >= {"GM"}


def test_a_short_hull_may_be_a_boat_or_the_model_of_a_ship():
    def radius(length, scale):
        made = estimate(Given(length=length, beam=25.4 * scale, draught=9.5 * scale), "x").ship
        inertia = sum(abs(made.mass.get(n, 0.0)) for n in INERTIA)
        return inertia, made.uncertainty["I_xx"]

    ship, sure = radius(175.0, 1.0)
    model, less = radius(5.0, 5.0 / 175.0)
    assert model / ship == pytest.approx((0.373 + 0.0615 - 0.043) ** 2 / 0.359**2, rel=0.03)
    assert less > sure
