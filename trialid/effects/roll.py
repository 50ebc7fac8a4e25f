"""Roll damping and the righting arm."""

from trialid.ship.effect import Force, Parameter, effect

SN82 = "Son & Nomoto (1982), container ship S-175"
ITTC = "ITTC Recommended Procedure 7.5-02-07-04.5, numerical estimation of roll damping"
BK99 = "Blanke & Knudsen (1999), Eq. 1: righting arm G_z"


@effect(source=BK99)
def linear_roll(
    p, phi, rho, g, nabla, *,
    Kp=Parameter(-0.0000075, high=0.0), GM=Parameter(0.5, "m", low=0.0),
):  # fmt: skip
    """K = Kp p - rho g nabla GM phi: damping that grows with speed, and the righting moment."""
    return Force(K=Kp * p - rho * g * nabla * GM * phi)


@effect(source=SN82)
def heel_roll(phi, *, Kphi=-0.00002):
    """K = Kphi phi: heeling moment of the flow on a heeled hull."""
    return Force(K=Kphi * phi)


@effect(source=BK99, system="SI")
def still_water_roll_damping(p, *, Kp0=Parameter(-1e6, "N m s", high=0.0)):
    """K = Kp0 p: damping that is there at rest."""
    return Force(K=Kp0 * p)


@effect(source=ITTC)
def quadratic_roll_damping(p, *, Kpap=Parameter(-0.00003, low=-0.01, high=0.0)):
    """K = Kp|p| p |p|: eddies at bilges and keels, damping that grows with amplitude."""
    return Force(K=Kpap * p * abs(p))


@effect(source=ITTC)
def cubic_roll_damping(p, *, Kppp=Parameter(-0.00005, low=-0.01, high=0.0)):
    """K = Kppp p^3: damping that grows with the square of the amplitude."""
    return Force(K=Kppp * p**3)


@effect(source=BK99)
def righting_arm_cubic(phi, rho, g, nabla, *, GM3=Parameter(2.0, "m", low=-50.0, high=50.0)):
    """K = -rho g nabla GM3 phi^3: the righting arm hardens (wall sides: BM/2) or softens."""
    return Force(K=-rho * g * nabla * GM3 * phi**3)


@effect(source=BK99)
def static_list(rho, g, nabla, *, a_0=Parameter(0.002, "m", low=-0.5, high=0.5)):
    """K = rho g nabla a_0: a steady heeling arm, from cargo or trim tanks; at any speed."""
    return Force(K=rho * g * nabla * a_0)


EFFECTS = (
    linear_roll, heel_roll, still_water_roll_damping, quadratic_roll_damping, cubic_roll_damping,
    righting_arm_cubic, static_list,
)  # fmt: skip
