"""A ship with a rudder to each side: which channel is which, and the rows of her file."""

import dataclasses
from collections.abc import Sequence
from typing import Final

from trialid.inspection.inspected import ChannelInspection
from trialid.inspection.name_words import sides
from trialid.ship.actuators import Actuator
from trialid.ship.particulars import Ship
from trialid.workflow.first_pipeline.choice import live_sources, rudder_signal
from trialid.workflow.first_pipeline.chosen import Chosen, Signal

RUDDERS: Final = {"n_p": "rudder_port", "n_s": "rudder_starboard"}
"""Signals, by the side as shafts have it."""
INSTANCES: Final = {"instance 0": "n_p", "instance 1": "n_s"}
"""Of NMEA 2000, counted from port as engines are."""
AFT, ASIDE = -0.48, 0.04
"""Where they stand over the ship's length; that of `rudders` alone goes without it."""
UNSEEN: Final = "the motion does not show which is to port, as both turn her alike"


def with_twins(trials: Sequence[Chosen], ship: Ship | None) -> list[Chosen]:
    """The trials with a rudder to each side, where every log has them and her file does not differ.

    Two rudders that stand in no race turn the ship alike, so that their sides are by name, and said
    to be; the way each of them turns her is measured.
    """
    names = RUDDERS if ship is None else _named(ship)
    found = [sides_of(one) for one in trials]
    if names is None or not all(found):
        return list(trials)
    return [_with(one, by_side, names) for one, by_side in zip(trials, found, strict=True)]


def _named(ship: Ship) -> dict[str, str] | None:
    """What her own file calls them; None where it has not one to each side."""
    port = [a.name for a in ship.actuators if a.kind == "rudder" and a.y < 0.0]
    starboard = [a.name for a in ship.actuators if a.kind == "rudder" and a.y > 0.0]
    one_each = len(port) == len(starboard) == 1
    return {"n_p": port[0], "n_s": starboard[0]} if one_each else None


def sides_of(trial: Chosen) -> dict[str, ChannelInspection]:
    """Rudder angles of a log by their side; empty where there is not one to each."""
    sources = live_sources(trial.survey, "delta") if "delta" in trial.quantities else ()
    found = {side: one for one in sources for side in _side(one)}
    return found if len(sources) == len(found) == 2 else {}


def _side(one: ChannelInspection) -> set[str]:
    return sides(one.name) or {
        side for number, side in INSTANCES.items() if number in one.description
    }


def _with(trial: Chosen, by_side: dict[str, ChannelInspection], names: dict[str, str]) -> Chosen:
    rate = next((s for s in trial.signals if s.quantity == "r"), None)
    psi = live_sources(trial.survey, "psi")
    rudders = []
    for side, name in names.items():
        one = by_side[side]
        found = rudder_signal("delta", {"delta": (one,), "psi": psi}, rate)
        told = "by its name" if sides(one.name) else "by its instance, CAREFUL"
        why = f"to {'port' if side == 'n_p' else 'starboard'} {told}: {UNSEEN}"
        rudders.append(dataclasses.replace(found, quantity=name, further=(why,)))
    rest = [s for s in trial.signals if s.quantity != "delta"]
    return dataclasses.replace(trial, signals=(*rudders, *rest))


def has_twins(signals: Sequence[Signal]) -> bool:
    """Whether signals are of a ship with a rudder to each side."""
    return {*RUDDERS.values()} <= {one.quantity for one in signals}


def twin_actuators(ship: Ship) -> tuple[Actuator, ...]:
    """Both rudders, where nobody says where they stand."""
    L = ship.particulars.get("L", 0.0)
    return tuple(
        Actuator(name=name, kind="rudder", x=round(AFT * L, 2), y=round(sign * ASIDE * L, 2))
        for name, sign in zip(RUDDERS.values(), (-1.0, 1.0), strict=True)
    )
