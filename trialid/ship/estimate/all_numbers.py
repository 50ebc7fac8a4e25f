"""Every number of a ship file from particulars, and how far each may be off."""

import math
from dataclasses import dataclass, replace
from typing import Final

from trialid.errors import ShipError
from trialid.ship.estimate import (
    roll_moments,
    rudder_and_propeller,
    sway_yaw,
)
from trialid.ship.estimate.estimated_number import Estimate, Estimates, joint_share
from trialid.ship.estimate.hull_form import GRAVITY, HullForm, assumptions, complete, typical
from trialid.ship.estimate.impossible import complaints
from trialid.ship.estimate.particulars_given import SEA, Given, told_of
from trialid.ship.particulars import MASS_KEYS, Ship

DIGITS: Final = 4
WEIGHED: Final = 0.02
"""Share by which a stated displacement or block coefficient is off, read from draught marks."""
SOURCES: Final = (
    "Clarke, Gedling & Hine (1983), Kijima et al. (1990), Yoshimura & Masumoto (2012), Fujii & "
    "Tsuda (1961), 2008 IS Code"
)
INERTIAS: Final = {"v": ("m", "Yvdot"), "p": ("I_xx", "Kpdot"), "r": ("I_zz", "Nrdot")}
COUPLINGS: Final = {"p": ("Ypdot", "Kvdot"), "r": ("Yrdot", "Nvdot")}
HOLDS: Final = {"p": 0.5, "r": 0.3}
"""Share of the product of two inertias that the square of their coupling may reach."""
ALONE: Final = "PLACEHOLDER"
"""How the source of a ship begins whose hull is a guess: see `identification.file_of_ship`."""


@dataclass(frozen=True)
class Estimated:
    """A ship made of particulars, with what each number rests on.

    Attributes
    ----------
    assumed
        Typical ratios taken for what is not stated.
    numbers
        Mass parameters and coefficients by name, rounded; shares hold what was assumed too.
    """

    ship: Ship
    given: Given
    form: HullForm
    assumed: tuple[str, ...]
    numbers: Estimates


def estimate(given: Given, name: str = "") -> Estimated:
    """The ship of these particulars.

    Raises
    ------
    ShipError
        All that is missing, impossible or contradictory, in one message.
    """
    if wrong := complaints(given):
        raise ShipError(refusal(wrong))
    taken, form = assumptions(given), complete(given)
    numbers = _rounded(_widened(given, taken, _numbers(form)))
    ship = Ship(
        name=name or f"ship of {form.L:g} m",
        source=_source(given),
        system="prime",
        rudder_positive="starboard",
        particulars=_particulars(form),
        mass={n: e.value for n, e in numbers.items() if n in MASS_KEYS},
        coefficients={n: e.value for n, e in numbers.items() if n not in MASS_KEYS},
        notes=f"Made from {told_of(given)}.",
        uncertainty={n: e.share for n, e in numbers.items()},
    )
    return Estimated(ship, given, form, taken, numbers)


def refusal(wrong: tuple[str, ...]) -> str:
    """Complaints as one sentence, numbered where there are several."""
    if len(wrong) == 1:
        return f"no ship can be made of this: {wrong[0]}"
    listed = "; ".join(f"({i}) {words}" for i, words in enumerate(wrong, 1))
    return f"no ship can be made of this, {len(wrong)} things are wrong: {listed}"


def ship_from_particulars(
    *,
    length: float | None = None,
    beam: float | None = None,
    draught: float | None = None,
    block: float | None = None,
    displacement: float | None = None,
    speed: float | None = None,
    GM: float | None = None,
    roll_period: float | None = None,
    rudder_area: float | None = None,
    rudder_aspect: float | None = None,
    propeller_diameter: float | None = None,
    x_G: float | None = None,
    rho: float = SEA,
    name: str = "",
) -> Ship:
    """A ship by published formulas, from as few or as many particulars as there are.

    Parameters
    ----------
    length, beam, draught
        [m], the length between perpendiculars; it alone is needed.
    block, displacement
        Block coefficient, or mass [kg].
    speed
        Approach speed [m/s].
    GM, roll_period
        Metacentric height [m], and period of the natural roll [s].
    rudder_area, rudder_aspect
        Of all rudders [m^2]; height over chord of one.
    propeller_diameter
        [m]
    x_G
        Centre of gravity ahead of midships [m].
    rho
        Density of the water [kg/m^3].

    Returns
    -------
    Ship
        With the scatter of each number as its `uncertainty`; `trialid ship` writes it as a file.

    Raises
    ------
    ShipError
        All that is missing, impossible or contradictory, in one message.
    """
    given = Given(
        length=length,
        beam=beam,
        draught=draught,
        block=block,
        displacement=displacement,
        speed=speed,
        GM=GM,
        roll_period=roll_period,
        rudder_area=rudder_area,
        rudder_aspect=rudder_aspect,
        propeller_diameter=propeller_diameter,
        x_G=x_G,
        rho=rho,
    )
    return estimate(given, name).ship


def _numbers(form: HullForm) -> Estimates:
    """Everything by formula, with the scatter of the formula alone."""
    masses = sway_yaw.added_mass(form)
    swing = form.m * (0.25**2 + (form.x_G / form.L) ** 2)
    gyration = "0.25 L, 0.22 to 0.24 of published ships"
    rigid = {
        "m": Estimate(form.m, WEIGHED, "displacement over 1/2 rho L^3"),
        "x_G": Estimate(form.x_G / form.L, 0.0, "as stated, or at midships"),
        "I_zz": Estimate(swing, 0.2, f"radius of gyration {gyration}"),
    }
    Xuu = rudder_and_propeller.resistance(form)
    screw = rudder_and_propeller.propeller(form)
    sideways = {
        **sway_yaw.linear(form),
        **sway_yaw.quadratic(form),
        **sway_yaw.cubic(form),
        **sway_yaw.of_heel(form),
    }
    steering = rudder_and_propeller.rudder(form, Xuu, screw)
    return {
        **_invertible({**rigid, **roll_moments.inertia(form, masses["Yvdot"]), **masses}),
        **sideways,
        **roll_moments.moments(form, {**sideways, "Ydelta": steering["Ydelta"]}),
        **roll_moments.restoring_moment(form),
        **roll_moments.damping(form),
        **steering,
        "Xuu": Xuu,
        **sway_yaw.surge(form, masses["Yvdot"]),
        **screw,
    }


def _invertible(masses: Estimates) -> Estimates:
    """Masses with the couplings of sway held within what keeps every acceleration finite.

    Only of hulls as deep as a keel boat's are they that large: their squares take 0.02 and 0.2 of
    the product of the inertias of S-175.
    """
    own = {s: masses[i].value - masses[a].value for s, (i, a) in INERTIAS.items()}
    kept = dict(masses)
    for state, names in COUPLINGS.items():
        most = math.sqrt(HOLDS[state] * own["v"] * own[state])
        for name in names:
            e = masses[name]
            kept[name] = replace(e, value=max(-most, min(most, e.value)))
    return kept


def _widened(given: Given, taken: tuple[str, ...], numbers: Estimates) -> Estimates:
    """The same, each share with what the assumed ratios add to it, to first order."""
    assert given.length is not None
    ratios = typical(given.length)
    adds: dict[str, list[float]] = {n: [] for n in numbers}
    for name in taken:
        step = ratios[name].share
        high, low = (_numbers(complete(given, {name: 1.0 + s})) for s in (step, -step))
        for n, e in numbers.items():
            if e.value:
                adds[n].append((high[n].value - low[n].value) / (2.0 * e.value))
    return {
        n: Estimate(e.value, joint_share(e.share, *adds[n]), e.source) for n, e in numbers.items()
    }


def _rounded(numbers: Estimates) -> Estimates:
    """As the file has them."""
    return {
        n: Estimate(float(f"{e.value:.{DIGITS}g}"), float(f"{e.share:.2g}"), e.source)
        for n, e in numbers.items()
    }


def _particulars(form: HullForm) -> dict[str, float]:
    found = {
        "L": form.L,
        "B": form.B,
        "T": form.T,
        "nabla": form.volume,
        "rho": form.rho,
        "g": GRAVITY,
        "U0": form.U,
    }
    return {n: float(f"{x:.6g}") for n, x in found.items()}


def _source(given: Given) -> str:
    """What the numbers rest on, for reports."""
    if given.beam is None and given.draught is None and given.displacement is None:
        return f"{ALONE}: typical ratios and {SOURCES}; only the length is the ship's own"
    return f"Estimated from her particulars by {SOURCES}; no test of this ship"
