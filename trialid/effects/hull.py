"""Hydrodynamic forces on the hull: linear, second-order modulus and third-order terms; primed."""

from trialid.maths import Number, sqrt
from trialid.ship.effect import Force, Parameter, Rate, effect

BK99 = "Blanke & Knudsen (1999), section 4"
SN82 = "Son & Nomoto (1982), container ship S-175"
BC93 = "Blanke & Christensen (1993), multipurpose naval vessel"
CST65 = "Chislett & Strom-Tejsen (1965), Mariner"
PCC = "SSPA Seaman model of a wind-powered car carrier (wPCC), 1/29.5"

WATER = 0.03
"""No ship takes more water along than she weighs: 0.01 of a container ship, 0.03 of the fullest."""

STRIPS = tuple((i + 0.5) / 10 - 0.5 for i in range(10))
"""Middles of ten equal pieces of the hull, from aft, over L."""


@effect(source=BK99)
def linear_hull(v, r, *, Yv=-0.0119, Yr=0.0029, Kv=0.00031, Kr=-0.00007, Nv=-0.0037, Nr=-0.0025):
    """Y = Yv v + Yr r,  K = Kv v + Kr r,  N = Nv v + Nr r: drift and turning, small motions."""
    return Force(Y=Yv * v + Yr * r, K=Kv * v + Kr * r, N=Nv * v + Nr * r)


@effect(source=SN82)
def centripetal_added_mass(
    u,
    v,
    r,
    *,
    Xvrm=Parameter(0.007, low=-WATER, high=WATER),
    Yurm=Parameter(-0.00024, low=-WATER, high=WATER),
    Kurm=0.0000074,
):
    """X = Xvrm v r,  Y = Yurm u r,  K = Kurm u r: the water that turns with the hull."""
    return Force(X=Xvrm * v * r, Y=Yurm * u * r, K=Kurm * u * r)


@effect(source=BK99)
def sway_drag_vav(v, *, Yvav=Parameter(-0.03, low=-0.5, high=0.0)):
    """Y = Yv|v| |v| v: water passing under the keel when the ship drifts."""
    return Force(Y=Yvav * abs(v) * v)


@effect(source=BK99)
def sway_drag_var(v, r, *, Yvar=Parameter(-0.02, low=-0.3, high=0.05)):
    """Y = Yv|r| v |r|: more sway damping while the ship turns."""
    return Force(Y=Yvar * v * abs(r))


@effect(source=BC93)
def sway_drag_rav(v, r, *, Yrav=Parameter(-0.02, low=-0.3, high=0.3)):
    """Y = Yr|v| r |v|: side force of turning, more of it while drifting."""
    return Force(Y=Yrav * r * abs(v))


@effect(source=BK99)
def sway_drag_rar(r, *, Yrar=Parameter(0.003, low=-0.05, high=0.05)):
    """Y = Yr|r| r |r|: side force of fast turning."""
    return Force(Y=Yrar * r * abs(r))


@effect(source=BK99)
def yaw_drag_vav(v, *, Nvav=Parameter(-0.005, low=-0.1, high=0.1)):
    """N = Nv|v| v |v|: yaw moment of large drift."""
    return Force(N=Nvav * v * abs(v))


@effect(source=BK99)
def yaw_drag_var(v, r, *, Nvar=Parameter(0.005, low=-0.1, high=0.1)):
    """N = Nv|r| v |r|: drift moment that changes with turning."""
    return Force(N=Nvar * v * abs(r))


@effect(source=BC93)
def yaw_drag_rav(v, r, *, Nrav=Parameter(-0.005, low=-0.1, high=0.02)):
    """N = Nr|v| r |v|: yaw damping that grows with drift."""
    return Force(N=Nrav * r * abs(v))


@effect(source=BK99)
def yaw_drag_rar(r, *, Nrar=Parameter(-0.0015, low=-0.02, high=0.0)):
    """N = Nr|r| r |r|: yaw damping that grows with the rate of turn."""
    return Force(N=Nrar * r * abs(r))


@effect(source=BC93)
def roll_drag_vav(v, *, Kvav=Parameter(0.0004, low=-0.02, high=0.02)):
    """K = Kv|v| v |v|: heeling moment of large drift."""
    return Force(K=Kvav * v * abs(v))


@effect(source=BC93)
def roll_drag_var(v, r, *, Kvar=Parameter(0.0003, low=-0.02, high=0.02)):
    """K = Kv|r| v |r|: heeling moment of drift that changes with turning."""
    return Force(K=Kvar * v * abs(r))


@effect(source=BC93)
def roll_drag_rav(v, r, *, Krav=Parameter(0.0001, low=-0.02, high=0.02)):
    """K = Kr|v| r |v|: heeling moment of turning that grows with drift."""
    return Force(K=Krav * r * abs(v))


@effect(source=BC93)
def roll_drag_rar(r, *, Krar=Parameter(0.00005, low=-0.01, high=0.01)):
    """K = Kr|r| r |r|: heeling moment of fast turning."""
    return Force(K=Krar * r * abs(r))


@effect(source=PCC)
def cross_flow_drag(v, r, T, *, C_D=Parameter(0.9, low=0.0, high=6.0)):
    """Y, N = -1/2 rho C_D T int |v + x r| (v + x r) {1, x} dx: drag of the flow across the hull.

    One number for all of the second-order terms in v and r, on a hull of the same draught T all
    along; ten strips.
    """
    across = [abs(v + x * r) * (v + x * r) for x in STRIPS]
    Y = -C_D * T / len(STRIPS) * sum(across)
    N = -C_D * T / len(STRIPS) * sum(x * w for x, w in zip(STRIPS, across, strict=True))
    return Force(Y=Y, N=N)


def _froude_gain(u: Number, g: Number, U0: Number) -> Number:
    """F - F0 of primed numbers, with the length 1."""
    return (u - U0) / sqrt(g)


@effect(source=PCC, corrects="Yv")
def sway_froude(u, v, g, U0, *, Yv_F=Parameter(-0.006, low=-0.3, high=0.3)):
    """Y = Yv_F v (F - F0), F = u / sqrt(g L): drift force that changes with the Froude number."""
    return Force(Y=Yv_F * v * _froude_gain(u, g, U0))


@effect(source=PCC, corrects="Nv")
def yaw_froude_v(u, v, g, U0, *, Nv_F=Parameter(0.0075, low=-0.3, high=0.3)):
    """N = Nv_F v (F - F0): drift moment that changes with the Froude number."""
    return Force(N=Nv_F * v * _froude_gain(u, g, U0))


@effect(source=PCC, corrects="Nr")
def yaw_froude_r(u, r, g, U0, *, Nr_F=Parameter(-0.0035, low=-0.3, high=0.3)):
    """N = Nr_F r (F - F0): yaw damping that changes with the Froude number."""
    return Force(N=Nr_F * r * _froude_gain(u, g, U0))


@effect(source=CST65)
def hull_asymmetry(
    *, Y0=Parameter(-0.00004, low=-0.0005, high=0.0005), N0=Parameter(0.00003, low=-3e-4, high=3e-4)
):
    """Y = Y0,  N = N0: a hull or a propeller unlike to port and starboard."""
    return Force(Y=Y0, N=N0)


MEMORY = "Nomoto-type lag of the lift on the hull; size by judgement"


@effect(source=MEMORY, system="SI", states={"r_late": None})
def yaw_memory(
    u, r, r_late, L, rho, *,
    N_late=Parameter(-0.0003, low=-0.01, high=0.01),
    tau_late=Parameter(1.0, low=0.2, high=5.0, null=None),
):  # fmt: skip
    """N = N_late (r_late - r), d(r_late)/dt = (r - r_late) u / (tau_late L): lift that comes late.

    r_late is the rate of turn that the flow has settled to; in a steady turn nothing is left.
    """
    settled = r_late - r
    return (
        Force(N=0.5 * rho * L**4 * u * N_late * settled),
        Rate(r_late=-settled * u / (tau_late * L)),
    )


@effect(source=SN82)
def sway_cubic_vvv(v, *, Yvvv=Parameter(-0.1, low=-2.0, high=0.0)):
    """Y = Yvvv v^3: sway damping at large drift."""
    return Force(Y=Yvvv * v**3)


@effect(source=SN82)
def sway_cubic_cross(
    v, r, *, Yvvr=Parameter(0.02, low=-1.0, high=1.0), Yvrr=Parameter(-0.04, low=-1.0, high=1.0)
):
    """Y = Yvvr v^2 r + Yvrr v r^2: side force of turning with drift."""
    return Force(Y=Yvvr * v**2 * r + Yvrr * v * r**2)


@effect(source=SN82)
def sway_cubic_rrr(r, *, Yrrr=Parameter(0.002, low=-0.1, high=0.1)):
    """Y = Yrrr r^3: side force of fast turning."""
    return Force(Y=Yrrr * r**3)


@effect(source=SN82)
def yaw_cubic_vvv(v, *, Nvvv=Parameter(0.002, low=-0.5, high=0.5)):
    """N = Nvvv v^3: yaw moment of large drift."""
    return Force(N=Nvvv * v**3)


@effect(source=SN82)
def yaw_cubic_cross(
    v, r, *, Nvvr=Parameter(-0.04, low=-1.0, high=1.0), Nvrr=Parameter(0.002, low=-1.0, high=1.0)
):
    """N = Nvvr v^2 r + Nvrr v r^2: yaw damping in a tight turn."""
    return Force(N=Nvvr * v**2 * r + Nvrr * v * r**2)


@effect(source=SN82)
def yaw_cubic_rrr(r, *, Nrrr=Parameter(-0.0023, low=-0.1, high=0.0)):
    """N = Nrrr r^3: yaw damping of fast turning."""
    return Force(N=Nrrr * r**3)


@effect(source=SN82)
def roll_cubic(
    v, r, *,
    Kvvv=Parameter(0.0028, low=-0.03, high=0.03), Kvvr=Parameter(-0.00059, low=-0.01, high=0.01),
    Kvrr=Parameter(0.00106, low=-0.01, high=0.01),
    Krrr=Parameter(-0.000046, low=-0.001, high=0.001),
):  # fmt: skip
    """K = Kvvv v^3 + Kvvr v^2 r + Kvrr v r^2 + Krrr r^3: heeling moment of tight turns."""
    return Force(K=Kvvv * v**3 + Kvvr * v**2 * r + Kvrr * v * r**2 + Krrr * r**3)


@effect(source=SN82)
def surge_resistance(u, *, Xuu=Parameter(-0.0004, high=0.0)):
    """X = Xuu u |u|: resistance ahead."""
    return Force(X=Xuu * u * abs(u))


@effect(source=SN82)
def surge_turning(
    v, r, *,
    Xvr=Parameter(-0.0031, low=-0.05, high=0.05), Xvv=Parameter(-0.0039, low=-0.05, high=0.05),
    Xrr=Parameter(0.0002, low=-0.005, high=0.005),
):  # fmt: skip
    """X = Xvr v r + Xvv v^2 + Xrr r^2: speed lost in turns.

    Most of it is the water that turns with the hull, Xvrm v r of centripetal_added_mass. The Xvr of
    a ship file stands beside Xvrm and often has the other sign: without it she speeds up in turns.
    """
    return Force(X=Xvr * v * r + Xvv * v**2 + Xrr * r**2)


EFFECTS = (
    linear_hull, centripetal_added_mass,
    sway_drag_vav, sway_drag_var, sway_drag_rav, sway_drag_rar,
    yaw_drag_vav, yaw_drag_var, yaw_drag_rav, yaw_drag_rar,
    roll_drag_vav, roll_drag_var, roll_drag_rav, roll_drag_rar, cross_flow_drag,
    sway_froude, yaw_froude_v, yaw_froude_r, hull_asymmetry, yaw_memory,
    sway_cubic_vvv, sway_cubic_cross, sway_cubic_rrr,
    yaw_cubic_vvv, yaw_cubic_cross, yaw_cubic_rrr, roll_cubic,
    surge_resistance, surge_turning,
)  # fmt: skip
