"""Eq. 1 against Newton's law: a body without forces keeps its energy and its momentum."""

import numpy as np
import pytest

from trialid.names.quantities import MASS_PARAMETERS
from trialid.ship.effect import Force
from trialid.ship.rigid_body import rigid_body

BODY = dict.fromkeys(MASS_PARAMETERS, 0.0) | {
    "m": 3.0, "x_G": 0.4, "z_G": -0.2, "I_xx": 0.7, "I_zz": 5.0,
}  # fmt: skip
MOVES = {"u": 2.0, "v": -0.3, "p": 0.4, "r": 0.6, "phi": 0.5}
ROWS = ("u", "v", "p", "r")


def accelerations(motion: dict[str, float], force: Force, mass: dict[str, float]) -> np.ndarray:
    balance = rigid_body(motion, force, mass)
    matrix = np.array([[balance.mass.get((a, b), 0.0) for b in ROWS] for a in ROWS])
    return np.linalg.solve(matrix, [balance.force[s] for s in ROWS])


def test_the_printed_equations() -> None:
    """Any accelerations put into Eq. 1 as printed, and back out of it."""
    u, v, p, r, phi = MOVES.values()
    ud, vd, pd, rd = 0.11, -0.07, 0.05, 0.13
    m, x, z, Ixx, Izz = (BODY[n] for n in ("m", "x_G", "z_G", "I_xx", "I_zz"))
    c = np.cos(phi)
    force = Force(
        X=m * (ud - v * r - x * r**2 + z * p * r * c),
        Y=m * (vd + u * r - z * pd * c + x * rd),
        N=Izz * rd + m * x * (u * r + vd),
        K=Ixx * pd - m * z * (u * r + vd) * c,
    )
    np.testing.assert_allclose(accelerations(MOVES, force, BODY), [ud, vd, pd, rd], rtol=1e-12)


def test_added_masses_stand_on_the_left() -> None:
    """Each takes part with its own acceleration and with nothing else."""
    rates = {"u": 0.11, "v": -0.07, "p": 0.05, "r": 0.13}
    rows = {"X": "u", "Y": "v", "K": "p", "N": "r"}
    for name in (n for n in MASS_PARAMETERS if n.endswith("dot")):
        with_it = rigid_body(MOVES, Force(), BODY | {name: 0.25})
        without = rigid_body(MOVES, Force(), BODY)
        row, by = rows[name[0]], name[1]
        assert with_it.force == without.force
        for a in ROWS:
            left, bare = (
                sum(b.mass.get((a, s), 0.0) * rates[s] for s in ROWS) for b in (with_it, without)
            )
            assert left - bare == pytest.approx(-0.25 * rates[by] if a == row else 0.0, abs=1e-15)


def test_energy_and_momentum_of_a_free_body() -> None:
    """Upright, so that the paper's heel terms play no part; dT/dt = 0, and G moves straight."""
    motion = MOVES | {"p": 0.0, "phi": 0.0}
    body = BODY | {"z_G": 0.0}
    ud, vd, pd, rd = accelerations(motion, Force(), body)
    u, v, r, m, x, Izz = motion["u"], motion["v"], motion["r"], body["m"], body["x_G"], body["I_zz"]
    power = m * (u * ud + v * vd) + m * x * (vd * r + v * rd) + Izz * r * rd
    assert power == pytest.approx(0.0, abs=1e-14)
    assert pd == pytest.approx(0.0, abs=1e-14)
    across = v + x * r  # sway of the centre of gravity
    assert ud - across * r == pytest.approx(0.0, abs=1e-14)
    assert vd + x * rd + u * r == pytest.approx(0.0, abs=1e-14)


def test_a_turn_heels_a_ship_outward() -> None:
    """Mass above the axis (z_G < 0) in a turn to starboard pushes the port side down."""
    turning = {"u": 5.0, "v": 0.0, "p": 0.0, "r": 0.1, "phi": 0.0}
    assert rigid_body(turning, Force(), BODY).force["p"] < 0.0


def test_a_centre_of_gravity_at_the_origin_keeps_the_matrix_constant() -> None:
    """z_G = 0 leaves no cos(phi) behind, so that the engine may invert once."""
    body = BODY | {"z_G": 0.0}
    upright, heeled = (rigid_body(MOVES | {"phi": a}, Force(), body) for a in (0.0, 0.7))
    assert upright == heeled
