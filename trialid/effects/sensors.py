"""What the sensors add of their own: bias, scale, tilted axes, places off the centre."""

from trialid.maths import cos, sin
from trialid.ship.effect import Effect, Measured, Parameter, effect
from trialid.ship.parameter import S175

PRACTICE = "sensor practice: typical sizes from data sheets and sea trials"
MOUNT = "mounting: 0.5 to 3 deg"
COMPASS = (
    "semicircular deviation, B and C of Bowditch's coefficients; a boat's 4.6 deg was measured"
)
PENDULUM = "a pendulum or an accelerometer feels gravity and acceleration as one"
ANTENNA = "rigid body: velocity at a point off the origin; up to 0.4 L"


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


@effect(source=COMPASS)
def compass_deviation(
    psi,
    *,
    B_dev=Parameter(0.05, "rad", low=-0.5, high=0.5),
    C_dev=Parameter(0.05, "rad", low=-0.5, high=0.5),
):
    """psi_measured = psi + B_dev sin(psi) + C_dev cos(psi): deviation of a magnetic compass.

    Of iron that turns with the ship: once a turn one way and the other; a constant is bias_psi.
    """
    return Measured(psi=B_dev * sin(psi) + C_dev * cos(psi))


@effect(source=PRACTICE)
def bias_v(*, b_v=Parameter(0.05, "m/s", low=-2.0, high=2.0)):
    """v_measured = v + b_v: offset of the sway speed log."""
    return Measured(v=b_v)


@effect(source=PRACTICE)
def bias_u(*, b_u=Parameter(0.1, "m/s", low=-3.0, high=3.0)):
    """u_measured = u + b_u: offset of the speed log."""
    return Measured(u=b_u)


@effect(source=PRACTICE)
def scale_u(u, *, e_u=Parameter(0.02, low=-0.3, high=0.3)):
    """u_measured = u + e_u u: gain of the speed log."""
    return Measured(u=e_u * u)


@effect(source=PRACTICE)
def scale_v(v, *, e_v=Parameter(0.02, low=-0.3, high=0.3)):
    """v_measured = v + e_v v: gain of the sway speed log."""
    return Measured(v=e_v * v)


@effect(source=PRACTICE)
def scale_p(p, *, e_p=Parameter(0.01, low=-0.2, high=0.2)):
    """p_measured = p + e_p p: gain of the roll-rate gyro."""
    return Measured(p=e_p * p)


@effect(source=PRACTICE)
def scale_r(r, *, e_r=Parameter(0.01, low=-0.2, high=0.2)):
    """r_measured = r + e_r r: gain of the rate gyro."""
    return Measured(r=e_r * r)


@effect(source=PRACTICE)
def scale_phi(phi, *, e_phi=Parameter(0.03, low=-0.3, high=0.3)):
    """phi_measured = phi + e_phi phi: gain of the roll sensor."""
    return Measured(phi=e_phi * phi)


@effect(source=PRACTICE)
def gyro_cross_axis(p, *, e_rp=Parameter(0.02, low=-0.2, high=0.2)):
    """r_measured = r + e_rp p: a yaw gyro that is not upright sees some roll."""
    return Measured(r=e_rp * p)


@effect(source=MOUNT)
def gyro_cross_axis_p(r, *, e_pr=Parameter(0.02, low=-0.2, high=0.2)):
    """p_measured = p + e_pr r: a roll-rate gyro that is not level sees some turn."""
    return Measured(p=e_pr * r)


@effect(source="strapdown gyro: it measures r cos(phi), 1.5 % less at 10 deg")
def gyro_heels(r, phi, *, k_heels=Parameter(1.0, low=0.0, high=2.0)):
    """r_measured = r - k_heels r (1 - cos(phi)): a yaw gyro fixed to the hull heels with it."""
    return Measured(r=-k_heels * r * (1.0 - cos(phi)))


@effect(source=PENDULUM)
def inclinometer_sway(u, r, v_dot, g, *, k_incl=Parameter(1.0, low=0.0, high=2.0)):
    """phi_measured = phi - k_incl (dv/dt + u r) / g: a pendulum takes a turn for a heel; 1 for one.

    It swings outward, the way the ship heels in a steady turn, and reads too much of it.
    """
    return Measured(phi=-k_incl * (v_dot + u * r) / g)


@effect(source=PENDULUM)
def inclinometer_lever(
    p_dot, g, *, z_incl=Parameter(5.0, "m", low=-60.0, high=60.0, of_length=S175)
):
    """phi_measured = phi + z_incl (dp/dt) / g: a pendulum z_incl below the roll axis."""
    return Measured(phi=z_incl * p_dot / g)


@effect(source=ANTENNA)
def lever_arm_x(r, *, x_s=Parameter(30.0, "m", low=-300.0, high=300.0, of_length=S175)):
    """v_measured = v + x_s r: the antenna or log is x_s ahead of the origin."""
    return Measured(v=x_s * r)


@effect(source=ANTENNA)
def lever_arm_y(r, *, y_s=Parameter(3.0, "m", low=-60.0, high=60.0, of_length=S175)):
    """u_measured = u - y_s r: the antenna or log is y_s to starboard of the middle."""
    return Measured(u=-y_s * r)


@effect(source=ANTENNA)
def lever_arm_z(p, *, z_s=Parameter(-20.0, "m", low=-80.0, high=80.0, of_length=S175)):
    """v_measured = v - z_s p: the antenna is z_s below the origin (above: z_s < 0)."""
    return Measured(v=-z_s * p)


@effect(source="two sensors of one rate of turn, with nothing simulated between them")
def reference_rate(r_ref, *, k_ref=Parameter(1.0, low=0.0, high=2.0)):
    """r_measured = r + k_ref r_ref: what a second sensor makes of the first one's rate.

    With `states = []` there is no other r, and k_ref = 1 where both have the same scale.
    """
    return Measured(r=k_ref * r_ref)


EFFECTS: tuple[Effect, ...] = (
    bias_u, bias_v, bias_p, bias_r, bias_phi, bias_psi, compass_deviation,
    scale_u, scale_v, scale_p, scale_r, scale_phi,
    gyro_cross_axis, gyro_cross_axis_p, gyro_heels, inclinometer_sway, inclinometer_lever,
    lever_arm_x, lever_arm_y, lever_arm_z, reference_rate,
)  # fmt: skip
