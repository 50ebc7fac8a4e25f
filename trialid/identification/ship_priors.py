"""What the ship's file knows of parameters that are estimated: its numbers, as sure as it says."""

from collections.abc import Sequence
from dataclasses import replace

from trialid.errors import ShipError
from trialid.ship.model import ShipModel

Known = tuple[float, float]
"""Mean and standard deviation."""


def ship_priors(model: ShipModel, free: Sequence[str]) -> dict[str, Known]:
    """Mean and standard deviation of every free parameter that the file states with its scatter.

    Parameters
    ----------
    model
        Values given by hand are where a search begins, never what is known: the file's count.
    free
        Parameters that are estimated; those the file says nothing of are left alone.

    Returns
    -------
    dict
        In the parameters' own units, and with this project's rudder sign.

    Raises
    ------
    ShipError
        The file states no scatter for any of them, or calls one exact.
    """
    known = known_of_ship(model, free)
    if not known:
        raise ShipError(
            f"ship {model.ship.name!r}: [uncertainty] says nothing of {', '.join(free)}, so priors "
            '= "ship" has nothing to hold them by; write it there (`trialid ship` does), or '
            "leave priors out"
        )
    return known


def known_of_ship(model: ShipModel, free: Sequence[str]) -> dict[str, Known]:
    """As `ship_priors`, of what the file says; that may be nothing.

    Raises
    ------
    ShipError
        The file calls one of them exact.
    """
    plain, known = replace(model, values={}), dict[str, Known]()
    ship = model.ship
    for name in (n for n in free if n in plain.parameters):
        told = plain.parameters[name].corrects or name
        share = ship.uncertainty.get(told, ship.uncertainty.get("default"))
        value = plain.stated(told)
        if share is None or value is None or not (told in ship.mass or told in ship.coefficients):
            continue
        if share == 0.0 and value != 0.0:
            raise ShipError(
                f"ship {ship.name!r}: [uncertainty] {told} = 0 calls it exact, and the pipeline "
                f'estimates {name} with priors = "ship"; take that out of identify.free, or say '
                "how far it may be off"
            )
        if value != 0.0:
            known[name] = value if told == name else 0.0, share * abs(value)
    return known
