"""Roll: inertia, righting, damping, and the heeling moments of sway, yaw and rudder by levers."""

import math
from collections.abc import Mapping
from typing import Final

from trialid.ship.estimate.estimated_number import Estimate, Estimates, joint_share
from trialid.ship.estimate.hull_form import GRAVITY, HullForm
from trialid.ship.estimate.hydrostatics import KEEL_SOURCE

WATER: Final = 0.2
"""Share of the inertia in roll that is the water's: 0.19 of S-175, 0.25 of the naval vessel."""
ELLIPSE: Final = 4.0 / (3.0 * math.pi)
"""Depth over draught where the force on a hull across acts: the load over a slender wing's span,
half of which is the draught, is an ellipse (Jones 1946). S-175 has 0.35, the naval vessel 0.34."""
LEVER: Final = 0.35
"""How far levers of published sets lie from that, a share of them."""
SLENDER: Final = "lever to 0.42 T, Jones (1946)"
DAMPING: Final = 0.05
"""Of critical, under way: 0.043 of S-175, 0.098 of the naval vessel."""
AT_REST: Final = 0.02
EDDIES: Final = 0.12
"""d of phi'' + d |phi'| phi': 0.108 of KVLCC2, 0.132 of the naval vessel."""
ITTC: Final = "ITTC 7.5-02-07-04.5: 0.02 to 0.1 of critical"
SMALLEST: Final = 0.02
"""Lever over draught below which its sign is not known any more."""

MOMENTS: Final = {
    "Kv": "Yv",
    "Kr": "Yr",
    "Kvav": "Yvav",
    "Kvar": "Yvar",
    "Krav": "Yrav",
    "Krar": "Yrar",
    "Kvvv": "Yvvv",
    "Kvvr": "Yvvr",
    "Kvrr": "Yvrr",
    "Krrr": "Yrrr",
    "Kphiauv": "Yphiauv",
    "Kphiaur": "Yphiaur",
    "Kdelta": "Ydelta",
}
"""Heeling moments, and the side force each is the moment of."""


def inertia(form: HullForm, Yvdot: Estimate) -> Estimates:
    """Inertia in roll with the water's, and how sway and roll go together."""
    whole = form.m * (form.roll_radius / form.L) ** 2
    code = "2008 IS Code, 2.3.4 (roll period), water 20 %"
    lever, off = _lever(form)
    coupling = Estimate(-lever * Yvdot.value, joint_share(off, Yvdot.share), f"-Yvdot, {SLENDER}")
    return {
        "I_xx": Estimate((1.0 - WATER) * whole, 0.1, code),
        "Kpdot": Estimate(-WATER * whole, 0.4, code),
        "Ypdot": coupling,
        "Kvdot": coupling,
    }


def restoring_moment(form: HullForm) -> Estimates:
    """GM, and how the righting arm of wall sides hardens."""
    hardens = 0.5 * form.metacentric_radius - form.GM / 6.0
    return {
        "GM": Estimate(form.GM, 0.1, "inclining test or loading computer"),
        "GM3": Estimate(hardens, 0.7, f"wall sides, BM/2 - GM/6; {KEEL_SOURCE}"),
        "Kphi": Estimate(
            -0.0087 * (form.T / form.L) ** 2, 1.0, "mean of S-175 and the naval vessel, by (T/L)^2"
        ),
    }


def damping(form: HullForm) -> Estimates:
    """Roll damping that grows with speed, that at rest, and that by eddies."""
    whole = form.m * (form.roll_radius / form.L) ** 2
    inertia = 0.5 * form.rho * form.L**5 * whole
    critical = 2.0 * math.sqrt(form.rho * GRAVITY * form.volume * form.GM * inertia)
    return {
        "Kp": Estimate(-DAMPING * critical / (0.5 * form.rho * form.L**4 * form.U), 0.6, ITTC),
        "Kp0": Estimate(-AT_REST * critical, 1.0, f"{ITTC}; beside Kp, not for it"),
        "Kpap": Estimate(-EDDIES * whole, 0.7, "d = 0.12, KVLCC2 and the naval vessel"),
    }


def moments(form: HullForm, forces: Mapping[str, Estimate]) -> Estimates:
    """Heeling moments of side forces."""
    lever, off = _lever(form)
    made = {
        name: Estimate(
            -lever * forces[force].value,
            joint_share(off, forces[force].share),
            f"{force}, {SLENDER}",
        )
        for name, force in MOMENTS.items()
        if force in forces
    }
    return made | {"Kurm": Estimate(0.0, 0.0, "inside Kr, as Yurm inside Yr")}


def _lever(form: HullForm) -> tuple[float, float]:
    """How deep below the centre of gravity side forces act, over L, and its share."""
    below = ELLIPSE * form.T
    lever = form.gravity_height + below
    if abs(lever) < SMALLEST * form.T:
        lever = math.copysign(SMALLEST * form.T, lever)
    return lever / form.L, joint_share(LEVER * below / abs(lever))


def rudder_lever(form: HullForm) -> float:
    """How deep below the centre of gravity a rudder's force acts, over L: half the draught."""
    return (form.gravity_height + 0.5 * form.T) / form.L
