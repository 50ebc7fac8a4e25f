"""Ships of which somebody has published coefficients, and what `trialid ship` makes of them."""

import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final

from stated_ships import NAVAL, S175

from trialid.effects import CATALOGUE
from trialid.errors import EffectError
from trialid.names.quantities import MASS_PARAMETERS
from trialid.ship.estimate import Estimated, Given, estimate
from trialid.ship.particulars import Ship, read_ship
from trialid.ship.prime import mass_scale, primed_coefficient

HERE: Final = Path(__file__).parent
SHIPS: Final = HERE.parents[2] / "sample_data" / "ships"

OWN: Final = {
    "S-175": {"Yvvr", "Yrrr", "Yphi", "Nphi", "Kphi", "Np", "tau_P", "x_P", "gamma_R", "l_R"},
    "ONR Tumblehome": {"Yvvr", "Yrrr"},
    "naval vessel": {
        "Yphi",
        "Nphi",
        "Kphi",
        "Yrav",
        "Krav",
        "Kpap",
        "Yphiauv",
        "Yphiaur",
        "Nphiauv",
        "Nphiuar",
    },
}
"""Numbers for which there is no formula, and which are therefore means over these very ships."""


@dataclass(frozen=True, kw_only=True)
class Published:
    """A ship as her source has her, primed, and the estimate from her particulars alone.

    `counted` where the scatter of the formulas was counted on her.
    """

    name: str
    source: str
    counted: bool
    values: Mapping[str, float]
    estimated: Estimated

    def pairs(self) -> Iterator[tuple[str, float, float, float]]:
        """Name, estimate, its scatter as a share, and what is published; where both are known."""
        for name, published in self.values.items():
            found = self.estimated.numbers.get(name)
            if name == "Xvr_whole":
                vr, vrm = (self.estimated.numbers[n] for n in ("Xvr", "Xvrm"))
                value = vr.value + vrm.value
                yield name, value, abs(vr.share * vr.value / value), published
            elif found is not None and found.value != 0.0:
                yield name, found.value, found.share, published

    def is_own(self, name: str) -> bool:
        """Whether the estimate of a number is a mean over this very ship."""
        return name in OWN.get(self.name, ())


def published_ships() -> list[Published]:
    """Those that are shipped, then those of `published_sets.toml`."""
    table = tomllib.loads((HERE / "published_sets.toml").read_text(encoding="utf-8"))
    return [_s175(), _naval(), *(_of_table(row) for row in table.values())]


def _of_table(row: Mapping[str, Any]) -> Published:
    given = Given(**row["given"])
    slim = given.draught / given.length if row.get("by_draught") else 1.0
    return Published(
        name=row["name"],
        source=row["source"],
        counted=row.get("counted", False),
        values={n: x * slim for n, x in row["values"].items()},
        estimated=estimate(given, row["name"]),
    )


def _s175() -> Published:
    """Hull and masses of S-175; the rudder and the modulus terms of S175Q, derived from her."""
    ship, derived = (read_ship(SHIPS / f"{n}.toml") for n in ("s175", "s175q"))
    values = {**primed(derived), **primed(ship)}
    return _whole("S-175", ship.source, values, S175)


def _naval() -> Published:
    """Moments about the centre of gravity, which lies 1.06 m above the origin of the source.

    The rudder of the shipped file is this project's own guess, and left out.
    """
    ship = read_ship(SHIPS / "naval.toml")
    values = primed(ship)
    up = values["z_G"]
    for name in [n for n in values if n.startswith("K") and "Y" + n[1:] in values]:
        values[name] += up * values["Y" + name[1:]]
    values["Ypdot"] = values["Kvdot"]
    L, rho, U = (ship.particulars[n] for n in ("L", "rho", "U0"))
    values["Kp"] += values.pop("Kp0") / (0.5 * rho * L**4 * U)  # all of it, under way
    for name in ("Ydelta", "Ndelta", "Kdelta", "z_G", "I_xx", "Kpdot"):
        del values[name]
    given = replace(NAVAL, rudder_area=3.0, rudder_aspect=1.5, propeller_diameter=1.6, x_G=-3.38)
    return _whole("naval vessel", ship.source, values, given)


def _whole(name: str, source: str, values: dict[str, float], given: Given) -> Published:
    values = {n: x for n, x in values.items() if x != 0.0}
    values["Yr"] = values["Yr"] + values.pop("Yurm", 0.0)
    values["Kr"] = values["Kr"] + values.pop("Kurm", 0.0)
    values["Xvr_whole"] = values.pop("Xvr") + values.pop("Xvrm", 0.0)
    given_there = {"m", "x_G", "GM", "A_R", "Lambda_R", "D_P"}
    values = {n: x for n, x in values.items() if n not in given_there}
    return Published(
        name=name, source=source, counted=True, values=values, estimated=estimate(given, name)
    )


def primed(ship: Ship) -> dict[str, float]:
    """Masses and coefficients in the prime system; those with a unit in theirs."""
    L, rho = ship.particulars["L"], ship.particulars["rho"]
    over = (lambda n: mass_scale(n, L, rho)) if ship.system == "dimensional" else (lambda n: 1.0)
    found = {n: x / over(n) for n, x in ship.mass.items() if n in MASS_PARAMETERS}
    for name in ship.coefficients:
        effect = next((e for e in CATALOGUE.values() if name in e.parameters), None)
        if effect is None:
            raise EffectError(f"no effect has {name!r}")
        found[name] = primed_coefficient(ship, effect, name)
    return found
