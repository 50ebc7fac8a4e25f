"""What a channel's name says, and what it must not be taken for."""

import pytest

from trialid.inspection import channel_names

RECORDERS = {
    "harbour/@v0/s175q/pubsub/rudder_angle_deg/steering_gear:value": "delta",
    "harbour/@v0/s175q/pubsub/yaw_rate_degps/gyro:value": "r",
    "gyro_z": "r",
    "yawrate_rad": "r",
    "yaw_rate_deg": "r",
    "compass": "psi",
    "Rel wind speed": "V_aw",
    "rel_wind_dir": "gamma_aw",
    "Fahrt durchs Wasser": "u",
    "FdW": "u",
    "Krängungswinkel": "phi",
    "/imu:angular_velocity.z": "r",
    "/imu:angular_velocity.x": "p",
    "ATTITUDE/1/1:yawspeed": "r",
    "ROT/HE:rate": "r",
    "rudderAngle": "delta",
    "RudderOrder": "delta_order",
    "Ruderlage": "delta",
    "commanded rudder": "delta_order",
    "shaft_rpm_port": "n_p",
    "Shaft Speed Stbd": "n_s",
    "heel": "phi",
    "HDT": "psi",
    "u": "u",
    "AWA": "gamma_aw",
    "/vessel/state:heading": "psi",
    "/pitch_roll:roll": "phi",
    "psi_hat": "psi",
    "Kurs": "psi",
    "Wellendrehzahl": "n",
    "rpm_left": "n_p",
    "phi_measured": "phi",
    "delta_meas": "delta",
    "motor_angle_deg": "delta",
    "Steering_deg": "delta",
    "surge_mps": "u",
    "speed_fwd_mps": "u",
    "fwd_speed": "u",
    "speed ahead [kn]": "u",
    "u_ms": "u",
    "v_ms": "v",
    "rot_deg_min": "r",
    "rot_dpm": "r",
    "engine_rpm": "n",
    "Engine RPM": "n",
    "jet_rpm": "n",
    "engine_rpm_links": "n_p",
    "Drehzahl rechts": "n_s",
    "nozzle_deg": "delta",
    "azimuth_deg": "delta",
    "gyro_z_rps": "r",
    "RUD_ORD": "delta_order",
    "CommandedRudderAngle": "delta_order",
    "delta_cmd": "delta_order",
    "delta_act": "delta",
    "helm_order": "delta_order",
    "psi_dot": "r",
    "yawDot": "r",
    "phi_dot": "p",
    "r_dot": None,
    "psi_ref": None,
    "longSpeed": "u",
    "lateral_velocity": "v",
    "forward_speed_over_ground": None,
    "transverse speed over ground": None,
    "longitudinal water speed": "u",
    "heading_min": None,
    "mag/compass_x": None,
    "heading_deg_min": None,
    "rudder_deg_min": None,
}

WITH_UNITS = {
    ("u_velo", "m/s"): "u",
    ("vm_velo", "m/s"): "v",
    ("r_angvelo", "rad/s"): "r",
    ("n_prop", "rps"): "n",
    ("n_prop", "rev/s"): "n",
    ("surge", "m/s"): "u",
    ("sway", "kn"): "v",
    ("surge", "m"): None,
    ("surge", None): None,
    ("steering", "deg"): "delta",
    ("servo_cmd", "deg"): "delta_order",
    ("servo", "us"): None,
    ("steering", None): "delta",
    ("steering_cmd", None): "delta_order",
    ("nozzle velocity", None): None,
    ("steering shaft", None): None,
    ("helm_gyro", None): None,
    ("steering wheel", "deg"): None,
    ("v_meas", "V"): None,
    ("v_meas", None): None,
    ("n_prop", "N"): None,
    ("Ruderlage", "°"): "delta",
    ("Wendegeschwindigkeit", "°/min"): "r",
    ("Drehzahl", "U/min"): "n",
    ("Drehzahl", "1/min"): "n",
    ("Fahrt", "kn"): None,
    ("Barre", "deg"): "delta",
    ("Taux de giration", "deg/s"): "r",
    ("Gîte", "deg"): "phi",
    ("Cap", "deg"): "psi",
    ("Cap", "uF"): None,
    ("Vitesse fond", "kn"): None,
    ("velocidad de guiñada", "deg/s"): "r",
    ("escora", "deg"): "phi",
    ("rumbo", "deg"): "psi",
    ("rumbo sobre el fondo", "deg"): None,
    ("corredera", "kn"): "u",
    ("Kurs über Grund", "°"): None,
}

OTHERS = (
    "heading_error", "desired_yaw_rate", "roll_std", "/imu:orientation_covariance[3]", "x", "U10",
    "engine_temperature", "engine_rpm_error", "satellite_azimuth",
    "rudder_temperature", "heading_status", "yaw_rate_setpoint", "/imu:linear.z",
    "heading_deviation", "max_roll", "t", "", "ATT:DesYaw", "GPS_RAW_INT/1/1:hdg_acc",
    "NAV_CONTROLLER_OUTPUT/1/1:nav_roll", "MANUAL_CONTROL/255/190:r", "/joy:u",
)  # fmt: skip


@pytest.mark.parametrize(("name", "quantity"), RECORDERS.items())
def test_names_of_recorders(name, quantity):
    assert channel_names.quantity(name, None) == quantity


@pytest.mark.parametrize(("name", "unit"), WITH_UNITS)
def test_letters_with_words_behind_them_mean_something_by_their_unit(name, unit):
    assert channel_names.quantity(name, unit) == WITH_UNITS[name, unit]


def test_a_speed_that_does_not_say_of_what():
    assert channel_names.of_some_speed("Fahrt", "kn")
    assert channel_names.of_some_speed("Boatspeed", "m/s")
    assert channel_names.of_some_speed("speed_kn", "kn")
    assert not channel_names.of_some_speed("Fahrt", "deg")
    assert not channel_names.of_some_speed("wind speed", "kn")
    assert channel_names.over_ground("Fahrt über Grund", "kn")


@pytest.mark.parametrize("name", OTHERS)
def test_what_only_sounds_like_a_motion_is_none(name):
    assert channel_names.quantity(name, None) is None


def test_a_name_of_two_quantities_is_none():
    assert channel_names.quantity("roll_heading", None) is None


def test_a_field_says_more_than_its_topic():
    assert channel_names.quantity("/heading:rate_of_turn", None) == "r"
    assert channel_names.quantity("/heading:roll", None) == "phi"


def test_a_unit_of_something_else_refutes_the_name():
    assert channel_names.quantity("rudder", "m/s") is None
    assert channel_names.quantity("rudder", "percent") is None
    assert channel_names.quantity("rudder", "degree") == "delta"
    assert channel_names.quantity("rudder", "no such unit") is None


def test_speed_over_ground_is_no_speed_through_the_water():
    assert channel_names.over_ground("RMC/GP:speed_over_ground", "kn")
    assert channel_names.quantity("RMC/GP:speed_over_ground", "kn") is None
    assert channel_names.over_ground("gps_speed_kn", "kn")
    assert channel_names.over_ground("GPS_Spd", None)
    assert not channel_names.over_ground("speed_through_water", "kn")
    assert channel_names.over_ground("forward speed over ground", "kn")
    assert not channel_names.over_ground("transverse speed over ground", "kn")


def test_every_phrase_leads_to_its_quantity():
    """No phrase is hidden by another one."""
    for quantity, text in channel_names.PHRASES.items():
        for phrase in text.split(", "):
            assert channel_names.quantity(phrase.replace(" ", "_"), None) == quantity, phrase


def test_a_gyro_in_rps_is_in_doubt_and_a_shaft_is_not():
    assert channel_names.unit_in_name("gyro_z_rps") is None
    assert channel_names.unit_in_name("yaw_rate_rps") is None
    assert channel_names.unit_in_name("yaw_rate_rad") == "rad/s"
    assert channel_names.unit_in_name("gyro_z_rad") == "rad/s"
    assert channel_names.unit_in_name("roll_rate_deg") is None
    assert channel_names.unit_in_name("yaw_rate_ms") is None
    assert channel_names.unit_in_name("rot_z_deg") == "deg"
    assert channel_names.unit_in_name("roll_deg") == "deg"
    assert channel_names.unit_in_name("shaft_rps") == "rps"


def test_a_course_over_ground():
    named = ("cog_deg", "Course", "gps_course_deg", "GPS_GCrs", "COG_gps", "crs_deg")
    assert all(channel_names.is_course(name, "", "deg") for name in named)
    for name in ("heading", "Kurs", "gps_heading_deg", "wind_course", "gps_course_error"):
        assert not channel_names.is_course(name, "", "deg")
    assert channel_names.is_course("GPS:GCrs", "GPS, course over ground", "deg")
    assert not channel_names.is_course("course_setpoint", "", "deg")


UNITS = {
    "u_ms": "m/s",
    "sog_ms": "m/s",
    "gps_speed_ms": "m/s",
    "Fahrt_ms": "m/s",
    "t_ms": None,
    "time_boot_ms": None,
    "delay_ms": None,
    "roll_ms": None,
    "r_ms": None,
}


@pytest.mark.parametrize("name", UNITS)
def test_only_of_a_speed_ms_is_no_millisecond(name):
    assert channel_names.unit_in_name(name) == UNITS[name]


@pytest.mark.parametrize("name", ["Ship speed", "vessel_speed_kn", "own ship speed"])
def test_a_ships_speed_says_no_more_than_a_speed(name):
    assert channel_names.of_some_speed(name, "kn")
    assert not channel_names.of_some_speed(name.replace("speed", "wind speed"), "kn")
