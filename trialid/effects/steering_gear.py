"""The steering gear between order and rudder."""

from trialid.maths import clip
from trialid.ship.effect import Parameter, Rate, effect


@effect(source="Son & Nomoto (1982): time constant 1 s", states={"delta": "delta_order"})
def rudder_servo(
    delta_order, delta, *, T_delta=Parameter(1.0, "s", low=0.05, high=20.0, scan=(0.5, 1.5, 4.0))
):
    """d(delta)/dt = (delta_order - delta) / T_delta: the rudder follows its order."""
    return Rate(delta=(delta_order - delta) / T_delta)


@effect(source="SOLAS II-1/29.3: 65 deg in 28 s at least", states={"delta": "delta_order"})
def rudder_servo_limited(
    delta_order, delta, *,
    T_servo=Parameter(1.0, "s", low=0.05, high=20.0, null=None),
    rate_max=Parameter(0.05, "rad/s", low=0.005, high=1.0, scan=(0.02, 0.04, 0.08)),
):  # fmt: skip
    """d(delta)/dt = clip((delta_order - delta) / T_servo, rate_max): a pump of limited flow."""
    return Rate(delta=clip((delta_order - delta) / T_servo, rate_max))


EFFECTS = (rudder_servo, rudder_servo_limited)
