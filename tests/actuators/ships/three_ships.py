"""Three ships with more than a rudder, written from the equations of motion alone.

A ferry with four pods, a cargo ship with two screws and a rudder in the race of each, a supply
vessel that moves slowly with a tunnel in her bow. Sizes are of usual ships of their kind, masses by
block coefficient, added mass 5 %, 80 % and 60 % of them. Nothing of `trialid` is used.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]
Row = Mapping[str, float]
Push = Callable[[Row, float, float, float], tuple[float, float, float]]
"""Force ahead, force to starboard and moment of all actuators, of their signals and u, v, r."""

RHO: Final = 1025.0
STRIPS: Final = tuple((i + 0.5) / 10.0 - 0.5 for i in range(10))
"""Middles of pieces of a hull over L, as many as the published sum has."""


@dataclass(frozen=True, kw_only=True)
class Hull:
    """A hull that moves in the plane; SI. Damping `Xu`, `Yv`, `Nr` is there at rest.

    `Yuv` to `Nur` are lift and drift forces that go with the speed, per |U|.
    """

    L: float
    T: float
    mass: float
    Xu: float
    Xuu: float
    Yv: float = 0.0
    Nr: float = 0.0
    C_D: float = 0.0
    Yuv: float = 0.0
    Yur: float = 0.0
    Nuv: float = 0.0
    Nur: float = 0.0
    munk: bool = True

    @property
    def inertia(self) -> float:
        """About the origin amidships, where the centre of gravity is."""
        return self.mass * (0.25 * self.L) ** 2

    @property
    def added(self) -> tuple[float, float, float]:
        """Xudot, Yvdot and Nrdot."""
        return -0.05 * self.mass, -0.8 * self.mass, -0.6 * self.inertia

    def rates(self, u: float, v: float, r: float, push: tuple[float, float, float]) -> Vector:
        """Accelerations ahead, to starboard and in yaw."""
        X, Y, N = push
        Xudot, Yvdot, Nrdot = self.added
        speed = math.hypot(u, v)
        X += (self.mass - Yvdot) * v * r + self.Xu * u + self.Xuu * u * abs(u)
        Y += -(self.mass - Xudot) * u * r + self.Yv * v
        Y += speed * (self.Yuv * v + self.Yur * r)
        N += self.Nr * r + speed * (self.Nuv * v + self.Nur * r)
        N += (Yvdot - Xudot) * u * v if self.munk else 0.0
        for share in STRIPS if self.C_D else ():
            x = share * self.L
            w = v + x * r
            drag = 0.5 * RHO * self.C_D * self.T * self.L / len(STRIPS) * w * abs(w)
            Y, N = Y - drag, N - x * drag
        return np.array(
            [X / (self.mass - Xudot), Y / (self.mass - Yvdot), N / (self.inertia - Nrdot)]
        )


def sail(hull: Hull, push: Push, t: Vector, given: Mapping[str, Vector], u0: float) -> Vector:
    """Motion u, v, r under recorded signals that run straight from sample to sample; (N, 3)."""
    h, x, rows = t[1] - t[0], np.array([u0, 0.0, 0.0]), []
    samples = [{n: float(y[k]) for n, y in given.items()} for k in range(len(t))]
    for k, now in enumerate(samples):
        rows.append(x)
        after = samples[min(k + 1, len(t) - 1)]
        middle = {n: 0.5 * (now[n] + after[n]) for n in now}

        def rate(y: Vector, row: Row) -> Vector:
            u, v, r = (float(z) for z in y)
            return hull.rates(u, v, r, push(row, u, v, r))

        a = rate(x, now)
        b = rate(x + 0.5 * h * a, middle)
        c = rate(x + 0.5 * h * b, middle)
        d = rate(x + h * c, after)
        x = x + h / 6.0 * (a + 2.0 * b + 2.0 * c + d)
    return np.array(rows)


def at_place(X: float, Y: float, x: float, y: float) -> Vector:
    """A force at a place, with its moment about amidships."""
    return np.array([X, Y, x * Y - y * X])


def bollard(n: float, ahead: float, astern: float) -> float:
    """Thrust of a screw [N] at n [rad/s]."""
    return ahead * n * n if n > 0.0 else -astern * n * n


def moved(t: Vector, rng: np.random.Generator, low: float, high: float, ramp: float) -> Vector:
    """A signal that goes to a new value every 30 to 60 s, in `ramp` [s]; (N,)."""
    times, values = [0.0], [0.5 * (low + high)]
    while times[-1] < t[-1]:
        hold = rng.uniform(30.0, 60.0)
        times += [times[-1] + hold, times[-1] + hold + ramp]
        values += [values[-1], rng.uniform(low, high)]
    return np.interp(t, times, values)


FERRY: Final = Hull(L=70.0, T=3.5, mass=2.26e6, Xu=-5e3, Xuu=-4.7e3, Yv=-3e4, Nr=-3e7, C_D=0.9)
PODS: Final = {
    "pod_1": (30.0, -5.0),
    "pod_2": (30.0, 5.0),
    "pod_3": (-30.0, -5.0),
    "pod_4": (-30.0, 5.0),
}
POD_AHEAD, POD_ASTERN, OLD_POD = 125.0, 90.0, 0.85
"""N s^2 each; the fourth pod has an old propeller with this share of both."""


def pods(now: Row, u: float, v: float, r: float) -> tuple[float, float, float]:
    """Four pods, each to where it points."""
    total = np.zeros(3)
    for name, (x, y) in PODS.items():
        pull = bollard(now[name], POD_AHEAD, POD_ASTERN) * (OLD_POD if name == "pod_4" else 1.0)
        angle = now[f"{name}_angle"]
        total += at_place(pull * math.cos(angle), pull * math.sin(angle), x, y)
    return tuple(total)


STRUT, LOST = 1.2e3, 45.0
"""Of each pod: side force [N s^2/m^2], thrust lost in the race of the nearest [N s^2]."""


def pods_in_races(now: Row, u: float, v: float, r: float) -> tuple[float, float, float]:
    """Four pods with struts; each loses thrust where the race of another one meets it."""
    total = np.array(pods(now, u, v, r))
    for name, (x, y) in PODS.items():
        angle = now[f"{name}_angle"]
        flow = complex(u - y * r, v + x * r)
        across = (flow * np.exp(-1j * angle)).imag
        force = -STRUT * abs(flow) * across * 1j * np.exp(1j * angle)
        for other, (x_o, y_o) in PODS.items():
            if other != name:
                there = complex(x - x_o, y - y_o)
                blows = -now[other] * np.exp(1j * now[f"{other}_angle"])
                off = abs(np.rad2deg(np.angle(there / blows)))
                near = (10.0 / abs(there)) / (
                    1.0
                    + (2.0 * np.sin(np.deg2rad(off) / 2.0)) ** 3
                    / (130.0 * np.deg2rad(1.0) ** 3 / 0.7**3)
                )
                force -= LOST * now[name] * abs(now[other]) * near * np.exp(1j * angle)
        total += at_place(force.real, force.imag, x, y)
    return tuple(total)


def pod_signals(t: Vector, seed: int) -> dict[str, Vector]:
    """Revolutions of each and where each points, all apart."""
    rng = np.random.default_rng([seed, 4])
    turns = {name: moved(t, rng, -12.0, 22.0, 6.0) for name in PODS}
    return turns | {f"{name}_angle": moved(t, rng, -1.5, 1.5, 12.0) for name in PODS}


_Q: Final = 0.5 * RHO * 100.0**2
CARGO: Final = Hull(
    L=100.0,
    T=5.5,
    mass=6.5e6,
    Xu=0.0,
    Xuu=-6e3,
    munk=False,
    Yuv=-0.0119 * _Q,
    Yur=0.0029 * _Q * 100.0,
    Nuv=-0.0037 * _Q * 100.0,
    Nur=-0.0025 * _Q * 100.0**2,
)
SCREWS: Final = {"port": -4.0, "stbd": 4.0}
AFT, SCREW_AHEAD, SCREW_ASTERN, ADVANCE, RACE = -45.0, 1200.0, 800.0, 900.0, 700.0
YDELTA, NDELTA = -0.0015, 0.0007
"""Of both rudders outside of the race, primed."""


def twin_screws(now: Row, u: float, v: float, r: float) -> tuple[float, float, float]:
    """Two screws, which lose thrust to the speed, and a rudder behind each."""
    total = np.zeros(3)
    for side, y in SCREWS.items():
        n, delta = now[f"screw_{side}"], now[f"rudder_{side}"]
        total += at_place(bollard(n, SCREW_AHEAD, SCREW_ASTERN) - ADVANCE * abs(n) * u, 0.0, AFT, y)
        total += 0.5 * delta * _Q * (u * u + v * v) * np.array([0.0, YDELTA, NDELTA * CARGO.L])
        normal = RACE * n * n * math.sin(delta) if n > 0.0 else 0.0
        total += at_place(-normal * math.sin(delta), -normal * math.cos(delta), AFT - 4.0, y)
    return tuple(total)


def twin_signals(t: Vector, seed: int) -> dict[str, Vector]:
    """Revolutions ahead and at times astern, rudders to 25 deg, each side apart."""
    rng = np.random.default_rng([seed, 2])
    turns = {f"screw_{side}": moved(t, rng, -6.0, 18.0, 8.0) for side in SCREWS}
    return turns | {f"rudder_{side}": moved(t, rng, -0.44, 0.44, 6.0) for side in SCREWS}


SUPPLY: Final = Hull(L=60.0, T=4.5, mass=2.9e6, Xu=-4e3, Xuu=-5e3, Yv=-4e4, Nr=-3e7, C_D=1.0)
BOW, TUNNEL, FADES = 24.0, 180.0, 1.6
"""Its place [m], thrust [N s^2], the speed [m/s] at which 1/e of it is left."""
MAIN: Final = {"port": -3.5, "stbd": 3.5}
MAIN_AHEAD, MAIN_ASTERN = 320.0, 210.0


def bow_and_screws(now: Row, u: float, v: float, r: float) -> tuple[float, float, float]:
    """Two screws aft and a tunnel that pushes to starboard."""
    total = np.zeros(3)
    for side, y in MAIN.items():
        total += at_place(bollard(now[f"main_{side}"], MAIN_AHEAD, MAIN_ASTERN), 0.0, -27.0, y)
    side_push = TUNNEL * now["bow"] * abs(now["bow"]) * math.exp(-((u / FADES) ** 2))
    return tuple(total + at_place(0.0, side_push, BOW, 0.0))


SUCKED: Final = -450.0
"""Force that the jet takes off the hull at a Froude number of one [N s^2], without a moment."""


def sucked_bow(now: Row, u: float, v: float, r: float) -> tuple[float, float, float]:
    """The same where the bent jet sucks at the side."""
    X, Y, N = bow_and_screws(now, u, v, r)
    return X, Y + SUCKED * now["bow"] * abs(now["bow"]) * abs(u) / math.sqrt(9.81 * SUPPLY.L), N


def slow_signals(t: Vector, seed: int) -> dict[str, Vector]:
    """Low revolutions of both screws, apart, and the tunnel to both sides."""
    rng = np.random.default_rng([seed, 1])
    turns = {f"main_{side}": moved(t, rng, -6.0, 10.0, 5.0) for side in MAIN}
    return turns | {"bow": moved(t, rng, -25.0, 25.0, 4.0)}
