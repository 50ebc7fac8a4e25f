"""What is not stated is assumed, widely, and the file is the ship."""

import math
from dataclasses import replace

import numpy as np
import pytest
from stated_ships import NAVAL, S175, drawn

from trialid.ship.estimate import Given, estimate, hull_form, rudder_and_propeller, sway_yaw
from trialid.ship.estimate.hull_form import complete, typical
from trialid.ship.estimate.ship_text import ship_text
from trialid.ship.particulars import read_ship


def test_what_is_assumed_widens_as_drawn_ships_do():
    """Ratios drawn at random about the typical ones, against the first-order shares."""
    given = Given(length=120.0, speed=8.0)
    made, ratios = estimate(given), typical(120.0)
    rng, values = np.random.default_rng(1), {n: [] for n in ("Yv", "Nr", "m", "Ndelta", "Yvdot")}
    whole = replace(
        given,
        beam=19.2,
        draught=6.86,
        block=0.65,
        rudder_area=20.0,
        rudder_aspect=1.6,
        propeller_diameter=4.1,
    )
    plain = {n: e.share for n, e in estimate(whole).numbers.items()}
    for _ in range(2000):
        factors = {n: math.exp(ratios[n].share * rng.standard_normal()) for n in made.assumed}
        one = hull_form.complete(given, factors)
        masses, Xuu = sway_yaw.added_mass(one), rudder_and_propeller.resistance(one)
        screw = rudder_and_propeller.propeller(one)
        values["Yv"].append(sway_yaw.linear(one)["Yv"].value)
        values["Nr"].append(sway_yaw.linear(one)["Nr"].value)
        values["m"].append(one.m)
        values["Yvdot"].append(masses["Yvdot"].value)
        values["Ndelta"].append(rudder_and_propeller.rudder(one, Xuu, screw)["Ndelta"].value)
    for name, drawn_values in values.items():
        spread = float(np.std(np.log(np.abs(drawn_values))))
        both = math.hypot(spread, plain[name])
        assert made.numbers[name].share == pytest.approx(both, rel=0.2), name


def test_the_more_is_stated_the_surer():
    steps = [
        {"length": 96.5},
        {"beam": 16.2, "draught": 5.2},
        {"block": 0.6},
        {"speed": 8.0},
        {"GM": 1.1},
        {"rudder_area": 9.0},
        {"rudder_aspect": 1.6},
        {"propeller_diameter": 3.3},
    ]
    told, before = {}, None
    for step in steps:
        told |= step
        made = estimate(Given(**told))
        now = {n: e.share for n, e in made.numbers.items()}
        if before is not None:
            assert len(made.assumed) < len(before[0])
            wider = {n for n in now if now[n] > before[1][n] * 1.3 + 0.05}
            assert wider <= {"Xuu"}  # which scatters more the faster she goes
        before = made.assumed, now
    assert made.assumed == ("k/CB",)


def test_a_displacement_stands_for_the_side_that_is_missing():
    whole = complete(S175)
    for name in ("beam", "draught"):
        one = complete(replace(S175, **{name: None}, block=whole.block))
        assert pytest.approx((whole.B, whole.T)) == (one.B, one.T)
    none = complete(replace(S175, beam=None, draught=None))
    assert none.volume == pytest.approx(21222.0)
    assert pytest.approx(typical(175.0)["B/T"].value) == none.B / none.T


@pytest.mark.parametrize("given", [S175, NAVAL, Given(length=3.0), drawn(3)])
def test_the_file_is_the_ship(given, tmp_path):
    made = estimate(given, 'called "her" \\ so')
    path = tmp_path / "ship.toml"
    path.write_text(ship_text(made), encoding="utf-8")
    assert read_ship(path) == made.ship


def test_every_number_of_the_file_has_its_source_and_its_scatter():
    made = estimate(Given(length=96.5, beam=16.2, draught=5.2))
    text = ship_text(made)
    for name, found in made.numbers.items():
        line = next(x for x in text.splitlines() if x.startswith(f"{name} = ") and "#" in x)
        comment = line.partition("#")[2]
        assert found.source in comment
        assert len(found.source) > 3
        assert (f"+-{100.0 * found.share:.3g} %" in comment) == (found.share > 0.0)
        assert made.ship.uncertainty[name] == found.share
    assert text.count("ASSUMED:") == len(made.assumed)
    for name in ("L", "B", "T"):
        assert next(x for x in text.splitlines() if x.startswith(f"{name} = ")).endswith("stated")
