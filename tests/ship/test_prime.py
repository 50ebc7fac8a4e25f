"""Prime scales and signs: the same ship written in another system is the same ship."""

from dataclasses import replace

import numpy as np
import pytest

from trialid.effects import CATALOGUE
from trialid.errors import EffectError, ShipError
from trialid.ship.effect import Force, Parameter, effect
from trialid.ship.model import STATES, ShipModel
from trialid.ship.particulars import Ship
from trialid.ship.prime import prime_signal, scale
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial

FORCES = {"Y": 2, "X": 2, "K": 3, "N": 3}
LENGTHS = {
    "m": 3, "I_xx": 5, "I_zz": 5, "Xudot": 3, "Yvdot": 3, "Ypdot": 4, "Yrdot": 4, "Kvdot": 4,
    "Kpdot": 5, "Krdot": 5, "Nvdot": 4, "Npdot": 5, "Nrdot": 5,
}  # fmt: skip
ODD_IN_RUDDER = ("Ydelta", "Kdelta", "Ndelta", "Yddd", "Nddd")
AS_THEY_ARE = (
    "GM", "GM3", "Kp0", "D_P", "KT0", "KT1", "t_P", "w_P", "tau_P", "x_P",
)  # fmt: skip


def sname(name: str, L: float, rho: float, U: float) -> float:
    """The dimensional unit of a coefficient, letter by letter: SNAME (1950), tables."""
    force, letters = name[0], name[1:].replace("delta", "d").replace("phi", "f").replace("m", "")
    length, speed = FORCES[force], 2
    for letter in letters.replace("a", ""):
        length += {"v": 0, "u": 0, "r": 1, "p": 1, "f": 0, "d": 0}[letter]
        speed -= {"v": 1, "u": 1, "r": 1, "p": 1, "f": 0, "d": 0}[letter]
    return 0.5 * rho * L**length * U**speed


def dimensional(ship: Ship, U: float) -> Ship:
    """A primed ship with every number in SI at the speed U."""
    L, rho = ship.particulars["L"], ship.particulars["rho"]
    mass = {
        n: x * (L if n in ("x_G", "z_G") else 0.5 * rho * L ** LENGTHS[n])
        for n, x in ship.mass.items()
    }
    coefficients = {
        n: x if n in AS_THEY_ARE else x * sname(n, L, rho, U) for n, x in ship.coefficients.items()
    }
    return replace(
        ship, system="dimensional", coefficient_speed=U, mass=mass, coefficients=coefficients
    )


def turn(model: ShipModel) -> np.ndarray:
    n, t = 120, np.arange(120.0)
    signals = {"n": np.full(n, 7.33), "delta": 0.35 * np.sin(0.05 * t), "u": np.full(n, 7.3)}
    simulator = prepare(model, (), ("r", "phi"), "numpy")
    start = {"u": 7.3, "phi": 0.1, "v": 0.2}
    return respond(simulator, Trial("turn", "fit", 1.0, signals, {}), {}, start, False).states


@pytest.fixture
def richer(s175q: ShipModel) -> ShipModel:
    """With terms even and odd in the rudder, and a centre of gravity off the origin."""
    more = {"Yddd": 0.001, "Nddd": -0.0005}
    ship = replace(
        s175q.ship,
        coefficients={**s175q.ship.coefficients, **more},
        mass={**s175q.ship.mass, "x_G": -0.01, "z_G": -0.005},
    )
    return replace(s175q, ship=ship, effects=(*s175q.effects, CATALOGUE["rudder_cubic"]))


@pytest.mark.parametrize("U", [1.0, 7.33])
def test_dimensional_and_primed_are_one_ship(U: float, richer: ShipModel) -> None:
    converted = replace(richer, ship=dimensional(richer.ship, U))
    for name in richer.parameters:
        assert converted.value(name) == pytest.approx(richer.value(name), rel=1e-12), name
    np.testing.assert_allclose(turn(converted), turn(richer), rtol=1e-9, atol=1e-12)


def test_typical_masses_are_primed_in_any_system(richer: ShipModel) -> None:
    """The scale of everything relative; a mass of 2e7 kg beside a value of 0.008 would be none."""
    converted = replace(richer, ship=dimensional(richer.ship, 1.0))
    for name in ("m", "x_G", "I_zz", "Yvdot", "Nrdot"):
        assert converted.parameters[name].start == pytest.approx(richer.value(name), rel=1e-12)


def test_port_positive_is_the_same_ship(richer: ShipModel) -> None:
    flipped = {
        n: -x if n in ODD_IN_RUDDER else x for n, x in richer.ship.coefficients.items()
    }  # fmt: skip
    port = replace(richer, ship=replace(richer.ship, rudder_positive="port", coefficients=flipped))
    assert port.ship.coefficients["Ydelta"] > 0.0 > port.value("Ydelta")
    assert port.value("Xdd") == richer.value("Xdd")
    np.testing.assert_array_equal(turn(port), turn(richer))


def test_port_positive_and_dimensional_at_once(richer: ShipModel) -> None:
    flipped = {n: -x if n in ODD_IN_RUDDER else x for n, x in richer.ship.coefficients.items()}
    ship = dimensional(replace(richer.ship, coefficients=flipped), 7.33)
    port = replace(richer, ship=replace(ship, rudder_positive="port"))
    np.testing.assert_allclose(turn(port), turn(richer), rtol=1e-9, atol=1e-12)


def test_a_port_positive_neutral_angle(richer: ShipModel) -> None:
    coefficients = {**richer.ship.coefficients, "delta_0": 0.02}
    ship = replace(richer.ship, rudder_positive="port", coefficients=coefficients)
    assert ShipModel(ship, ("v",), (CATALOGUE["rudder_offset"],)).value("delta_0") == -0.02


def test_stated_values_are_primed_already(richer: ShipModel) -> None:
    """A pipeline's number counts as it stands, whatever the ship file's system."""
    ship = replace(dimensional(richer.ship, 1.0), rudder_positive="port")
    assert replace(richer, ship=ship).with_values({"Ydelta": -0.003}).value("Ydelta") == -0.003


def test_a_term_neither_odd_nor_even_is_refused(s175q: ShipModel) -> None:
    @effect(source="test")
    def odd(delta, *, Yo=-0.001):
        """Y = Yo (delta + delta^2): no mirror can turn this."""
        return Force(Y=Yo * (delta + delta**2))

    ship = replace(s175q.ship, rudder_positive="port", coefficients={"Yo": 0.001})
    with pytest.raises(ShipError, match=r"'Yo'.*neither odd nor even.*convert it"):
        ShipModel(ship, ("v",), (odd,)).value("Yo")


def test_one_coefficient_in_two_equations_is_refused(s175q: ShipModel) -> None:
    @effect(source="test")
    def both(v, *, Yb=-0.001):
        """Y = Yb v, N = Yb v: forces and moments have different scales."""
        return Force(Y=Yb * v, N=0.5 * Yb * v)

    ship = replace(s175q.ship, system="dimensional", coefficients={"Yb": 1e6})
    with pytest.raises(ShipError, match=r"'Yb' acts on several equations.*give it primed"):
        ShipModel(ship, ("v",), (both,)).value("Yb")


def test_a_unit_the_prime_system_does_not_know(s175q: ShipModel) -> None:
    @effect(source="test")
    def heavy(v, *, M=Parameter(1.0, "kg")):
        """Y = M v."""
        return Force(Y=M * v)

    model = ShipModel(s175q.ship, STATES, (heavy,), {"M": 1.0})
    with pytest.raises(EffectError, match=r"'M' has unit 'kg'.*system=.SI."):
        prepare(model, (), ("v",))


@pytest.mark.parametrize(("name", "length", "speed"), [("v", 0, 1), ("r", -1, 1), ("g", -1, 2)])
def test_a_signal_over_its_scale(name: str, length: int, speed: int) -> None:
    assert scale(length, speed, 175.0, 7.0) == pytest.approx(175.0**length * 7.0**speed)
    assert prime_signal(name, 0.3, 175.0, 7.0) == pytest.approx(0.3 / 175.0**length / 7.0**speed)


@pytest.mark.parametrize("name", ["delta", "phi", "psi"])
def test_an_angle_has_no_scale(name: str) -> None:
    assert prime_signal(name, 0.3, 175.0, 7.0) == 0.3


def test_forces_do_not_depend_on_the_approach_speed(s175q: ShipModel) -> None:
    """Primes use the speed of the moment, so U0 only decides where u starts."""
    other = replace(s175q.ship, particulars={**s175q.ship.particulars, "U0": 3.0})
    np.testing.assert_array_equal(turn(replace(s175q, ship=other)), turn(s175q))
