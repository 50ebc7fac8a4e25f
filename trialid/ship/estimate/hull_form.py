"""A hull in full: what is not stated by typical ratios, each with how far ships differ."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final, NamedTuple

from trialid.ship.estimate.hydrostatics import metacentre, metacentric_radius
from trialid.ship.estimate.particulars_given import Given

GRAVITY: Final = 9.81
FLEETS: Final = "Watson & Gilfillan (1977), merchant ships"


class Ratio(NamedTuple):
    """A ratio that ships have alike.

    What it is in words, its value (zero where it is by formula), the standard deviation over ships
    as a share of it, and the source.
    """

    what: str
    value: float
    share: float
    source: str


def length_over_beam(length: float) -> float:
    """L/B of merchant ships (Watson & Gilfillan 1977): 4 up to 30 m, 6.5 from 130 m on.

    >>> [length_over_beam(L) for L in (20.0, 90.0, 300.0)]
    [4.0, 5.5, 6.5]
    """
    return 4.0 + 0.025 * (min(max(length, 30.0), 130.0) - 30.0)


CODE_FROM: Final = 24.0
MODEL_OF: Final = 100.0
"""[m] The code's ships are 24 m and longer. What is shorter is a boat, 11 % above the coefficient
of a ship of 100 m, or the model of a ship, which of 20 to 200 m is 9 % above to 11 % below."""


def typical(length: float) -> dict[str, Ratio]:
    """Ratios of a ship of which nothing but the length [m] is known."""
    least = "DNV's least, 0.01 (1 + 25 (B/L)^2) L T"
    return {
        "L/B": Ratio("length over beam", length_over_beam(length), 0.15, FLEETS),
        "B/T": Ratio("beam over draught", 2.8, 0.2, "2.2 to 3.8, Parsons (2003)"),
        "C_B": Ratio("block coefficient", 0.65, 0.2, "0.5 to 0.85 of merchant ships"),
        "Fn": Ratio("Froude number", 0.2, 0.3, "0.15 to 0.28 of merchant ships"),
        "GM/B": Ratio("GM over beam", 0.05, 0.7, "0.01 to 0.13 of published ships"),
        "A_R/LT": Ratio("rudder area", 0.0, 0.35, least),
        "aspect": Ratio("rudder aspect ratio", 1.6, 0.25, "1.2 to 2 of published ships"),
        "D/T": Ratio("propeller over draught", 0.6, 0.3, "0.4 to 0.8 of published ships"),
        "k/CB": _roll_period(length),
    }


def _roll_period(length: float) -> Ratio:
    """How far the code's roll period is off; what is too short for it may be a boat or a model."""
    boat = length < CODE_FROM
    words = "2008 IS Code, 2.3.4" + (f", for {CODE_FROM:g} m and more" if boat else "")
    return Ratio("roll period, by a factor", 1.0, 0.16 if boat else 0.12, words)


@dataclass(frozen=True, kw_only=True)
class HullForm:
    """Dimensions that all estimates are made of, SI.

    Attributes
    ----------
    roll_radius
        Radius of gyration in roll, of ship and water together [m].
    propeller
        Diameter [m].
    """

    L: float
    B: float
    T: float
    block: float
    rho: float
    U: float
    x_G: float
    GM: float
    roll_radius: float
    rudder_area: float
    rudder_aspect: float
    propeller: float

    @property
    def volume(self) -> float:
        """Displaced volume [m^3]."""
        return self.block * self.L * self.B * self.T

    @property
    def m(self) -> float:
        """Mass over 1/2 rho L^3."""
        return 2.0 * self.volume / self.L**3

    @property
    def froude(self) -> float:
        """Froude number."""
        return self.U / math.sqrt(GRAVITY * self.L)

    @property
    def gravity_height(self) -> float:
        """Centre of gravity above the waterline [m]; negative below."""
        return metacentre(self.B, self.T, self.block) - self.GM - self.T

    @property
    def metacentric_radius(self) -> float:
        """BM [m]."""
        return metacentric_radius(self.B, self.T, self.block)


def complete(given: Given, factors: Mapping[str, float] = MappingProxyType({})) -> HullForm:
    """The hull of what is stated, the rest by typical ratios, each times its factor.

    Parameters
    ----------
    given
        Without contradictions, and with the length.
    """
    assert given.length is not None
    L = given.length
    ratio = {n: r.value * factors.get(n, 1.0) for n, r in typical(L).items()}
    B, T, block = _box(given, L, ratio)
    C = 0.373 + 0.023 * B / T - 0.043 * (L if L >= CODE_FROM else MODEL_OF) / 100.0
    U = given.speed or ratio["Fn"] * math.sqrt(GRAVITY * L)
    radius, GM = _roll(given, C * B * ratio["k/CB"], ratio["GM/B"] * B)
    least = 0.01 * (1.0 + 25.0 * (B / L) ** 2) * L * T * factors.get("A_R/LT", 1.0)
    return HullForm(
        L=L,
        B=B,
        T=T,
        block=block,
        rho=given.rho,
        U=U,
        x_G=given.x_G or 0.0,
        GM=GM,
        roll_radius=radius,
        rudder_area=given.rudder_area or least,
        rudder_aspect=given.rudder_aspect or ratio["aspect"],
        propeller=given.propeller_diameter or ratio["D/T"] * T,
    )


def _box(given: Given, L: float, ratio: Mapping[str, float]) -> tuple[float, float, float]:
    """Beam, draught and block coefficient; a displacement stands for the one that is missing."""
    B, T, block = given.beam, given.draught, given.block
    if given.displacement is None:
        B = B or (T * ratio["B/T"] if T else L / ratio["L/B"])
        return B, T or B / ratio["B/T"], block or ratio["C_B"]
    volume = given.displacement / given.rho
    if B and T:
        return B, T, volume / (L * B * T)
    block = block or ratio["C_B"]
    area = volume / (block * L)
    B = B or (area / T if T else math.sqrt(area * ratio["B/T"]))
    return B, T or area / B, block


def _roll(given: Given, radius: float, GM: float) -> tuple[float, float]:
    """Radius of gyration and GM; a stated roll period gives the one that is not stated."""
    if given.roll_period is None:
        return radius, given.GM or GM
    slow = given.roll_period / (2.0 * math.pi)
    if given.GM is not None:
        return slow * math.sqrt(GRAVITY * given.GM), given.GM
    return radius, (radius / slow) ** 2 / GRAVITY


def assumptions(given: Given) -> tuple[str, ...]:
    """Ratios that had to be taken for what is not stated."""
    volume = given.displacement is not None
    box = (given.beam, given.draught)
    both, none = None not in box, given.beam is None and given.draught is None
    needs = {
        "L/B": given.beam is None and given.draught is None and not volume,
        "B/T": none if volume else not both,
        "C_B": given.block is None and not (volume and both),
        "Fn": given.speed is None,
        "GM/B": given.GM is None and given.roll_period is None,
        "A_R/LT": given.rudder_area is None,
        "aspect": given.rudder_aspect is None,
        "D/T": given.propeller_diameter is None,
        "k/CB": given.roll_period is None or given.GM is None,
    }
    return tuple(name for name, needed in needs.items() if needed)
