"""What the hidden-effects benchmark hides: the effect, its size, what counts as right, the start.

Sizes are those of published ships (the S-175 where it has the term) or of sensor practice; none is
chosen so that it can be seen: whether it can, `hidden_score` says run by run. Only what is made up
to be outside the catalogue has a size that shows.
"""

from collections.abc import Mapping
from typing import Final

from hidden_truth import (
    DEG,
    FREE,
    MODEL,
    OUTPUTS,
    START_ERROR,
    Gear,
    Group,
    Scenario,
    backlash,
    deadband,
    generator,
    limited,
    servo,
    without,
)

from trialid.diagnosis.search.candidates import linear_parameters
from trialid.effects import CATALOGUE
from trialid.maths import sin, tanh
from trialid.ship.effect import Effect, Force, Mass, Rate, Steered, effect
from trialid.ship.model import ShipModel

TWINS: Final = (
    {"yaw_drag_rar", "yaw_cubic_rrr"},
    {"sway_drag_rar", "sway_cubic_rrr"},
    {"sway_drag_vav", "sway_cubic_vvv"},
    {"yaw_drag_vav", "yaw_cubic_vvv"},
    {"sway_drag_var", "sway_drag_rav"},
    {"yaw_drag_var", "yaw_drag_rav"},
    {"roll_drag_var", "roll_drag_rav"},
    {"quadratic_roll_damping", "cubic_roll_damping"},
    {"righting_arm_cubic", "righting_arm_quintic"},
    {"static_list", "bias_phi"},
    {"rudder_offset", "propeller_side_force", "hull_asymmetry"},
    {"delay_r", "lag_r", "lag_twice_r"},
    {"delay_phi", "lag_phi"},
    {"rudder_servo", "rudder_servo_limited", "rudder_servo_second_order"},
    {"rudder_slipstream", "rudder_race_shaft"},
)
"""Names that no manoeuvre of a rudder separates: |cos| of their traces is 0.97 to 1.00, or the one
holds the other as a limit."""

MADE_UP: Final = "made up for the benchmark: no ship does this"
"""Of what the fit leaves of their traces in the mixed trials, the |cos| with what it leaves of any
effect of the catalogue is at most 0.33 (nothing else hidden, white noise, seed 0)."""


@effect(source=MADE_UP)
def odd_rudder(delta, *, odd_Ndelta=0.00007):
    """N = odd_Ndelta sin(40 delta): a rudder moment that turns over every 4.5 deg."""
    return Force(N=odd_Ndelta * sin(40.0 * delta))


@effect(source=MADE_UP)
def odd_switch(p, r, *, odd_Nswitch=0.00003):
    """N = odd_Nswitch tanh(p / 0.005) tanh(r / 0.05): a moment that switches with two rates.

    The sign of roll rate and turn is all that counts.
    """
    return Force(N=odd_Nswitch * tanh(p / 0.005) * tanh(r / 0.05))


@effect(source=MADE_UP)
def odd_heel(v, phi, *, odd_Kvav=0.0002):
    """K = odd_Kvav v |v| sin(60 phi): a heeling moment of drift that comes and goes with heel."""
    return Force(K=odd_Kvav * v * abs(v) * sin(60.0 * phi))


@effect(source=MADE_UP)
def odd_course(psi, *, odd_Y=0.0001):
    """Y = odd_Y sin(8 psi): a side force with eight periods in a turn of the compass."""
    return Force(Y=odd_Y * sin(8.0 * psi))


def _one(group: Group, name: str, values: Mapping[str, float]) -> Scenario:
    """An effect of the catalogue, with its own twins."""
    return Scenario(name, group, (CATALOGUE[name],), values, twins=_twins(name))


def _twins(name: str) -> frozenset[str]:
    return frozenset(n for alike in TWINS if name in alike for n in alike)


def _gear(name: str, gear: Gear) -> Scenario:
    """A steering gear between the order, which alone is recorded, and the rudder."""
    return Scenario(name, "gear", names=frozenset([name]), twins=_twins(name), gear=gear)


def _typical(name: str) -> Scenario | None:
    """An effect that has no row below, at the size its file calls typical; None if none can see it.

    That it is part of the ship the person knows, drives the rudder from orders that are not
    logged, reads or changes a signal that the record does not hold, shares a number with the known
    ship, stands for a motion that is simulated, or is not to be sought at all.
    """
    hidden = CATALOGUE[name]
    record = {*MODEL.states, "psi", "delta", "n", "U", "t", *MODEL.ship.particulars, *hidden.states}
    shared = set(hidden.parameters) & set(MODEL.parameters)
    if shared or "delta" in hidden.states or not {*hidden.signals} <= record:
        return None
    steered = {*hidden.acts_on(Steered)} & {*MODEL.states}
    if steered or not (hidden.scanned or linear_parameters(hidden)):
        return None
    if not {*hidden.measures} <= {*OUTPUTS}:
        return None
    group: Group = "physics" if {Force, Mass, Rate} & {*hidden.forms} else "sensor"
    return _one(group, name, {n: p.start for n, p in hidden.parameters.items()})


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
    "rudder_in_drift": {"Yvvd": -0.012, "Nvvd": 0.005},
    "rudder_slipstream": {"N_slip": 0.0015, "z_slip": 0.03},
    "propeller_side_force": {"N_n": -1e-9},
    "shaft_thrust": {"X_nn": 4e-9, "X_un": 0.0},  # a tenth more than her screw is said to have
    "shaft_speed_drop": {"k_n": 0.2},
    # weather
    "steady_wind": {"F_N": 0.0001, "F_E": 0.00015, "x_wind": 0.05, "z_wind": 0.05,
                    "k_wind": 0.3},  # 10 m/s
}  # fmt: skip

_SENSORS: Final[Mapping[str, Mapping[str, float]]] = {
    "rudder_offset": {"delta_0": 0.5 * DEG},
    "bias_r": {"b_r": 0.02 * DEG},
    "bias_phi": {"b_phi": 0.3 * DEG},
    "delay_r": {"tau_r": 1.0},
    "delay_phi": {"tau_phi": 1.0},
    "gyro_cross_axis": {"e_rp": 0.03},
    "lag_r": {"T_r": 1.0},
    "lag_phi": {"T_phi": 1.0},
    "clock_drift_r": {
        "drift_r": 0.0005
    },  # half a second in a trial: loggers without a common clock
    "rudder_record_delay": {"tau_delta": 1.0},
}

_GEARS: Final[Mapping[str, Gear]] = {
    "rudder_servo": servo(1.5),
    "rudder_servo_limited": limited(1.0, 1.2 * DEG),
    "rudder_backlash": backlash(1.5 * DEG),
    "rudder_deadband": deadband(1.0 * DEG),
}

_CONTROLS: Final = (
    Scenario(
        "x_G + 1 % of L", "control", values={"x_G": 0.01}, names=frozenset(["gravity_centre_ahead"])
    ),
    Scenario("gyro scale + 3 %", "control", scale={"r": 1.03}, names=frozenset(["scale_r"])),
    Scenario("roll scale + 3 %", "control", scale={"phi": 1.03}, names=frozenset(["scale_phi"])),
)
"""Wrong by as much as happens, and behind the fitted parameters: hardly any record shows them."""

SCENARIOS: Final[Mapping[str, Scenario]] = {
    s.name: s
    for s in (
        *(_one("physics", name, x) for name, x in _PHYSICS.items() if name in CATALOGUE),
        *(_one("sensor", name, x) for name, x in _SENSORS.items() if name in CATALOGUE),
        *(_gear(name, x) for name, x in _GEARS.items() if name in CATALOGUE),
        _odd(odd_rudder, 0.00007),
        _odd(odd_switch, 0.00003),
        _odd(odd_heel, 0.0002),
        _odd(odd_course, 0.0001),
        *_CONTROLS,
        Scenario("nothing", "nothing"),
    )
}

TYPICAL: Final[Mapping[str, Scenario]] = {
    s.name: s for s in map(_typical, CATALOGUE) if s is not None and s.name not in SCENARIOS
}
"""What else the catalogue holds: an effect is hidden the day it is listed."""


def guessed(scenario: Scenario, seed: int, fixed_off: float = 0.0) -> ShipModel:
    """The model a person starts the fit from: right in its form, its free values somewhat off.

    What is held fixed is off by up to the share `fixed_off`.
    """
    model, n = without(scenario), scenario.name
    rest = tuple(
        p for e in model.effects for p in e.parameters if p not in FREE and model.stated(p)
    )
    off = [
        *generator(seed, n, "start").uniform(-START_ERROR, START_ERROR, len(FREE)),
        *generator(seed, n, "fixed").uniform(-fixed_off, fixed_off, len(rest)),
    ]
    names = (*FREE, *rest)
    return model.with_values(
        {p: model.value(p) * (1.0 + x) for p, x in zip(names, off, strict=True)}
    )
