"""Newton's equations of the ship in surge, sway, roll and yaw, with added masses."""

from collections.abc import Mapping
from typing import Final, NamedTuple

from trialid.maths import Number, cos
from trialid.ship.effect import Force

ROWS: Final = {"u": "X", "v": "Y", "p": "K", "r": "N"}
"""State to the equation that drives it."""


class Balance(NamedTuple):
    """Mass matrix and right-hand sides of `mass @ acceleration = force`, by state name."""

    mass: Mapping[tuple[str, str], Number]
    force: Mapping[str, Number]


def rigid_body(motion: Mapping[str, Number], force: Force, mass: Mapping[str, Number]) -> Balance:
    """Eq. 1: surge, sway, yaw and roll about horizontal axes that move with the ship.

    `motion` holds u, v, p, r, phi [SI], `mass` the mass parameters [SI]; added masses stand on the
    left with the rigid ones. The righting arm G_z is an effect and part of `force.K`.

    Departure: the axes do not roll, so a careful derivation gives twice z_G p r cos(phi) in X and
    small heel terms elsewhere; the paper's form is kept, because coefficients were fitted with it.
    """
    u, v, p, r = (motion[s] for s in "uvpr")
    m, x_G, z_G = mass["m"], mass["x_G"], mass["z_G"]
    z_cos = 0.0 if _is_zero(z_G) else z_G * cos(motion["phi"])
    matrix = {
        ("u", "u"): m - mass["Xudot"],
        ("v", "v"): m - mass["Yvdot"],
        ("v", "p"): -m * z_cos - mass["Ypdot"],
        ("v", "r"): m * x_G - mass["Yrdot"],
        ("p", "v"): -m * z_cos - mass["Kvdot"],
        ("p", "p"): mass["I_xx"] - mass["Kpdot"],
        ("p", "r"): -mass["Krdot"],
        ("r", "v"): m * x_G - mass["Nvdot"],
        ("r", "p"): -mass["Npdot"],
        ("r", "r"): mass["I_zz"] - mass["Nrdot"],
    }
    right = {
        "u": force.X + m * (v * r + x_G * r * r - z_cos * p * r),
        "v": force.Y - m * u * r,
        "p": force.K + m * z_cos * u * r,
        "r": force.N - m * x_G * u * r,
    }
    return Balance(matrix, right)


def _is_zero(x: Number) -> bool:
    """Whether a parameter is fixed at zero, which keeps the mass matrix constant."""
    return isinstance(x, float | int) and x == 0.0
