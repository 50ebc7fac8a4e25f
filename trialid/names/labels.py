"""What a signal is called: on an axis, in a CSV header, in a message field."""

import re

from trialid.names import units, wording
from trialid.names.quantities import SIGNALS, Quantity

_GREEK = {
    "phi": "\u03c6", "psi": "\u03c8", "delta": "\u03b4", "gamma": "\u03b3", "alpha": "\u03b1",
}  # fmt: skip

_FIELDS = {
    "u": "surge_speed",
    "v": "sway_speed",
    "p": "roll_rate",
    "r": "yaw_rate",
    "phi": "roll",
    "psi": "heading",
    "delta": "rudder",
    "delta_order": "rudder_order",
    "n": "shaft_speed",
    "U": "speed",
}
"""Spoken names for plot tools, whose users never saw our letters."""


def quantity(name: str) -> Quantity:
    """The dictionary's entry, or a plain number under its own name for what it does not hold."""
    return SIGNALS.get(name) or Quantity(name, name, "1", "1", name)


def meaning(name: str) -> str:
    """A signal in words, without the sign convention.

    >>> meaning("r")
    'yaw rate'
    """
    return quantity(name).meaning.split(",")[0]


def symbol(name: str) -> str:
    """A signal's letter as printed, Greek letters as such.

    >>> symbol("r"), symbol("delta_order")
    ('r', 'δ_c')
    """
    stem, _, index = quantity(name).symbol.partition("_")
    return "_".join(part for part in (_GREEK.get(stem, stem), index) if part)


def label(name: str) -> str:
    """A signal in words and by its letter.

    >>> label("r")
    'yaw rate r'
    """
    words, letter = meaning(name), symbol(name)
    return words if words == letter else f"{words} {letter}"


def shown_unit(name: str) -> str:
    """The unit reports show a signal in."""
    return quantity(name).shown


def shown_factor(name: str) -> float:
    """What to multiply an SI value of a signal by to show it."""
    known = quantity(name)
    return 1.0 if known.shown == known.unit else units.shown_factor(known)


def shown_text(name: str, value: float | None) -> str:
    """A signal's SI value in words, three digits and the unit reports show it in.

    >>> shown_text("delta", 0.1)
    '5.73 deg'
    """
    if value is None:
        return wording.DASH
    return f"{wording.number(value * shown_factor(name), 3)} {shown_unit(name)}"


def command_text(command: Quantity, value: float) -> str:
    """What an actuator is told, in SI, as it is called out; a share in per cent.

    >>> command_text(Quantity("left", "left", "1", "1", ""), -0.35)
    '-35 %'
    """
    if command.shown == "1":
        return f"{100.0 * value:.3g} %"
    return f"{value * units.shown_factor(command):.4g} {command.shown}"


def unit_word(unit: str) -> str:
    """A unit as part of a column or field name.

    >>> unit_word("rad/s"), unit_word("m/s^2")
    ('radps', 'mps2')
    """
    return unit.replace("/", "p").replace("^", "").replace("*", "")


def column(name: str, role: str = "", unit: str | None = None) -> str:
    """A CSV header: the quantity, what it is of it, the SI unit, the dictionary's where not given.

    >>> column("delta"), column("r", "measured"), column("left", unit="rad/s")
    ('delta_rad', 'r_measured_radps', 'left_radps')
    """
    known = quantity(name).unit if unit is None else unit
    return "_".join(part for part in (name, role, unit_word(known)) if part)


def message_field(name: str, unit: str | None = None) -> str:
    """A protobuf field: the spoken name and the SI unit, the dictionary's where none is given.

    >>> message_field("r"), message_field("delta"), message_field("left", "N")
    ('yaw_rate_radps', 'rudder_rad', 'left_N')
    """
    unit = quantity(name).unit if unit is None else unit
    words = (_FIELDS.get(name, name), "" if unit == "1" else unit_word(unit))
    return re.sub(r"\W", "_", "_".join(word for word in words if word), flags=re.ASCII)
