"""Roll damping and the righting arm."""

from trialid.maths import sqrt
from trialid.ship.effect import Force, Parameter, Rate, effect
from trialid.ship.parameter import S175

SN82 = "Son & Nomoto (1982), container ship S-175"
ITTC = "ITTC Recommended Procedure 7.5-02-07-04.5, numerical estimation of roll damping"
BK99 = "Blanke & Knudsen (1999), Eq. 1: righting arm G_z"


@effect(source=BK99)
def linear_roll(
    p, phi, rho, g, nabla, *,
    Kp=Parameter(-0.0000075, high=0.0), GM=Parameter(0.5, "m", low=0.0, of_length=S175),
):  # fmt: skip
    """K = Kp p - rho g nabla GM phi: damping that grows with speed; righting moment."""
    return Force(K=Kp * p - rho * g * nabla * GM * phi)


@effect(source=SN82)
def heel_roll(phi, *, Kphi=Parameter(-0.00002, low=-0.0005, high=0.0005)):
    """K = Kphi phi: heeling moment of the flow on a heeled hull."""
    return Force(K=Kphi * phi)


@effect(source=BK99, system="SI")
def still_water_roll_damping(p, *, Kp0=Parameter(-1e6, "N m s", high=0.0, of_length=S175)):
    """K = Kp0 p: damping that is there at rest."""
    return Force(K=Kp0 * p)


@effect(source=ITTC)
def quadratic_roll_damping(p, *, Kpap=Parameter(-0.00003, low=-0.01, high=0.0)):
    """K = Kp|p| p |p|: eddies at bilges and keels, growing with amplitude."""
    return Force(K=Kpap * p * abs(p))


@effect(source=ITTC)
def cubic_roll_damping(p, *, Kppp=Parameter(-0.00005, low=-0.01, high=0.0)):
    """K = Kppp p^3: damping that grows with the square of the amplitude."""
    return Force(K=Kppp * p**3)


@effect(source=BK99)
def righting_arm_cubic(
    phi, rho, g, nabla, *, GM3=Parameter(2.0, "m", low=-50.0, high=50.0, of_length=S175)
):
    """K = -rho g nabla GM3 phi^3 (wall sides: BM/2): the righting arm hardens or softens."""
    return Force(K=-rho * g * nabla * GM3 * phi**3)


@effect(source=BK99)
def righting_arm_quintic(
    phi, rho, g, nabla, *, GM5=Parameter(20.0, "m", low=-1000.0, high=1000.0, of_length=S175)
):
    """K = -rho g nabla GM5 phi^5: the righting arm at large heel."""
    return Force(K=-rho * g * nabla * GM5 * phi**5)


@effect(source="squat and the wave along the hull; size by judgement")
def righting_arm_speed(
    u, phi, rho, nabla, U0, *, GM_F=Parameter(1.0, "m", low=-50.0, high=50.0, of_length=S175)
):
    """K = -rho g nabla GM_F (F^2 - F0^2) phi: GM changes with the Froude number F = u / sqrt(g L).

    g L (F^2 - F0^2) is u^2 - U0^2, and in primes the length is 1.
    """
    return Force(K=-rho * nabla * GM_F * (u * u - U0 * U0) * phi)


@effect(
    source="free surface or U-tube tank, linear", system="SI", states={"q_t": "phi", "w_t": None}
)
def anti_roll_tank(
    phi, q_t, w_t, L, rho, g, nabla, *,
    s_t=Parameter(0.1, "m", low=0.0, high=3.0, of_length=S175),
    omega_t=Parameter(1.5, low=0.3, high=10.0, null=None),
    zeta_t=Parameter(0.15, low=0.01, high=2.0, null=None),
):  # fmt: skip
    """K = rho g nabla s_t (q_t - phi): water in a tank that swings at its own frequency.

    d(q_t)/dt = w_t,  d(w_t)/dt = w^2 (phi - q_t) - 2 zeta_t w w_t  with  w = omega_t sqrt(g / L).
    In slow motion the water follows the roll: GM is what the free surface leaves, s_t its cost.
    """
    w = omega_t * sqrt(g / L)
    return (
        Force(K=rho * g * nabla * s_t * (q_t - phi)),
        Rate(q_t=w_t, w_t=w * w * (phi - q_t) - 2.0 * zeta_t * w * w_t),
    )


@effect(source=BK99)
def static_list(rho, g, nabla, *, a_0=Parameter(0.002, "m", low=-0.5, high=0.5, of_length=S175)):
    """K = rho g nabla a_0: a steady heel at any speed, from cargo or tanks."""
    return Force(K=rho * g * nabla * a_0)


EFFECTS = (
    linear_roll, heel_roll, still_water_roll_damping, quadratic_roll_damping, cubic_roll_damping,
    righting_arm_cubic, righting_arm_quintic, righting_arm_speed, anti_roll_tank, static_list,
)  # fmt: skip
