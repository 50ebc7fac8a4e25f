"""What receivers of satellites say in NMEA 0183: position, its quality, course and speed.

From the public summaries of NMEA 0183 / IEC 61162-1. A position that the receiver reckoned, was
told or made up (modes E, M, S; quality 6, 7, 8) is no fix and no number here.
"""

from collections.abc import Mapping

from trialid.ingest.nmea0183.nmea0183_instruments import INSTRUMENTS
from trialid.ingest.nmea0183.nmea0183_layouts import Field, Layout, Letter

FIXED = "ADRFP"
"""Modes of a fix by satellites: autonomous, differential, real time kinematic, float, precise."""
QUALITY = "123459"
"""The same in GGA: 1 autonomous, 2 differential, 3 precise, 4 and 5 RTK, 9 by a maker's means."""
SAYS = "ADEFRPMS"
"""Modes in which a course and a speed are told; N is none."""


def _position(at: int, fix: Letter, status: Letter | None = None) -> tuple[Field, ...]:
    """Latitude from field `at` on, then its side, the longitude and its side."""
    return (
        Field(
            name="latitude",
            at=at,
            unit="deg",
            words="latitude, positive north",
            status=status,
            side=(at + 1, "NS"),
            fix=fix,
            minutes=True,
        ),
        Field(
            name="longitude",
            at=at + 2,
            unit="deg",
            words="longitude, positive east",
            status=status,
            side=(at + 3, "EW"),
            fix=fix,
            minutes=True,
        ),
    )


def _over_ground(name: str, at: int, unit: str, words: str, letter: str) -> Field:
    return Field(name, at, unit, words, status=(9, SAYS), mark=(at + 1, letter))


def _precision(at: int, satellites: int) -> tuple[Field, ...]:
    return (
        Field("satellites", satellites, None, "satellites used"),
        Field("hdop", at, None, "horizontal dilution of precision"),
    )


RECEIVERS: Mapping[str, tuple[Layout, ...]] = {
    "VTG": (
        Layout(
            "course and speed over ground",
            (
                _over_ground("true_course", 1, "deg", "true course", "T"),
                _over_ground("magnetic_course", 3, "deg", "magnetic course", "M"),
                _over_ground("speed", 5, "kn", "speed over ground", "N"),
                _over_ground("speed_kmh", 7, "km/h", "speed over ground", "K"),
            ),
        ),
    ),
    "RMC": (
        Layout(
            "recommended minimum data of the receiver",
            (
                *_position(3, (12, FIXED), status=(2, "A")),
                Field("speed", 7, "kn", "speed over ground", status=(2, "A")),
                Field("course", 8, "deg", "true course over ground", status=(2, "A")),
                Field("variation", 10, "deg", "magnetic variation, positive east", side=(11, "EW")),
            ),
        ),
    ),
    "GGA": (Layout("fix of the receiver", (*_position(2, (6, QUALITY)), *_precision(8, 7))),),
    "GLL": (Layout("position", _position(1, (7, FIXED), status=(6, "A"))),),
    "GNS": (Layout("fix of several systems", (*_position(2, (6, FIXED)), *_precision(8, 7))),),
}
"""Sentence by its three letters."""

SENTENCES: Mapping[str, tuple[Layout, ...]] = {**INSTRUMENTS, **RECEIVERS}
"""Every sentence that is read."""
