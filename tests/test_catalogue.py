"""The catalogue is complete: every row is said or left out, and every size is a published one."""

from collections import Counter

import pytest

from trialid.effects import CATALOGUE, FILES
from trialid.effects.coverage import besides, left_out, rows, rows_of, trial_results
from trialid.errors import EffectError
from trialid.names.quantities import SIGNALS
from trialid.report.terminal.catalogue import KINDS, kind, needs, part

CONSIDERED = {"H": 19, "E": 11, "R": 11, "S": 16, "P": 7, "W": 7, "M": 15, "L": 6}
"""Rows by part: hull, heel, roll, rudder, propulsion, environment, measurement, loading."""


def test_every_row_is_there_once() -> None:
    wanted = [f"{part}{i:02d}" for part, count in CONSIDERED.items() for i in range(1, count + 1)]
    assert [row.id for row in rows()] == wanted
    assert len(wanted) == 92


def test_a_row_is_said_by_effects_that_exist_or_left_out_with_a_reason() -> None:
    for row in rows():
        assert row.what
        assert set(row.effects) <= set(CATALOGUE), row.id
        assert bool(row.effects) != bool(row.why_not), row.id
        assert bool(row.effects) == bool(row.seen), row.id
    assert len(rows()) - len(left_out()) >= 75
    assert all(len(row.why_not) > 40 for row in left_out())


def test_every_effect_belongs_to_a_row_or_is_explained() -> None:
    for name in CATALOGUE:
        assert bool(rows_of(name)) != (name in besides()), name
    assert set(besides()) <= set(CATALOGUE)


def test_names_in_reasons_are_names() -> None:
    """A reason that points to an effect points to one that is there."""
    for row in left_out():
        pointed = {w.strip(",.;:") for w in row.why_not.split() if "_" in w} - {"I_zz", "x_G"}
        assert pointed <= set(CATALOGUE), row.id


def test_what_looks_alike_is_in_the_catalogue_and_mutual() -> None:
    seen = [(name, s) for name in CATALOGUE for s in trial_results(name)]
    assert len(seen) > 150
    for name, s in seen:
        assert 0.0 < s.visible <= 1.0
        assert name not in s.alike
        for other, x in s.alike.items():
            assert 0.7 <= x <= 1.0
            [back] = [b for b in trial_results(other) if b.trial == s.trial]
            assert back.alike[name] == x


def test_every_part_of_the_ship_is_there() -> None:
    count = Counter(part(e) for e in CATALOGUE.values())
    assert list(count) == [f.__name__.rpartition(".")[2].replace("_", " ") for f in FILES]
    assert all(kind(e) in KINDS for e in CATALOGUE.values())


def test_a_record_can_hold_what_an_effect_needs() -> None:
    for effect in CATALOGUE.values():
        assert set(needs(effect)) <= {*SIGNALS, "T"} - {"t", "U"}, effect.name
    assert needs(CATALOGUE["rudder_servo"]) == ("delta_order",)
    assert needs(CATALOGUE["bias_r"]) == ("r",)
    assert needs(CATALOGUE["shallow_water_sway"]) == ("v", "h", "T")
    assert needs(CATALOGUE["inclinometer_sway"]) == ("u", "r", "phi")


# Sizes as published, converted where the source counts otherwise: Mariner's rudder is positive to
# port, the multipurpose naval vessel is primed at 8 m/s, the tanker's bis numbers are multiplied by
# 2 nabla / L^3 = 0.0155.
PUBLISHED = {
    "sway_drag_vav": {"Yvav": (-0.05, -0.00275)},
    "sway_drag_var": {"Yvar": (-0.03, -0.01147)},
    "sway_drag_rav": {"Yrav": (-0.00263,)},
    "sway_drag_rar": {"Yrar": (-0.01, 0.01)},
    "yaw_drag_vav": {"Nvav": (-0.01, -0.001)},
    "yaw_drag_var": {"Nvar": (-0.01, 0.01)},
    "yaw_drag_rav": {"Nrav": (-0.00437,)},
    "yaw_drag_rar": {"Nrar": (-0.0025, -0.0011)},
    "sway_cubic_vvv": {"Yvvv": (-0.109, -0.063, -0.08078)},
    "sway_cubic_cross": {"Yvvr": (0.0214, 0.15356), "Yvrr": (-0.0405, -0.029)},
    "sway_cubic_rrr": {"Yrrr": (0.00177, 0.006)},
    "yaw_cubic_vvv": {"Nvvv": (0.001492, 0.01636, -0.019)},
    "yaw_cubic_cross": {"Nvvr": (-0.0424, -0.05483, -0.022), "Nvrr": (0.00156, -0.005)},
    "yaw_cubic_rrr": {"Nrrr": (-0.00229, -0.0002)},
    "cross_flow_drag": {"C_D": (0.6, 1.0069, 1.2)},
    "hull_asymmetry": {"Y0": (-4e-5,), "N0": (3e-5,)},
    "yaw_memory": {"tau_late": (0.5, 2.0)},
    "heel_yaw": {"Nphi": (-1.424e-4, -1.16e-4, -1.8e-4)},
    "heel_sway": {"Yphi": (-6.3e-5, -5.5e-5, -2e-5)},
    "roll_rate_yaw": {"Np": (2.13e-4,)},
    "heel_yaw_modulus": {"Nphiaphi": (-1e-3, 1e-3)},
    "heel_drift": {"Yphiauv": (0.00803,), "Yphiaur": (0.00362,), "Nphiauv": (-0.00309,),
                   "Nphiuar": (-0.0014,)},
    "heel_yaw_cubic": {"Nvvphi": (-0.019058,), "Nvphiphi": (-0.0053766,),
                       "Nrrphi": (-0.0038592,), "Nrphiphi": (0.0024195,)},
    "heel_sway_cubic": {"Yvvphi": (0.04605,), "Yvphiphi": (0.00304,), "Yrrphi": (0.009325,),
                        "Yrphiphi": (-0.001368,)},
    "heel_roll_cubic": {"Kvvphi": (-0.0012012,), "Kvphiphi": (-7.93e-5,), "Krrphi": (-2.43e-4,),
                        "Krphiphi": (3.569e-5,)},
    "rudder_heeled": {"N_heeled": (-0.0015,)},
    "quadratic_roll_damping": {"Kpap": (-2.27e-6, -1e-5, -6e-5)},
    "cubic_roll_damping": {"Kppp": (-2e-5, -1e-4)},
    "righting_arm_cubic": {"GM3": (2.8, 0.325)},
    "righting_arm_quintic": {"GM5": (-10.0, 100.0)},
    "roll_drag_vav": {"Kvav": (4.23e-4,)},
    "roll_drag_var": {"Kvar": (1.74e-4,)},
    "roll_drag_rav": {"Krav": (3.98e-5,)},
    "roll_cubic": {"Kvvv": (0.002843,), "Kvvr": (-5.88e-4,), "Kvrr": (0.0010565,),
                   "Krrr": (-4.62e-5,)},
    "rudder_offset": {"delta_0": (0.0035, 0.026)},
    "rudder_scale": {"e_delta": (-0.1, 0.1)},
    "rudder_cubic": {"Yddd": (90e-5,), "Nddd": (-45e-5,)},
    "rudder_stall": {"delta_stall": (0.35, 0.40, 0.61)},
    "rudder_flow_asymmetry": {"l_flow": (-0.7, -1.0)},
    "rudder_in_drift": {"Yvvd": (-1190e-5,), "Nvvd": (489e-5,)},
    "drift_with_rudder": {"Yvdd": (-4e-5,), "Nvdd": (13e-5,)},
    "rudder_slipstream": {"N_slip": (0.8 * 0.00148, 1.4 * 0.00148), "z_slip": (0.033,)},
    "rudder_race": {"Y_race": (-0.00298382,), "K_race": (9.847e-5,), "N_race": (0.00148048,)},
    "shaft_thrust": {"X_nn": (4.28e-8,), "X_un": (-5.07e-6,)},
    "rudder_race_shaft": {"N_un": (4.8e-7,), "N_nn": (1.6e-8,)},
    "rudder_deadband": {"b_dead": (0.0035, 0.0175)},
    "rudder_backlash": {"b_play": (0.0035, 0.026)},
    "rudder_servo": {"T_delta": (0.3, 1.0, 3.0)},
    "rudder_servo_limited": {"rate_max": (0.0405, 0.0175, 0.122)},
    "rudder_servo_second_order": {"omega_servo": (0.5, 2.0), "zeta_servo": (0.6, 1.0)},
    "rudder_record_delay": {"tau_delta": (0.1, 2.0)},
    "surge_turning": {"Xvr": (-0.00311,), "Xvv": (-0.00386,), "Xrr": (0.0002,)},
    "surge_rudder": {"Xdd": (-0.0017, -0.0022)},
    "surge_heel": {"Xphiphi": (-0.0002,)},
    "shaft_speed_drop": {"k_n": (0.0, 0.4)},
    "steady_wind": {"F_E": (1e-4, 3e-4), "x_wind": (0.05,), "z_wind": (0.05,),
                    "k_wind": (0.1, 1.0)},
    "apparent_wind_yaw": {"N_2aw": (-0.1 * 8e-5,)},
    "shallow_water_yaw": {"Nvz": (-0.24 * 0.0155,), "Nrz": (-0.047 * 0.0155,),
                          "Nravz": (-0.12 * 0.0155,)},
    "shallow_water_sway": {"Yvavz": (-1.5 * 0.0155,)},
    "bias_r": {"b_r": (8.7e-5, 1.7e-3)},
    "bias_phi": {"b_phi": (0.0017, 0.0175)},
    "scale_r": {"e_r": (0.001, 0.03)},
    "scale_phi": {"e_phi": (0.01, 0.05)},
    "delay_r": {"tau_r": (0.05, 1.5)},
    "lag_r": {"T_r": (0.2, 3.0)},
    "gyro_cross_axis": {"e_rp": (0.01, 0.05)},
    "inclinometer_sway": {"k_incl": (1.0,)},
    "rudder_feedback_curve": {"a_delta": (0.0175 / 0.611**2, 0.035 / 0.611**2)},
    "clock_drift_r": {"drift_r": (1e-5, 1e-4)},
}  # fmt: skip


@pytest.mark.parametrize("name", PUBLISHED)
def test_published_sizes_lie_in_the_range(name: str) -> None:
    effect = CATALOGUE[name]
    for parameter, sizes in PUBLISHED[name].items():
        p = effect.parameters[parameter]
        assert all(p.low <= x <= p.high for x in sizes), parameter


@pytest.mark.parametrize("name", PUBLISHED)
def test_a_typical_value_is_of_the_published_size(name: str) -> None:
    """Within a factor of ten of the nearest, and of the sign where all agree on one."""
    for parameter, sizes in PUBLISHED[name].items():
        start = CATALOGUE[name].parameters[parameter].start
        ratios = [abs(start / x) for x in sizes if x != 0.0]
        assert any(0.1 <= ratio <= 10.0 for ratio in ratios), parameter
        if len({x > 0.0 for x in sizes if x != 0.0}) == 1:
            assert start * sum(sizes) > 0.0, parameter


def test_a_range_is_no_wider_than_physics_asks() -> None:
    """Every number that is sought is bounded on both sides, or has a certain sign."""
    base = {"linear_hull", "centripetal_added_mass", "linear_rudder", "outer_force"}
    for effect in CATALOGUE.values():
        if effect.name in base or kind(effect) == "no":
            continue
        for parameter, p in effect.parameters.items():
            assert p.low > -float("inf") or p.high < float("inf"), f"{effect.name} {parameter}"


def test_a_name_that_is_none_is_told_with_the_nearest() -> None:
    with pytest.raises(EffectError, match=r"no effect 'yaw_drag_rra'.*yaw_drag_rar"):
        CATALOGUE["yaw_drag_rra"]
    assert CATALOGUE.get("yaw_drag_rra") is None
    assert "yaw_drag_rra" not in CATALOGUE
