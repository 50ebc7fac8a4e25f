"""Rudder and propeller: normal force by aspect ratio, in the race of a screw; resistance."""

import math
from typing import Final

from trialid.ship.estimate.estimated_number import Estimate, Estimates, joint_share
from trialid.ship.estimate.hull_form import HullForm
from trialid.ship.estimate.roll_moments import rudder_lever

FUJII: Final = "Fujii & Tsuda (1961)"
QUADVLIEG: Final = "Quadvlieg (2013)"
KIJIMA: Final = "Kijima et al. (1990)"
MMG: Final = "Yasukawa & Yoshimura (2015)"
S175: Final = "as S-175 (Son & Nomoto 1982)"
VISCOSITY: Final = 1.19e-6
"""[m^2/s] Of sea water at 15 degrees."""
ROUGH: Final = 0.0004
"""Correlation allowance of a full-scale hull (ITTC 1978)."""
FORM: Final = 1.2
EPSILON, KAPPA = 1.0, 0.6
CALM: Final = 0.2
"""Froude number up to which waves are a small part of the resistance."""


def normal_force_slope(aspect: float) -> float:
    """6.13 A / (A + 2.25), per radian (Fujii).

    >>> round(normal_force_slope(1.827), 3)  # KVLCC2 in Yasukawa & Yoshimura (2015): 2.747
    2.747
    """
    return 6.13 * aspect / (aspect + 2.25)


def resistance(form: HullForm) -> Estimate:
    """Xuu: friction by ITTC 1957 on the wetted surface of Denny and Mumford, waves left out."""
    wetted = 1.7 * form.L * form.T + form.volume / form.T
    reynolds = max(form.U * form.L / VISCOSITY, 1e5)
    friction = 0.075 / (math.log10(reynolds) - 2.0) ** 2
    share = joint_share(0.4 + 10.0 * max(form.froude - CALM, 0.0))
    total = (FORM * friction + ROUGH) * wetted / form.L**2
    return Estimate(-total, share, "ITTC 1957 friction, form 1.2, 0.0004 for roughness; no waves")


def propeller(form: HullForm) -> Estimates:
    """A single screw of ordinary pitch."""
    wake = max(0.5 * form.block - 0.05, 0.05)
    series = "Wageningen B, pitch ratio 0.7 to 1.1"
    return {
        "D_P": Estimate(form.propeller, 0.02, "as stated, or by D/T"),
        "KT0": Estimate(0.40, 0.3, series),
        "KT1": Estimate(-0.40, 0.3, series),
        "w_P": Estimate(wake, 0.3, "0.5 C_B - 0.05, Taylor (1933), single screw"),
        "t_P": Estimate(0.6 * wake, 0.3, "0.6 w_P, Schneekluth & Bertram (1998)"),
        "tau_P": Estimate(1.09, 0.5, S175),
        "x_P": Estimate(-0.526, 0.05, S175),
    }


def race(form: HullForm, Xuu: Estimate, screw: Estimates) -> tuple[float, float]:
    """Squared speed of the flow over the rudder, over U^2, and its share.

    The propeller's load at the approach speed by its thrust, the race by momentum theory, as in the
    MMG standard method: epsilon 1.0, kappa 0.6.
    """
    w, t, D = (screw[n].value for n in ("w_P", "t_P", "D_P"))
    span = math.sqrt(form.rudder_area * form.rudder_aspect)
    eta = min(D / span, 1.0)
    area = 0.25 * math.pi * D**2
    load = -Xuu.value * form.L**2 / ((1.0 - t) * area * (1.0 - w) ** 2)
    faster = 1.0 + KAPPA * (math.sqrt(1.0 + load) - 1.0)
    return (EPSILON * (1.0 - w)) ** 2 * (eta * faster**2 + 1.0 - eta), 0.2


def rudder(form: HullForm, Xuu: Estimate, screw: Estimates) -> Estimates:
    """Rudder derivatives, and the same rudder for `propeller_rudder`."""
    flow, off = race(form, Xuu, screw)
    slope = normal_force_slope(form.rudder_aspect)
    force = form.rudder_area / form.L**2 * slope * flow
    a_H = max(0.627 * form.block - 0.153, 0.0)
    x_H = -(0.4 + 0.1 * form.block)
    c_RX = 0.55 + 0.28 * form.block
    source = f"{FUJII}, a_H {QUADVLIEG}, race {MMG}"
    return {
        "Ydelta": Estimate(-(1.0 + a_H) * force, joint_share(off, 0.15), source),
        "Ndelta": Estimate((0.5 - a_H * x_H) * force, joint_share(off, 0.15), source),
        "Xdd": Estimate(-c_RX * force, joint_share(off, 0.3), f"{FUJII}, t_R {KIJIMA}"),
        **_in_the_race(form, a_H, x_H, c_RX),
    }


def _in_the_race(form: HullForm, a_H: float, x_H: float, c_RX: float) -> Estimates:
    mean = "mean of S-175 and KVLCC2"
    return {
        "A_R": Estimate(form.rudder_area, 0.02, "as stated, or by DNV's least area"),
        "Lambda_R": Estimate(form.rudder_aspect, 0.05, "as stated, or typical"),
        "k_R": Estimate(KAPPA, 0.15, MMG),
        "eps_R": Estimate(EPSILON, 0.1, MMG),
        "x_R": Estimate(-0.5, 0.03, "at the aft perpendicular"),
        "gamma_R": Estimate(0.3, 0.8, mean),
        "l_R": Estimate(-0.22, 0.5, mean),
        "l_Rrrr": Estimate(0.0, 0.0, f"none in {MMG}"),
        "l_Rrrv": Estimate(0.0, 0.0, f"none in {MMG}"),
        "c_RX": Estimate(c_RX, 0.15, f"1 - t_R, {KIJIMA}"),
        "a_H": Estimate(a_H, 0.4, QUADVLIEG),
        "z_R": Estimate(rudder_lever(form), 0.3, "half the draught, below G"),
        "x_H": Estimate(x_H, 0.05, KIJIMA),
    }
