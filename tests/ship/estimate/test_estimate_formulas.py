"""Formulas against theory and published numbers, and in their dimensions."""

import math
from dataclasses import replace

import numpy as np
import pytest
from published import SHIPS
from stated_ships import NAVAL, S175, drawn

from trialid.design.helm import vessel
from trialid.design.search import natural_roll
from trialid.effects import CATALOGUE
from trialid.pipeline_file import load
from trialid.pipeline_file.design_file import load_design
from trialid.ship.estimate import Given, estimate, rudder_and_propeller, sway_yaw
from trialid.ship.estimate.hull_form import HullForm, complete
from trialid.ship.estimate.hydrostatics import buoyancy_height, metacentric_radius
from trialid.ship.estimate.impossible import complaints
from trialid.ship.model import ShipModel
from trialid.ship.motion import check_mass

ROOT = SHIPS.parents[1]


def form(**changes) -> HullForm:
    return replace(complete(S175), **changes)


def test_a_thin_hull_is_a_flat_plate():
    """Slender-body theory (Jones 1946) of a plate of draught T, which Clarke corrects for beam."""
    thin = form(L=1.0, B=1e-6, T=1e-4)
    plate = math.pi * thin.T**2
    known = {"Yvdot": -1.0, "Nrdot": -1.0 / 12.0, "Yv": -1.0, "Yr": 0.5, "Nv": -0.5, "Nr": -0.25}
    found = {**sway_yaw.added_mass(thin), **sway_yaw.linear(thin)}
    for name, of_plate in known.items():
        assert found[name].value == pytest.approx(of_plate * plate, rel=1e-2), name


@pytest.mark.parametrize(
    "hull",
    [{}, {"L": 320.0, "B": 58.0, "T": 20.8, "block": 0.81}, {"B": 23.17, "T": 7.46, "L": 160.93}],
    ids=["S-175", "KVLCC2", "Mariner"],
)
def test_another_papers_formulas_say_the_same_of_ordinary_ships(hull):
    """Kijima et al. (1990), k = 2 T/L, over L d: pi k/2 + 1.4 C_B B/L, k, and -0.54 k + k^2."""
    ship = form(**hull)
    k, slim = 2.0 * ship.T / ship.L, ship.T / ship.L
    kijima = {
        "Yv": -(0.5 * math.pi * k + 1.4 * ship.block * ship.B / ship.L),
        "Nv": -k,
        "Nr": -0.54 * k + k**2,
    }
    found = sway_yaw.linear(ship)
    for name, value in kijima.items():
        assert found[name].value / slim == pytest.approx(value, rel=0.08), name


def test_the_rudder_of_the_kvlcc2():
    """f_alpha = 2.747 in Yasukawa & Yoshimura (2015), aspect ratio 1.827."""
    assert rudder_and_propeller.normal_force_slope(1.827) == pytest.approx(2.747, abs=5e-4)


def test_a_canal_ship_as_others_have_reckoned_her():
    """GMS1, 110 m, C_B 0.9: Yoshimura's formulas and a_H as printed with her, over L d."""
    ship = form(L=110.0, B=11.45, T=1.631, block=0.9)
    found, slim = sway_yaw.cubic(ship), ship.T / ship.L
    known = {"Nvvv": -0.039, "Nvvr": -0.614, "Nrrr": -0.0326}
    for name, value in known.items():
        assert found[name].value / slim == pytest.approx(value, rel=0.01), name
    Xuu, screw = rudder_and_propeller.resistance(ship), rudder_and_propeller.propeller(ship)
    assert rudder_and_propeller.rudder(ship, Xuu, screw)["a_H"].value == pytest.approx(0.4113)


def test_a_barge_floats_as_a_box():
    """KB half the draught, BM = B^2 / 12 T, exactly so for a box."""
    assert buoyancy_height(3.0, 1.0) == pytest.approx(1.5)
    assert metacentric_radius(12.0, 3.0, 1.0) == pytest.approx(12.0**2 / 36.0, rel=0.05)


def test_a_ship_whose_metacentre_is_known():
    """S-175: KM 10.39 m, KB 4.615 m."""
    ship = complete(S175)
    KB = buoyancy_height(ship.T, ship.block)
    assert pytest.approx(4.615, rel=0.06) == KB
    assert KB + ship.metacentric_radius == pytest.approx(10.39, rel=0.06)


@pytest.mark.parametrize(("given", "seconds"), [(S175, 28.8), (NAVAL, 5.50)])
def test_the_roll_period_is_the_published_one_within_its_scatter(given, seconds):
    """With sway, yaw and heel coupled: 28.8 s of S-175, 5.50 s of the naval vessel."""
    made = estimate(given)
    effects = tuple(CATALOGUE[e] for e in ("linear_hull", "linear_roll", "heel_roll", "heel_sway"))
    model = ShipModel(made.ship, ("v", "p", "r", "phi"), (*effects, CATALOGUE["linear_rudder"]))
    found = natural_roll(vessel(model, 0.1, {"u": given.speed}, 0.1))
    half = 0.5 * made.numbers["I_xx"].share
    assert abs(math.log(2.0 * math.pi / found / seconds)) < 2.0 * half


def test_a_stated_roll_period_is_kept():
    told = estimate(replace(S175, roll_period=30.0)).ship
    L, rho, g, nabla = (told.particulars[n] for n in ("L", "rho", "g", "nabla"))
    inertia = 0.5 * rho * L**5 * (told.mass["I_xx"] - told.mass["Kpdot"])
    stiffness = rho * g * nabla * told.coefficients["GM"]
    assert 2.0 * math.pi * math.sqrt(inertia / stiffness) == pytest.approx(30.0, rel=1e-3)
    by_period = estimate(replace(S175, GM=None, roll_period=30.0)).form
    assert complete(replace(S175, GM=by_period.GM)).roll_radius == pytest.approx(
        30.0 * math.sqrt(9.81 * by_period.GM) / (2.0 * math.pi)
    )


def test_a_model_has_the_numbers_of_her_ship():
    """By Froude's law; what knows of viscosity or of metres (the code's roll period) apart."""
    scale = 1.0 / 49.0
    given = replace(
        S175,
        length=175.0 * scale,
        beam=25.4 * scale,
        draught=8.5 * scale,
        GM=0.3 * scale,
        displacement=21222.0 * 1000.0 * scale**3,
        speed=7.33 * scale**0.5,
        rho=1000.0,
        rudder_area=33.0376 * scale**2,
        propeller_diameter=6.533 * scale,
        roll_period=7.0 * 0.6,
    )
    small = estimate(given).ship
    large = estimate(replace(S175, roll_period=7.0 * 0.6 / scale**0.5)).ship
    metres = {"GM", "GM3", "D_P"}
    for name, value in {**large.mass, **large.coefficients}.items():
        if name in {"Xuu", "Ydelta", "Ndelta", "Kdelta", "Xdd", "A_R", "Kp0"}:
            continue
        there = {**small.mass, **small.coefficients}[name]
        assert there == pytest.approx(value * (scale if name in metres else 1.0), rel=2e-3), name
    # N m s: a mass times a length squared over a time
    ratio = small.coefficients["Kp0"] / large.coefficients["Kp0"] * 1025.0 / 1000.0
    assert ratio == pytest.approx(scale**4.5, rel=1e-3)
    assert small.coefficients["A_R"] == pytest.approx(33.0376 * scale**2, rel=1e-3)


BRAKES = (
    "Xudot Yvdot Kpdot Nrdot Xuu Yv Nv Nr Kp Kp0 Kpap Yvav Yvar Yvvv Yvrr Nvvr Nrrr Nrar Nrav Xdd "
    "Yphi Nphi Kphi Ydelta"
)
POSITIVE = "m I_xx I_zz GM GM3 Ndelta Kdelta Kv Kvdot Ypdot Yr Xvrm C_D D_P KT0 t_P w_P"


@pytest.mark.parametrize("seed", range(25))
def test_signs_and_ranges_are_those_of_ships(seed):
    """Drag brakes, a starboard rudder turns to starboard and heels to port, the water resists."""
    given = drawn(seed)
    assert complaints(given) == ()
    numbers = estimate(given).numbers
    assert [n for n in BRAKES.split() if numbers[n].value >= 0.0] == []
    assert [n for n in POSITIVE.split() if numbers[n].value <= 0.0] == []
    for effect in CATALOGUE.values():
        for name, p in effect.parameters.items():
            if name in numbers:
                assert p.low <= numbers[name].value <= p.high, name


@pytest.mark.parametrize("seed", range(25))
def test_masses_can_be_inverted_whatever_the_hull(seed):
    """A raft, a fin, a full barge and a needle too."""
    rng = np.random.default_rng(seed)
    B = 10.0 / rng.uniform(1.2, 30.0)
    given = Given(
        length=10.0,
        beam=B,
        draught=B / rng.uniform(0.5, 20.0),
        block=rng.uniform(0.15, 1.0),
        GM=B * rng.uniform(0.001, 0.1),
    )
    ship = estimate(given).ship
    model = ShipModel(ship, ("v", "p", "r", "phi"), (CATALOGUE["linear_hull"],))
    check_mass(
        model, {n: model.value(n) for n in ship.mass} | {"z_G": 0.0, "Krdot": 0.0, "Npdot": 0.0}
    )


@pytest.mark.parametrize("path", sorted((ROOT / "pipelines").glob("*.toml")), ids=lambda p: p.stem)
def test_every_parameter_of_the_shipped_pipelines_is_there(path):
    read = load_design(path) if path.stem.startswith("design") else load(path)
    effects = tuple(CATALOGUE[e] for e in read.model.effects)
    model = ShipModel(estimate(S175).ship, read.model.states, effects)
    assert [n for n in model.parameters if model.stated(n) is None] == []
