"""What autopilots mean by the fields that matter to a ship: unit, quantity and positive side.

Axes are forward, right, down, as ours: roll positive starboard down, yaw clockwise. Sources: the
MAVLink message definitions, and ArduPilot's AP_Logger, LogStructure.h and Rover/Log.cpp.
"""

from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True)
class Meaning:
    """What a field is; `unit` is what it is in where the log itself does not say."""

    words: str
    unit: str | None = None
    quantity: str | None = None
    positive: Literal["starboard", "port"] | None = None


def _side(words: str, unit: str, quantity: str) -> Meaning:
    return Meaning(words, unit, quantity, "starboard")


_ROLL, _HEADING = ("roll angle", "deg", "phi"), ("heading", "deg", "psi")
_ORDER = "normalised steering order -4500 to 4500, not degrees"
_BODY = "of one gyro, body axes, bias not removed"

DATAFLASH = {
    ("ATT", "Roll"): _side(*_ROLL),
    ("ATT", "Pitch"): Meaning("pitch angle", "deg"),
    ("ATT", "Yaw"): _side(*_HEADING),
    ("ATT", "DesRoll"): Meaning("roll angle the autopilot wants", "deg"),
    ("ATT", "DesYaw"): Meaning("heading the autopilot wants", "deg"),
    ("AHR2", "Roll"): _side("roll angle, second estimate", "deg", "phi"),
    ("AHR2", "Yaw"): _side("heading, second estimate", "deg", "psi"),
    ("XKF1", "Roll"): _side("roll angle of one filter", "deg", "phi"),
    ("XKF1", "Yaw"): _side("heading of one filter", "deg", "psi"),
    ("NKF1", "Roll"): _side("roll angle of one filter", "deg", "phi"),
    ("NKF1", "Yaw"): _side("heading of one filter", "deg", "psi"),
    ("IMU", "GyrX"): _side(f"roll rate {_BODY}", "rad/s", "p"),
    ("IMU", "GyrY"): Meaning(f"pitch rate {_BODY}", "rad/s"),
    ("IMU", "GyrZ"): _side(f"yaw rate {_BODY}", "rad/s", "r"),
    ("IMU2", "GyrX"): _side(f"roll rate {_BODY}", "rad/s", "p"),
    ("IMU2", "GyrZ"): _side(f"yaw rate {_BODY}", "rad/s", "r"),
    ("IMU", "AccX"): Meaning("acceleration forward", "m/s^2"),
    ("IMU", "AccY"): Meaning("acceleration to starboard", "m/s^2"),
    ("IMU", "AccZ"): Meaning("acceleration downwards", "m/s^2"),
    ("RATE", "R"): _side("roll rate, body axes", "deg/s", "p"),
    ("RATE", "Y"): _side("yaw rate, body axes", "deg/s", "r"),
    ("STER", "SteerIn"): Meaning(_ORDER),
    ("STER", "SteerOut"): Meaning(_ORDER),
    ("STER", "TurnRate"): Meaning("rate of turn about the vertical, starboard positive", "deg/s"),
    ("GPS", "Spd"): Meaning("speed over ground", "m/s"),
    ("GPS", "GCrs"): Meaning("course over ground", "deg"),
    ("GPS", "Lat"): Meaning("latitude", "deg"),
    ("GPS", "Lng"): Meaning("longitude", "deg"),
    ("POS", "Lat"): Meaning("latitude, as estimated", "deg"),
    ("POS", "Lng"): Meaning("longitude, as estimated", "deg"),
    ("THR", "Speed"): Meaning("forward speed over ground, as estimated", "m/s"),
    ("WIND", "DirApp"): Meaning("apparent wind direction", "deg"),
    ("WIND", "SpdApp"): Meaning("apparent wind speed", "m/s", "V_aw"),
    ("DPTH", "Depth"): Meaning("depth of the water below the sounder", "m", "h"),
}  # fmt: skip
"""By message and column of dataflash."""

DATAFLASH_MESSAGES = {
    "STRT": "startup of the autopilot, not steering",
    "RCOU": "pulse width sent to an output, an order",
    "RCO2": "pulse width sent to an output, an order",
    "RCO3": "pulse width sent to an output, an order",
    "RCIN": "pulse width received from the pilot",
}
"""What whole messages of dataflash are, where the name misleads."""

MAVLINK = {
    ("ATTITUDE", "roll"): _side("roll angle", "rad", "phi"),
    ("ATTITUDE", "pitch"): Meaning("pitch angle", "rad"),
    ("ATTITUDE", "yaw"): _side("heading", "rad", "psi"),
    ("ATTITUDE", "rollspeed"): _side("roll rate, body axes", "rad/s", "p"),
    ("ATTITUDE", "yawspeed"): _side("yaw rate, body axes", "rad/s", "r"),
    ("ATTITUDE_QUATERNION", "rollspeed"): _side("roll rate, body axes", "rad/s", "p"),
    ("ATTITUDE_QUATERNION", "yawspeed"): _side("yaw rate, body axes", "rad/s", "r"),
    ("AHRS2", "roll"): _side("roll angle, second estimate", "rad", "phi"),
    ("AHRS2", "yaw"): _side("heading, second estimate", "rad", "psi"),
    ("AHRS3", "roll"): _side("roll angle, third estimate", "rad", "phi"),
    ("AHRS3", "yaw"): _side("heading, third estimate", "rad", "psi"),
    ("HIGHRES_IMU", "xgyro"): _side(f"roll rate {_BODY}", "rad/s", "p"),
    ("HIGHRES_IMU", "zgyro"): _side(f"yaw rate {_BODY}", "rad/s", "r"),
    ("SCALED_IMU", "xgyro"): _side(f"roll rate {_BODY}", "rad/s", "p"),
    ("SCALED_IMU", "zgyro"): _side(f"yaw rate {_BODY}", "rad/s", "r"),
    ("SCALED_IMU2", "xgyro"): _side(f"roll rate {_BODY}", "rad/s", "p"),
    ("SCALED_IMU2", "zgyro"): _side(f"yaw rate {_BODY}", "rad/s", "r"),
    ("SCALED_IMU3", "xgyro"): _side(f"roll rate {_BODY}", "rad/s", "p"),
    ("SCALED_IMU3", "zgyro"): _side(f"yaw rate {_BODY}", "rad/s", "r"),
    ("VFR_HUD", "heading"): _side("heading in whole degrees", "deg", "psi"),
    ("VFR_HUD", "groundspeed"): Meaning("speed over ground"),
    ("GLOBAL_POSITION_INT", "hdg"): _side("heading", "deg", "psi"),
    ("GLOBAL_POSITION_INT", "lat"): Meaning("latitude, as estimated"),
    ("GLOBAL_POSITION_INT", "lon"): Meaning("longitude, as estimated"),
    ("GLOBAL_POSITION_INT", "vx"): Meaning("velocity over ground to the north"),
    ("GLOBAL_POSITION_INT", "vy"): Meaning("velocity over ground to the east"),
    ("GPS_RAW_INT", "lat"): Meaning("latitude"),
    ("GPS_RAW_INT", "lon"): Meaning("longitude"),
    ("GPS_RAW_INT", "vel"): Meaning("speed over ground"),
    ("GPS_RAW_INT", "cog"): Meaning("course over ground"),
    ("WIND", "direction"): Meaning("where the wind comes from, off north"),
    ("WATER_DEPTH", "distance"): Meaning("depth of the water below the sounder", "m", "h"),
}
"""By message and field of MAVLink."""

MAVLINK_MESSAGES = {
    "SERVO_OUTPUT_RAW": "pulse width sent to an output, an order",
    "RC_CHANNELS": "pulse width received from the pilot",
    "RC_CHANNELS_RAW": "pulse width received from the pilot",
}
"""What whole messages of MAVLink are."""

UNITS: dict[str, tuple[str | None, float]] = {
    "": (None, 1.0),
    "UNKNOWN": (None, 1.0),
    "instance": (None, 1.0),
    "degheading": ("deg", 1.0),
    "deglatitude": ("deg", 1.0),
    "deglongitude": ("deg", 1.0),
    "cdeg": ("deg", 1e2),
    "ddeg": ("deg", 1e1),
    "degE5": ("deg", 1e5),
    "degE7": ("deg", 1e7),
    "cdeg/s": ("deg/s", 1e2),
    "mrad/s": ("rad/s", 1e3),
    "cdegC": ("degC", 1e2),
    "mG": ("g_0", 1e3),
    "m/s/s": ("m/s^2", 1.0),
    "cm/s/s": ("cm/s^2", 1.0),
    "deg/s/s": ("deg/s^2", 1.0),
    "rad/s/s": ("rad/s^2", 1.0),
    "%": ("percent", 1.0),
    "d%": ("percent", 1e1),
    "c%": ("percent", 1e2),
    "Gauss": ("gauss", 1.0),
    "mGauss": ("mgauss", 1.0),
    "µs": ("us", 1.0),
}
"""What a unit as ArduPilot or MAVLink writes it is called here, and what to divide numbers by."""


def unit(text: str) -> tuple[str | None, float]:
    """Unit as the package writes it, and what to divide the logged number by.

    >>> unit("cdeg"), unit("m/s"), unit("UNKNOWN")
    (('deg', 100.0), ('m/s', 1.0), (None, 1.0))
    """
    return UNITS.get(text, (text, 1.0))
