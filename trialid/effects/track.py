"""What a current does to the track: the ship moves with the water, and the water over the ground.

It is of each trial apart, `nuisance = ["current"]`, and no member of the catalogue: the scan for
effects that are missing tries what all trials share.
"""

from typing import Final

from trialid.ship.effect import Measured, Parameter, effect

CURRENT: Final = ("V_cn", "V_ce")
"""Speed of the water over the ground, to the north and to the east."""


@effect(source="uniform steady current: the ship moves with the water, and does not feel it")
def current(
    t,
    *,
    V_cn=Parameter(0.3, "m/s", low=-5.0, high=5.0),
    V_ce=Parameter(0.3, "m/s", low=-5.0, high=5.0),
):
    """x_measured = x + V_cn t,  y_measured = y + V_ce t: the track drifts with the water."""
    return Measured(x=V_cn * t, y=V_ce * t, x_dot=V_cn, y_dot=V_ce)
