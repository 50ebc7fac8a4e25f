"""Laws every effect of the catalogue obeys; a new effect is tested the day it is listed."""

import re
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from dual import independent, slope
from typical import draw

from trialid.effects import CATALOGUE, FILES
from trialid.names.quantities import PARTICULARS, POSITION, QUANTITIES, SIGNALS
from trialid.ship.effect import FORMS, Effect, Force
from trialid.ship.model import STATES, ShipModel
from trialid.ship.motion import derivatives
from trialid.ship.particulars import read_ship
from trialid.ship.prime import prime_parameter, prime_signal
from trialid.simulation.graph import Graph, Node, gradient, order
from trialid.simulation.reference import evaluator
from trialid.simulation.trace import trace

SHIP = read_ship(Path(__file__).parent.parent / "sample_data" / "ships" / "s175q.toml")
L, U = 175.0, 7.3
EVERY = pytest.mark.parametrize("name", CATALOGUE)

PUSHES = {
    "static_list", "rudder_offset", "bias_v", "bias_p", "bias_r", "bias_phi", "bias_psi",
    "hull_asymmetry", "propeller_side_force", "propeller_astern", "steady_wind", "current_in_sway",
    "compass_deviation",
}  # fmt: skip
"""Something to one side that is there on a straight course too."""

ASYMMETRIC = PUSHES | {
    "rudder_flow_asymmetry",
    "rudder_feedback_curve",
    "lever_arm_y",
    "current_in_surge",
    "current_in_speed_record",
}
"""Port and starboard differ."""

FORCED_AT_REST = {"static_list", "steady_wind", "propeller_unrecorded"}
"""Forces that do not ask for speed."""

NO_NULL = {
    "rudder_servo", "rudder_servo_limited", "rudder_servo_second_order", "rudder_backlash",
    "propeller_unrecorded", "propeller_thrust", "propeller_rudder", "rudder_race",
    "drift_in_speed_record",
}  # fmt: skip
"""Never absent: parameters inside the formula (time constants) or none, or instead of others."""
NOT_LINEAR = NO_NULL | {"rudder_deadband"}
"""No superposition."""

EVEN_STATES = {"u_lost"}
"""States of an effect's own that the mirror leaves alone."""
TWINS = {"n_p": "n_s", "n_s": "n_p"}
"""What the mirror exchanges."""

FORCE_MIRROR = {"X": 1, "Y": -1, "K": -1, "N": -1}
DRAWS, MANY = 6, 40
"""Random points; many where both sides of every kink and limit must be met."""


def values(effect: Effect, seed: int) -> dict[str, float]:
    """Signals and parameters in the effect's own system, drawn at random."""
    rng = np.random.default_rng([seed, sum(effect.name.encode())])
    signals = {s: draw(s, rng) for s in effect.signals}
    theta = {
        n: p.start * rng.uniform(0.8, 1.2) if p.start else rng.uniform(0.1, 0.2)
        for n, p in effect.parameters.items()
    }
    if effect.system == "SI":
        return signals | theta
    primed = {s: prime_signal(s, x, L, U) for s, x in signals.items()}
    return primed | {n: prime_parameter(effect, n, x, L, U) for n, x in theta.items()}


def flat(effect: Effect, at: Mapping[str, Any]) -> dict[str, Any]:
    """Every number the effect gives, by form and name."""
    found = {}
    for part in effect(at):
        rows = part._asdict() if isinstance(part, Force) else dict(part)
        found |= {f"{type(part).__name__}.{n}": x for n, x in rows.items()}
    return found


def sign(name: str) -> int:
    """How the mirror treats a signal; a state of an effect's own is taken as odd."""
    if name in QUANTITIES:
        return QUANTITIES[name].mirror
    return 1 if name in EVEN_STATES else -1


def result_sign(key: str) -> int:
    form, name = key.split(".")
    if form in {"Delayed", "Lagged", "Mass"}:
        return 1
    return FORCE_MIRROR[name] if form == "Force" else sign(name)


def mirrored(effect: Effect, at: Mapping[str, float]) -> dict[str, float]:
    changed = {n: at[m] if (m := TWINS.get(n)) in at else x for n, x in at.items()}
    return {n: x * sign(n) if n in effect.signals else x for n, x in changed.items()}


def straight(effect: Effect, at: Mapping[str, float]) -> dict[str, float]:
    """Upright on a straight course: everything the mirror reverses is zero."""
    even = at | ({"n_s": at["n_p"]} if "n_s" in at else {})
    return {n: 0.0 if n in effect.signals and sign(n) < 0 else x for n, x in even.items()}


def in_graph(effect: Effect, at: Mapping[str, float]) -> tuple[dict[str, Node], dict[str, Node]]:
    """The effect's results as graph nodes, and the symbols they are of."""
    graph = Graph()
    symbols = {n: graph.symbol(n, n in effect.signals) for n in at}
    return {k: x for k, x in flat(effect, symbols).items() if isinstance(x, Node)}, symbols


def is_analytic(effect: Effect, at: Mapping[str, float]) -> bool:
    """No modulus and no limit in it, so that a complex step is the derivative."""
    nodes, _ = in_graph(effect, at)
    return not {n.op for n in order(nodes.values())} & {"abs", "sign", "clip", "inside"}


@EVERY
def test_mirror_symmetry(name: str) -> None:
    """Port for starboard: X stays; Y, K, N and every odd motion change sign."""
    effect, same = CATALOGUE[name], []
    for seed in range(DRAWS):
        at = values(effect, seed)
        here, there = flat(effect, at), flat(effect, mirrored(effect, at))
        same += [
            there[k] == pytest.approx(result_sign(k) * x, rel=1e-13, abs=0) for k, x in here.items()
        ]
    assert all(same) == (name not in ASYMMETRIC)


@EVERY
def test_nothing_happens_on_a_straight_course(name: str) -> None:
    effect, sideways = CATALOGUE[name], []
    for seed in range(DRAWS):
        at = straight(effect, values(effect, seed))
        sideways += [x for k, x in flat(effect, at).items() if result_sign(k) < 0]
    assert np.any(sideways) if name in PUSHES else not np.any(sideways), sideways


@EVERY
def test_a_ship_at_rest_stays_at_rest(name: str) -> None:
    """In the model, where the speed U that primes the forces is itself zero."""
    effect = CATALOGUE[name]
    states = tuple(s for s in STATES if s not in {*effect.states, *POSITION})
    model = ShipModel(SHIP, states, (effect,))
    theta = {n: SHIP.mass.get(n, 0.0) for n in model.parameters}
    theta |= {n: p.start for n, p in effect.parameters.items()}
    rest = dict.fromkeys(model.all_states, 0.0)
    rates = derivatives(model, rest, dict.fromkeys(model.recorded, 0.0), theta)
    assert (rates == pytest.approx(rest, abs=1e-12)) == (name not in FORCED_AT_REST)


def without_rates(results: Mapping[str, Any]) -> dict[str, Any]:
    return {k: x for k, x in results.items() if not k.startswith("Rate.")}


@pytest.mark.parametrize("name", [n for n in CATALOGUE if n not in NO_NULL])
def test_absent_at_null(name: str) -> None:
    """Nothing acts, whatever its own states do; or these never leave zero and then nothing acts."""
    effect = CATALOGUE[name]
    for seed in range(DRAWS):
        at = values(effect, seed) | effect.nulls
        quiet = at | dict.fromkeys(effect.states, 0.0)
        ignored = not any(without_rates(flat(effect, at)).values())
        assert ignored or not any(flat(effect, quiet).values())


@EVERY
def test_parameters_superpose(name: str) -> None:
    """Twice the coefficients, twice the result; the sum of two sets, the sum of two results."""
    effect = CATALOGUE[name]
    assert all(superposes(effect, seed) for seed in range(DRAWS)) == (name not in NOT_LINEAR)


def superposes(effect: Effect, seed: int) -> bool:
    a, b = values(effect, seed), values(effect, seed + 100)
    same = {*effect.signals, *(n for n, p in effect.parameters.items() if p.null is None)}
    b |= {n: a[n] for n in same}
    if Force not in effect.forms:  # what is scored drives the states, which begin at zero
        a, b = (at | dict.fromkeys(effect.states, 0.0) for at in (a, b))
    mixed = {n: a[n] if n in same else 2.0 * a[n] - 3.0 * b[n] for n in a}
    left, one, two = (flat(effect, at) for at in (mixed, a, b))
    if Force in effect.forms:
        left, one, two = (without_rates(x) for x in (left, one, two))
    size = {k: 1e-13 * (abs(one[k]) + abs(two[k])) for k in one}
    return all(left[k] == pytest.approx(2.0 * one[k] - 3.0 * two[k], abs=size[k]) for k in left)


LETTERS = re.compile(r"phi|delta|[uvrpda]")
COEFFICIENTS = [
    (effect.name, n)
    for effect in CATALOGUE.values()
    for n in effect.parameters
    if re.fullmatch(r"[XYKN](phi|delta|[uvrpda])*[0m]?", n)
]


@pytest.mark.parametrize(("name", "coefficient"), COEFFICIENTS)
def test_a_coefficient_does_what_its_letters_say(name: str, coefficient: str) -> None:
    """Yvar is v |r| in Y: the letters after `a` stand inside the modulus, d is the rudder."""
    effect = CATALOGUE[name]
    nothing = effect.nulls
    for seed in range(DRAWS):
        at = values(effect, seed) | nothing
        product, inside = 1.0, False
        for letter in LETTERS.findall(coefficient[1:]):
            inside |= letter == "a"
            x = 1.0 if letter == "a" else at["delta" if letter == "d" else letter]
            product *= abs(x) if inside else x
        force = {row: 0.0 for row in "XYKN"} | {coefficient[0]: 0.7 * product}
        found = effect(at | {coefficient: 0.7})[0]
        assert found._asdict() == pytest.approx(force, rel=1e-13, abs=0.0)


def test_steering_gear_by_hand() -> None:
    """The rudder comes at the pump's rate while it is far, at its own time constant when near."""
    servo, limited = CATALOGUE["rudder_servo"], CATALOGUE["rudder_servo_limited"]
    far, near = {"delta_order": -0.5, "delta": 0.1}, {"delta_order": 0.12, "delta": 0.1}
    pump = {"T_servo": 2.0, "rate_max": 0.04}
    assert dict(servo(far | {"T_delta": 2.0})[0]) == pytest.approx({"delta": -0.3})
    assert dict(limited(far | pump)[0]) == {"delta": -0.04}
    assert dict(limited(near | pump)[0]) == pytest.approx({"delta": 0.01})


def test_restoring_moments_by_hand() -> None:
    """Displacement times righting arm, 0.3 m phi + 2 m phi^3, at any speed."""
    phi = 0.2
    for speed in (1.0, 7.3):
        at = {s: prime_signal(s, SHIP.particulars[s], L, speed) for s in ("rho", "g", "nabla")}
        at |= {"phi": phi, "p": 0.0, "Kp": -1.0}
        moment = 0.0
        for name, n, x in (("linear_roll", "GM", 0.3), ("righting_arm_cubic", "GM3", 2.0)):
            effect = CATALOGUE[name]
            moment += effect(at | {n: prime_parameter(effect, n, x, L, speed)})[0].K
        arm = 0.3 * phi + 2.0 * phi**3
        expected = -1025.0 * 9.81 * 21222.0 * arm
        assert moment * 0.5 * 1025.0 * L**3 * speed**2 == pytest.approx(expected, rel=1e-12)


@EVERY
def test_floats_arrays_and_nodes_agree(name: str) -> None:
    effect = CATALOGUE[name]
    drawn = [values(effect, seed) for seed in range(DRAWS)]
    one_by_one = [flat(effect, at) for at in drawn]
    at_once = flat(effect, {n: np.array([at[n] for at in drawn]) for n in drawn[0]})
    nodes, symbols = in_graph(effect, drawn[0])
    run = evaluator(list(nodes.values()), tuple(symbols), scalar=True)
    for i, at in enumerate(drawn):
        traced = dict(zip(nodes, run([at[n] for n in symbols]), strict=True))
        for key, x in one_by_one[i].items():
            assert np.broadcast_to(at_once[key], DRAWS)[i] == pytest.approx(x, rel=1e-13)
            assert traced.get(key, 0.0) == pytest.approx(x, rel=1e-13)


@EVERY
def test_gradient_against_dual_numbers(name: str) -> None:
    """By every signal and every parameter, at random points on both sides of every kink."""
    effect = CATALOGUE[name]
    nodes, symbols = in_graph(effect, values(effect, 0))
    slopes = [s for node in nodes.values() for s in gradient(node, list(symbols.values()))]
    run = evaluator(slopes, tuple(symbols), scalar=True)
    for seed in range(MANY):
        at = values(effect, seed)
        found = np.reshape(run([at[n] for n in symbols]), (len(nodes), len(symbols)))
        exact = flat(effect, independent(at))
        expected = [slope(exact[key], len(at)) for key in nodes]
        np.testing.assert_allclose(found, expected, rtol=1e-9, atol=0)


@pytest.mark.parametrize("name", [n for n, e in CATALOGUE.items() if is_analytic(e, values(e, 0))])
def test_gradient_against_a_complex_step(name: str) -> None:
    effect, step = CATALOGUE[name], 1e-30
    nodes, symbols = in_graph(effect, values(effect, 0))
    slopes = [gradient(node, list(symbols.values())) for node in nodes.values()]
    run = evaluator([s for row in slopes for s in row], tuple(symbols), scalar=True)
    for seed in range(DRAWS):
        at = values(effect, seed)
        found = np.reshape(run([at[n] for n in symbols]), (len(nodes), len(symbols)))
        for column, by in enumerate(symbols):
            moved = flat(effect, at | {by: at[by] + 1j * step})
            expected = [np.imag(moved[key]) / step for key in nodes]
            np.testing.assert_allclose(found[:, column], expected, rtol=1e-9, atol=0)


@EVERY
def test_traced_equations_against_dual_numbers(name: str) -> None:
    """J and W G of a ship with this effect alone, off-centre and heeled, every mass free."""
    effect = CATALOGUE[name]
    off_centre = {"x_G": -0.01, "z_G": -0.006, "Npdot": 1e-5, "Krdot": -2e-5}
    ship = replace(SHIP, mass={**SHIP.mass, **off_centre})
    model = ShipModel(ship, STATES, (effect,))
    theta = {n: p.start for n, p in model.parameters.items()}
    eq = trace(model.with_values(theta), tuple(theta), ())
    rng = np.random.default_rng(len(name))
    x = {s: draw(s, rng) for s in eq.states}
    u = {s: draw(s, rng) for s in eq.inputs}
    numbers = [*x.values(), *u.values(), *(theta[n] for n in eq.parameters)]
    symbols = (*eq.states, *eq.inputs, *eq.parameters)
    n_x, n_free = len(eq.states), len(eq.free)
    J, W, G = np.zeros((n_x, n_x)), np.zeros((n_x, n_x)), np.zeros((n_x, n_free))
    fill(J, eq.J, symbols, numbers)
    fill(W, eq.W, symbols, numbers)
    fill(G, {(r, c): g for c, d in enumerate(eq.G) for r, g in d.items()}, symbols, numbers)
    named = independent({**x, **theta})
    rates = derivatives(model, {s: named[s] for s in x}, u, {n: named[n] for n in theta})
    exact = np.array([slope(rates[s], len(named)) for s in eq.states])
    by_free = [list(named).index(n) for n in eq.free]
    check_close(J, exact[:, :n_x])
    check_close(W @ G, exact[:, by_free])


def fill(
    matrix: np.ndarray,
    entries: Mapping[tuple[int, int], Node],
    symbols: tuple[str, ...],
    numbers: list[float],
) -> None:
    for place, x in zip(
        entries, evaluator(list(entries.values()), symbols, scalar=True)(numbers), strict=True
    ):
        matrix[place] = x


def check_close(found: np.ndarray, expected: np.ndarray) -> None:
    """To 1e-9 of each entry; 1e-13 of the largest in the column is rounding of W G."""
    size = np.abs(expected).max(axis=0)
    assert np.all(np.abs(found - expected) <= 1e-9 * np.abs(expected) + 1e-13 * size)


@EVERY
def test_declaration(name: str) -> None:
    effect = CATALOGUE[name]
    assert effect.name == name == effect.function.__name__
    assert 10 < len(effect.equation) <= 100
    assert effect.source
    assert set(effect.signals) <= {*SIGNALS, *PARTICULARS, *effect.states}
    for parameter, p in effect.parameters.items():
        assert p.low < p.high, parameter
        assert p.low <= p.start <= p.high, parameter
        assert p.start != p.null, parameter
        assert name in NO_NULL or p.null is None or p.low <= p.null <= p.high, parameter
        assert all(p.low <= x <= p.high for x in p.scan), parameter
    assert set(effect.forms) <= set(FORMS)


@EVERY
def test_every_argument_is_used(name: str) -> None:
    effect = CATALOGUE[name]
    used = np.zeros(len(effect.signals) + len(effect.parameters))
    for seed in range(MANY):
        at = values(effect, seed)
        for x in flat(effect, independent(at)).values():
            used += np.abs(slope(x, len(at)))
    assert [n for n, u in zip(at, used, strict=True) if u == 0.0] == []


def test_names_are_unique() -> None:
    assert len(CATALOGUE) == sum(len(file.EFFECTS) for file in FILES)


def test_a_parameter_belongs_to_one_effect_or_to_alternatives() -> None:
    """propeller_rudder contains the thrust, so it shares the names with propeller_thrust."""
    owners: dict[str, list[str]] = {}
    for effect in CATALOGUE.values():
        for parameter in effect.parameters:
            owners.setdefault(parameter, []).append(effect.name)
    shared = {tuple(names) for names in owners.values() if len(names) > 1}
    assert shared == {("propeller_thrust", "propeller_rudder")}


@pytest.mark.parametrize("file", ["s175q", "s175", "naval"])
def test_published_coefficients_lie_in_the_declared_range(file: str) -> None:
    """The range of a parameter is physics; ships that were measured must fit into it."""
    ship = read_ship(Path(__file__).parent.parent / "sample_data" / "ships" / f"{file}.toml")
    for effect in CATALOGUE.values():
        model = ShipModel(ship, STATES[:5], (effect,))
        for n, p in effect.parameters.items():
            value = model.stated(n)
            assert value is None or p.low <= value <= p.high, f"{n} = {value}"
