"""What a ship's instruments say in NMEA 0183 that a trial needs: fields, units, sides, status.

Rudder, heading, rate of turn, attitude, speed, wind, revolutions, depth. From the public summaries
of NMEA 0183 / IEC 61162-1 and of the makers' own sentences: PASHR (attitude, heave), PSXN 23
(Seapath), PFEC GPatt (Furuno).
"""

from collections.abc import Mapping

from trialid.ingest.nmea0183.nmea0183_layouts import Field, Layout, Side

RELATIVE = "relative, no unit: state unit (deg) and check gain"


def _rudder(name: str, at: int, words: str) -> Field:
    return Field(
        name=name,
        at=at,
        unit=None,
        words=f"{words} ({RELATIVE})",
        quantity="delta",
        positive="starboard",
        status=(at + 1, "A"),
    )


def _order(name: str, at: int, words: str) -> Field:
    return Field(
        name=name,
        at=at,
        unit="deg",
        words=words,
        quantity="delta_order",
        positive="starboard",
        status=(at + 1, "A"),
    )


def _steering(words: str) -> Layout:
    return Layout(
        words,
        (
            Field(
                "rudder_order",
                2,
                "deg",
                "commanded rudder angle",
                "delta_order",
                "starboard",
                side=(3, "RL"),
            ),
            Field("heading_order", 10, "deg", "commanded heading to steer"),
        ),
    )


def _knots(name: str, at: int, words: str, status: int, quantity: str | None = None) -> Field:
    side: Side | None = "starboard" if name.startswith(("transverse", "stern")) else None
    return Field(
        name=name,
        at=at,
        unit="kn",
        words=words,
        quantity=quantity,
        positive=side,
        status=(status, "A"),
    )


def _wind(name: str, reference: str, words: str, known: bool) -> tuple[Field, ...]:
    only, status = (2, reference), (5, "A")
    angle, speed = ("gamma_aw", "V_aw") if known else (None, None)
    return (
        Field(
            name=f"{name}_angle",
            at=1,
            unit="deg",
            words=f"angle of the {words} wind off the bow, clockwise",
            quantity=angle,
            positive="starboard" if known else None,
            status=status,
            only=only,
        ),
        Field(
            name=f"{name}_speed",
            at=3,
            unit=None,
            words=f"speed of the {words} wind",
            quantity=speed,
            positive=None,
            status=status,
            only=only,
            unit_at=4,
            units=(("K", "km/h"), ("M", "m/s"), ("N", "kn"), ("S", "mph")),
        ),
    )


def _attitude(heading: int, pitch: int, roll: int, side: Side | None) -> tuple[Field, ...]:
    which = "starboard side down" if side else "the maker's side, check it"
    return (
        Field("heading", heading, "deg", "true heading", "psi", "starboard"),
        Field("pitch", pitch, "deg", "pitch"),
        Field("roll", roll, "deg", f"roll, positive {which}", "phi", side),
    )


INSTRUMENTS: Mapping[str, tuple[Layout, ...]] = {
    "RSA": (
        Layout(
            "rudder sensor angle",
            (
                _rudder("starboard", 1, "starboard or single rudder, fed back"),
                _rudder("port", 3, "port rudder, fed back"),
            ),
        ),
    ),
    "ROR": (
        Layout(
            "rudder order",
            (
                _order("starboard", 1, "order to the starboard or single rudder"),
                _order("port", 3, "order to the port rudder"),
            ),
        ),
    ),
    "HTC": (_steering("heading and track control command"),),
    "HTD": (_steering("heading and track control data"),),
    "ROT": (
        Layout(
            "rate of turn",
            (
                Field(
                    name="rate",
                    at=1,
                    unit="deg/min",
                    words="rate of turn, minus is bow to port",
                    quantity="r",
                    positive="starboard",
                    status=(2, "A"),
                ),
            ),
        ),
    ),
    "HDT": (
        Layout(
            "heading, true",
            (Field("heading", 1, "deg", "true heading", "psi", "starboard", mark=(2, "T")),),
        ),
    ),
    "THS": (
        Layout(
            "true heading and status",
            (
                Field(
                    name="heading",
                    at=1,
                    unit="deg",
                    words="true heading",
                    quantity="psi",
                    positive="starboard",
                    status=(2, "AE"),
                ),
            ),
        ),
    ),
    "HDG": (
        Layout(
            "heading, deviation and variation",
            (
                Field("heading", 1, "deg", "magnetic heading of the sensor", "psi", "starboard"),
                Field("deviation", 2, "deg", "deviation, positive east", side=(3, "EW")),
                Field("variation", 4, "deg", "magnetic variation, positive east", side=(5, "EW")),
            ),
        ),
    ),
    "HDM": (
        Layout(
            "heading, magnetic",
            (Field("heading", 1, "deg", "magnetic heading", "psi", "starboard", mark=(2, "M")),),
        ),
    ),
    "VBW": (
        Layout(
            "dual ground/water speed",
            (
                _knots("longitudinal_water", 1, "speed ahead through the water", 3, "u"),
                _knots("transverse_water", 2, "speed to starboard through the water", 3, "v"),
                _knots("longitudinal_ground", 4, "speed ahead over ground", 6),
                _knots("transverse_ground", 5, "speed to starboard over ground", 6),
                _knots("stern_transverse_water", 7, "stern to starboard through the water", 8),
                _knots("stern_transverse_ground", 9, "stern to starboard over ground", 10),
            ),
        ),
    ),
    "VHW": (
        Layout(
            "water speed and heading",
            (
                Field("true_heading", 1, "deg", "true heading", "psi", "starboard", mark=(2, "T")),
                Field(
                    "magnetic_heading",
                    3,
                    "deg",
                    "magnetic heading",
                    "psi",
                    "starboard",
                    mark=(4, "M"),
                ),
                Field("speed", 5, "kn", "speed through the water", "u", mark=(6, "N")),
                Field("speed_kmh", 7, "km/h", "speed through the water", "u", mark=(8, "K")),
            ),
        ),
    ),
    "MWV": (
        Layout(
            "wind speed and angle",
            _wind("relative", "R", "apparent", True)
            + _wind("theoretical", "T", "theoretical (true)", False),
        ),
    ),
    "RPM": (
        Layout(
            "revolutions",
            (
                Field(
                    "speed",
                    3,
                    "rpm",
                    "revolutions, minus is counter-clockwise",
                    status=(5, "A"),
                ),
                Field("pitch", 4, "percent", "propeller pitch, minus is astern", status=(5, "A")),
            ),
            instance=(1, 2),
        ),
    ),
    "DPT": (
        Layout(
            "depth",
            (
                Field("depth", 1, "m", "depth below the transducer"),
                Field("offset", 2, "m", "transducer to waterline, or to the keel if negative"),
            ),
        ),
    ),
    "DBT": (
        Layout(
            "depth below transducer",
            (
                Field("depth", 3, "m", "depth below the transducer", mark=(4, "M")),
                Field("depth_feet", 1, "ft", "depth below the transducer", mark=(2, "f")),
            ),
        ),
    ),
    "PASHR": (
        Layout(
            "attitude and heave",
            (
                Field("heading", 2, "deg", "true heading", "psi", "starboard", mark=(3, "T")),
                *_attitude(2, 5, 4, "starboard")[1:],
                Field("heave", 6, "m", "heave"),
            ),
            kind="",
        ),
        Layout("attitude", _attitude(3, 4, 5, None), kind="ATT"),
    ),
    "PSXN": (
        Layout(
            "attitude and heave",
            (
                Field("roll", 2, "deg", "roll, positive port side up", "phi", "starboard"),
                Field("pitch", 3, "deg", "pitch, positive bow up"),
                Field("heading", 4, "deg", "true heading", "psi", "starboard"),
                Field("heave", 5, "m", "heave, positive down"),
            ),
            kind="23",
        ),
    ),
    "PFEC": (Layout("attitude", _attitude(2, 3, 4, None), kind="GPatt", at_most=4),),
}
"""Sentence by its three letters, those of a maker by all letters of the address."""
SHAFTS = {
    "S0": ("n", "the single or centre shaft"),
    "S1": ("n_s", "starboard shaft"),
    "S2": ("n_p", "port shaft"),
}
"""Which shaft the numbers of RPM mean: odd to starboard, even to port, from the middle."""
