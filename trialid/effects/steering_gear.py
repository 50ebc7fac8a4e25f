"""The steering gear between order and rudder."""

from trialid.maths import clip
from trialid.ship.effect import Delayed, Parameter, Rate, Steered, effect

FOLLOWS = {"delta": "delta_order"}
"""The rudder becomes a state that starts where its order starts."""


@effect(source="Son & Nomoto (1982): time constant 1 s", states=FOLLOWS)
def rudder_servo(
    delta_order, delta, *, T_delta=Parameter(1.0, "s", low=0.05, high=20.0, scan=(0.5, 1.5, 4.0))
):
    """d(delta)/dt = (delta_order - delta) / T_delta: the rudder follows its order."""
    return Rate(delta=(delta_order - delta) / T_delta)


# a model's gear is faster by the root of its scale: 5 m with 9 deg/s had a play named in its place
@effect(source="SOLAS II-1/29.3: 65 deg in 28 s at least", states=FOLLOWS)
def rudder_servo_limited(
    delta_order, delta, *,
    T_servo=Parameter(1.0, "s", low=0.05, high=20.0, null=None),
    rate_max=Parameter(0.05, "rad/s", low=0.005, high=1.0, scan=(0.02, 0.04, 0.08, 0.16, 0.32)),
):  # fmt: skip
    """d(delta)/dt = clip((delta_order - delta) / T_servo, rate_max): a pump of limited flow."""
    return Rate(delta=clip((delta_order - delta) / T_servo, rate_max))


@effect(
    source="hydraulic gear with proportional control: 0.5 to 2 rad/s, damping 0.6 to 1",
    states=FOLLOWS | {"delta_rate": None},
)
def rudder_servo_second_order(
    delta_order, delta, delta_rate, *,
    omega_servo=Parameter(1.0, "rad/s", low=0.1, high=20.0, scan=(0.5, 1.0, 2.0)),
    zeta_servo=Parameter(0.8, low=0.1, high=3.0, null=None),
):  # fmt: skip
    """d2(delta)/dt2 = w^2 (delta_order - delta) - 2 zeta_servo w d(delta)/dt: it overshoots.

    w is omega_servo.
    """
    drive = omega_servo * (delta_order - delta) - 2.0 * zeta_servo * delta_rate
    return Rate(delta=delta_rate, delta_rate=omega_servo * drive)


@effect(source="play of the linkage: 0.2 to 1.5 deg", states={"delta_blade": "delta"})
def rudder_backlash(
    delta, delta_blade, *,
    b_play=Parameter(0.01, "rad", low=0.0, high=0.1, scan=(0.004, 0.01, 0.025)),
    T_play=Parameter(0.5, "s", low=0.05, high=20.0, null=None),
):  # fmt: skip
    """delta = delta_blade,  d(delta_blade)/dt = (e - clip(e, b_play)) / T_play: a linkage's play.

    e = delta - delta_blade: the blade stays where it is until the gear has moved b_play ahead of
    it, then follows at that distance; T_play is how quickly.
    """
    e = delta - delta_blade
    return Steered(delta=-e), Rate(delta_blade=(e - clip(e, b_play)) / T_play)


@effect(source="dead band of the control valve: 0.2 to 1 deg")
def rudder_deadband(delta, *, b_dead=Parameter(0.009, "rad", low=0.0, high=0.1)):
    """delta = delta - clip(delta, b_dead): small angles do nothing, large ones act b_dead less."""
    return Steered(delta=-clip(delta, b_dead))


@effect(source="logging and control: 0.1 to 2 s")
def rudder_record_delay(*, tau_delta=Parameter(0.5, "s", low=-5.0, high=5.0)):
    """delta acts at t what is recorded at t - tau_delta: a late gear, or a clock of its own."""
    return Delayed(delta=tau_delta)


@effect(source="unsynchronised loggers: 1e-5 to 1e-4; rows counted at a nominal rate: to 0.05")
def clock_drift_delta(t, *, drift_delta=Parameter(0.00005, low=-0.05, high=0.05)):
    """delta acts at t what is recorded at t - drift_delta t: the rudder's clock runs fast."""
    return Delayed(delta=drift_delta * t)


EFFECTS = (
    rudder_servo, rudder_servo_limited, rudder_servo_second_order, rudder_backlash,
    rudder_deadband, rudder_record_delay, clock_drift_delta,
)  # fmt: skip
