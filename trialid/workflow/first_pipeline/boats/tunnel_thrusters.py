"""Bow and stern thrusters beside what steers a ship, and drives that nothing is made of."""

import dataclasses
import math
from collections.abc import Sequence
from typing import Final

from trialid.inspection.drives import drives_among
from trialid.inspection.inspected import ChannelInspection
from trialid.inspection.name_words import words
from trialid.inspection.relations import Side, side
from trialid.names.quantities import SIGNALS
from trialid.ship.actuators import Actuator
from trialid.ship.particulars import Ship
from trialid.workflow.first_pipeline.boats.actuators_begun import command_of
from trialid.workflow.first_pipeline.boats.unit_of_drive import unit_of_drive
from trialid.workflow.first_pipeline.choice import RUDDERS
from trialid.workflow.first_pipeline.chosen import Chosen, Signal

PLACES: Final = {"bow_thruster": 0.4, "stern_thruster": -0.4}
"""Signals, and how far ahead a tunnel stands over the ship's length: 0.35 to 0.45 of ships and
yachts. Its moment goes with it, and so does the gain, which is written as ASSUMED."""
ENDS: Final = {"bow_thruster": "bow bug", "stern_thruster": "stern heck"}
THRUST: Final = frozenset(words("thr thrust thruster thrusters strahl strahlruder"))
"""Words of a thruster at one end, and that it is one."""
NO_THRUST: Final = frozenset(
    words("temperature temp voltage current oil hours status enable angle")
)

TURNS: Final = ("r", "psi")
"""Of which every steered trial has one, the rate before the heading."""

SOUGHT: Final = "the run seeks what it does"
BY_HAND: Final = "write an [[actuator]] for it in her file, see `trialid guide actuators`"
NOT_HERS: Final = f"her file has no tunnel at that end: {BY_HAND}"
NOT_IN_ALL: Final = f"not every log has it with its unit and moving: where it counts, {BY_HAND}"
NO_SIDE: Final = (
    f"whether it pushes her to starboard where it is positive the motion does not show: {BY_HAND}, "
    "with kind tunnel and direction 90, or -90"
)
UNUSED: Final = f"it seems to drive her, and nothing reads it: {BY_HAND}"


def with_tunnels(trials: Sequence[Chosen], ship: Ship | None) -> list[Chosen]:
    """The trials with their bow and stern thrusters; what drives her and is not read is told.

    With the signal, and a place in the ship's file, the run seeks what one does: the first model is
    without it. Nobody's file states where it pushes when it is positive, so that a new ship has one
    only where the motion shows that.
    """
    told = list(trials)
    for name in PLACES:
        told = _with_one(told, name, ship)
    return [_with_unused(one) for one in told]


def tunnels_of(trials: Sequence[Chosen], ship: Ship) -> tuple[Actuator, ...]:
    """Tunnels of a new ship, for the signals that are there."""
    found = {s.quantity: s for s in trials[0].signals if s.quantity in PLACES}
    return tuple(
        Actuator(
            name=name,
            kind="tunnel",
            x=round(PLACES[name] * ship.particulars.get("L", 0.0), 2),
            y=0.0,
            direction=_pushes_to(trials, name),
            command=command_of(signal.unit or "1"),
        )
        for name, signal in found.items()
    )


def _with_one(trials: Sequence[Chosen], name: str, ship: Ship | None) -> list[Chosen]:
    found = [_source(one, name) for one in trials]
    called = name if ship is None else _hers(ship, name)
    read = [
        one if s is None else dataclasses.replace(one, signals=(*one.signals, s))
        for one, s in zip(trials, found, strict=True)
    ]
    if not called:
        why = NOT_HERS
    elif any(s is None or s.open for s in found):
        why = NOT_IN_ALL
    elif ship is None and not _pushes_to(read, name):
        why = NO_SIDE
    else:
        return [_renamed(one, name, called) for one in read]
    return [
        one if s is None else dataclasses.replace(one, beside=(*one.beside, (s, why)))
        for one, s in zip(trials, found, strict=True)
    ]


def _renamed(trial: Chosen, name: str, called: str) -> Chosen:
    signals = (
        dataclasses.replace(s, quantity=called) if s.quantity == name else s for s in trial.signals
    )
    return dataclasses.replace(trial, signals=tuple(signals))


def _hers(ship: Ship, name: str) -> str:
    """What her own file calls the tunnel at this end; empty where it has not one there."""
    own = [a.name for a in ship.actuators if a.kind == "tunnel" and a.x * PLACES[name] > 0.0]
    return own[0] if len(own) == 1 else ""


def _source(trial: Chosen, name: str) -> Signal | None:
    """The thruster at this end as a signal, where one channel is that."""
    able = [one for one in trial.survey.channels.values() if _is_at(one, name)]
    moves = [one for one in able if one.mostly_there and not one.constant]
    if len(moves) != 1 or moves[0].key in _read(trial):
        return None
    unit, why = unit_of_drive(moves[0])
    return Signal(
        quantity=name,
        source=moves[0],
        unit=unit,
        taken="by its name",
        of_unit=why,
        further=(SOUGHT,),
    )


def _is_at(one: ChannelInspection, name: str) -> bool:
    told = " ".join(words(one.name))
    at_end = any(told.startswith(end) or f" {end}" in told for end in ENDS[name].split())
    is_thruster = THRUST & {*words(one.name)} or "strahl" in told
    return at_end and bool(is_thruster) and not NO_THRUST & {*words(one.name)}


def _pushes_to(trials: Sequence[Chosen], name: str) -> float:
    """Where a positive one pushes her [rad], as all trials have it that show it; 0: none does."""
    shown = set[str]()
    for trial in trials:
        found = _side(trial, name)
        shown |= {found.side} if found else set()
    if len(shown) != 1:
        return 0.0
    ahead = PLACES[name] > 0.0  # aft a push to starboard turns her to port
    return math.radians(90.0 if (shown == {"starboard"}) == ahead else -90.0)


def _side(trial: Chosen, name: str) -> Side | None:
    """To which side a positive one turns her, with what else steers her taken out."""
    ours = next(one for one in trial.signals if one.quantity == name)
    turn = next(one for one in trial.signals if one.quantity in TURNS)
    steers = [
        one.source
        for one in trial.signals
        if one.quantity in RUDDERS or one.quantity not in (*SIGNALS, *PLACES)
    ]
    towards = turn.positive or "starboard" if turn.quantity == "r" else None
    return side(ours.source, turn.source, towards, steers)


def _with_unused(trial: Chosen) -> Chosen:
    """The trial with the drives that nothing reads beside, each under its own name."""
    known = _read(trial)
    left = [
        one
        for one in trial.survey.channels.values()
        if one.name in drives_among(trial.survey) and one.key not in known
    ]
    told = tuple(
        (Signal(quantity="_".join(words(s.name)), source=s, unit=unit_of_drive(s)[0]), UNUSED)
        for s in left
    )
    return dataclasses.replace(trial, beside=(*trial.beside, *told))


def _read(trial: Chosen) -> set[str]:
    """Channels that the pipeline says something of."""
    told = (*trial.signals, *(signal for signal, _ in trial.beside))
    return {one.key for s in told for one in (s.source, *s.others)}
