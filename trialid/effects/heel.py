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
def heel_sway_cubic(v, r, phi, *, Yvvphi=0.046, Yvphiphi=0.003, Yrrphi=0.0093, Yrphiphi=-0.0014):
    """Y = Yvvphi v^2 phi + Yvphiphi v phi^2 + Yrrphi r^2 phi + Yrphiphi r phi^2."""
    return Force(Y=(Yvvphi * v * v + Yrrphi * r * r) * phi + (Yvphiphi * v + Yrphiphi * r) * phi**2)


@effect(source=SN82)
def heel_roll_cubic(
    v, r, phi, *, Kvvphi=-0.0012, Kvphiphi=-0.00008, Krrphi=-0.00024, Krphiphi=0.000036
):
    """K = Kvvphi v^2 phi + Kvphiphi v phi^2 + Krrphi r^2 phi + Krphiphi r phi^2."""
    return Force(K=(Kvvphi * v * v + Krrphi * r * r) * phi + (Kvphiphi * v + Krphiphi * r) * phi**2)


@effect(source=SN82)
def heel_yaw_cubic(v, r, phi, *, Nvvphi=-0.019, Nvphiphi=-0.0054, Nrrphi=-0.0039, Nrphiphi=0.0024):
    """N = Nvvphi v^2 phi + Nvphiphi v phi^2 + Nrrphi r^2 phi + Nrphiphi r phi^2."""
    return Force(N=(Nvvphi * v * v + Nrrphi * r * r) * phi + (Nvphiphi * v + Nrphiphi * r) * phi**2)


@effect(source=BC93)
def heel_drift(
    u, v, r, phi, *,
    Yphiauv=0.008, Yphiaur=0.0036, Kphiauv=-0.00012, Kphiaur=-0.000055,
    Nphiauv=-0.0031, Nphiuar=-0.0014,
):  # fmt: skip
    """Y, K, N = coefficients of phi |u v| and phi |u r| (N: phi u |r|): heel in drift and turns."""
    drifting, turning = phi * abs(u * v), phi * abs(u * r)
    return Force(
        Y=Yphiauv * drifting + Yphiaur * turning,
        K=Kphiauv * drifting + Kphiaur * turning,
        N=Nphiauv * drifting + Nphiuar * phi * u * abs(r),
    )


@effect(source=SN82)
def surge_heel(phi, *, Xphiphi=-0.0002):
    """X = Xphiphi phi^2: resistance of a heeled hull."""
    return Force(X=Xphiphi * phi**2)


EFFECTS = (
    heel_sway, heel_yaw, roll_rate_yaw, heel_sway_cubic, heel_roll_cubic, heel_yaw_cubic,
    heel_drift, surge_heel,
)  # fmt: skip
