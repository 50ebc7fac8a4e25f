"""What heel does to the forces on the hull; primed."""

from trialid.ship.effect import Force, Parameter, effect

SN82 = "Son & Nomoto (1982), container ship S-175"
BC93 = "Blanke & Christensen (1993), multipurpose naval vessel"


@effect(source=SN82)
def heel_sway(phi, *, Yphi=Parameter(-0.00006, low=-0.002, high=0.002)):
    """Y = Yphi phi: side force of a heeled hull."""
    return Force(Y=Yphi * phi)


@effect(source=SN82)
def heel_yaw(phi, *, Nphi=Parameter(-0.00014, low=-0.003, high=0.0005)):
    """N = Nphi phi: a heeled hull turns away from its low side."""
    return Force(N=Nphi * phi)


@effect(source=SN82)
def roll_rate_yaw(p, *, Np=Parameter(0.0002, low=-0.005, high=0.005)):
    """N = Np p: yaw moment of rolling."""
    return Force(N=Np * p)


@effect(source=SN82)
def roll_rate_sway(p, *, Yp=Parameter(0.0002, low=-0.005, high=0.005)):
    """Y = Yp p: side force of rolling."""
    return Force(Y=Yp * p)


@effect(source="bow flare, wedge of the heeled waterline; size by judgement")
def heel_yaw_modulus(phi, *, Nphiaphi=Parameter(-0.001, low=-0.01, high=0.01)):
    """N = Nphi|phi| phi |phi|: the yaw moment of heel grows faster than the heel."""
    return Force(N=Nphiaphi * phi * abs(phi))


@effect(source=BC93)
def heel_yaw_drift(v, phi, *, Nvaphi=Parameter(-0.003, low=-0.05, high=0.05)):
    """N = Nv|phi| v |phi|: drift moment that changes with heel to either side."""
    return Force(N=Nvaphi * v * abs(phi))


@effect(source="ONR Tumblehome model: rudder force times cos(phi); a ventilated rudder loses more")
def rudder_heeled(delta, phi, *, N_heeled=Parameter(-0.0015, low=-0.05, high=0.005)):
    """N = N_heeled delta phi^2,  Y = -2 N: a rudder, aft, that loses grip as the ship heels."""
    N = N_heeled * delta * phi**2
    return Force(Y=-2.0 * N, N=N)


@effect(source=SN82)
def heel_sway_cubic(
    v, r, phi, *,
    Yvvphi=Parameter(0.046, low=-0.5, high=0.5), Yvphiphi=Parameter(0.003, low=-0.1, high=0.1),
    Yrrphi=Parameter(0.0093, low=-0.1, high=0.1), Yrphiphi=Parameter(-0.0014, low=-0.05, high=0.05),
):  # fmt: skip
    """Y = (Yvvphi v + Yvphiphi phi) v phi + (Yrrphi r + Yrphiphi phi) r phi: heel and turns."""
    return Force(Y=(Yvvphi * v * v + Yrrphi * r * r) * phi + (Yvphiphi * v + Yrphiphi * r) * phi**2)


@effect(source=SN82)
def heel_roll_cubic(
    v, r, phi, *,
    Kvvphi=Parameter(-0.0012, low=-0.02, high=0.02),
    Kvphiphi=Parameter(-0.00008, low=-0.01, high=0.01),
    Krrphi=Parameter(-0.00024, low=-0.005, high=0.005),
    Krphiphi=Parameter(0.000036, low=-0.004, high=0.004),
):  # fmt: skip
    """K = (Kvvphi v + Kvphiphi phi) v phi + (Krrphi r + Krphiphi phi) r phi: heel and turns."""
    return Force(K=(Kvvphi * v * v + Krrphi * r * r) * phi + (Kvphiphi * v + Krphiphi * r) * phi**2)


@effect(source=SN82)
def heel_yaw_cubic(
    v, r, phi, *,
    Nvvphi=Parameter(-0.019, low=-0.2, high=0.2), Nvphiphi=Parameter(-0.0054, low=-0.1, high=0.1),
    Nrrphi=Parameter(-0.0039, low=-0.05, high=0.05),
    Nrphiphi=Parameter(0.0024, low=-0.05, high=0.05),
):  # fmt: skip
    """N = (Nvvphi v + Nvphiphi phi) v phi + (Nrrphi r + Nrphiphi phi) r phi: heel and turns."""
    return Force(N=(Nvvphi * v * v + Nrrphi * r * r) * phi + (Nvphiphi * v + Nrphiphi * r) * phi**2)


@effect(source=BC93)
def heel_drift(
    u, v, r, phi, *,
    Yphiauv=Parameter(0.008, low=-0.1, high=0.1), Yphiaur=Parameter(0.0036, low=-0.05, high=0.05),
    Kphiauv=Parameter(-0.00012, low=-0.003, high=0.003),
    Kphiaur=Parameter(-0.000055, low=-0.001, high=0.001),
    Nphiauv=Parameter(-0.0031, low=-0.05, high=0.05),
    Nphiuar=Parameter(-0.0014, low=-0.02, high=0.02),
):  # fmt: skip
    """Y, K, N = coefficients of phi |u v| and phi |u r| (N: phi u |r|): heel in drift and turns."""
    drifting, turning = phi * abs(u * v), phi * abs(u * r)
    return Force(
        Y=Yphiauv * drifting + Yphiaur * turning,
        K=Kphiauv * drifting + Kphiaur * turning,
        N=Nphiauv * drifting + Nphiuar * phi * u * abs(r),
    )


@effect(source=SN82)
def surge_heel(phi, *, Xphiphi=Parameter(-0.0002, low=-0.005, high=0.001)):
    """X = Xphiphi phi^2: resistance of a heeled hull."""
    return Force(X=Xphiphi * phi**2)


EFFECTS = (
    heel_sway, heel_yaw, roll_rate_yaw, roll_rate_sway, heel_yaw_modulus, heel_yaw_drift,
    rudder_heeled, heel_sway_cubic, heel_roll_cubic, heel_yaw_cubic,
    heel_drift, surge_heel,
)  # fmt: skip
