"""The rudder: linear and cubic forces, its neutral angle, and the propeller's race over it."""

import math
from typing import Final

from trialid.maths import Number, arctan, cos, sin, sqrt
from trialid.ship.effect import Force, Parameter, Steered, effect

BK99 = "Blanke & Knudsen (1999), section 4"
SN82 = "Son & Nomoto (1982), container ship S-175"
BC93 = "Blanke & Christensen (1993), multipurpose naval vessel"
BG72 = "van Berlekom & Goddard (1972), tanker: squared flow over the rudder as u n and n^2"
CST65 = "Chislett & Strom-Tejsen (1965), Mariner"
TURN = 2.0 * math.pi
PI = math.pi
STANDSTILL = 1e-12  # (m/s)^2: quotients keep their limit at rest


@effect(source=BK99)
def linear_rudder(delta, *, Ydelta=-0.003, Kdelta=0.0001, Ndelta=0.0015):
    """Y = Ydelta delta,  K = Kdelta delta,  N = Ndelta delta: small rudder angles."""
    return Force(Y=Ydelta * delta, K=Kdelta * delta, N=Ndelta * delta)


@effect(source=CST65)
def rudder_cubic(
    delta, *,
    Yddd=Parameter(0.001, low=-0.02, high=0.02), Nddd=Parameter(-0.0005, low=-0.01, high=0.01),
):  # fmt: skip
    """Y = Yddd delta^3,  N = Nddd delta^3: lift that falls off at large rudder angles."""
    return Force(Y=Yddd * delta**3, N=Nddd * delta**3)


@effect(source=SN82)
def surge_rudder(delta, *, Xdd=Parameter(-0.002, low=-0.05, high=0.0)):
    """X = Xdd delta^2: resistance of the rudder."""
    return Force(X=Xdd * delta**2)


@effect(source=CST65)
def rudder_in_drift(
    v, delta, *,
    Yvvd=Parameter(-0.012, low=-0.2, high=0.2), Nvvd=Parameter(0.005, low=-0.1, high=0.1),
):  # fmt: skip
    """Y = Yvvd v^2 delta,  N = Nvvd v^2 delta: the rudder at large drift."""
    return Force(Y=Yvvd * v**2 * delta, N=Nvvd * v**2 * delta)


@effect(source=CST65)
def drift_with_rudder(
    v, delta, *,
    Yvdd=Parameter(-0.00004, low=-0.02, high=0.02), Nvdd=Parameter(0.00013, low=-0.02, high=0.02),
):  # fmt: skip
    """Y = Yvdd v delta^2,  N = Nvdd v delta^2: drift with the rudder put over."""
    return Force(Y=Yvdd * v * delta**2, N=Nvdd * v * delta**2)


ROUNDED: Final = 0.005
"""[rad] Over which a rudder begins to stall; half and twice of it name it too, on four records of a
ship that stalls at 12 to 20 deg."""


def _above(x: Number) -> Number:
    """x where it is above zero, else none of it, over half a degree: no lift breaks at a corner.

    At one a search for its angle ends where the rudder of a zig-zag is held.
    """
    return 0.5 * (x + sqrt(x * x + ROUNDED * ROUNDED))


# Tried at 12, 17 and 21 deg too: at its typical angle a rudder that was never put over so far has
# no trace.
@effect(source="rudders stall at 20 to 35 deg; 23 deg in " + BC93)
def rudder_stall(
    delta, *,
    N_stall=Parameter(-0.0015, low=-0.05, high=0.0, scan=(-0.0015,)),
    delta_stall=Parameter(0.45, "rad", low=0.2, high=0.9, null=None, scan=(0.21, 0.29, 0.37)),
):  # fmt: skip
    """N = N_stall (delta beyond +- delta_stall),  Y = -2 N: lift that breaks off; aft."""
    N = N_stall * (_above(delta - delta_stall) - _above(-delta - delta_stall))
    return Force(Y=-2.0 * N, N=N)


# The lever is tried from none to its typical one: of a tanker by the MMG model that one showed
# nothing (p = 1), and with none the error falls by a sixth.
@effect(source="MMG: flow straightening gamma_R differs by 20 % to port and starboard")
def rudder_flow_asymmetry(
    v, r, *,
    N_flow=Parameter(0.00015, low=-0.003, high=0.003, scan=(0.0005, -0.0005)),
    l_flow=Parameter(-0.8, low=-2.0, high=0.0, null=None, scan=(0.0, -0.4)),
):  # fmt: skip
    """N = N_flow |v + l_flow r|,  Y = -2 N: drift feeds the rudder unlike on each side."""
    N = N_flow * abs(v + l_flow * r)
    return Force(Y=-2.0 * N, N=N)


@effect(source="model tests at constant shaft speed")
def rudder_race(
    u, delta, U0, *,
    Y_race=Parameter(-0.003, low=-0.05, high=0.0, null=None),
    K_race=Parameter(0.0001, low=0.0, high=0.002, null=None),
    N_race=Parameter(0.0015, low=0.0, high=0.02, null=None),
):  # fmt: skip
    """Y, K, N = Y_race, K_race, N_race times delta u U0 / U^2: rudder force as u U0.

    Instead of linear_rudder, whose force goes as U^2: at constant shaft speed the propeller's race
    keeps part of the flow over the rudder when the ship slows down.
    """
    race = delta * u * U0
    return Force(Y=Y_race * race, K=K_race * race, N=N_race * race)


@effect(source="neutral angle of a single-screw ship; indicator zero")
def rudder_offset(*, delta_0=Parameter(0.01, "rad", low=-0.1, high=0.1)):
    """delta = delta + delta_0: the recorded zero does not keep the ship straight."""
    return Steered(delta=delta_0)


@effect(source="indicator gain")
def rudder_scale(delta, *, e_delta=Parameter(0.05, low=-0.5, high=0.5)):
    """delta = delta + e_delta delta: an indicator that reads too little; acts as Ydelta."""
    return Steered(delta=e_delta * delta)


@effect(source="linkage of a rudder feedback unit: 1 to 2 deg at 35 deg")
def rudder_feedback_curve(delta, *, a_delta=Parameter(0.07, "1/rad", low=-0.5, high=0.5)):
    """delta = delta + a_delta delta^2: an indicator wrong to one side."""
    return Steered(delta=a_delta * delta**2)


def _inflow(
    u: Number, v: Number, r: Number, L: Number, w_P: Number, tau_P: Number, x_P: Number
) -> Number:
    """Speed of the water at the propeller; the printed code of the set has cos(v) for u."""
    return u * ((1.0 - w_P) + tau_P * (v + x_P * r * L) ** 2 / (u * u + v * v + STANDSTILL))


def _race(inflow: Number, n: Number, D_P: Number, KT0: Number, KT1: Number) -> Number:
    """K_T (n D_P)^2 with K_T = KT0 + KT1 J, finite with the shaft stopped; n in rad/s, ahead."""
    tip = _ahead(n) / TURN * D_P
    return (KT0 * tip + KT1 * inflow) * tip


def _astern(inflow: Number, n: Number, D_P: Number, KT0: Number, KT1: Number) -> Number:
    """The same of a shaft that turns astern, as of a screw with two like faces.

    Water from ahead, in which the blades stall, leaves it the thrust of a ship at rest; from astern
    it takes of it as J takes ahead.
    """
    return _race(_ahead(-inflow), -n, D_P, KT0, KT1)


def _ahead(x: Number) -> Number:
    """x where it is positive, else 0."""
    return 0.5 * (x + abs(x))


@effect(source=BG72)
def rudder_race_shaft(
    u,
    n,
    delta,
    *,
    N_un=Parameter(2e-6, low=0.0, high=1e-4),
    N_nn=Parameter(3e-8, low=0.0, high=1e-6),
    z_race=Parameter(0.03, low=0.0, high=0.2, null=None),
):
    """N = (N_un u n + N_nn n^2) delta,  Y = -2 N,  K = 2 z_race N: the race as the shaft turns.

    Beside linear_rudder, whose force goes as U^2, or instead of it, where trials are at several
    revolutions or speed falls far: rudder_race and rudder_slipstream know one approach speed. With
    the shaft stopped or astern there is no race and no force.
    """
    ahead = _ahead(n)
    N = (N_un * u + N_nn * ahead) * ahead * delta
    return Force(Y=-2.0 * N, K=2.0 * z_race * N, N=N)


# Values are the S-175's. The ends are wide of what is built: open screws have K_T of 0.1 to 0.7 at
# rest, hulls a thrust deduction of 0 to 0.4 and a wake of 0 to 0.6; what a search finds beyond them
# is another effect's.
PROPELLER_DIAMETER = Parameter(6.533, "m", low=0.01, high=13.0, null=None)
KT_AT_REST = Parameter(0.527, low=0.05, high=1.2, null=None)
KT_SLOPE = Parameter(-0.455, low=-1.5, high=0.0, null=None)
THRUST_DEDUCTION = Parameter(0.175, low=-0.2, high=0.6, null=None)
WAKE_FRACTION = Parameter(0.184, low=-0.2, high=0.8, null=None)
WAKE_BY_DRIFT = Parameter(1.09, low=-5.0, high=10.0, null=None)
PROPELLER_AT = Parameter(-0.526, low=-0.7, high=0.0, null=None)


@effect(source=SN82, system="SI")
def propeller_thrust(
    u, v, r, n, L, rho, *,
    D_P=PROPELLER_DIAMETER, KT0=KT_AT_REST, KT1=KT_SLOPE, t_P=THRUST_DEDUCTION,
    w_P=WAKE_FRACTION, tau_P=WAKE_BY_DRIFT, x_P=PROPELLER_AT,
):  # fmt: skip
    """X = (1 - t_P) rho n^2 D_P^4 K_T(J): thrust at the recorded shaft speed (n in rev/s).

    Astern -rho n^2 D_P^4 K_T, the screw as good as ahead: propeller_astern says by how much not.
    """
    inflow = _inflow(u=u, v=v, r=r, L=L, w_P=w_P, tau_P=tau_P, x_P=x_P)
    ahead, back = (push(inflow, n, D_P, KT0, KT1) for push in (_race, _astern))
    return Force(X=rho * D_P**2 * ((1.0 - t_P) * ahead - back))


@effect(source=SN82, system="SI")
def propeller_rudder(
    u, v, r, n, delta, L, rho, *,
    D_P=PROPELLER_DIAMETER, KT0=KT_AT_REST, KT1=KT_SLOPE, t_P=THRUST_DEDUCTION,
    w_P=WAKE_FRACTION, tau_P=WAKE_BY_DRIFT, x_P=PROPELLER_AT,
    A_R=Parameter(33.0376, "m^2", low=1e-4, high=300.0, null=None),
    Lambda_R=Parameter(1.8219, low=0.3, high=6.0, null=None),
    k_R=Parameter(0.631, low=0.0, high=1.5, null=None),
    eps_R=Parameter(0.921, low=0.3, high=2.0, null=None),
    x_R=Parameter(-0.5, low=-0.7, high=0.7, null=None),
    gamma_R=Parameter(0.088, low=-1.0, high=2.0, null=None),
    l_R=Parameter(-0.156, low=-2.0, high=2.0, null=None),
    l_Rrrr=Parameter(-0.275, null=None), l_Rrrv=Parameter(1.96, null=None),
    c_RX=Parameter(0.71, low=0.0, high=1.5, null=None),
    a_H=Parameter(0.237, low=-0.5, high=1.5, null=None),
    z_R=Parameter(0.033, low=-0.1, high=0.2, null=None),
    x_H=Parameter(-0.48, low=-1.0, high=0.5, null=None),
):  # fmt: skip
    """F_N = -1/2 rho A_R f (u_R^2 + v_R^2) sin(alpha_R): a rudder in the propeller's race.

    With the thrust X = (1 - t_P) rho n^2 D_P^4 K_T(J); u_R is the race, v_R the side flow that
    drift and turning leave at the rudder, f the slope of the normal force by aspect ratio. Astern
    the thrust is that of propeller_thrust, and there is no race.
    """
    inflow = _inflow(u=u, v=v, r=r, L=L, w_P=w_P, tau_P=tau_P, x_P=x_P)
    race = _race(inflow, n, D_P, KT0, KT1)
    thrust = rho * D_P**2 * ((1.0 - t_P) * race - _astern(inflow, n, D_P, KT0, KT1))
    u_R = eps_R * sqrt(inflow * inflow + 8.0 * k_R * race / PI + STANDSTILL)
    turning = (r * L) ** 2 / (u * u + v * v + STANDSTILL)
    turned = l_R * r + l_Rrrr * r * turning
    v_R = gamma_R * v + turned * L + l_Rrrv * turning * v
    alpha = delta + arctan(v_R / u_R)
    slope = 6.13 * Lambda_R / (Lambda_R + 2.25)
    F_N = -0.5 * rho * A_R * slope * (u_R * u_R + v_R * v_R) * sin(alpha)
    across = F_N * cos(delta)
    return Force(
        X=thrust + c_RX * F_N * sin(delta),
        Y=(1.0 + a_H) * across,
        K=-(1.0 + a_H) * z_R * L * across,
        N=(x_R + a_H * x_H) * L * across,
    )


EFFECTS = (
    linear_rudder, rudder_cubic, rudder_in_drift, drift_with_rudder, rudder_stall,
    rudder_flow_asymmetry, rudder_race, rudder_race_shaft, surge_rudder, rudder_offset,
    rudder_scale, rudder_feedback_curve, propeller_thrust, propeller_rudder,
)  # fmt: skip
