"""What holds a boat back at rest too, where every term with the speed in it is gone."""

from collections.abc import Iterator
from dataclasses import replace

from trialid.effects.actuators.instances import usual_speed
from trialid.effects.actuators.push_kinds import F11
from trialid.ship.effect import Effect, Force, Parameter, Rate, effect
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


@effect(source=F11, system="SI", states={"sway": None}, stands_for="v")
def sway_in_turns(
    u,
    r,
    sway,
    *,
    X_sway=Parameter(1.0, "kg", low=0.0),
    N_sway=Parameter(-1.0, "kg"),
    T_sway=Parameter(1.0, "s", low=0.05, high=60.0, null=None),
):
    """X = X_sway w r,  N = N_sway u w,  dw/dt = -u r - w / T_sway: sway that nothing records.

    w is the sway speed but for its scale, which no record without it tells: of a boat that nothing
    pushes aside X_sway is her mass with the water ahead, N_sway the Munk moment of that scale.
    """
    return (
        Force(X=X_sway * sway * r, N=N_sway * u * sway),
        Rate(sway=-u * r - sway / T_sway),
    )


EFFECTS = (
    still_water_surge,
    still_water_sway,
    still_water_yaw,
    still_water_yaw_quadratic,
    munk_moment,
    sway_in_turns,
)
SHARE = {
    "Xu0": (-0.004, 2, 1),
    "Yv0": (-0.02, 2, 1),
    "Nr0": (-0.002, 4, 1),
    "Nrar0": (-0.01, 5, 0),
    "X_sway": (0.02, 3, 0),
    "N_sway": (-0.01, 3, 0),
    "T_sway": (1.0, 1, -1),
}
"""Coefficient over 1/2 rho L^k U^i, k and i, of a time without the water; by the Otter's published
numbers, only where a search starts."""


def standstill_effects(ship: Ship) -> Iterator[Effect]:
    """Damping at rest, the Munk moment and unrecorded sway, with starts of the ship's own size."""
    L, rho, U = ship.particulars["L"], ship.particulars["rho"], usual_speed(ship)
    for one in EFFECTS:
        sized = {}
        for name, p in one.parameters.items():
            share, length, speed = SHARE.get(name, (0.0, 0, 0))
            water = 1.0 if p.unit == "s" else 0.5 * rho
            start = share * water * L**length * U**speed if share else p.start
            sized[name] = replace(p, start=start)
        yield replace(one, parameters=sized)
