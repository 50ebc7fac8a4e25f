"""The parameter groups (PGN) of NMEA 2000 a trial needs: what their messages hold, byte by byte.

Layouts, units and signs are those of the public description of the bus by the canboat project
(canboat.github.io/canboat/canboat.html).
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

HALF_TURN = 3.1416
"""Pi in the steps of an angle [rad]."""

NORTH = {0: "true", 1: "magnetic"}
WIND = {
    0: "true_north",
    1: "magnetic_north",
    2: "apparent",
    3: "true_boat",
    4: "true_water",
}
ENGINES = {0: "single engine or port", 1: "starboard engine"}
"""Which engine an instance is."""
NO_FIX = {0: "no fix", 6: "estimated", 7: "put in", 8: "simulated", 14: "an error"}
"""Methods by which a position is none of satellites; 15 says nothing, 1 to 5 are fixes."""
POSITIONS = frozenset(("latitude", "longitude"))


@dataclass(frozen=True)
class Field:
    """One number of a message: `kind` is i or u and the count of its bytes, from byte `at`.

    With `bits` it is the lowest of them, and none where all are set. Beyond `limit` to either side
    a number is none: half a turn, the poles. `{}` in the name stands for the reference the message
    states: true, magnetic, apparent.
    """

    name: str
    at: int
    kind: str
    step: float
    unit: str
    words: str
    quantity: str | None = None
    positive: Literal["starboard", "port"] | None = None
    limit: float = math.inf
    bits: int = 0

    @property
    def size(self) -> int:
        """Bytes."""
        return int(self.kind[1:])

    @property
    def end(self) -> int:
        """Bytes a message needs to hold it."""
        return self.at + self.size


@dataclass(frozen=True)
class Reference:
    """Bits that say what the numbers of a message refer to; code to name."""

    at: int
    shift: int
    mask: int
    names: Mapping[int, str]


@dataclass(frozen=True)
class Layout:
    """A parameter group: what a message holds; by `no_fix` its positions are none by satellites.

    `instances` are words for the numbers of its devices, where the bus says what they are.
    """

    name: str
    words: str
    fields: tuple[Field, ...]
    instance: int | None = None
    reference: Reference | None = None
    fast: bool = False
    no_fix: Reference | None = None
    instances: Mapping[int, str] = field(default_factory=dict)


def _angle(name: str, at: int, words: str, quantity: str | None = None) -> Field:
    return Field(name=name, at=at, kind="u2", step=1e-4, unit="rad", words=words, quantity=quantity)


def _tilt(name: str, at: int, words: str, quantity: str | None = None) -> Field:
    """A signed angle, positive to starboard where it has a side."""
    positive: Literal["starboard"] | None = "starboard" if quantity else None
    return Field(
        name=name,
        at=at,
        kind="i2",
        step=1e-4,
        unit="rad",
        words=words,
        quantity=quantity,
        positive=positive,
        limit=HALF_TURN,
    )


def _component(name: str, at: int, words: str, quantity: str | None = None) -> Field:
    return Field(name=name, at=at, kind="i2", step=1e-3, unit="m/s", words=words, quantity=quantity)


def _speed(name: str, at: int, words: str, quantity: str | None = None) -> Field:
    return Field(name=name, at=at, kind="u2", step=1e-2, unit="m/s", words=words, quantity=quantity)


LAYOUTS: Mapping[int, Layout] = {
    127237: Layout(
        "heading_control",
        "heading and track control",
        (
            _tilt("rudder_order", 3, "commanded rudder angle", "delta_order"),
            _angle("{}_heading_to_steer", 5, "{} heading to steer"),
            Field("rate_of_turn_order", 15, "i2", 3.125e-5, "rad/s", "ordered rate of turn"),
            _angle("{}_heading", 19, "{} heading of the vessel", "psi"),
        ),
        reference=Reference(1, 6, 3, NORTH),
        fast=True,
    ),
    127245: Layout(
        "rudder",
        "rudder",
        (
            _tilt("order", 2, "ordered angle", "delta_order"),
            _tilt("position", 4, "angle fed back", "delta"),
        ),
        instance=0,
    ),
    127250: Layout(
        "heading",
        "vessel heading",
        (
            _angle("{}", 1, "{} heading", "psi"),
            _tilt("deviation", 3, "deviation of the compass, positive east"),
            _tilt("variation", 5, "magnetic variation, positive east"),
        ),
        reference=Reference(7, 0, 3, NORTH),
    ),
    127251: Layout(
        "rate_of_turn",
        "rate of turn",
        (
            Field(
                name="rate",
                at=1,
                kind="i4",
                step=3.125e-8,
                unit="rad/s",
                words="rate of turn",
                quantity="r",
                positive="starboard",
            ),
        ),
    ),
    127252: Layout("heave", "heave", (Field("heave", 1, "i2", 1e-2, "m", "heave, positive up"),)),
    127257: Layout(
        "attitude",
        "attitude",
        (
            _tilt("yaw", 1, "yaw"),
            _tilt("pitch", 3, "pitch, positive bow up"),
            _tilt("roll", 5, "roll, positive starboard side down", "phi"),
        ),
    ),
    127258: Layout(
        "variation",
        "magnetic variation",
        (_tilt("variation", 4, "magnetic variation, positive east"),),
    ),
    127488: Layout(
        "engine",
        "engine parameters, rapid update",
        (
            Field(
                "speed",
                1,
                "u2",
                0.25,
                "rpm",
                "speed of the engine without sign, not of the shaft",
            ),
        ),
        instance=0,
        instances=ENGINES,
    ),
    127493: Layout(
        "transmission",
        "transmission parameters",
        (Field("gear", 1, "u1", 1.0, "1", "gear: 0 ahead, 1 neutral, 2 astern", bits=2),),
        instance=0,
        instances=ENGINES,
    ),
    128259: Layout(
        "speed",
        "speed",
        (
            _speed("water", 1, "speed through the water, without sign", "u"),
            _speed("ground", 3, "speed over ground, without sign"),
        ),
    ),
    128267: Layout(
        "depth",
        "water depth",
        (
            Field("below_transducer", 1, "u4", 1e-2, "m", "depth below the transducer"),
            Field("offset", 5, "i2", 1e-3, "m", "waterline above the transducer; negative: keel"),
        ),
    ),
    129025: Layout(
        "position",
        "position, rapid update",
        (
            Field("latitude", 0, "i4", 1e-7, "deg", "latitude, positive north", limit=90.0),
            Field("longitude", 4, "i4", 1e-7, "deg", "longitude, positive east", limit=180.0),
        ),
    ),
    129026: Layout(
        "cog_sog",
        "course and speed over ground, rapid update",
        (
            _angle("{}_cog", 2, "{} course over ground"),
            _speed("sog", 4, "speed over ground, without sign"),
        ),
        reference=Reference(1, 0, 3, NORTH),
    ),
    129029: Layout(
        "gnss",
        "GNSS position",
        (
            Field("latitude", 7, "i8", 1e-16, "deg", "latitude, positive north", limit=90.0),
            Field("longitude", 15, "i8", 1e-16, "deg", "longitude, positive east", limit=180.0),
            Field("satellites", 33, "u1", 1.0, "1", "satellites used"),
            Field("hdop", 34, "i2", 1e-2, "1", "horizontal dilution of precision"),
        ),
        fast=True,
        no_fix=Reference(31, 4, 15, NO_FIX),
    ),
    130306: Layout(
        "wind",
        "wind",
        (
            _speed("{}_speed", 1, "speed of the {} wind"),
            _angle("{}_angle", 3, "where the {} wind comes from, clockwise"),
        ),
        reference=Reference(5, 0, 7, WIND),
    ),
    130578: Layout(
        "vessel_speed",
        "vessel speed components",
        (
            _component("longitudinal_water", 0, "speed ahead through the water", "u"),
            _component("transverse_water", 2, "speed to starboard through the water", "v"),
            _component("longitudinal_ground", 4, "speed ahead over ground"),
            _component("transverse_ground", 6, "speed to starboard over ground"),
            _component("stern_water", 8, "speed of the stern to starboard through the water"),
            _component("stern_ground", 10, "speed of the stern to starboard over ground"),
        ),
        fast=True,
    ),
}
"""Parameter groups that are read, by number."""
