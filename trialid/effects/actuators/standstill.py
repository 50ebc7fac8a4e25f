"""What holds a boat back at rest too, where every term with the speed in it is gone."""

from collections.abc import Iterator
from dataclasses import replace

from trialid.effects.actuators.instances import usual_speed
from trialid.effects.actuators.push_kinds import F11
from trialid.ship.effect import Effect, Force, Parameter, effect
from trialid.ship.particulars import Ship

MUNK = "Munk (1924), NACA report 184"


@effect(source=F11, system="SI")
def still_water_surge(u, *, Xu0=Parameter(-1.0, "kg/s", high=0.0)):
    """X = Xu0 u: resistance ahead that is linear, at rest too."""
    return Force(X=Xu0 * u)


@effect(source=F11, system="SI")
def still_water_sway(v, *, Yv0=Parameter(-1.0, "kg/s", high=0.0)):
    """Y = Yv0 v: sway damping that is there at rest."""
    return Force(Y=Yv0 * v)


@effect(source=F11, system="SI")
def still_water_yaw(r, *, Nr0=Parameter(-1.0, "kg m^2/s", high=0.0)):
    """N = Nr0 r: yaw damping that is there at rest, as a boat turns on the spot."""
    return Force(N=Nr0 * r)


@effect(source=F11, system="SI")
def still_water_yaw_quadratic(r, *, Nrar0=Parameter(-1.0, "kg m^2", high=0.0)):
    """N = Nrar0 r |r|: eddies as a boat turns, in SI; yaw_drag_rar is the same, primed."""
    return Force(N=Nrar0 * r * abs(r))


@effect(source=MUNK)
def munk_moment(u, v, *, Nuv=Parameter(-0.007, low=-0.1, high=0.0)):
    """N = Nuv u v, Nuv = Yvdot - Xudot: water that the hull pushes aside turns her broadside."""
    return Force(N=Nuv * u * v)


EFFECTS = (
    still_water_surge,
    still_water_sway,
    still_water_yaw,
    still_water_yaw_quadratic,
    munk_moment,
)
SHARE = {"Xu0": (0.004, 2), "Yv0": (0.02, 2), "Nr0": (0.002, 4), "Nrar0": (0.01, 5)}
"""Coefficient over 1/2 rho L^k U, and k; by the Otter's published numbers, only where a search
starts."""


def standstill_effects(ship: Ship) -> Iterator[Effect]:
    """Damping at rest, with starts of the ship's own size, and the Munk moment."""
    L, rho, U = ship.particulars["L"], ship.particulars["rho"], usual_speed(ship)
    for one in EFFECTS:
        sized = {}
        for name, p in one.parameters.items():
            share, power = SHARE.get(name, (0.0, 0))
            speed = 1.0 if power == 5 else U
            start = -share * 0.5 * rho * L**power * speed if share else p.start
            sized[name] = replace(p, start=start)
        yield replace(one, parameters=sized)
