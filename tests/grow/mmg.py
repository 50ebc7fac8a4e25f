"""Drawn ships of another structure than any model here, sailed by equations of their own.

The MMG standard method, Yasukawa & Yoshimura (2015), J Mar Sci Technol 20: hull forces by cubic
polynomials of drift and turning, a screw that turns on while the ship slows down, a rudder in its
race. Numbers are those of a large tanker, each scattered by a quarter; the size is drawn.
"""

from dataclasses import dataclass, replace

import numpy as np

RHO = 1025.0
TANKER = """
R0 0.022  Xvv -0.040  Xvr 0.002  Xrr 0.011  Xvvvv 0.771
Yv -0.315  Yr 0.083  Yvvv -1.607  Yvvr 0.379  Yvrr -0.391  Yrrr 0.008
Nv -0.137  Nr -0.049  Nvvv -0.030  Nvvr -0.294  Nvrr 0.055  Nrrr -0.013
mx 0.022  my 0.223  Jz 0.011
tR 0.387  aH 0.312  xH -0.464  C1 2.0  gamma 0.5  lR -0.710  slope 2.747
"""
_WORDS = TANKER.split()
NUMBERS = dict(zip(_WORDS[::2], map(float, _WORDS[1::2]), strict=True))
WAKE, THRUST_LOST, RACE, HULL_WAKE = 0.35, 0.22, 0.5, 1.09


@dataclass(frozen=True, kw_only=True)
class Ship:
    """A ship: her coefficients, size [m], mass [kg], speed [m/s], shaft [1/s], gear [rad/s]."""

    c: dict[str, float]
    L: float
    B: float
    d: float
    block: float
    U0: float
    n: float
    gear: float

    @property
    def mass(self):
        return RHO * self.block * self.L * self.B * self.d


def drawn(seed):
    """A ship of 5 to 300 m at a Froude number of 0.12 to 0.24."""
    rng = np.random.default_rng(seed)
    c = {n: x * (1.0 + 0.25 * rng.standard_normal()) for n, x in NUMBERS.items()}
    L = float(np.exp(rng.uniform(np.log(5.0), np.log(300.0))))
    B, d = L * 0.18 * rng.uniform(0.75, 1.05), L * 0.065 * rng.uniform(0.8, 1.2)
    U0 = rng.uniform(0.12, 0.24) * np.sqrt(9.81 * L)
    gear = np.deg2rad(rng.uniform(2.3, 5.0)) / np.sqrt(min(L / 150.0, 1.0))
    low, high = 1e-3, 200.0 / np.sqrt(L)
    ship = Ship(c=c, L=L, B=B, d=d, block=rng.uniform(0.6, 0.82), U0=U0, n=high, gear=gear)
    for _ in range(60):  # the shaft at which she keeps her speed
        n = 0.5 * (low + high)
        ship = replace(ship, n=n)
        low, high = (low, n) if forces(ship, U0, 0.0, 0.0, 0.0)[0] > 0.0 else (n, high)
    return ship


def forces(ship, u, v, r, delta):
    """X, Y [N] and N [N m]; a rudder to starboard, delta > 0, turns her to starboard."""
    c, L = ship.c, ship.L
    U = max(np.hypot(u, v), 1e-3 * ship.U0)
    b, w = v / U, r * L / U
    q = 0.5 * RHO * L * ship.d * U * U
    X = -c["R0"] + c["Xvv"] * b**2 + c["Xvr"] * b * w + c["Xrr"] * w**2 + c["Xvvvv"] * b**4
    Y, N = (_polynomial(c, k, b, w) for k in ("Y", "N"))
    diameter, height = L * 9.86 / 320.0, L * 15.8 / 320.0
    drift = np.arctan2(-v, u)
    inflow = 1.0 - np.exp(-c["C1"] * abs(drift + 0.48 * w))
    ahead = u * (1.0 - WAKE) * (1.0 + 0.35 * inflow)  # the wake goes as she drifts
    J = ahead / (ship.n * diameter)
    KT = 0.2931 - 0.2753 * J - 0.1385 * J**2
    thrust = (1.0 - THRUST_LOST) * RHO * ship.n**2 * diameter**4 * KT
    share = diameter / height
    loading = np.sqrt(max(1.0 + 8.0 * KT / (np.pi * max(J, 1e-3) ** 2), 0.0)) - 1.0
    uR = HULL_WAKE * ahead * np.sqrt(share * (1.0 + RACE * loading) ** 2 + 1.0 - share)
    vR = U * c["gamma"] * (drift - c["lR"] * w)
    area = L * ship.d / 55.0
    FN = 0.5 * RHO * area * (uR**2 + vR**2) * c["slope"] * np.sin(delta - np.arctan2(vR, uR))
    aft = 0.5 * L - c["aH"] * c["xH"] * L
    return (
        q * X + thrust - (1.0 - c["tR"]) * FN * np.sin(delta),
        q * Y - (1.0 + c["aH"]) * FN * np.cos(delta),
        q * L * N + aft * FN * np.cos(delta),
    )


def _polynomial(c, k, b, w):
    """Side force or moment of the hull by drift b and turning w."""
    linear, square = c[f"{k}v"] * b + c[f"{k}r"] * w, c[f"{k}vvr"] * b**2 * w
    return linear + square + c[f"{k}vvv"] * b**3 + c[f"{k}vrr"] * b * w**2 + c[f"{k}rrr"] * w**3


def rates(ship, x, delta):
    """Time derivatives of u, v, r and the course."""
    u, v, r, _ = x
    X, Y, N = forces(ship, u, v, r, delta)
    water = 0.5 * RHO * ship.L**2 * ship.d
    mx, my = (ship.mass + ship.c[k] * water for k in ("mx", "my"))
    inertia = ship.mass * (0.25 * ship.L) ** 2 + ship.c["Jz"] * water * ship.L**2
    return np.array([(X + my * v * r) / mx, (Y - mx * u * r) / my, N / inertia, r])


def sail(ship, angle, check=None, lengths=30.0):
    """A zig-zag, or a turn without `check` [deg]: t, u, v, r, rudder [SI]; (N,) each."""
    dt, x, delta, side, rows = ship.L / ship.U0 / 40.0, np.array([ship.U0, 0, 0, 0.0]), 0.0, 1.0, []
    for k in range(int(40.0 * lengths)):
        if check is not None and np.rad2deg(x[3]) * side >= check:
            side = -side
        order = np.deg2rad(angle) * side if k >= 80 else 0.0
        delta += np.clip(order - delta, -ship.gear * dt, ship.gear * dt)
        rows.append([k * dt, *x[:3], delta])
        k1 = rates(ship, x, delta)
        k2 = rates(ship, x + 0.5 * dt * k1, delta)
        k3 = rates(ship, x + 0.5 * dt * k2, delta)
        x = x + dt * (k1 + 2 * k2 + 2 * k3 + rates(ship, x + dt * k3, delta)) / 6.0
    return np.array(rows).T


def slopes(ship):
    """Her linear coefficients about the straight course, as a model without surge has them.

    The added mass ahead, which turns with her, is part of what turning does; primed by length.
    """
    q, L, U, step = 0.5 * RHO * ship.L**2, ship.L, ship.U0, 1e-5
    scale = {"v": U, "r": U / L, "delta": 1.0}
    found = {}
    for name, unit in scale.items():
        ends = []
        for side in (step, -step):
            at = {n: side * unit if n == name else 0.0 for n in scale}
            ends.append(forces(ship, U, at["v"], at["r"], at["delta"]))
        by = np.subtract(*ends) / (2.0 * step)
        found[f"Y{name}"], found[f"N{name}"] = by[1] / (q * U**2), by[2] / (q * L * U**2)
    found["Yr"] -= ship.c["mx"] * ship.d / L
    return found | {"Y_race": found["Ydelta"], "N_race": found["Ndelta"]}


def file_of(ship):
    """The ship file that her own model tests would give: masses, and the slopes of above."""
    m, thin, c = ship.mass / (0.5 * RHO * ship.L**3), ship.d / ship.L, ship.c
    mass = {"m": m, "I_zz": m / 16.0, "Xudot": -c["mx"], "Yvdot": -c["my"], "Nrdot": -c["Jz"]}
    mass |= {n: thin * x for n, x in mass.items() if n.endswith("dot")}
    size = {"L": ship.L, "B": ship.B, "T": ship.d, "nabla": ship.mass / RHO, "U0": ship.U0}
    linear = {n: x for n, x in slopes(ship).items() if "race" not in n}
    tables = {"particulars": size | {"rho": RHO, "g": 9.81}, "mass": mass, "coefficients": linear}
    lines = ['name = "drawn"', 'source = "her own tests"', 'system = "prime"']
    lines.append('rudder_positive = "starboard"')
    for name, table in tables.items():
        lines += ["", f"[{name}]", *(f"{key} = {value:.6g}" for key, value in table.items())]
    return "\n".join(lines) + "\n"


def noise_of(ship):
    """Standard deviations of a simple recorder's sensors [SI]; the gyro's is 0.05 deg/s at 60 m."""
    return {
        "r": np.deg2rad(0.5) * ship.U0 / ship.L,
        "v": 0.01 * ship.U0,
        "u": 0.005 * ship.U0,
        "delta": np.deg2rad(0.1),
        "psi": np.deg2rad(0.2),
    }


ZERO = np.deg2rad(0.3)
"""Of the rudder from trial to trial, where heading and speed alone are logged."""


def write_log(path, ship, rng, *manoeuvre, heading=False):
    """What such a recorder writes of a manoeuvre; with `heading` by a compass and a speed log."""
    t, u, v, r, delta = sail(ship, *manoeuvre)
    seen = {"delta": delta, "r": r, "v": v, "u": u}
    if heading:
        turned = np.concatenate([[0.0], np.cumsum(0.5 * (r[1:] + r[:-1]) * np.diff(t))])
        zero = ZERO * rng.standard_normal()
        seen = {"delta": delta + zero, "psi": np.deg2rad(90.0) + turned, "u": u}
    noise = noise_of(ship)
    columns = {"time [s]": t}
    for name, x in seen.items():
        called, unit = CALLED[name]
        columns[called] = unit * (x + noise[name] * rng.standard_normal(len(t)))
    if heading:
        columns["heading [deg]"] %= 360.0
    table = np.column_stack(list(columns.values()))
    np.savetxt(path, table, "%.5f", ",", header=",".join(columns), comments="")


CALLED = {
    "delta": ("rudder angle [deg]", np.rad2deg(1.0)),
    "r": ("yaw rate [deg/s]", np.rad2deg(1.0)),
    "psi": ("heading [deg]", np.rad2deg(1.0)),
    "v": ("v [m/s]", 1.0),
    "u": ("u [m/s]", 1.0),
}
"""What a recorder calls it, and its unit over ours."""
