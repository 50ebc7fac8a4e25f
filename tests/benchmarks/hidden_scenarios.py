"""What the hidden-effects benchmark hides, as data: the effect, its size, and what counts as right.

Sizes are those of published ships (the S-175 where it has the term) or of sensor practice; none is
chosen so that it can be seen. Whether it can is what the score says, run by run.
"""

from collections.abc import Mapping
from typing import Final

from hidden_truth import DEG, Gear, Group, Scenario, limited, servo

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

MADE_UP: Final = "made up for the benchmark: no ship does this"
"""The figure in each docstring is the largest |cos| of what the fit leaves of its trace with what
it leaves of any effect of the catalogue, in the mixed trials."""


@effect(source=MADE_UP)
def odd_rudder(delta, *, odd_Ndelta=0.00007):
    """N = odd_Ndelta sin(40 delta): a rudder moment that turns over every 4.5 deg; 0.36."""
    return Force(N=odd_Ndelta * sin(40.0 * delta))


@effect(source=MADE_UP)
def odd_switch(p, r, *, odd_Nswitch=0.00003):
    """N = odd_Nswitch tanh(p / 0.005) tanh(r / 0.05): a moment that switches with two rates; 0.19.

    The sign of roll rate and turn is all that counts.
    """
    return Force(N=odd_Nswitch * tanh(p / 0.005) * tanh(r / 0.05))


@effect(source=MADE_UP)
def odd_heel(v, phi, *, odd_Kvavphi=0.004):
    """K = odd_Kvavphi v |v| phi: a heeling moment to one side, of drift times heel; 0.48."""
    return Force(K=odd_Kvavphi * v * abs(v) * phi)


@effect(source=MADE_UP)
def odd_course(psi, *, odd_Y=0.0001):
    """Y = odd_Y sin(8 psi): a side force with eight periods in a turn of the compass; 0.26."""
    return Force(Y=odd_Y * sin(8.0 * psi))


def _one(group: Group, name: str, values: Mapping[str, float]) -> Scenario:
    """An effect of the catalogue, with its own twins."""
    twins = frozenset(n for pair in TWINS if name in pair for n in pair)
    return Scenario(name, group, (CATALOGUE[name],), values, twins)


def _gear(name: str, gear: Gear, *twins: str) -> Scenario:
    """A steering gear between the order, which alone is recorded, and the rudder."""
    return Scenario(name, "gear", names=frozenset([name]), twins=frozenset(twins), gear=gear)


def _scored(scenario: Scenario) -> bool:
    """Whether the catalogue has what is hidden, in a form that the diagnosis can score."""
    return all(n in CATALOGUE for n in scenario.names)


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
        _gear("rudder_servo", servo(1.5)),
        _gear("rudder_servo_limited", limited(1.0, 1.2 * DEG)),
        _odd(odd_rudder, 0.00007),
        _odd(odd_switch, 0.00003),
        _odd(odd_heel, 0.004),
        _odd(odd_course, 0.0001),
        Scenario("x_G + 1 % of L", "control", values={"x_G": 0.01}),
        Scenario("gyro scale + 3 %", "control", scale={"r": 1.03}),
        Scenario("roll scale + 3 %", "control", scale={"phi": 1.03}),
        Scenario("nothing", "nothing"),
    )
    if _scored(s)
}
