"""Ships, zig-zags and sensors drawn at random, by equations written here and nowhere else.

Three kinds, so that the model that is fitted is right, roughly right, and of another structure:
`linear` (the same masses as the placeholder, every coefficient another), `beyond` (other masses,
and cross-flow, cubic yaw, quadratic roll damping, heel that turns her, wind and swell at random)
and `nomoto` (first order in yaw with a cubic term, heel by u r, speed lost in turns).
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.trial import Trial

Vector = NDArray[np.float64]
D: Final = np.pi / 180.0
G: Final = 9.81
KINDS: Final = ("linear", "beyond", "nomoto")

MASS: Final = {"m": 0.00792, "my": 0.007049, "I_x": 0.000021, "I_z": 0.000875}
"""Sway and yaw with added mass, roll with added mass; of the S-175, primed as SNAME."""

NABLA: Final = 0.00396
"""Displaced volume over L^3."""

BASE: Final = {
    "Yv": -0.0119, "Yr": 0.0029, "Nv": -0.0037, "Nr": -0.0025, "Kv": 0.00031, "Kr": -0.00007,
    "Ydelta": -0.0030, "Ndelta": 0.0015, "Kdelta": 0.0001,
}  # fmt: skip
ANGLES: Final = ((10 * D, "fit"), (20 * D, "fit"), (15 * D, "check"))
STEPS: Final = 4
"""Steps of the simulation in one sample."""


@dataclass(frozen=True)
class Drawn:
    """A ship, her three zig-zags as they were logged, and the truth as a placeholder would say it.

    Attributes
    ----------
    GM
        What a model with the placeholder's masses must find for the true roll period [m].
    values
        Coefficients to start from at the truth, as far as there is one.
    rolling
        Largest roll rate of the true motion [rad/s].
    """

    kind: str
    length: float
    speed: float
    GM: float
    ratio: float
    values: dict[str, float]
    unstable: bool
    rolling: float
    trials: tuple[Trial, ...]


def draw(seed: int) -> Drawn:
    """One ship by her seed."""
    rng = np.random.default_rng(seed)
    kind = KINDS[seed % len(KINDS)]
    L = float(np.exp(rng.uniform(np.log(2.0), np.log(300.0))))
    U = float(rng.uniform(0.10, 0.25) * np.sqrt(G * L))
    GM = L * float(np.exp(rng.uniform(np.log(0.002), np.log(0.03))))
    ratio = float(np.exp(rng.uniform(np.log(0.02), np.log(0.2))))
    if kind == "nomoto":
        motion, values, unstable, held = _nomoto(rng, L, U, GM, ratio)
    else:
        motion, values, unstable, held = _hull(rng, kind, L, U, GM, ratio)
    period = _period(L, U)
    sailed = _sail(motion, L, U, period)
    fastest = max(float(np.max(np.abs(s["p"]))) for s in sailed)
    trials = _logged(rng, kind, period, U, sailed)
    return Drawn(kind, L, U, held, ratio, values, unstable, fastest, trials)


def _period(L: float, U: float) -> float:
    """As a starter pipeline takes it: a fortieth of the time for her length."""
    return max(p for p in (0.01, 0.02, 0.05, 0.1, 0.2, 0.25, 0.5) if p <= max(L / U / 40, 0.05))


Motion = Callable[[Vector, Vector], Vector]
"""Rates of (v, p, r, phi, psi, u, t) [SI], (7, trials), by the states and the rudders."""


def _hull(
    rng: np.random.Generator, kind: str, L: float, U: float, GM: float, ratio: float
) -> tuple[Motion, dict[str, float], bool, float]:
    spread = 0.3 if kind == "beyond" else 0.25
    c = {n: x * float(np.exp(spread * rng.standard_normal())) for n, x in BASE.items()}
    c["Nv"] *= float(rng.uniform(0.6, 1.8 if kind == "beyond" else 1.2))
    off = rng.uniform(0.8, 1.2, 4) if kind == "beyond" else np.ones(4)
    M = {n: x * float(f) for (n, x), f in zip(MASS.items(), off, strict=True)}
    stiff = 2.0 * G * NABLA * GM / U**2  # of roll, primed: over L^3 U^2 / 2
    Kp = -2.0 * ratio * float(np.sqrt(stiff * M["I_x"]))
    there = rng.random(6) < (0.6 if kind == "beyond" else 0.0)
    size = np.exp(0.5 * rng.standard_normal(6))
    cross, cubic, quadratic, turns, blows, swells = np.where(there, size, 0.0)
    unstable = c["Yv"] * c["Nr"] - c["Nv"] * (c["Yr"] - M["m"]) < 0.0
    if unstable and kind == "linear":  # nothing would hold her: as much yaw damping as it takes
        c["Nr"] = 1.2 * c["Nv"] * (c["Yr"] - M["m"]) / c["Yv"]
        unstable = False
    cubic = max(cubic, 1.0) if unstable else cubic
    wind, wave = rng.uniform(0.0, 2.0 * np.pi), rng.uniform(0.4, 1.6)

    def motion(x: Vector, delta: Vector) -> Vector:
        v, p, r, phi = x[0] / U, x[1] * L / U, x[2] * L / U, x[3]
        gust = blows * np.cos(wind - x[4])
        Y = c["Yv"] * v + (c["Yr"] - M["m"]) * r + c["Ydelta"] * delta - 0.05 * cross * abs(v) * v
        N = c["Nv"] * v + c["Nr"] * r + c["Ndelta"] * delta - 0.003 * cubic * r**3
        N += -0.0003 * turns * phi + 0.00004 * gust
        K = c["Kv"] * v + c["Kr"] * r + c["Kdelta"] * delta + Kp * p - stiff * phi
        K += 2.0 * quadratic * Kp * abs(p) * p + stiff * 0.004 * gust
        roll = np.sqrt(stiff / M["I_x"]) * U / L
        K += stiff * 0.004 * swells * np.sin(wave * roll * x[6])
        forces = Y / (M["m"] + M["my"]) * U**2 / L
        turn = (U / L) ** 2
        still, one = np.zeros(len(v)), np.ones(len(v))
        return np.array([forces, turn * K / M["I_x"], turn * N / M["I_z"], x[1], x[2], still, one])

    held = GM * MASS["I_x"] / M["I_x"]
    values = {n: c[n] for n in ("Nv", "Nr", "Ndelta", "Kv", "Kr", "Kdelta")}
    return motion, values, unstable, held


def _nomoto(
    rng: np.random.Generator, L: float, U: float, GM: float, ratio: float
) -> tuple[Motion, dict[str, float], bool, float]:
    T, K = rng.uniform(0.8, 2.5), rng.uniform(0.8, 1.8)
    cubic, lean, lost = rng.uniform(0.0, 1.0), rng.uniform(0.3, 1.0), rng.uniform(0.2, 1.5)
    drift = rng.uniform(0.2, 0.6)
    omega = float(np.sqrt(2.0 * G * NABLA * GM / U**2 / MASS["I_x"])) * U / L

    def motion(x: Vector, delta: Vector) -> Vector:
        u, r, phi, p = x[5], x[2], x[3], x[1]
        turn = r * L / u
        rate = (K * delta - turn - cubic * turn**3) / T * (u / L) ** 2
        outward = -lean * 0.03 * (u / U) * turn
        rolled = omega**2 * (outward - phi) - 2.0 * ratio * omega * p
        slows = ((U - u) * 0.3 - lost * 0.3 * U * turn**2) * U / L
        settles = (-drift * r * L - x[0]) * u / L
        return np.array([settles, rolled, rate, p, r, slows, np.ones(len(u))])

    return motion, {}, False, GM


def _sail(motion: Motion, L: float, U: float, period: float) -> list[dict[str, Vector]]:
    """Zig-zags that go over at a heading of the rudder's angle; signals at the samples."""
    h, count = period / STEPS, round(35.0 * L / U / period)
    angle = np.array([a for a, _ in ANGLES])
    x, delta, order = np.zeros((7, len(angle))), np.zeros(len(angle)), np.zeros(len(angle))
    x[5], rate = U, 0.35 * U / L
    kept = np.zeros((count, 7, len(angle)))
    for k in range(count):
        kept[k, :6], kept[k, 6] = x[:6], delta
        if k * period > L / U:
            order = np.where(order == 0.0, angle, order)
            order = np.where(x[4] * np.sign(order) > angle, -order, order)
        for _ in range(STEPS):
            delta = delta + np.clip(order - delta, -rate * h, rate * h)
            a = motion(x, delta)
            b = motion(x + 0.5 * h * a, delta)
            c = motion(x + 0.5 * h * b, delta)
            x = x + h / 6.0 * (a + 2.0 * b + 2.0 * c + motion(x + h * c, delta))
    names = ("v", "p", "r", "phi", "psi", "u", "delta")
    return [dict(zip(names, kept[:, :, i].T, strict=True)) for i in range(len(angle))]


def _logged(
    rng: np.random.Generator,
    kind: str,
    period: float,
    U: float,
    sailed: list[dict[str, Vector]],
) -> tuple[Trial, ...]:
    """What sensors make of it: noise, biases, delays and a rudder whose zero is off.

    One ship in ten has a sensor far from others of its kind.
    """
    far = 4.0 if rng.random() < 0.1 else 1.0
    gyro, tilt = rng.uniform(0.02, 0.1) * D, rng.uniform(0.05, 0.2) * D
    b_r, b_phi = 0.02 * D * rng.standard_normal(), far * 0.5 * D * rng.standard_normal()
    zero = far * 0.5 * D * rng.standard_normal()
    late = far * rng.uniform(0.0, 0.4, 2)
    logs_speed = kind == "nomoto" and rng.random() < 0.5
    made = []
    for (angle, use), y in zip(ANGLES, sailed, strict=True):
        n = len(y["r"])
        t = period * np.arange(n)
        r = np.interp(t - late[0], t, y["r"]) + b_r + gyro * rng.standard_normal(n)
        phi = np.interp(t - late[1], t, y["phi"]) + b_phi + tilt * rng.standard_normal(n)
        middle = float(np.median(y["u"]))
        u = y["u"] + 0.01 * U * rng.standard_normal(n) if logs_speed else np.full(n, middle)
        signals = {"r": r, "phi": phi, "delta": y["delta"] - zero, "u": u}
        valid = {name: np.ones(n, dtype=bool) for name in signals}
        name = f"zigzag-{round(angle / D)}"
        made.append(Trial(name, "check" if use == "check" else "fit", period, signals, valid))
    return tuple(made)


# --- what a search is begun from -----------------------------------------------------------------

PLACEHOLDER: Final = """\
# A PLACEHOLDER, not your ship: only L and U0 are hers. Masses and coefficients are those of the
# container ship S-175, primed, so that they grow with L. They are good to begin a fit with: motions
# tell accelerations, and every coefficient found is relative to these masses. Put in your own
# figures where you have them, the masses first; the coefficients found are then your ship's.
"""

S175: Final = """\
m = 0.00792         # mass over 1/2 rho L^3: displacement / (1/2 L^3)
I_xx = 0.0000176    # roll inertia over 1/2 rho L^5
I_zz = 0.000456     # yaw inertia, a radius of gyration of 0.24 L
Xudot = -0.000238   # added masses
Yvdot = -0.007049
Kpdot = -0.0000034
Nrdot = -0.000419

[coefficients]      # where the search begins
Yv = -0.0119
Yr = 0.0029
Nv = -0.0037
Nr = -0.0025
Kv = 0.00031
Kr = -0.00007
Ydelta = -0.0030
Ndelta = 0.0015
Kdelta = 0.0001
Kp = -0.0000075
"""

DENSITY: Final = 1025.0
GM_OVER_L: Final = 0.3 / 175.0
"""Metacentric height over L of the S-175."""


def placeholder(length: float, speed: float) -> str:
    """The text of a ship file for a ship of this length [m] and speed [m/s]."""
    return (
        PLACEHOLDER
        + f'name = "placeholder of {length:g} m"\n'
        + 'source = "PLACEHOLDER: masses and coefficients of the container ship S-175 (Son & '
        + "Nomoto 1982), primed; only the length is the ship's own\"\n"
        + 'system = "prime"\nrudder_positive = "starboard"\n\n[particulars]\n'
        + f"L = {length:g}  # m, as stated\n"
        + f"U0 = {speed:.4g}  # m/s, as stated\n"
        + f"nabla = {NABLA * length**3:.5g}  # m^3, L^3 times the S-175's share: REPLACE\n"
        + f"rho = {DENSITY}\ng = {G}\n\n[mass]  # REPLACE\n"
        + S175
        + f"GM = {GM_OVER_L * length:.3g}  # m\n"
    )
