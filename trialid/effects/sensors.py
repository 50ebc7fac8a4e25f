"""What the sensors add of their own: bias, delay, a gyro that is not upright."""

from trialid.ship.effect import Delayed, Effect, Measured, Parameter, effect

PRACTICE = "sensor practice: typical sizes from data sheets and sea trials"


@effect(source=PRACTICE)
def bias_r(*, b_r=Parameter(0.0005, "rad/s", low=-0.02, high=0.02)):
    """r_measured = r + b_r: offset of the rate gyro."""
    return Measured(r=b_r)


@effect(source=PRACTICE)
def bias_p(*, b_p=Parameter(0.0005, "rad/s", low=-0.02, high=0.02)):
    """p_measured = p + b_p: offset of the roll-rate gyro."""
    return Measured(p=b_p)


@effect(source=PRACTICE)
def bias_phi(*, b_phi=Parameter(0.005, "rad", low=-0.2, high=0.2)):
    """phi_measured = phi + b_phi: mounting offset of the roll sensor."""
    return Measured(phi=b_phi)


@effect(source=PRACTICE)
def bias_psi(*, b_psi=Parameter(0.02, "rad", low=-0.5, high=0.5)):
    """psi_measured = psi + b_psi: offset of the compass."""
    return Measured(psi=b_psi)


@effect(source=PRACTICE)
def bias_v(*, b_v=Parameter(0.05, "m/s", low=-2.0, high=2.0)):
    """v_measured = v + b_v: offset of the sway speed log."""
    return Measured(v=b_v)


@effect(source=PRACTICE)
def bias_u(*, b_u=Parameter(0.1, "m/s", low=-3.0, high=3.0)):
    """u_measured = u + b_u: offset of the speed log."""
    return Measured(u=b_u)


@effect(source=PRACTICE)
def delay_r(*, tau_r=Parameter(0.5, "s", low=-3.0, high=3.0)):
    """r_measured(t) = r(t - tau_r): a late rate of turn, by filtering or by its clock."""
    return Delayed(r=tau_r)


@effect(source=PRACTICE)
def delay_p(*, tau_p=Parameter(0.5, "s", low=-3.0, high=3.0)):
    """p_measured(t) = p(t - tau_p): a late roll rate."""
    return Delayed(p=tau_p)


@effect(source=PRACTICE)
def delay_phi(*, tau_phi=Parameter(0.5, "s", low=-3.0, high=3.0)):
    """phi_measured(t) = phi(t - tau_phi): a late roll angle."""
    return Delayed(phi=tau_phi)


@effect(source=PRACTICE)
def delay_psi(*, tau_psi=Parameter(0.5, "s", low=-3.0, high=3.0)):
    """psi_measured(t) = psi(t - tau_psi): a late heading."""
    return Delayed(psi=tau_psi)


@effect(source=PRACTICE)
def delay_v(*, tau_v=Parameter(0.5, "s", low=-3.0, high=3.0)):
    """v_measured(t) = v(t - tau_v): a late sway speed."""
    return Delayed(v=tau_v)


@effect(source=PRACTICE)
def delay_u(*, tau_u=Parameter(0.5, "s", low=-3.0, high=3.0)):
    """u_measured(t) = u(t - tau_u): a late speed log."""
    return Delayed(u=tau_u)


@effect(source=PRACTICE)
def gyro_cross_axis(p, *, e_rp=Parameter(0.02, low=-0.2, high=0.2)):
    """r_measured = r + e_rp p: a yaw gyro that is not upright sees some roll."""
    return Measured(r=e_rp * p)


EFFECTS: tuple[Effect, ...] = (
    bias_u, bias_v, bias_p, bias_r, bias_phi, bias_psi,
    delay_u, delay_v, delay_p, delay_r, delay_phi, delay_psi, gyro_cross_axis,
)  # fmt: skip
