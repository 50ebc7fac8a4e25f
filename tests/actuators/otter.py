"""The Otter, a 2 m catamaran with two thrusters and no rudder, from published facts alone.

Fossen's model as PythonVehicleSimulator publishes it, written anew: rigid body and added mass about
the origin amidships with their Coriolis terms, the full Munk moment, linear damping that does not
fall with speed, ten times its yaw term in r |r|, cross-flow drag of two pontoons (Hoerner's curve
replaced by one number, 0.8), two propellers with a lag. Nothing of `trialid` is used.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]

G, RHO = 9.81, 1025.0
L, B = 2.0, 1.08
HULL, PAYLOAD = 55.0, 25.0
MASS = HULL + PAYLOAD
X_HULL, X_PAYLOAD = 0.2, 0.05
R66 = 0.25 * L
X_G = (HULL * X_HULL + PAYLOAD * X_PAYLOAD) / MASS
I_Z = HULL * R66**2 + HULL * (X_HULL - X_G) ** 2 + PAYLOAD * (X_PAYLOAD - X_G) ** 2 + MASS * X_G**2
XUDOT, YVDOT, NRDOT = -0.1 * HULL, -1.5 * HULL, -1.7 * I_Z
U_MAX = 6.0 * 1852.0 / 3600.0
XU, YV, NR = -24.4 * G / U_MAX, -(MASS + 1.5 * HULL), -(I_Z - NRDOT)
NRR = 10.0 * NR
ARM = 0.395
AHEAD, ASTERN = 0.02216 / 2.0, 0.01289 / 2.0
N_MAX, N_MIN = np.sqrt(0.5 * 24.4 * G / AHEAD), -np.sqrt(0.5 * 13.6 * G / ASTERN)
LAG = 0.1
STRIPS = 10
"""As many as the published sum has: twice as many are 1.5 % more drag, which Nrr would make up."""
PONTOON, DRAUGHT, C_D = 0.25, MASS / (2.0 * RHO * L * 0.25 * 0.5), 0.8


@dataclass(frozen=True, kw_only=True)
class Sailed:
    """What the boat did: orders and revolutions [rad/s], motion [SI]; (N,) each."""

    t: Vector
    orders: Vector
    revolutions: Vector
    u: Vector
    v: Vector
    r: Vector


def thrust(n: Vector) -> Vector:
    """Of each propeller [N]."""
    return np.where(n > 0.0, AHEAD, ASTERN) * n * np.abs(n)


def rates(
    state: Vector, orders: Vector, weak: Vector, cross_flow: float, quadratic: float = 0.0
) -> Vector:
    """Time derivatives of u, v, r and both revolutions; `quadratic` is Xuu [kg/m], hers is 0."""
    u, v, r, *n = state
    left, right = thrust(np.array(n)) * (1.0 - weak)
    X = left + right + XU * u + quadratic * u * abs(u) + (MASS - YVDOT) * v * r + MASS * X_G * r * r
    Y = YV * v - (MASS - XUDOT) * u * r
    N = ARM * (left - right) + NR * r + NRR * abs(r) * r - MASS * X_G * u * r
    N += (YVDOT - XUDOT) * u * v
    strips = (np.arange(STRIPS) + 0.5) * L / STRIPS - L / 2.0
    drag = 0.5 * RHO * DRAUGHT * cross_flow * np.abs(v + strips * r) * (v + strips * r) * L / STRIPS
    Y, N = Y - drag.sum(), N - (strips * drag).sum()
    lateral = np.array([[MASS - YVDOT, MASS * X_G], [MASS * X_G, I_Z - NRDOT]])
    v_dot, r_dot = np.linalg.solve(lateral, [Y, N])
    return np.array([X / (MASS - XUDOT), v_dot, r_dot, *((orders - n) / LAG)])


def sail(
    t: Vector,
    orders: Vector,
    weak: tuple[float, float] = (0.0, 0.0),
    cross_flow: float = C_D,
    quadratic: float = 0.0,
) -> Sailed:
    """The boat under orders (N, 2) [rad/s] that run straight from sample to sample, from rest.

    Classical Runge-Kutta, five steps each: of orders held for a fifth of a sample the lag would
    come back 0.1 % too long, a quarter of its standard error.
    """
    state, lost, states = np.zeros(5), np.array(weak), []
    h = (t[1] - t[0]) / 5.0
    for k in range(len(t)):
        states.append(state)
        for i in range(5):
            rise = (orders[min(k + 1, len(t) - 1)] - orders[k]) / 5.0
            first, middle, last = (orders[k] + rise * (i + part) for part in (0.0, 0.5, 1.0))
            a = rates(state, first, lost, cross_flow, quadratic)
            b = rates(state + h / 2.0 * a, middle, lost, cross_flow, quadratic)
            c = rates(state + h / 2.0 * b, middle, lost, cross_flow, quadratic)
            d = rates(state + h * c, last, lost, cross_flow, quadratic)
            state = state + h / 6.0 * (a + 2.0 * b + 2.0 * c + d)
    x = np.array(states)
    return Sailed(t=t, orders=orders, revolutions=x[:, 3:], u=x[:, 0], v=x[:, 1], r=x[:, 2])


def some_orders(t: Vector, seed: int) -> Vector:
    """Steps of both propellers, held 3 to 9 s, ahead and astern; (N, 2) [rad/s]."""
    rng = np.random.default_rng(seed)
    orders, at = np.zeros((len(t), 2)), 2.0
    while at < t[-1]:
        held = rng.uniform(3.0, 9.0)
        both = rng.uniform([0.75 * N_MIN] * 2, [0.95 * N_MAX] * 2)
        orders[t >= at] = both
        at += held
    return orders
