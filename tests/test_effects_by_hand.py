"""Effects of the catalogue against numbers worked out by hand or by another route."""

import math
from pathlib import Path

import numpy as np
import pytest

from trialid.effects import CATALOGUE
from trialid.maths import Number
from trialid.ship.model import STATES, ShipModel
from trialid.ship.motion import derivatives
from trialid.ship.particulars import read_ship
from trialid.ship.readings import readings

SHIP = read_ship(Path(__file__).parent.parent / "sample_data" / "ships" / "s175q.toml")
L, RHO, G, NABLA, T, U0 = (SHIP.particulars[n] for n in ("L", "rho", "g", "nabla", "T", "U0"))
STILL = dict.fromkeys(STATES, 0.0)
MASSES = {n: SHIP.mass.get(n, 0.0) for n in ShipModel(SHIP, ("u",)).parameters}


def rates(name: str, values: dict[str, float], **signals: float) -> dict[str, Number]:
    """Time derivatives of a ship on which this effect alone acts."""
    model = ShipModel(SHIP, STATES, (CATALOGUE[name],))
    theta = MASSES | {n: p.start for n, p in CATALOGUE[name].parameters.items()} | values
    start = STILL | {s: 0.0 for s in model.all_states} | {"u": U0}
    states = {s: signals.get(s, x) for s, x in start.items()}
    inputs = {s: signals.get(s, 0.0) for s in model.recorded}
    return derivatives(model, states, inputs, theta)


def forces(name: str, values: dict[str, float], **signals: float) -> dict[str, float]:
    """Forces [N] and moments [N m] of one effect, by Newton's law from the accelerations."""
    model = ShipModel(SHIP, STATES, (CATALOGUE[name],))
    with_it, without = rates(name, values, **signals), rates(name, nulls(name), **signals)
    d = {s: float(with_it[s] - without[s]) for s in "uvpr"}
    m, half = MASSES, 0.5 * RHO
    assert model.effects[0].forms[0].__name__ == "Force"
    return {
        "X": half * L**3 * (m["m"] - m["Xudot"]) * d["u"],
        "Y": half * (L**3 * (m["m"] - m["Yvdot"]) * d["v"]
                     - L**4 * (m["Ypdot"] * d["p"] + m["Yrdot"] * d["r"])),
        "K": half * (L**5 * (m["I_xx"] - m["Kpdot"]) * d["p"] - L**4 * m["Kvdot"] * d["v"]),
        "N": half * (L**5 * (m["I_zz"] - m["Nrdot"]) * d["r"] - L**4 * m["Nvdot"] * d["v"]),
    }  # fmt: skip


def nulls(name: str) -> dict[str, float]:
    return CATALOGUE[name].nulls


def sensed(name: str, values: dict[str, float], **signals: float) -> dict[str, Number]:
    """What the sensors record of one instant."""
    model = ShipModel(SHIP, STATES, (CATALOGUE[name],))
    theta = MASSES | {n: p.start for n, p in CATALOGUE[name].parameters.items()} | values
    states = {s: signals.get(s, 0.0) for s in model.all_states}
    inputs = {s: signals.get(s, 0.0) for s in model.recorded}
    accelerations = {s: signals.get(f"{s}_dot", 0.0) for s in "uvpr"}
    return readings(model, states, inputs, theta, accelerations).measured


def test_cross_flow_drag_is_the_integral_over_the_hull() -> None:
    """Ten strips against a thousand, in drift, in turning, and in both."""
    x = (np.arange(1000) + 0.5) / 1000 * L - L / 2
    for v, r in ((0.7, 0.0), (0.0, 0.01), (-0.5, 0.012), (0.9, -0.004)):
        w = v + x * r
        Y = -0.5 * RHO * 0.8 * T * float(np.mean(np.abs(w) * w)) * L
        N = -0.5 * RHO * 0.8 * T * float(np.mean(x * np.abs(w) * w)) * L
        found = forces("cross_flow_drag", {"C_D": 0.8}, v=v, r=r)
        size = 0.5 * RHO * 0.8 * T * L * (abs(v) + abs(r) * L / 2) ** 2
        assert found["Y"] == pytest.approx(Y, abs=0.01 * size)
        assert found["N"] == pytest.approx(N, abs=0.01 * size * L)


def test_cross_flow_drag_holds_the_second_order_terms() -> None:
    """Pure drift: Yvav = -C_D T / L; pure turning: Nrar = -C_D T / (32 L), by strips within 2 %."""
    effect, at = CATALOGUE["cross_flow_drag"], {"T": T / L, "C_D": 1.0}
    [(_, Y, _, N)] = effect(at | {"v": 0.3, "r": 0.0})
    assert pytest.approx((-T / L * 0.3**2, 0.0), abs=1e-15) == (Y, N)
    [(_, _, _, N)] = effect(at | {"v": 0.0, "r": 0.5})
    assert pytest.approx(-T / L / 32.0 * 0.5**2, rel=0.021) == N


@pytest.mark.parametrize("name", ["sway_froude", "yaw_froude_v", "yaw_froude_r"])
def test_froude_terms_vanish_at_the_approach_speed_and_grow_with_f(name: str) -> None:
    [p] = CATALOGUE[name].parameters
    row = {"Y": 0.5 * RHO * L**2, "N": 0.5 * RHO * L**3}
    for u in (U0, 5.0, 9.0):
        at = {"v": 0.5} if not name.endswith("_r") else {"r": 0.01}
        U = math.hypot(u, at.get("v", 0.0))
        gain = (u - U0) / math.sqrt(G * L)
        moved = at.get("v", 0.0) / U + at.get("r", 0.0) * L / U
        found = forces(name, {p: 0.02}, u=u, **at)
        for letter in {"sway_froude": "Y"}.get(name, "N"):
            expected = 0.02 * moved * gain * row[letter] * U**2
            assert found[letter] == pytest.approx(expected, rel=1e-6, abs=1.0)


def test_a_righting_arm_that_changes_with_speed() -> None:
    u, phi = 5.0, 0.1
    arm = 2.0 * (u**2 - U0**2) / (G * L) * phi
    found = forces("righting_arm_speed", {"GM_F": 2.0}, u=u, phi=phi)["K"]
    assert found == pytest.approx(-RHO * G * NABLA * arm, rel=1e-6)


def test_the_race_keeps_the_force_on_the_rudder() -> None:
    """With N_slip = Ndelta the force on the rudder goes as u U0, as that of rudder_race does."""
    u, delta, Ndelta = 4.0, 0.3, 0.0015
    base = {"Ydelta": -0.003, "Kdelta": 0.0, "Ndelta": Ndelta}
    steady = forces("linear_rudder", base, u=u, delta=delta)
    more = forces("rudder_slipstream", {"N_slip": Ndelta, "z_slip": 0.0}, u=u, delta=delta)
    race = 0.5 * RHO * L**2 * u * U0 * delta
    assert steady["N"] + more["N"] == pytest.approx(race * L * Ndelta, rel=1e-6)
    assert steady["Y"] + more["Y"] == pytest.approx(race * -0.003, rel=1e-6)
    instead = CATALOGUE["rudder_race"](
        {"u": 1.0, "delta": delta, "U0": U0 / u, "Y_race": -0.003, "K_race": 0.0, "N_race": Ndelta}
    )[0]
    assert instead.N * 0.5 * RHO * L**3 * u**2 == pytest.approx(race * L * Ndelta)


def test_the_race_of_a_shaft_goes_by_its_revolutions() -> None:
    """As rudder_race at revolutions that go with U0; nothing with the shaft stopped or astern."""
    shaft, race = CATALOGUE["rudder_race_shaft"], CATALOGUE["rudder_race"]
    at = {"u": 0.6, "delta": 0.3}
    known = {"Y_race": -0.003, "K_race": 0.0001, "N_race": 0.0015, "U0": 1.4}
    [of_race] = race({**at, **known})
    [of_shaft] = shaft({**at, "n": 140.0, "N_un": 1.5e-5, "N_nn": 0.0, "z_race": 0.0001 / 0.003})
    assert pytest.approx(of_race.N) == of_shaft.N
    assert pytest.approx(of_race.Y) == of_shaft.Y
    assert pytest.approx(of_race.K) == of_shaft.K
    at |= {"N_un": 0.0, "N_nn": 1e-7, "z_race": 0.0}
    [slow], [fast] = (shaft({**at, "n": n}) for n in (60.0, 120.0))
    assert pytest.approx(4.0 * slow.N) == fast.N
    assert all(shaft({**at, "n": n})[0].N == 0.0 for n in (0.0, -60.0))


def test_speed_is_lost_in_a_steady_turn() -> None:
    """The state settles where k (r L)^2 = u u_lost, and then acts as less speed."""
    r, k = 0.008, 5.0
    lost = k * (r * L) ** 2 / U0
    values = {"k_lost": k, "tau_lost": 10.0}
    model = ShipModel(SHIP, ("v", "r"), (CATALOGUE["surge_loss"], CATALOGUE["linear_rudder"]))
    theta = {n: model.value(n) if n in MASSES else 0.0 for n in model.parameters}
    theta |= values | {"Ndelta": 0.0015, "Ydelta": -0.003}
    at = {"v": 0.0, "r": r, "u_lost": lost}
    slow = derivatives(model, at, {"u": U0, "delta": 0.2}, theta)
    assert slow["u_lost"] == pytest.approx(0.0, abs=1e-12)
    # not turning, so that only the rudder's force is left: it goes as the square of the speed
    fast, slower = (
        derivatives(model, at | {"r": 0.0, "u_lost": x}, {"u": U0, "delta": 0.2}, theta)["r"]
        for x in (0.0, lost)
    )
    assert slower / fast == pytest.approx(((U0 - lost) / U0) ** 2)


def test_wind_blows_to_lee_and_heels_the_ship_away_from_it() -> None:
    """From the west, on a northbound ship: to starboard, starboard side down."""
    steady = forces("steady_wind", {"F_N": 0.0, "F_E": 2e-4, "x_wind": 0.05, "z_wind": 0.04}, u=4.0)
    Y = 0.5 * RHO * L**2 * U0**2 * 2e-4
    assert steady["Y"] == pytest.approx(Y, rel=1e-6)
    assert steady["K"] == pytest.approx(0.04 * L * Y, rel=1e-6)
    assert steady["N"] == pytest.approx(0.05 * L * Y, rel=1e-6)
    for psi, X, side in ((math.pi / 2, 0.4, -0.5), (0.0, 0.2, 1.0)):  # eastbound, northbound
        got = forces("steady_wind", {"F_N": 1e-4, "F_E": 2e-4, "k_wind": 0.4}, psi=psi)
        assert [got["X"], got["Y"]] == pytest.approx([X * Y, side * Y], rel=1e-6)
    apparent = {"C_aw": 8e-5, "z_aw": 0.05}
    seen = forces("apparent_wind", apparent, V_aw=12.0, gamma_aw=-math.pi / 2)
    assert seen["Y"] == pytest.approx(0.5 * RHO * L**2 * 8e-5 * 12.0**2, rel=1e-6)
    assert seen["K"] == pytest.approx(0.05 * L * seen["Y"], rel=1e-6)
    assert forces("apparent_wind_ahead", {"C_ax": 1e-5}, V_aw=12.0, gamma_aw=0.0)["X"] < 0.0


def test_a_uniform_current_is_seen_over_ground_only() -> None:
    """2 m/s to the east: along for an eastbound ship, to starboard for a northbound one."""
    east, north, flow = math.pi / 2, 0.0, {"vc_N": 0.0, "vc_E": 2.0}
    assert sensed("current_in_sway", flow, v=0.3, psi=north)["v"] == pytest.approx(2.3)
    assert sensed("current_in_sway", flow, v=0.3, psi=east)["v"] == pytest.approx(0.3)
    flow = {"uc_N": 0.0, "uc_E": 2.0}
    assert sensed("current_in_surge", flow, u=7.0, psi=north)["u"] == pytest.approx(7.0)
    assert sensed("current_in_surge", flow, u=7.0, psi=east)["u"] == pytest.approx(9.0)
    assert CATALOGUE["drift_in_speed_record"]({"u": 5.0, "v": -3.0})[0]["u"] == pytest.approx(-1.0)
    recorded = CATALOGUE["current_in_speed_record"]({"psi": east, "Uc_N": 0.0, "Uc_E": 2.0})[0]
    assert recorded["u"] == pytest.approx(-2.0)


def test_shallow_water_by_depth() -> None:
    deep, near = (
        forces("shallow_water_sway", {"Yvz": -0.01, "Yvavz": 0.0}, v=0.5, h=h)["Y"]
        for h in (1e6, 2.0 * T)
    )
    U = math.hypot(U0, 0.5)
    assert deep == pytest.approx(0.0, abs=1e-4 * abs(near))
    assert near == pytest.approx(-0.01 * 0.5 * 0.5 * RHO * L**2 * U, rel=1e-6)


def test_a_memory_leaves_nothing_in_a_steady_turn() -> None:
    turn = {"r": 0.01}
    settled = rates("yaw_memory", {"N_late": -0.003}, **turn, r_late=0.01)
    without = rates("yaw_memory", {"N_late": 0.0}, **turn, r_late=0.01)
    assert settled == pytest.approx(without)
    assert settled["r_late"] == pytest.approx(0.0)
    fresh = rates("yaw_memory", {"tau_late": 2.0}, **turn)
    assert fresh["r_late"] == pytest.approx(0.01 * U0 / (2.0 * L))


def test_a_tank_rings_at_its_own_frequency_and_lets_slow_heel_alone() -> None:
    shape = {"omega_t": 1.5, "zeta_t": 0.1}
    w = 1.5 * math.sqrt(G / L)
    free = rates("anti_roll_tank", shape, q_t=0.1)
    assert free["w_t"] == pytest.approx(-w * w * 0.1)
    damped = rates("anti_roll_tank", shape, w_t=0.1)
    assert damped["w_t"] == pytest.approx(-2.0 * 0.1 * w * 0.1)
    slow = forces("anti_roll_tank", shape | {"s_t": 0.2}, phi=0.1, q_t=0.1)
    assert slow["K"] == pytest.approx(0.0, abs=1.0)
    late = forces("anti_roll_tank", shape | {"s_t": 0.2}, phi=0.1, q_t=0.04)
    assert late["K"] == pytest.approx(-RHO * G * NABLA * 0.2 * 0.06, rel=1e-6)


def test_a_pendulum_reads_outward_heel_too_large() -> None:
    """A turn to starboard, port side down: it swings to port by u r / g."""
    found = sensed("inclinometer_sway", {"k_incl": 1.0}, phi=-0.05, u=7.0, r=0.01, v_dot=0.02)
    assert found["phi"] == pytest.approx(-0.05 - (0.02 + 0.07) / G)
    # 10 m below the axis, rolling faster to starboard: the sensor is thrown to port
    below = sensed("inclinometer_lever", {"z_incl": 10.0}, p_dot=0.01)
    assert below["phi"] == pytest.approx(10.0 * 0.01 / G)


def test_levers_of_an_antenna_by_the_rigid_body() -> None:
    """Velocity of a point 40 m ahead, 3 m to starboard and 20 m above: v + omega x r."""
    omega, arm = np.array([0.02, 0.0, 0.01]), np.array([40.0, 3.0, -20.0])
    there = np.array([7.0, 0.5, 0.0]) + np.cross(omega, arm)
    at = {"u": 7.0, "v": 0.5, "p": 0.02, "r": 0.01}
    v = 0.5
    for name, value in (("lever_arm_x", {"x_s": 40.0}), ("lever_arm_z", {"z_s": -20.0})):
        v += sensed(name, value, **at)["v"] - 0.5
    assert v == pytest.approx(there[1])
    assert sensed("lever_arm_y", {"y_s": 3.0}, **at)["u"] == pytest.approx(there[0])


def test_a_gyro_that_heels_reads_the_turn_times_the_cosine() -> None:
    found = sensed("gyro_heels", {"k_heels": 1.0}, r=0.01, phi=0.2)["r"]
    assert found == pytest.approx(0.01 * math.cos(0.2))


def test_gears_by_hand() -> None:
    second, play = CATALOGUE["rudder_servo_second_order"], CATALOGUE["rudder_backlash"]
    at = {"delta_order": 0.3, "delta": 0.1, "delta_rate": 0.05}
    found = dict(second(at | {"omega_servo": 2.0, "zeta_servo": 0.5})[0])
    assert found == pytest.approx({"delta": 0.05, "delta_rate": 4.0 * 0.2 - 2.0 * 0.05})
    slack = {"b_play": 0.02, "T_play": 0.5}
    inside, beyond = (play({"delta": x, "delta_blade": 0.1} | slack) for x in (0.11, 0.15))
    assert [inside[0]["delta"], beyond[0]["delta"]] == pytest.approx([0.1 - 0.11, 0.1 - 0.15])
    assert [x[1]["delta_blade"] for x in (inside, beyond)] == pytest.approx([0.0, 0.03 / 0.5])
    dead = CATALOGUE["rudder_deadband"]
    acting = [x + dead({"delta": x, "b_dead": 0.01})[0]["delta"] for x in (0.005, -0.03)]
    assert acting == pytest.approx([0.0, -0.02])


def test_screws_push_to_the_side_they_should() -> None:
    """Right-handed ahead: bow to port. More thrust to port: bow to starboard."""
    single = forces("propeller_side_force", {"N_n": -1e-9}, n=U0)
    assert single["N"] == pytest.approx(-1e-9 * 0.5 * RHO * L**5 * U0**2, rel=1e-6)
    assert single["Y"] == pytest.approx(-2.0 * single["N"] / L, rel=1e-6)
    back = forces("propeller_astern", {"X_ast": 2e-9, "N_ast": 4e-10}, n=-U0)
    assert back["X"] == pytest.approx(2e-9 * 0.5 * RHO * L**4 * U0**2, rel=1e-6)
    assert back["N"] == pytest.approx(4e-10 * 0.5 * RHO * L**5 * U0**2, rel=1e-6)
    assert not any(forces("propeller_astern", {"X_ast": 2e-9, "N_ast": 4e-10}, n=U0).values())
    assert forces("twin_screws", {"N_twin": 2e-10}, n_p=8.0, n_s=7.0)["N"] > 0.0
    slowed = CATALOGUE["shaft_speed_drop"]({"n": 8.0, "u": 0.5 * U0, "U0": U0, "k_n": 0.4})[0]
    assert slowed["n"] == pytest.approx(8.0 * 0.4 * -0.5)
    kept = {"X_P0": 8e-4, "k_P": 2.1}
    course, half = (forces("propeller_unrecorded", kept, u=x * U0)["X"] for x in (1.0, 0.5))
    assert half == pytest.approx(2.05 * course)


def test_the_thrust_of_a_shaft_is_that_of_its_screw() -> None:
    """Of the S-175 on a course, by the numbers of her screw; nothing with the shaft stopped."""
    D, KT0, KT1, left, wake = 6.533, 0.527, -0.455, 1.0 - 0.175, 1.0 - 0.184
    known = {
        "X_nn": 2.0 * left * KT0 * (D / L) ** 4 / (2.0 * np.pi) ** 2,
        "X_un": 2.0 * left * KT1 * wake * (D / L) ** 3 / (2.0 * np.pi),
    }
    screw = CATALOGUE["propeller_thrust"]
    known_of_her = screw.nulls | {"v": 0.0, "r": 0.0, "L": L, "rho": RHO}
    for n, u in ((7.33, U0), (5.0, U0), (9.0, 0.6 * U0)):
        [of_screw] = screw({**known_of_her, "u": u, "n": n})
        assert forces("shaft_thrust", known, u=u, n=n)["X"] == pytest.approx(of_screw.X, rel=1e-6)
    assert not any(forces("shaft_thrust", known, n=-3.0).values())


def test_loading_changes_the_masses() -> None:
    """Twice the inertia, half the yaw acceleration."""
    inertia = MASSES["I_zz"] - MASSES["Nrdot"]
    model = ShipModel(SHIP, ("r",), (CATALOGUE["linear_rudder"], CATALOGUE["yaw_inertia_error"]))
    theta = MASSES | {"Ydelta": 0.0, "Kdelta": 0.0, "Ndelta": 0.0015}
    light, heavy = (
        derivatives(model, {"r": 0.0}, {"u": U0, "delta": 0.1}, theta | {"dI_zz": x})["r"]
        for x in (0.0, inertia)
    )
    assert heavy == pytest.approx(0.5 * light)
