"""Drawn ships that heel, sailed by equations of their own: drag in sway and yaw, GM stated.

Forces by hulls of 80 to 200 m of published ones, each scattered; the water that sways with her
acts at a level of its own, between her keel and her waterline, and so does the hull's side force.
"""

from dataclasses import dataclass

import mmg
import numpy as np

RHO, G = mmg.RHO, 9.81


@dataclass(frozen=True, kw_only=True)
class Ship(mmg.Ship):
    """A ship as of `mmg`, without her shaft, and GM [m]; coefficients are primed by length."""

    GM: float
    n: float = 0.0


MIDDLE = {
    **{"Yvdot": -0.0080, "Nrdot": -0.00045, "Xudot": -0.0004, "Yv": -0.0125, "Yr": 0.0030},
    **{"Nv": -0.0042, "Nr": -0.0024, "Ydelta": -0.0026, "Ndelta": 0.0012},
    **{"Yvav": -0.035, "Nrar": -0.0011, "X0": 0.0012, "Xdd": -0.0014},
}
"""Of a cargo ship; each is drawn within a fifth of it."""


def drawn(seed):
    """A ship of 80 to 200 m; her roll period is 0.75 to 0.95 of her beam over root GM."""
    rng = np.random.default_rng(seed)
    L = rng.uniform(80.0, 200.0)
    B, d, block = L * rng.uniform(0.14, 0.17), L * rng.uniform(0.045, 0.055), rng.uniform(0.5, 0.7)
    c = {n: x * (1.0 + 0.2 * rng.uniform(-1.0, 1.0)) for n, x in MIDDLE.items()}
    GM, U0 = B * rng.uniform(0.03, 0.06), rng.uniform(0.2, 0.26) * np.sqrt(G * L)
    c["m"] = 2.0 * block * B * d / L**2
    c["I_zz"] = c["m"] * rng.uniform(0.22, 0.25) ** 2
    period = rng.uniform(0.75, 0.95) * B / np.sqrt(GM)
    c["I_xx"] = c["m"] * G * GM * (period / (2.0 * np.pi)) ** 2 / L**2  # the water's in it
    c["lever"], c["water"] = rng.uniform(0.2, 0.6) * d / L, rng.uniform(-0.1, 0.6) * d / L
    c["Kp"] = -2.0 * rng.uniform(0.04, 0.1) * c["I_xx"] * (2.0 * np.pi / period) * L / U0
    return Ship(c=c, L=L, B=B, d=d, block=block, U0=U0, GM=GM, gear=np.deg2rad(3.5))


def rates(ship, x, delta):
    """Time derivatives of u, v, p, r, phi and the course."""
    c, L = ship.c, ship.L
    u, v, p, r, phi, _ = x
    U = np.hypot(u, v)
    b, w, s = v / U, r * L / U, p * L / U
    q = 0.5 * RHO * L**2 * U**2
    hull = c["Yv"] * b + c["Yr"] * w + c["Yvav"] * b * abs(b)
    Y = q * (hull + c["Ydelta"] * delta) - c["m"] * 0.5 * RHO * L**3 * u * r
    N = q * L * (c["Nv"] * b + c["Nr"] * w + c["Nrar"] * w * abs(w) + c["Ndelta"] * delta)
    K = q * L * (-c["lever"] * (hull + c["Ydelta"] * delta) + c["Kp"] * s)
    K -= G * ship.mass * ship.GM * phi
    m3 = 0.5 * RHO * L**3
    sway, roll = (c["m"] - c["Yvdot"]) * m3, c["I_xx"] * m3 * L**2
    both = c["water"] * c["Yvdot"] * m3 * L  # what the water that sways does to the roll
    dv, dp = np.linalg.solve([[sway, both], [both, roll]], [Y, K])
    drive = c["X0"] * (ship.U0**2 - u**2) * 0.5 * RHO * L**2 + c["Xdd"] * delta**2 * q
    du = (drive + 0.4 * c["m"] * m3 * v * r) / ((c["m"] - c["Xudot"]) * m3)
    dr = N / ((c["I_zz"] - c["Nrdot"]) * m3 * L**2)
    return np.array([du, dv, dp, dr, p, r])


def sail(ship, angle, check, lengths=26.0):
    """A zig-zag that checks at a heading [deg]: t, u, r, phi, course, rudder; (N,) each."""
    dt, x, delta, side, rows = ship.L / ship.U0 / 120.0, np.zeros(6), 0.0, 1.0, []
    x[0] = ship.U0
    for k in range(int(120.0 * lengths)):
        if np.rad2deg(x[5]) * side >= check:
            side = -side
        order = np.deg2rad(angle) * side if k >= 240 else 0.0
        delta += np.clip(order - delta, -ship.gear * dt, ship.gear * dt)
        rows.append([k * dt, x[0], x[3], x[4], x[5], delta])
        k1 = rates(ship, x, delta)
        k2 = rates(ship, x + 0.5 * dt * k1, delta)
        k3 = rates(ship, x + 0.5 * dt * k2, delta)
        x = x + dt * (k1 + 2 * k2 + 2 * k3 + rates(ship, x + dt * k3, delta)) / 6.0
    return np.array(rows[::4]).T


def write_log(path, ship, rng, angle, check):
    """A log as a voyage recorder exports it."""
    t, u, r, phi, course, delta = sail(ship, angle, check)

    def noise(by):
        return by * rng.standard_normal(len(t))

    heading = (40.0 + np.rad2deg(course) + noise(0.1)) % 360.0
    angles = np.rad2deg(delta) + noise(0.1), np.rad2deg(r) * 60.0 + noise(0.6)
    columns = (t, *angles, np.rad2deg(phi) + noise(0.05), u / 0.514444 + noise(0.05), heading)
    head = "time_s,rudder_deg,rot_deg_per_min,roll_deg,stw_kn,heading_deg"
    np.savetxt(path, np.column_stack(columns), "%.5f", ",", header=head, comments="")
