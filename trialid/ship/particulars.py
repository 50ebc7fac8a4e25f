"""A ship: its particulars, masses and hydrodynamic coefficients, as its source publishes them."""

import math
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final, Literal

from trialid import user_files
from trialid.errors import ShipError, nearest
from trialid.names.quantities import MASS_PARAMETERS
from trialid.names.quantities import PARTICULARS as KNOWN
from trialid.ship.actuators import Actuator, actuators_of

REQUIRED: Final = ("name", "source", "system", "rudder_positive", "particulars", "mass")
OPTIONAL: Final = (
    "coefficients",
    "coefficient_speed",
    "uncertainty",
    "antenna",
    "actuator",
    "notes",
)
PARTICULARS: Final = ("L", "rho", "g", "nabla", "U0")
"""Those no model can do without; T and B are for the effects that ask for them."""
SECTIONS: Final = ("particulars", "mass", "coefficients", "uncertainty", "antenna")
ARM: Final = ("x", "y", "z")

UNCERTAIN: Final = 0.05
"""Standard deviation of a number of `[mass]` or `[coefficients]`, as a share of it, where the file
says none. With held coefficients up to 15 % off, drawn evenly, ranges of the others hold 98 % of
the truths in sensor noise and 95 % with gusts on the hull; at half of it 93 and 92, at twice 100
and 98, and half as wide again."""

MOST_UNCERTAIN: Final = 3.0
"""Of a number of which hardly the sign is known; a larger share is per cent, written by mistake."""

KEYS: Final = {
    "name": "What reports call the ship.",
    "source": "Where the numbers come from.",
    "system": 'How the numbers are written: `"prime"`, forces over 1/2 rho L^2 U^2, or '
    '`"dimensional"`, SI.',
    "rudder_positive": "The side the ship turns to for a positive rudder angle in these "
    'coefficients: `"starboard"` (Ydelta < 0, Ndelta > 0) or `"port"` (SNAME: Ydelta > 0).',
    "particulars": "Dimensions, water and approach speed, SI.",
    "mass": "Mass, its place and inertia, and added masses, in the system of the file: `m` where "
    "u or v is simulated, `I_xx` for p, `I_zz` for r; the others are zero where not given.",
    "coefficients": "Values of the effects' parameters, by their names, in the system of the "
    "file; one that is not given has to be free, or given in the pipeline's `[model.values]`.",
    "coefficient_speed": "Speed at which dimensional coefficients hold [m/s]; 1 where the source "
    "writes the speed into the term, as `Y_|u|v |u| v`.",
    "uncertainty": "How far numbers of `[mass]` and `[coefficients]` may be off, by name: a "
    "standard deviation as a share of the number, zero for one that is exact; `default` for all "
    f"others, {UNCERTAIN:g} where not given. It widens the likely ranges of what is fitted, and "
    'with `priors = "ship"` in a pipeline it holds what is fitted about these numbers.',
    "antenna": "Where the antenna of positions, `sog` and `cog` stands, from the origin [m]: `x` "
    "ahead, `y` to starboard, `z` below (above: negative); zero where not given.",
    "actuator": "A table `[[actuator]]` for each rudder, thruster, pod, tunnel and jet, where "
    "there is more than one rudder; see the guide's page of actuators.",
    "notes": "Anything a reader should know of it.",
}
"""What each key of a ship file means; the guide's page of keys is made of it."""

MASS_KEYS: Final = {
    "m": "mass",
    "x_G": "centre of gravity ahead of the origin",
    "z_G": "centre of gravity below the origin",
    "I_xx": "moment of inertia in roll",
    "I_zz": "moment of inertia in yaw",
    "Xudot": "added mass in surge, negative: the force of an acceleration is Xudot du/dt",
    "Yvdot": "added mass in sway",
    "Ypdot": "sway force of a roll acceleration",
    "Yrdot": "sway force of a yaw acceleration",
    "Kvdot": "roll moment of a sway acceleration",
    "Kpdot": "added inertia in roll",
    "Krdot": "roll moment of a yaw acceleration",
    "Nvdot": "yaw moment of a sway acceleration",
    "Npdot": "yaw moment of a roll acceleration",
    "Nrdot": "added inertia in yaw",
}
"""What each number of `[mass]` is."""


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
    uncertainty
        Standard deviations as shares of the numbers, by name, `default` for all others.
    antenna
        Place of the receiver of positions [m]: `x` ahead, `y` to starboard, `z` below the origin.
    actuators
        What drives and steers her, where it is more than one rudder.
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
    uncertainty: Mapping[str, float] = field(default_factory=dict)
    antenna: Mapping[str, float] = field(default_factory=dict)
    actuators: tuple[Actuator, ...] = ()

    def share_off(self, name: str) -> float:
        """Standard deviation of a mass or coefficient, as a share of it."""
        return self.uncertainty.get(name, self.uncertainty.get("default", UNCERTAIN))


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


def read_ship(path: str | Path) -> Ship:
    """Read a ship file (TOML).

    Raises
    ------
    ShipError
        The file is missing, not TOML, or lacks something a model cannot do without.
    """
    path = user_files.path_of(path, "ti.read_ship")
    try:
        text = user_files.text(path)
    except OSError as error:
        raise ShipError(f"ship file {path}: cannot be read ({error.strerror})") from error
    except UnicodeDecodeError as error:
        raise ShipError(f"ship file {path}: not UTF-8 text (byte {error.start})") from error
    try:
        table = user_files.toml(text)
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
        uncertainty=_shares(path, table),
        antenna=_arm(path, table),
        actuators=actuators_of(table, f"ship file {path}"),
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
    _check_volume(path, table)
    for key in table["mass"]:  # one with a slip in its name would silently be zero
        if key not in MASS_PARAMETERS:
            known = nearest(key, MASS_PARAMETERS)
            raise ShipError(f"ship file {path}: [mass] {key} is not a mass parameter; {known}")


def _check_volume(path: Path, table: Mapping[str, Any]) -> None:
    """Refuse a hull that its box does not hold, or that is no mass of it: a number is no SI."""
    known: dict[str, float] = {
        key: float(x)
        for key, x in {**table["mass"], **table["particulars"]}.items()
        if isinstance(x, int | float) and not isinstance(x, bool)
    }
    L, nabla, m = known["L"], known["nabla"], known.get("m", 0.0)
    box = L * known.get("B", math.inf) * known.get("T", math.inf)
    if nabla > FULLEST * box > 0.0:
        raise ShipError(
            f"ship file {path}: [particulars] nabla = {nabla:g} m3 is more than L B T = {box:g} "
            "m3, and no hull is fuller than its box; check their units [m, m3]"
        )
    floats = 2.0 * nabla / L / L / L if table["system"] == "prime" else known["rho"] * nabla
    if m > 0.0 and not floats / AFLOAT < m < AFLOAT * floats:
        raise ShipError(
            f"ship file {path}: [mass] m = {m:g}, and she floats at {floats:.4g} by nabla and L; "
            "check their units, and the system of the file"
        )


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


def _shares(path: Path, table: Mapping[str, Any]) -> dict[str, float]:
    """Standard deviations by the names that the file gives numbers for."""
    known = ("default", *table["mass"], *table.get("coefficients", {}))
    shares = _numbers(path, table, "uncertainty")
    for key, share in shares.items():
        if key not in known:
            nearby = nearest(key, known)
            raise ShipError(f"ship file {path}: [uncertainty] {key} is no number of it; {nearby}")
        if not 0.0 <= share <= MOST_UNCERTAIN:
            raise ShipError(
                f"ship file {path}: [uncertainty] {key} = {share:g}; expected a share of the "
                f"number from 0 to {MOST_UNCERTAIN:g}"
            )
    return shares


def _arm(path: Path, table: Mapping[str, Any]) -> dict[str, float]:
    for key in table.get("antenna", {}):
        if key not in ARM:
            raise ShipError(f"ship file {path}: [antenna] {key} is not known; write x, y and z")
    return _numbers(path, table, "antenna")


FULLEST: Final = 1.05
"""Block coefficient that no hull has: a barge has 1, by a length that may be a little less than it
is under water. By a tenth of their lengths a container ship and a tanker have 6 and 8. Half of it
refuses the one as she is, twice says the same."""

AFLOAT: Final = 2.0
"""Factor by which a mass is none of what floats at this volume: files round, and count water that
goes along. A length in feet makes 35 of it. Half as far beyond 1 and twice refuse none of the
project's own files, whose masses are 1.00 of it."""

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
