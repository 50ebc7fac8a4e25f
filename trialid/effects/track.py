"""What a current does over the ground: to the track, and to a speed that is read there.

It is `nuisance = ["current"]` and no member of the catalogue. That of a track is of each trial
apart: the scan for effects that are missing tries what all trials share.
"""

from typing import Final

from trialid.effects.environment import AT_REST, MOST_DRIFT
from trialid.maths import clip, cos, sin, sqrt
from trialid.ship.effect import Measured, Parameter, Steered, effect

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


@effect(source="uniform steady current: the ship moves with the water, and does not feel it")
def current_in_velocity(
    psi,
    *,
    V_cn=Parameter(0.3, "m/s", low=-5.0, high=5.0),
    V_ce=Parameter(0.3, "m/s", low=-5.0, high=5.0),
):
    """u_measured = u + V_cn cos(psi) + V_ce sin(psi), v_measured so: both are over the ground."""
    north, east = cos(psi), sin(psi)
    return Measured(u=V_cn * north + V_ce * east, v=V_ce * north - V_cn * east)


@effect(source="kinematics: U^2 = (u + c_x)^2 + (v + c_y)^2, c the current along and across her")
def current_in_speed(
    u,
    v,
    psi,
    *,
    Uc_N=Parameter(0.3, "m/s", low=-5.0, high=5.0),
    Uc_E=Parameter(0.3, "m/s", low=-5.0, high=5.0),
):
    """u = sqrt(U^2 - (v + c_y)^2) - c_x, with `drift_in_speed_record`: U, an input, is recorded."""
    across = Uc_E * cos(psi) - Uc_N * sin(psi)
    drift, over_ground = (clip(u * x / (u * u + AT_REST), MOST_DRIFT) for x in (v, v + across))
    ahead = sqrt(1.0 - over_ground * over_ground) - sqrt(1.0 - drift * drift)
    return Steered(u=u * ahead - Uc_N * cos(psi) - Uc_E * sin(psi))
