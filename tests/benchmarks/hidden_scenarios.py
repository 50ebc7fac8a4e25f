"""What the hidden-effects benchmark hides, as data: the effect, its size, and what counts as right.

Sizes are those of published ships (the S-175 where it has the term) or of sensor practice; none is
chosen so that it can be seen. Whether it can is what the score says, run by run.
"""

from collections.abc import Mapping
from typing import Final

from hidden_truth import DEG, Group, Scenario

from trialid.effects import CATALOGUE
from trialid.maths import sin, tanh
from trialid.ship.effect import Effect, Force, effect

TWINS: Final = (
    {"yaw_drag_rar", "yaw_cubic_rrr"},
    {"sway_drag_rar", "sway_cubic_rrr"},
    {"sway_drag_vav", "sway_cubic_vvv"},
    {"yaw_drag_vav", "yaw_cubic_vvv"},
    {"sway_drag_var", "sway_drag_rav"},
    {"yaw_drag_var", "yaw_drag_rav"},
    {"roll_drag_var", "roll_drag_rav"},
    {"quadratic_roll_damping", "cubic_roll_damping"},
)
"""Pairs that no manoeuvre of a rudder separates: |cos| of their traces is 0.97 to 1.00."""


@effect(source="made up for the benchmark: no ship does this")
def odd_heel_yaw(r, phi, *, odd_N=0.0001):
    """N = odd_N sin(3 phi / 0.1) |r|: a yaw moment that comes and goes with heel."""
    return Force(N=odd_N * sin(phi * 30.0) * abs(r))


@effect(source="made up for the benchmark: no ship does this", system="SI")
def odd_switch(r, *, odd_Y=1e5):
    """Y = odd_Y tanh(r / 0.0005): a side force that switches with the side of the turn."""
    return Force(Y=odd_Y * tanh(r / 0.0005))


@effect(source="made up for the benchmark: no ship does this")
def odd_heel(v, phi, *, odd_K=0.01):
    """K = odd_K v |v| phi |phi| / 0.01: drift that rights or heels by its own side."""
    return Force(K=odd_K * v * abs(v) * phi * abs(phi) * 100.0)


@effect(source="made up for the benchmark: no ship does this")
def odd_course(psi, *, odd_turn=0.0001):
    """N = odd_turn sin(5 psi): a yaw moment with five periods in a turn of the compass."""
    return Force(N=odd_turn * sin(psi * 5.0))


def _one(group: Group, name: str, values: Mapping[str, float]) -> Scenario:
    """An effect of the catalogue, with its own twins."""
    twins = frozenset(n for pair in TWINS if name in pair for n in pair)
    return Scenario(name, group, (CATALOGUE[name],), values, twins)


def _odd(made: Effect, value: float) -> Scenario:
    return Scenario(made.name, "outside", (made,), dict.fromkeys(made.parameters, value))


_PHYSICS: Final[Mapping[str, Mapping[str, float]]] = {
    # hull
    "sway_drag_vav": {"Yvav": -0.05},
    "sway_drag_var": {"Yvar": -0.02},
    "sway_drag_rav": {"Yrav": -0.02},
    "sway_drag_rar": {"Yrar": 0.005},
    "yaw_drag_vav": {"Nvav": -0.005},
    "yaw_drag_var": {"Nvar": 0.009},
    "yaw_drag_rav": {"Nrav": -0.005},
    "yaw_drag_rar": {"Nrar": -0.0014},
    "roll_drag_vav": {"Kvav": 0.0004},
    "roll_drag_var": {"Kvar": 0.0002},
    "roll_drag_rav": {"Krav": 0.0002},
    "sway_cubic_vvv": {"Yvvv": -0.109},
    "sway_cubic_cross": {"Yvvr": 0.021, "Yvrr": -0.041},
    "sway_cubic_rrr": {"Yrrr": 0.006},
    "yaw_cubic_vvv": {"Nvvv": -0.019},
    "yaw_cubic_cross": {"Nvvr": -0.042, "Nvrr": 0.0016},
    "yaw_cubic_rrr": {"Nrrr": -0.0023},
    "roll_cubic": {"Kvvv": 0.0028, "Kvvr": -0.00059, "Kvrr": 0.00106, "Krrr": -0.000046},
    "centripetal_added_mass": {"Xvrm": 0.007049, "Yurm": -0.000238, "Kurm": 0.0},
    # heel
    "heel_yaw": {"Nphi": -0.00014},
    "roll_rate_yaw": {"Np": 0.00021},
    "heel_sway_cubic": {
        "Yvvphi": 0.046, "Yvphiphi": 0.003, "Yrrphi": 0.0093, "Yrphiphi": -0.0014,
    },
    "heel_yaw_cubic": {
        "Nvvphi": -0.019, "Nvphiphi": -0.0054, "Nrrphi": -0.0039, "Nrphiphi": 0.0024,
    },
    "heel_drift": {
        "Yphiauv": 0.008, "Yphiaur": 0.0036, "Kphiauv": -0.00012, "Kphiaur": -0.000055,
        "Nphiauv": -0.0031, "Nphiuar": -0.0014,
    },
    # roll
    "quadratic_roll_damping": {"Kpap": -3e-5},
    "cubic_roll_damping": {"Kppp": -5e-5},
    "righting_arm_cubic": {"GM3": 2.8},
    "static_list": {"a_0": 0.0026},  # half a degree at a GM of 0.3 m
    # rudder and speed
    "rudder_cubic": {"Yddd": 0.001, "Nddd": -0.0005},
    "surge_rudder": {"Xdd": -0.0022},
    "surge_turning": {"Xvr": -0.0031, "Xvv": -0.0039, "Xrr": 0.0002},
    "surge_heel": {"Xphiphi": -0.0002},
}  # fmt: skip

_SENSORS: Final[Mapping[str, Mapping[str, float]]] = {
    "rudder_offset": {"delta_0": 0.5 * DEG},
    "bias_r": {"b_r": 0.02 * DEG},
    "bias_phi": {"b_phi": 0.3 * DEG},
    "delay_r": {"tau_r": 1.0},
    "delay_phi": {"tau_phi": 1.0},
    "gyro_cross_axis": {"e_rp": 0.03},
}

SCENARIOS: Final[Mapping[str, Scenario]] = {
    s.name: s
    for s in (
        *(_one("physics", name, values) for name, values in _PHYSICS.items()),
        *(_one("sensor", name, values) for name, values in _SENSORS.items()),
        _odd(odd_heel_yaw, 0.0001),
        _odd(odd_switch, 1e5),
        _odd(odd_heel, 0.01),
        _odd(odd_course, 0.0001),
        Scenario("x_G + 1 % of L", "control", values={"x_G": 0.01}),
        Scenario("gyro scale + 3 %", "control", scale={"r": 1.03}),
        Scenario("roll scale + 3 %", "control", scale={"phi": 1.03}),
        Scenario("nothing", "nothing"),
    )
}
