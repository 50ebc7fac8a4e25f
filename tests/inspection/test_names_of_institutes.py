"""Names as towing tanks write them: capitals, units behind an underscore, a rudder to each side."""

import numpy as np
import pytest

from trialid.alignment import frames
from trialid.alignment.sources import SignalSource
from trialid.errors import AlignmentError, UnitError
from trialid.inspection import channel_names, inspect_log
from trialid.inspection.drives import drives_among, drives_of
from trialid.inspection.name_words import sides
from trialid.inspection.positions import positions, usual_speed
from trialid.inspection.speed_letters import of_either
from trialid.recording import Channel, Recording

UNIT_BEHIND = {
    "psi_deg": "psi",
    "phi_deg": "phi",
    "r_deg_s": "r",
    "p_deg_s": "p",
    "u_m_s": "u",
    "v_m_s": "v",
    "rud_deg": "delta",
    "n_rps": "n",
}
CAPITALS = {
    ("PSI", "deg"): "psi",
    ("PHI", "deg"): "phi",
    ("R", "deg/s"): "r",
    ("P", "deg/s"): "p",
    ("V", "m/s"): "v",
    ("N", "rps"): "n",
    ("V", "V"): None,
    ("R", "ohm"): None,
    ("P", "kW"): None,
    ("N", "N"): None,
    ("R", None): None,
    ("PSI", None): None,
    ("PSI", "bar"): None,
    ("H", "m"): None,
    ("RATE:R", "deg/s"): None,
    ("/joy/u", "m/s"): None,
    ("delta_PS", "deg"): "delta",
    ("DELTA_S", "deg"): "delta",
    ("delta_p", None): None,
    ("delta_p", "Pa"): None,
    ("delta_t", "deg"): None,
    ("n_P", "rps"): "n_p",
    ("rev", None): "n",
    ("REV", "rpm"): "n",
    ("fw_rev", "rpm"): None,
}
OF_A_SIDE = {
    "rud_ps": {"n_p"},
    "rud_sb_deg": {"n_s"},
    "Rudder Angle SB": {"n_s"},
    "delta_BB": {"n_p"},
    "delta STB": {"n_s"},
    "DELTA_P": {"n_p"},
    "r_deg_s": set(),
    "gyro_p": set(),
    "rudder": set(),
}
T = np.arange(0.0, 60.0, 0.1)
TURN = np.deg2rad(3.0) * T
"""Heading [rad] of half a turn in a minute."""


@pytest.mark.parametrize(("name", "quantity"), UNIT_BEHIND.items())
def test_a_unit_behind_the_name_is_its_unit(name, quantity):
    assert channel_names.quantity(name, channel_names.unit_in_name(name)) == quantity


NUMBERED = {
    "rudder_angle_deg_1": ("delta", "deg"),
    "rudder_order_deg_2": ("delta_order", "deg"),
    "positioningsystem_rot_degpm_1": ("r", "deg/min"),
    "positioningsystem_stw_kn_1": ("u", "kn"),
    "positioningsystem_accx_mps2_1": (None, None),
    "speed_mps2": (None, None),
    "rudder_1": ("delta", None),
    "dvl_u": ("u", None),
    "dvl_v": ("v", None),
    "vel_u_mps": ("u", "m/s"),
    "dvl_w": (None, None),
}


@pytest.mark.parametrize(("name", "told"), NUMBERED.items())
def test_a_number_behind_a_unit_is_of_one_of_several(name, told):
    unit = channel_names.unit_in_name(name)
    assert (channel_names.quantity(name, unit), unit) == told


@pytest.mark.parametrize(("name", "unit"), CAPITALS)
def test_a_capital_means_what_its_unit_allows(name, unit):
    assert channel_names.quantity(name, unit) == CAPITALS[name, unit]


@pytest.mark.parametrize(("name", "side"), OF_A_SIDE.items())
def test_a_side_in_a_name(name, side):
    assert sides(name) == side


def looked_into(tmp_path, **columns):
    """The survey of a table of these columns; `_` before the unit in their names."""
    log = tmp_path / "log.csv"
    heads = [name.replace("__", " [") + "]" if "__" in name else name for name in columns]
    heads = [head.replace("_per_", "/") for head in heads]
    rows = np.column_stack([T, *columns.values()])
    np.savetxt(log, rows, fmt="%.6f", delimiter=",", header=",".join(["t", *heads]), comments="")
    return inspect_log(log)


def known(survey):
    return {c.name: c.guess.quantity for c in survey.channels.values() if c.guess}


def test_a_v_is_a_sway_beside_a_u_and_else_some_speed(tmp_path):
    sway, ahead = 0.2 * np.sin(T), 2.0 + 0.1 * np.cos(T)
    both = looked_into(tmp_path, U__m_per_s=ahead, V__m_per_s=sway)
    assert known(both) == {"U": "u", "V": "v"}
    assert known(looked_into(tmp_path, V__m_per_s=ahead)) == {}
    assert known(looked_into(tmp_path, u__m_per_s=ahead, V__m_per_s=1.01 * ahead)) == {"u": "u"}


def test_a_lone_u_or_v_is_a_speed_of_which_nobody_says_relative_to_what(tmp_path):
    for columns, told in (
        ({"U__m_per_s": 2.0 + 0.1 * np.cos(T)}, True),
        ({"V__m_per_s": 2.0 + 0.1 * np.cos(T)}, True),
        ({"V__m_per_s": 0.2 * np.sin(T)}, False),
        ({"V__V": 2.0 + 0.1 * np.cos(T)}, False),
    ):
        (one,) = looked_into(tmp_path, **columns).channels.values()
        assert of_either(one) is told


def test_speeds_along_axes_are_hers_where_they_keep_to_the_bow(tmp_path):
    names = ("VX__m_per_s", "VY__m_per_s")
    ship = dict(zip(names, (2.0 + 0.0 * T + 0.01 * np.sin(T), -0.2 * np.ones(len(T))), strict=True))
    ship["VY__m_per_s"] = ship["VY__m_per_s"] + 0.01 * np.cos(T)
    earth = dict(zip(names, (2.0 * np.cos(TURN), 2.0 * np.sin(TURN)), strict=True))
    heading = {"psi__deg": np.rad2deg(TURN)}
    assert known(looked_into(tmp_path, **ship, **heading)) == {"VX": "u", "VY": "v", "psi": "psi"}
    for columns in ({**earth, **heading}, ship):
        told = looked_into(tmp_path, **columns)
        assert not {"VX", "VY"} & known(told).keys()
        assert sum("VX and VY are speeds along axes" in line for line in told.warnings) == 1


def test_a_shaft_and_its_thrust_are_no_two_thrusters(tmp_path):
    columns = {"n__rps": 10.0 + np.sin(T), "Thrust__N": 14.0 + np.cos(T)}
    assert drives_among(looked_into(tmp_path, **columns)) == []
    columns = {"thrust_left__N": 10.0 + np.sin(T), "thrust_right__N": 14.0 + np.cos(T)}
    assert drives_among(looked_into(tmp_path, **columns)) == ["thrust_left", "thrust_right"]


def test_a_position_in_millimetres(tmp_path):
    told = looked_into(tmp_path, X__mm=2000.0 * T, Y__mm=100.0 * T)
    found = positions(told.channels.values())
    assert {name: one.name for name, one in found.items()} == {"x": "X", "y": "Y"}
    assert usual_speed(told.channels.values()) == pytest.approx(2.0, rel=0.01)


def test_revolutions_in_one_over_a_second_are_asked_for(tmp_path):
    name = "Rate of Revolutions"
    told = looked_into(tmp_path, **{f"{name}__1_per_s": 10.0 + np.sin(T)})
    assert [line for line in told.warnings if line.startswith(f"{name}: 1/s may be")]
    log = Recording(
        told.path,
        "csv",
        "0" * 64,
        {name: Channel(name, np.arange(3), np.ones(3), unit="1/s", clock="table")},
        (),
    )
    turns = frames.series(SignalSource("n", name, unit="rps"), [log], "")
    assert turns.y == pytest.approx(np.full(3, 2.0 * np.pi))
    with pytest.raises(UnitError):
        frames.series(SignalSource("n", name), [log], "")
    with pytest.raises(AlignmentError, match="the log states '1/s'"):
        frames.series(SignalSource("r", name, unit="deg/s"), [log], "")


@pytest.mark.parametrize("names", [("left", "right"), ("port", "stbd")])
def test_a_side_alone_is_a_drives_where_no_unit_is_stated(tmp_path, names) -> None:
    """The guide called them so, and `start` knew no rudder and nothing that steers."""
    waves = {name: np.sin((k + 1) * T) for k, name in enumerate(names)}
    found = drives_of(looked_into(tmp_path, **waves))
    assert [one.name for one in found] == [*names]
    with_unit = {f"{name}__m": y for name, y in waves.items()}
    assert drives_of(looked_into(tmp_path, **with_unit)) == ()
