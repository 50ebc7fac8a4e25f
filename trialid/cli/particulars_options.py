"""Particulars of a ship as options: in metres, tonnes and knots, as people have them."""

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import click

if TYPE_CHECKING:
    from trialid.ship.estimate import Given

KNOT: Final = 1852.0 / 3600.0
TONNE: Final = 1000.0


class Particular(NamedTuple):
    """An option: what it is called in Python, its unit, how much of SI one is, its help."""

    name: str
    unit: str
    help: str
    factor: float = 1.0


PARTICULARS: Final = {
    "--length": Particular("length", "METRES", "Length between perpendiculars."),
    "--beam": Particular("beam", "METRES", "Beam."),
    "--draught": Particular("draught", "METRES", "Mean draught."),
    "--block": Particular("block", "NUMBER", "Block coefficient; or --displacement."),
    "--displacement": Particular("displacement", "TONNES", "Displacement.", TONNE),
    "--speed": Particular("speed", "KNOTS", "Approach speed.", KNOT),
    "--gm": Particular("GM", "METRES", "Metacentric height."),
    "--roll-period": Particular("roll_period", "SECONDS", "Period of the natural roll."),
    "--rudder-area": Particular("rudder_area", "SQUARE-METRES", "Area of all rudders together."),
    "--rudder-aspect": Particular("rudder_aspect", "NUMBER", "Height over chord of one rudder."),
    "--propeller": Particular("propeller_diameter", "METRES", "Diameter of the propeller."),
    "--x-g": Particular("x_G", "METRES", "Centre of gravity ahead of midships."),
    "--rho": Particular("rho", "KG/M3", "Density of the water; 1025 if not given."),
}
"""Every particular by its option, in the order people know them."""

Command = Callable[..., None]


def particulars_options(
    *names: str, prefix: str = "", left_out: tuple[str, ...] = ()
) -> Callable[[Command], Command]:
    """Options for particulars, all of them where none is named.

    Parameters
    ----------
    prefix
        Words before each help.
    """

    def of(command: Command) -> Command:
        for option in reversed([n for n in names or tuple(PARTICULARS) if n not in left_out]):
            known = PARTICULARS[option]
            said = f"{prefix}{known.help[:1].lower()}{known.help[1:]}" if prefix else known.help
            add = click.option(option, known.name, type=float, metavar=known.unit, help=said)
            command = add(command)
        return command

    return of


def given_from(values: Mapping[str, Any]) -> "Given":
    """What is known of a ship, SI, from the values of options."""
    from trialid.ship.estimate import Given

    factors = {known.name: known.factor for known in PARTICULARS.values()}
    return Given(**{n: x * factors[n] for n, x in values.items() if x is not None})


def option_names(given: "Given") -> list[str]:
    """Options by which what is known was told; the water apart."""
    from trialid.ship.estimate.particulars_given import known_names

    known = known_names(given)
    return [o for o, p in PARTICULARS.items() if p.name in known and p.name != "rho"]


def water_option(given: "Given") -> list[str]:
    """The water's option, where it was told and is not the sea's."""
    from trialid.ship.estimate.particulars_given import SEA

    return ["--rho"] if given.rho != SEA else []
