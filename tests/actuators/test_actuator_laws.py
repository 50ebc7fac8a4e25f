"""Effects of actuators obey the laws of the catalogue: derivatives, symmetry, absence at null."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import test_effects as laws
from boats import EFFECTS, QUANTITIES, SHIP, eight_actuators, ship_with
from dual import independent, slope
from typical import draw

from trialid.effects.actuators import actuator_effects
from trialid.ship.actuators import Actuator
from trialid.ship.effect import Effect
from trialid.ship.model import STATES, ShipModel
from trialid.simulation.graph import gradient
from trialid.simulation.integrate import prepare, respond
from trialid.simulation.reference import evaluator
from trialid.simulation.trace import trace

EVERY = pytest.mark.parametrize("name", EFFECTS)
SPAN = {"rad": 0.6, "rad/s": 9.0, "1": 0.9, "N": 3e7}


def signal(name: str, rng: np.random.Generator) -> float:
    """A value of either sign: ahead and astern, to both sides."""
    if name in QUANTITIES:
        span = SPAN[QUANTITIES[name].unit]
        return float(rng.uniform(0.01, 1.0) ** 2 * span * rng.choice([-1.0, 1.0]))
    return draw(name, rng)


def values(effect: Effect, seed: int) -> dict[str, float]:
    rng = np.random.default_rng([seed, sum(effect.name.encode())])
    theta = {n: p.start * rng.uniform(0.8, 1.2) for n, p in effect.parameters.items()}
    return {s: signal(s, rng) for s in effect.signals} | theta


@EVERY
def test_gradient_against_dual_numbers(name: str) -> None:
    """By every signal and parameter, on both sides of every kink; and every argument is used."""
    effect = EFFECTS[name]
    nodes, symbols = laws.in_graph(effect, values(effect, 0))
    slopes = [s for node in nodes.values() for s in gradient(node, list(symbols.values()))]
    run = evaluator(slopes, tuple(symbols), scalar=True)
    used = np.zeros(len(symbols))
    for seed in range(30):
        at = values(effect, seed)
        found = np.reshape(run([at[n] for n in symbols]), (len(nodes), len(symbols)))
        exact = laws.flat(effect, independent(at))
        expected = [slope(exact[key], len(at)) for key in nodes]
        np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-12)
        used += np.abs(found).sum(axis=0)
    assert [n for n, u in zip(symbols, used, strict=True) if u == 0.0] == []


@EVERY
def test_traced_equations_against_dual_numbers(name: str) -> None:
    """The state derivatives of a ship with this effect alone, by states and parameters."""
    effect = EFFECTS[name]
    model = ShipModel(SHIP, STATES, (effect,))
    theta = {n: p.start for n, p in model.parameters.items()}
    free = tuple(effect.parameters)
    eq = trace(model.with_values(theta), free, ())
    rng = np.random.default_rng(len(name))
    x = {s: signal(s, rng) for s in eq.states}
    u = {s: signal(s, rng) for s in eq.inputs}
    numbers = [*x.values(), *u.values(), *(theta[n] for n in eq.parameters)]
    symbols = (*eq.states, *eq.inputs, *eq.parameters)
    n_x, n_free = len(eq.states), len(eq.free)
    J, W, G = np.zeros((n_x, n_x)), np.zeros((n_x, n_x)), np.zeros((n_x, n_free))
    laws.fill(J, eq.J, symbols, numbers)
    laws.fill(W, eq.W, symbols, numbers)
    laws.fill(G, {(r, c): g for c, d in enumerate(eq.G) for r, g in d.items()}, symbols, numbers)
    named = independent({**x, **{n: theta[n] for n in free}})
    rates = laws.derivatives(model, {s: named[s] for s in x}, u, {**theta, **named})
    exact = np.array([slope(rates[s], len(named)) for s in eq.states])
    laws.check_close(J, exact[:, :n_x])
    laws.check_close(W @ G, exact[:, [list(named).index(n) for n in eq.free]])


@pytest.mark.parametrize(
    "name", [n for n, e in EFFECTS.items() if "lag" not in n and 0.0 in e.nulls.values()]
)
def test_absent_at_null(name: str) -> None:
    effect = EFFECTS[name]
    for seed in range(6):
        at = values(effect, seed) | effect.nulls
        size = max(map(abs, values(effect, seed).values()))
        gone = laws.flat(effect, at).values()
        assert gone == pytest.approx([0.0] * len(gone), abs=1e-8 * size) if gone else True


@EVERY
def test_declaration(name: str) -> None:
    effect = EFFECTS[name]
    assert effect.name == name == effect.function.__name__
    assert 10 < len(effect.equation) <= 100
    assert effect.source
    for parameter, p in effect.parameters.items():
        assert p.low <= p.start <= p.high, parameter
        assert p.start != p.null, parameter
        assert all(p.low <= x <= p.high for x in p.scan), parameter


MIRRORED = (
    Actuator(name="a", kind="thruster", x=-70.0, y=-6.0, direction=0.2),
    Actuator(name="b", kind="thruster", x=-70.0, y=6.0, direction=-0.2),
    Actuator(name="c", kind="azimuth", x=-70.0, y=-6.0),
    Actuator(name="d", kind="azimuth", x=-70.0, y=6.0),
    Actuator(name="e", kind="waterjet", x=-70.0, y=-6.0),
    Actuator(name="f", kind="waterjet", x=-70.0, y=6.0),
    Actuator(name="g", kind="rudder", x=-70.0, y=-6.0, behind="a"),
    Actuator(name="h", kind="rudder", x=-70.0, y=6.0, behind="b"),
)
PARTNERS = {a: b for a, b in zip("abcdefgh", "badcfehg", strict=True)}


@pytest.mark.parametrize(
    "name",
    [
        "thrusters",
        "azimuths",
        "azimuths_advance",
        "azimuths_race",
        "azimuths_strut",
        "waterjets",
        "waterjets_advance",
        "rudders",
        "rudders_drag",
        "rudders_race",
        "thrusters_advance",
    ],
)
def test_port_for_starboard(name: str) -> None:
    """Drives exchanged, angles exchanged and turned over: X stays, Y, K and N change sign."""
    effect = actuator_effects(ship_with(MIRRORED))[name]
    turning = 0
    for seed in range(6):
        at = values(effect, seed)
        there = dict(at)
        for s in effect.signals:
            if s in ("v", "r"):
                there[s] = -at[s]
            elif s != "u":
                partner = s.replace(s[0], PARTNERS[s[0]], 1)
                turned = s.endswith("_angle") or s[0] in "gh"
                there[partner] = -at[s] if turned else at[s]
        here, other = effect(at)[0], effect(there)[0]
        wanted = [here.X, -here.Y, -here.K, -here.N]
        np.testing.assert_allclose(list(other), wanted, rtol=1e-9, atol=1e-9 * abs(here.X) + 1e-12)
        turning += here.N != 0.0
    assert turning >= 3  # a screw that backs has no race


ALONE = {
    "thruster": {},
    "azimuth": {"one_angle": 0.5},
    "waterjet": {"one_angle": 0.5},
}


@pytest.mark.parametrize("kind", ALONE)
@pytest.mark.parametrize("command", ["revolutions", "share", "thrust"])
def test_a_push_ahead_on_the_port_side_turns_to_starboard(kind: Any, command: Any) -> None:
    """And astern to port, with its own gain; numbers by hand."""
    one = Actuator(name="one", kind=kind, x=0.0, y=-2.0, command=command)
    [effect] = [e for n, e in actuator_effects(ship_with((one,))).items() if n == f"{kind}s"]
    ahead, astern = effect.parameters
    at = {"one": 3.0, "one_angle": 0.0, ahead: 5.0, astern: 4.0}
    at = {n: at[n] for n in (*effect.signals, *effect.parameters)}
    size = 3.0 if command == "thrust" else 9.0
    assert effect(at)[0] == pytest.approx((5.0 * size, 0.0, 0.0, 10.0 * size))
    assert effect(at | {"one": -3.0})[0] == pytest.approx((-4.0 * size, 0.0, 0.0, -8.0 * size))


def test_a_pod_pushes_to_where_it_points_and_a_nozzle_aft_turns_the_ship_to_its_side() -> None:
    aft = {"x": -5.0, "y": 0.0, "command": "thrust"}
    ship = ship_with(
        (
            Actuator(name="pod", kind="azimuth", **aft),
            Actuator(name="jet", kind="waterjet", **aft),
        )
    )
    made = actuator_effects(ship)
    pod = {"pod": 2.0, "pod_angle": np.pi / 2, "k_pod_ahead": 1.0, "k_pod_astern": 1.0}
    assert made["azimuths"](pod)[0] == pytest.approx((0.0, 2.0, 0.0, -10.0), abs=1e-12)
    jet = {"jet": 2.0, "jet_angle": np.pi / 6, "k_jet_ahead": 1.0, "k_jet_astern": 1.0}
    assert made["waterjets"](jet)[0] == pytest.approx((np.sqrt(3.0), -1.0, 0.0, 5.0))


def test_a_bucket_takes_the_jet_away_and_turns_it_back() -> None:
    jet = {"jet": 10.0, "jet_angle": 0.2, "k_jet_ahead": 2.0, "k_jet_astern": 1.0}
    X, Y, _, N = EFFECTS["waterjets"](jet)[0]
    at = {"jet": 10.0, "jet_angle": 0.2, "jet_bucket": 0.5, "k_bucket": 3.0}
    taken = EFFECTS["waterjets_bucket"](at)[0]
    assert pytest.approx((-0.75 * X, -0.75 * Y, -0.75 * N)) == (taken.X, taken.Y, taken.N)
    astern = EFFECTS["waterjets_bucket"](at | {"jet_bucket": 1.0})[0]
    assert X + astern.X < 0.0
    assert EFFECTS["waterjets_bucket"](at | {"jet": -10.0})[0] == pytest.approx((0.0,) * 4)


def test_the_water_that_a_jet_takes_in_is_brought_to_her_speed() -> None:
    """Along her, however the jet points; by hand at 2 m/s: 0.5 * 3 * 2 N, 5 m aft, 2 m to port."""
    jet = Actuator(name="jet", kind="waterjet", x=-5.0, y=-2.0, direction=0.3)
    lost = actuator_effects(ship_with((jet,)))["waterjets_advance"]
    at = {"jet": 3.0, "u": 2.0, "k_jet_advance": 0.5}
    assert lost(at)[0] == pytest.approx((-3.0, 0.0, 0.0, -6.0))
    assert lost(at | {"jet": -3.0})[0] == pytest.approx((-3.0, 0.0, 0.0, -6.0))
    assert lost(at | {"u": -2.0})[0] == pytest.approx((3.0, 0.0, 0.0, 6.0))


@pytest.mark.parametrize(("order", "held", "passed"), [(0.9, 0.7, 0.7), (-0.6, -0.6, -0.4)])
def test_no_more_comes_of_an_order_than_a_drive_can(order, held, passed) -> None:
    """And of a small one nothing: 0.2 of each are lost in the dead band."""
    at = {"pod": order, "pod_fwd": 0.1}
    [moved] = EFFECTS["azimuths_saturation"](at | {"n_full_azimuths": 0.7})
    assert (order + moved["pod"], moved["pod_fwd"]) == (pytest.approx(held), 0.0)
    [moved] = EFFECTS["azimuths_deadband"](at | {"dead_azimuths": 0.2})
    assert order + moved["pod"] == pytest.approx(passed if order < 0.0 else 0.7)
    assert 0.1 + moved["pod_fwd"] == 0.0


def test_a_bow_thruster_to_starboard_turns_to_starboard_less_at_speed() -> None:
    at = {"bow": 2.0, "u": 0.0, "k_tunnel": 3.0, "u_tunnel": 1.5}
    assert EFFECTS["tunnels"](at)[0] == pytest.approx((0.0, 12.0, 0.0, 840.0))
    faded, to_port = (EFFECTS["tunnels"](at | more)[0] for more in ({"u": 1.5}, {"bow": -2.0}))
    assert faded[3] == pytest.approx(840.0 / np.e)
    assert to_port[3] == pytest.approx(-840.0)


def test_rudders_together_are_the_one_rudder_and_a_bow_rudder_pushes_the_other_way() -> None:
    rudder = {"Ydelta": -0.003, "Kdelta": 0.0001, "Ndelta": 0.0015}
    linear = laws.CATALOGUE["linear_rudder"]({"delta": 0.2, **rudder})[0]
    two = EFFECTS["rudders"]({"rudder_port": 0.3, "rudder_stbd": 0.1, **rudder})[0]
    assert two == pytest.approx(linear)
    bow = replace(SHIP, actuators=(Actuator(name="bow", kind="rudder", x=60.0, y=0.0),))
    one = actuator_effects(bow)["rudders"]({"bow": 0.2, **rudder})[0]
    assert one == pytest.approx((0.0, -linear.Y, -linear.K, linear.N))


def test_a_rudder_in_a_race_acts_at_rest_and_not_behind_a_screw_that_backs() -> None:
    at = {"rudder_stbd": 0.5, "right": 3.0, "k_race": 2.0}
    F = 2.0 * 9.0 * np.sin(0.5)
    X, Y = -F * np.sin(0.5), -F * np.cos(0.5)
    assert EFFECTS["rudders_race"](at)[0] == pytest.approx((X, Y, 0.0, -80.0 * Y - 4.0 * X))
    assert EFFECTS["rudders_race"](at | {"right": -3.0})[0] == pytest.approx((0.0, 0.0, 0.0, 0.0))


def test_coefficients_of_a_file_with_port_rudders_are_turned_over_for_several_too() -> None:
    port = replace(SHIP, rudder_positive="port", coefficients={"Ndelta": -0.0015, "Xdd": -0.002})
    model = ShipModel(port, ("v", "r"), (EFFECTS["rudders"], EFFECTS["rudders_drag"]))
    assert model.value("Ndelta") == 0.0015
    assert model.value("Xdd") == -0.002


def test_the_jet_of_a_tunnel_sucks_at_the_hull_as_she_moves() -> None:
    """By hand: Fr times a share of the push, whether ahead or astern; no moment, none at rest."""
    effect, (one,) = EFFECTS["tunnels_hull"], [a for a in SHIP.actuators if a.kind == "tunnel"]
    at = {one.name: 3.0, "aY_tunnel": -50.0}
    Fr = 2.0 / np.sqrt(SHIP.particulars["g"] * SHIP.particulars["L"])
    for sign in (1.0, -1.0):
        [found] = effect(at | {"u": 2.0 * sign})
        assert found == pytest.approx((0.0, -450.0 * Fr, 0.0, 0.0), abs=1e-9)
        [back] = effect(at | {"u": 2.0, one.name: -3.0})
        assert back == pytest.approx([-x for x in found], abs=1e-9)
    assert effect(at | {"u": 0.0})[0] == pytest.approx((0.0, 0.0, 0.0, 0.0))


@pytest.mark.parametrize("fault", [(), ("pod_2_revolutions_stuck", "bow_1_stuck", "stbd_stuck")])
def test_compiled_and_numpy_agree_on_eight_actuators(fault) -> None:
    model, free, trial = eight_actuators()
    own = actuator_effects(model.ship)
    for name in fault:
        put = {n: -0.3 if n.startswith("held") else 0.9 for n in own[name].parameters}
        model, free = (model + own[name]).with_values(put), (*free, *put)
    values = {n: model.value(n) for n in free}
    start = {"u": 5.0, "v": 0.1, "r": 0.001}
    found = [
        respond(prepare(model, free, ("u", "r"), engine), trial, values, start)
        for engine in ("compiled", "numpy")
    ]
    assert found[0].departure is None
    assert np.ptp(found[0].y[:, 1]) > 0.001
    assert all(np.ptp(found[0].S[..., free.index(n)]) > 0.0 for n in free)
    for compiled, plain in zip(*((one.y, one.S) for one in found), strict=True):
        size = np.abs(plain).max(axis=0)
        assert np.all(np.abs(compiled - plain) <= 1e-9 * size + 1e-300)
