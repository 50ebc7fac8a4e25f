"""A ship: its particulars, masses and hydrodynamic coefficients, as its source publishes them."""

import math
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, Literal

from trialid.errors import ShipError, nearest
from trialid.quantities import MASS_PARAMETERS
from trialid.quantities import PARTICULARS as KNOWN

REQUIRED: Final = ("name", "source", "system", "rudder_positive", "particulars", "mass")
OPTIONAL: Final = ("coefficients", "coefficient_speed", "notes")
PARTICULARS: Final = ("L", "rho", "g", "nabla", "U0")
"""Those no model can do without; T and B are for the effects that ask for them."""
SECTIONS: Final = ("particulars", "mass", "coefficients")


@dataclass(frozen=True)
class Ship:
    """Facts about a ship.

    Attributes
    ----------
    particulars
        At least L [m], rho [kg/m^3], g [m/s^2], nabla [m^3], U0 [m/s]; SI.
    mass, coefficients
        Numbers in the system of their source.
    system
        `prime`: forces over 1/2 rho L^2 U^2; `dimensional`: SI at the speed `coefficient_speed`
        (1 m/s where the source writes the speed into the term, as Y_|u|v |u| v).
    rudder_positive
        Which way the ship turns for a positive rudder angle in these coefficients.
    """

    name: str
    source: str
    system: Literal["prime", "dimensional"]
    rudder_positive: Literal["starboard", "port"]
    particulars: Mapping[str, float]
    mass: Mapping[str, float]
    coefficients: Mapping[str, float]
    coefficient_speed: float = 1.0
    notes: str = ""


NO_SHIP: Final = Ship(
    name="none",
    source="sensors alone: nothing is simulated",
    system="prime",
    rudder_positive="starboard",
    particulars={"L": 175.0, "rho": 1025.0, "g": 9.81, "nabla": 1.0, "U0": 0.0},
    mass={},
    coefficients={},
)
"""Stands where sensors are compared and no ship is known.

Its length only says what is slow (time windows go by Froude's law); no effect may read it.
"""


def read_ship(path: Path) -> Ship:
    """Read a ship file (TOML).

    Raises
    ------
    ShipError
        The file is missing, not TOML, or lacks something a model cannot do without.
    """
    try:
        text = path.read_text(encoding="utf-8-sig")  # some editors write a byte-order mark
    except OSError as error:
        raise ShipError(f"ship file {path}: cannot be read ({error.strerror})") from error
    except UnicodeDecodeError as error:
        raise ShipError(f"ship file {path}: not UTF-8 text (byte {error.start})") from error
    try:
        table = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise ShipError(f"ship file {path}: not valid TOML: {error}") from error
    _check_keys(path, table)
    _check_sections(path, table)
    return Ship(
        name=table["name"],
        source=table["source"],
        system=table["system"],
        rudder_positive=table["rudder_positive"],
        particulars=_numbers(path, table, "particulars"),
        mass=_numbers(path, table, "mass"),
        coefficients=_numbers(path, table, "coefficients"),
        coefficient_speed=_positive(path, "", table, "coefficient_speed", 1.0),
        notes=table.get("notes", ""),
    )


def _check_keys(path: Path, table: Mapping[str, Any]) -> None:
    for key in table:
        if key not in REQUIRED + OPTIONAL:
            known = nearest(key, REQUIRED + OPTIONAL)
            raise ShipError(f"ship file {path}: unknown key {key!r}; {known}")
    for key in REQUIRED:
        if key not in table:
            raise ShipError(f"ship file {path}: key {key!r} is missing; {_MEANING.get(key, '')}")
    for key, allowed in _CHOICES.items():
        if table[key] not in allowed:
            raise ShipError(f"ship file {path}: {key} = {table[key]!r}; expected one of {allowed}")


def _check_sections(path: Path, table: Mapping[str, Any]) -> None:
    for key in SECTIONS:
        if not isinstance(table.get(key, {}), dict):
            raise ShipError(f"ship file {path}: {key} = {table[key]!r}; expected a [{key}] section")
    missing = [key for key in PARTICULARS if key not in table["particulars"]]
    if missing:
        raise ShipError(f"ship file {path}: [particulars] lacks {', '.join(missing)}")
    for key in (k for k in KNOWN if k in table["particulars"]):
        _positive(path, "[particulars] ", table["particulars"], key, zero=key == "U0")
    for key in table["mass"]:  # one with a slip in its name would silently be zero
        if key not in MASS_PARAMETERS:
            known = nearest(key, MASS_PARAMETERS)
            raise ShipError(f"ship file {path}: [mass] {key} is not a mass parameter; {known}")


def _positive(
    path: Path, where: str, rows: Mapping[str, Any], key: str, default: float = math.nan,
    *, zero: bool = False,
) -> float:  # fmt: skip
    value = rows.get(key, default)
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise ShipError(f"ship file {path}: {where}{key} = {value!r} is not a number")
    if not (0.0 < value < math.inf or (zero and value == 0.0)):
        raise ShipError(f"ship file {path}: {where}{key} = {value!r}; expected a positive number")
    return float(value)


_CHOICES: Final = {"system": ("prime", "dimensional"), "rudder_positive": ("starboard", "port")}

_MEANING: Final = {
    "rudder_positive": "say which way the ship turns for a positive rudder angle in these "
    'coefficients: "starboard" (Ydelta < 0, Ndelta > 0) or "port" (SNAME: Ydelta > 0)',
    "system": 'write "prime" or "dimensional"',
    "source": "say where the numbers come from",
    "mass": "at least m, and I_zz or I_xx of what is simulated",
}


def _numbers(path: Path, table: Mapping[str, Any], section: str) -> dict[str, float]:
    rows = table.get(section, {})
    for key, value in rows.items():
        number = isinstance(value, int | float) and not isinstance(value, bool)
        if not number or not math.isfinite(value):
            raise ShipError(f"ship file {path}: [{section}] {key} = {value!r} is not a number")
    return {key: float(value) for key, value in rows.items()}
