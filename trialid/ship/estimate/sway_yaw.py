"""Sway and yaw derivatives of a hull from length, beam, draught and fullness; primed, midships.

The papers show their scatter in figures. The shares here are how far published sets lie from each
formula, root mean square: S-175, Mariner, naval vessel, ONR Tumblehome, as far as each has the
number; `tests/ship/estimate/test_estimate_scatter.py` counts them, and holds them against three
other ships.
"""

import math
from itertools import pairwise
from typing import Final

from trialid.ship.estimate.estimated_number import Estimate, Estimates, joint_share
from trialid.ship.estimate.hull_form import HullForm

CGH83: Final = "Clarke, Gedling & Hine (1983)"
KIJIMA: Final = "Kijima et al. (1990)"
YM12: Final = "Yoshimura & Masumoto (2012)"
CROSS: Final = "cross-flow, C_D by Hoerner (1965)"
SETS: Final = "mean of S-175 and ONR Tumblehome"
NAVAL: Final = "as the naval vessel (Blanke & Christensen 1993)"

HOERNER: Final = (
    (0.18, 1.97),
    (0.35, 1.90),
    (0.45, 1.79),
    (0.49, 1.28),
    (0.56, 1.08),
    (0.65, 1.00),
    (0.83, 0.88),
    (0.99, 0.83),
    (1.31, 0.76),
    (1.64, 0.69),
    (1.86, 0.66),
    (2.31, 0.63),
    (3.01, 0.59),
    (4.00, 0.56),
)
"""Half beam over draught, and drag coefficient of the section across (Hoerner 1965, read off)."""

TURN_SWAY: Final = 0.30
"""Share of C_D T/L that v|r| takes of the cross-flow's side force beside v|v|: least squares over
drift up to 0.3 and r L / U up to 0.8, an even hull."""


WIDEST: Final = 0.25
"""Beam over length of the widest hulls behind Clarke's formulas; beyond, added masses turn negative
and what is written is that of the edge."""


def _clarke(form: HullForm, bracket: float, share: float) -> Estimate:
    """-pi (T/L)^2 times a bracket; outside of the hulls behind it less is known."""
    beyond = max(form.B / form.L / WIDEST - 1.0, 0.0)
    return Estimate(-math.pi * (form.T / form.L) ** 2 * bracket, joint_share(share, beyond), CGH83)


def drag_across(beam: float, draught: float) -> float:
    """C_D of the flow across the hull, by half beam over draught.

    >>> round(drag_across(25.4, 8.5), 2)
    0.72
    """
    x = 0.5 * beam / draught
    if x <= HOERNER[0][0]:
        return HOERNER[0][1]
    for (low, at_low), (high, at_high) in pairwise(HOERNER):
        if x <= high:
            return at_low + (at_high - at_low) * (x - low) / (high - low)
    return HOERNER[-1][1]


def added_mass(form: HullForm) -> Estimates:
    """Added masses in sway and yaw, and 5 % of the mass in surge."""
    deep, wide = form.B / form.T, min(form.B / form.L, WIDEST)
    full = form.block * deep
    return {
        "Xudot": Estimate(-0.05 * form.m, 0.5, "5 % of m, van Berlekom & Goddard (1972)"),
        "Yvdot": _clarke(form, 1.0 + 0.16 * full - 5.1 * wide**2, 0.2),
        "Yrdot": _clarke(form, 0.67 * wide - 0.0033 * deep**2, 0.6),
        "Nvdot": _clarke(form, 1.1 * wide - 0.041 * deep, 1.3),
        "Nrdot": _clarke(form, 1.0 / 12.0 + 0.017 * full - 0.33 * wide, 0.2),
    }


def linear(form: HullForm) -> Estimates:
    """Yv, Yr, Nv, Nr; what the water that turns with the hull does is inside Yr."""
    deep, wide = form.B / form.T, min(form.B / form.L, WIDEST)
    return {
        "Yv": _clarke(form, 1.0 + 0.40 * form.block * deep, 0.3),
        "Yr": _clarke(form, -0.5 + 2.2 * wide - 0.080 * deep, 0.3),
        "Nv": _clarke(form, 0.5 + 2.4 * form.T / form.L, 0.45),
        "Nr": _clarke(form, 0.25 + 0.039 * deep - 0.56 * wide, 0.35),
        "Yurm": Estimate(0.0, 0.0, "inside Yr, as tests at a rotating arm have it"),
    }


def quadratic(form: HullForm) -> Estimates:
    """Second-order modulus terms, for a model that has these and not the cubic ones."""
    slim, full = form.T / form.L, form.block
    k_T = (1.0 - full) * form.T / form.B
    C_D = drag_across(form.B, form.T)
    across = C_D * slim
    turn = 0.5 * full * form.T / form.B - 0.05
    return {
        "C_D": Estimate(C_D, 0.35, "Hoerner (1965), by B / 2T"),
        "Yvav": Estimate(-slim * (2.5 * k_T + 0.5), 0.7, KIJIMA),
        "Yvar": Estimate(-TURN_SWAY * across, 0.6, CROSS),
        "Yrav": Estimate(-0.0026, 1.5, NAVAL),
        "Yrar": Estimate(slim * (0.343 * full * form.T / form.B - 0.07), 2.0, KIJIMA),
        "Nvav": Estimate(slim * (0.96 * k_T - 0.066), 2.0, KIJIMA),
        "Nvar": Estimate(0.5 * slim * turn, 2.0, f"{KIJIMA}, Nvrr at r' = 0.5"),
        "Nrav": Estimate(-across / 6.0, 0.4, f"{CROSS}, small turn rates"),
        "Nrar": Estimate(-across / 32.0, 0.4, f"{CROSS}, small drift"),
    }


def cubic(form: HullForm) -> Estimates:
    """Third-order terms, for a model that has these and not the modulus ones."""
    slim, full, wide = form.T / form.L, form.block, min(form.B / form.L, WIDEST)
    turn = 0.5 * full * form.T / form.B - 0.05
    return {
        "Yvvv": Estimate(-slim * (0.185 / wide + 0.48), 0.3, YM12),
        "Yvvr": Estimate(slim * 0.35, 1.0, SETS),
        "Yvrr": Estimate(-slim * 5.95 * (1.0 - full) * form.T / form.B, 0.3, KIJIMA),
        "Yrrr": Estimate(slim * 0.10, 1.0, SETS),
        "Nvvv": Estimate(slim * (0.69 * full - 0.66), 1.6, YM12),
        "Nvvr": Estimate(slim * (1.55 * full * wide - 0.76), 0.6, YM12),
        "Nvrr": Estimate(slim * turn, 3.0, KIJIMA),
        "Nrrr": Estimate(slim * min(0.25 * full * wide - 0.056, -0.005), 0.7, YM12),
    }


def of_heel(form: HullForm) -> Estimates:
    """What heel and roll do to side force and yaw moment; two sets agree, nobody has a formula."""
    plate = (form.T / form.L) ** 2
    two = "mean of S-175 and the naval vessel, by (T/L)^2"
    return {
        "Yphi": Estimate(-0.027 * plate, 0.6, two),
        "Nphi": Estimate(-0.059 * plate, 1.0, two),
        "Np": Estimate(0.090 * plate, 1.0, "as S-175 (Son & Nomoto 1982), by (T/L)^2"),
        "Yphiauv": Estimate(0.0080, 1.0, NAVAL),
        "Yphiaur": Estimate(0.0036, 1.0, NAVAL),
        "Nphiauv": Estimate(-0.0031, 1.0, NAVAL),
        "Nphiuar": Estimate(-0.0014, 1.0, NAVAL),
    }


def surge(form: HullForm, Yvdot: Estimate) -> Estimates:
    """Speed lost in turns; m_y of the source is split off into Xvrm."""
    slim, wide = form.T / form.L, form.block * form.B / form.L
    turn = slim * (1.91 * wide - 0.08)
    Xvr = turn + Yvdot.value
    return {
        "Xvrm": Estimate(-Yvdot.value, Yvdot.share, "-Yvdot"),
        "Xvr": Estimate(Xvr, joint_share(0.3, Yvdot.share * Yvdot.value / Xvr), YM12),
        "Xvv": Estimate(slim * (1.15 * wide - 0.18), 1.5, YM12),
        "Xrr": Estimate(slim * 0.008, 2.5, f"{YM12}, of a slender hull"),
    }
