"""Model algebra, where values come from, and what a model refuses."""

from dataclasses import replace

import numpy as np
import pytest

from trialid.effects import CATALOGUE
from trialid.errors import EffectError, ShipError
from trialid.names.quantities import MASS_PARAMETERS
from trialid.ship.mass_matrix import solve
from trialid.ship.model import STATES, ShipModel
from trialid.ship.motion import check_mass, derivatives, motion
from trialid.ship.rigid_body import Balance
from trialid.simulation.trace import trace


def theta(model: ShipModel) -> dict[str, float]:
    return {n: model.value(n) for n in model.parameters}


def masses(model: ShipModel, **changed: float) -> ShipModel:
    return replace(model, ship=replace(model.ship, mass={**model.ship.mass, **changed}))


def test_plus_and_minus_give_new_models(s175q: ShipModel) -> None:
    more = s175q + CATALOGUE["sway_cubic_vvv"]
    assert [e.name for e in more.effects] == [*(e.name for e in s175q.effects), "sway_cubic_vvv"]
    assert (more - "sway_cubic_vvv") == s175q
    assert "Yvvv" in more.parameters
    assert "Yvvv" not in s175q.parameters


def test_minus_forgets_the_values_that_went_with_it(s175q: ShipModel) -> None:
    told = s175q.with_values({"Yvav": -0.1, "Nr": -0.002})
    assert (told - "sway_drag_vav").values == {"Nr": -0.002}
    back = (told - "sway_drag_vav") + CATALOGUE["sway_drag_vav"]
    assert back.value("Yvav") == s175q.value("Yvav")


def test_values_are_stated_then_the_ships(s175q: ShipModel) -> None:
    assert s175q.value("Nr") == -0.00247579
    assert s175q.with_values({"Nr": -0.002}).value("Nr") == -0.002
    assert s175q.with_values({"m": 0.009}).value("m") == 0.009
    assert s175q.value("Krdot") == 0.0
    assert (s175q + CATALOGUE["static_list"]).stated("a_0") is None


def test_a_value_nobody_gives(s175q: ShipModel) -> None:
    with pytest.raises(EffectError, match=r"'a_0' has no value: ship 'S175Q'.*free it, or write"):
        (s175q + CATALOGUE["static_list"]).value("a_0")
    with pytest.raises(EffectError, match="'a_0' has no value"):
        trace(s175q + CATALOGUE["static_list"], (), ("r",))
    assert "a_0" in trace(s175q + CATALOGUE["static_list"], ("a_0",), ("r",)).free


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda m: m + CATALOGUE["linear_hull"], "'linear_hull' is in the model twice"),
        (lambda m: m + CATALOGUE["propeller_rudder"], "both have 'D_P'; rename one"),
        (lambda m: m - "linear_hul", "no effect 'linear_hul'; did you mean 'linear_hull'"),
        (lambda m: m - "wind", "no effect 'wind'; known: "),
        (lambda m: m.with_values({"Yvv": 1.0}), "value for parameter 'Yvv', which no effect"),
        (lambda m: replace(m, states=("v", "q")), "state 'q' cannot be simulated"),
        (lambda m: replace(m, states=("v", "phi")), "state 'phi' needs state 'p' beside it"),
    ],
)
def test_contradictions_are_refused(change: object, says: str, s175q: ShipModel) -> None:
    with pytest.raises(EffectError, match=says) as caught:
        change(s175q)
    assert "\n" not in str(caught.value)


def test_a_name_the_rigid_body_has(s175q: ShipModel) -> None:
    from trialid.ship.effect import Force, effect

    @effect(source="test")
    def heavier(v, *, m=0.1):
        """Y = m v."""
        return Force(Y=m * v)

    with pytest.raises(EffectError, match="'heavier' and the rigid body both have 'm'"):
        s175q + heavier


def test_two_servos_on_one_rudder(s175q: ShipModel) -> None:
    with pytest.raises(EffectError, match="both have 'delta'"):
        replace(s175q, effects=(CATALOGUE["rudder_servo"], CATALOGUE["rudder_servo_limited"]))


@pytest.mark.parametrize(("state", "name"), [("v", "m"), ("p", "I_xx"), ("r", "I_zz")])
def test_a_missing_mass(state: str, name: str, s175q: ShipModel) -> None:
    mass = {n: x for n, x in s175q.ship.mass.items() if n != name}
    with pytest.raises(ShipError, match=rf"\[mass\] {name} is missing or not positive; state '.'"):
        replace(s175q, ship=replace(s175q.ship, mass=mass))
    without = tuple(s for s in STATES if s not in {state, "phi", "u", "v"})
    replace(s175q, ship=replace(s175q.ship, mass=mass), states=without)


def test_recorded_is_what_nobody_simulates(s175q: ShipModel) -> None:
    assert s175q.recorded == ("delta", "n")
    assert (s175q + CATALOGUE["rudder_servo"]).recorded == ("delta_order", "n")
    lateral = replace(s175q, states=("v", "r"))
    assert lateral.recorded == ("delta", "n", "p", "phi", "u")
    offset = ShipModel(s175q.ship, ("v",), (CATALOGUE["rudder_offset"],))
    assert offset.recorded == ("delta", "u")


def test_the_heading_alone_follows_the_recorded_rate(s175q: ShipModel) -> None:
    model = ShipModel(s175q.ship, ("psi",), ())
    assert "r" in model.recorded
    assert derivatives(model, {"psi": 0.0}, {"u": 7.0, "r": 0.01}, theta(model)) == {"psi": 0.01}


def test_a_recorded_motion_acts_as_a_simulated_one(s175q: ShipModel) -> None:
    """The same instant, once with p and phi simulated and once as they were recorded."""
    x = {"u": 7.0, "v": 0.3, "p": 0.01, "r": -0.004, "phi": 0.1, "psi": 0.2}
    inputs = {"n": 7.3, "delta": 0.1}
    all_forces = motion(s175q, x, inputs, theta(s175q)).balance.force
    part = replace(s175q, states=("v", "r"))
    recorded = inputs | {s: x[s] for s in ("u", "p", "phi")}
    some = motion(part, {"v": 0.3, "r": -0.004}, recorded, theta(part)).balance.force
    assert some == {s: all_forces[s] for s in ("v", "r")}


def test_the_model_is_a_mirror_image_of_itself(s175q: ShipModel) -> None:
    """Port for starboard in the whole model, with the centre of gravity off the origin."""
    odd = {"v", "p", "r", "phi", "psi", "y", "delta"}
    model = masses(s175q, x_G=-0.02, z_G=-0.01)
    x = {"u": 7.0, "v": 0.3, "p": 0.01, "r": -0.004, "phi": 0.1, "psi": 0.2, "x": 40.0, "y": 9.0}
    there_x = {s: -a if s in odd else a for s, a in x.items()}
    here = derivatives(model, x, {"n": 7.3, "delta": 0.1}, theta(model))
    there = derivatives(model, there_x, {"n": 7.3, "delta": -0.1}, theta(model))
    for s in STATES:
        assert there[s] == pytest.approx(-here[s] if s in odd else here[s], rel=1e-13)


def test_a_starboard_rudder_turns_to_starboard_and_heels_outward(s175q: ShipModel) -> None:
    from trialid.simulation.integrate import prepare, respond
    from trialid.trial import Trial

    signals = {"n": np.full(400, 7.33), "delta": np.full(400, 0.17)}
    trial = Trial("turn", "fit", 0.5, signals, {})
    _, v, _, r, phi, psi, _, y = respond(
        prepare(s175q, (), ("r",)), trial, {}, {}, sensitivities=False
    ).states[-1]  # fmt: skip
    assert r > 0.0
    assert psi > 0.0
    assert y > 0.0, "north at first, then to the east"
    assert v < 0.0, "drift: the bow points into the turn"
    assert phi < 0.0, "port side down"


ROWS = ("u", "v", "p", "r")


@pytest.mark.parametrize("rows", [("u",), ("v", "r"), ("v", "p", "r"), ROWS, ("u", "r"), ("p",)])
def test_inverse_of_the_mass_matrix(rows: tuple[str, ...]) -> None:
    """Cofactors against LAPACK, on a matrix without any symmetry."""
    rng = np.random.default_rng(len(rows))
    lateral = [s for s in rows if s != "u"]
    entries = {(a, b): float(rng.uniform(-1, 1)) for a in lateral for b in lateral}
    entries |= {(s, s): float(rng.uniform(2, 3)) for s in rows}
    matrix = np.array([[entries.get((a, b), 0.0) for b in rows] for a in rows])
    inverse = solve(Balance(entries, dict.fromkeys(rows, 0.0)), rows)
    found = np.array([[inverse.get((a, b), 0.0) for b in rows] for a in rows])
    np.testing.assert_allclose(found, np.linalg.inv(matrix), rtol=1e-12, atol=1e-14)


@pytest.mark.parametrize("name", ["s175q", "s175", "naval"])
def test_the_sample_ships_can_be_inverted(name: str, request: pytest.FixtureRequest) -> None:
    model = request.getfixturevalue(name)
    check_mass(model, {n: model.value(n) for n in MASS_PARAMETERS})


@pytest.mark.parametrize(
    ("changed", "rows"),
    [
        ({"Yvdot": 0.02}, "v"),
        ({"Kpdot": 0.0001}, "v, p"),
        ({"Ypdot": 0.002, "Kvdot": 0.002}, "v, p"),
        ({"Nrdot": 0.001}, "v, p, r"),
        ({"Yrdot": 0.01, "Nvdot": 0.01}, "v, p, r"),
        ({"m": float("inf")}, "v"),
    ],
)
def test_an_impossible_mass_matrix(changed: dict[str, float], rows: str, s175q: ShipModel) -> None:
    model = masses(s175q, **changed)
    with pytest.raises(ShipError, match=f"mass matrix of {rows} is not positive") as caught:
        check_mass(model, {n: model.value(n) for n in MASS_PARAMETERS})
    assert "check m, I_xx, I_zz and the added masses" in str(caught.value)


def test_masses_are_above_zero_and_what_water_adds_below(s175q: ShipModel) -> None:
    """As far as the file has them so: what is stated beyond is left to whoever stated it."""
    assert (s175q.parameters["I_xx"].low, s175q.parameters["I_xx"].high) == (0.0, np.inf)
    assert (s175q.parameters["Yvdot"].low, s175q.parameters["Yvdot"].high) == (-np.inf, 0.0)
    assert (s175q.parameters["x_G"].low, s175q.parameters["x_G"].high) == (-np.inf, np.inf)
    other = replace(s175q.ship, mass={**s175q.ship.mass, "Yvdot": 0.007})
    assert replace(s175q, ship=other).parameters["Yvdot"].high == np.inf


@pytest.mark.parametrize(("states", "needs"), [("vr", None), ("uvr", "k_wind"), ("vpr", "z_wind")])
def test_what_reaches_nothing_that_is_simulated_needs_no_value(
    s175q: ShipModel, states: str, needs: str | None
) -> None:
    """A push from ahead where the speed is read from the log, a heel where she does not roll."""
    known = {"F_N": 2e-4, "F_E": 0.0, "x_wind": 0.05}
    model = ShipModel(s175q.ship, tuple(states), (CATALOGUE["steady_wind"],)).with_values(known)
    for name in {"k_wind", "z_wind"} - {needs}:
        assert model.value(name) == 0.0
    if needs:
        with pytest.raises(EffectError, match=f"parameter '{needs}' has no value"):
            model.value(needs)
