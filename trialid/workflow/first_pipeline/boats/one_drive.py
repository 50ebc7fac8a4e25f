"""One drive that is turned: an outboard, a jet or a pod that pushes and steers at once."""

import dataclasses
from collections.abc import Sequence
from typing import Final

from trialid.inspection import name_words
from trialid.inspection.drives import lone_drive
from trialid.ship.particulars import Ship
from trialid.workflow.first_pipeline.boats.over_ground import UNITS, with_velocity_over_ground
from trialid.workflow.first_pipeline.boats.turned_drives import ANGLE, CLOCKWISE, TO_PORT
from trialid.workflow.first_pipeline.boats.unit_of_drive import unit_of_drive
from trialid.workflow.first_pipeline.choice import AS_RUDDER, PUSHES, live_sources
from trialid.workflow.first_pipeline.chosen import OPEN, Chosen, Reason, Signal

DRIVE: Final = "drive"
"""What she is driven by, where her own file has no name for it."""
TURNED: Final = ("azimuth", "waterjet")
"""Kinds of what pushes to where it is turned; the angle of the second counts as a rudder's does."""
HUNG: Final = -0.5
"""How far ahead it stands, over the length of a boat: at her transom. A pod may stand a tenth
further ahead, and the inertia in yaw that is found goes with it."""

VARIES: Final = 0.2
"""Share of the most that drives her by which that has to vary within the logs. Held, it turns her
as a rudder does, and what it does in surge shows nowhere else: of a simulated outboard's zig-zags
at one throttle 9.5 % of the rate was left to a rudder, and 13.8 % to it; of a pod that is turned
down by 0.45 of its most 10.7 % of the heading was, and 4.7. Half and twice of it choose the same.
"""

NO_RUDDER: Final = ("delta", "delta_order", "phi", "n", *UNITS)
"""What a model of a rudder reads and that of a push does not."""


def with_turned_drive(trials: Sequence[Chosen], ship: Ship | None) -> list[Chosen]:
    """The trials with what drives her and the angle it is turned to, in the place of a rudder.

    A rudder's force goes with the square of her speed, a push with what drives it. As they are
    where that hardly varies, where some log does not tell her sway, or where her own file has not
    one actuator that is turned.
    """
    hers = [a.kind for a in ship.actuators if a.kind in TURNED] if ship else ["azimuth"]
    if len(hers) != 1:
        return list(trials)
    found = [_turned(one, hers[0]) for one in trials]
    made = [one for one in found if one is not None]
    return made if len(made) == len(trials) and _varies(made) else list(trials)


def _turned(trial: Chosen, kind: str) -> Chosen | None:
    """The trial of a boat; None where it is one of a rudder."""
    angle = next((s for s in trial.signals if s.quantity == "delta"), None)
    source = lone_drive(trial.survey)
    if angle is None or angle.open or source is None:
        return None
    unit, of_unit = unit_of_drive(source)
    if unit == OPEN or not PUSHES & {*name_words.words(angle.source.name)}:
        return None
    drive = Signal(quantity=DRIVE, source=source, unit=unit, taken="by its name", of_unit=of_unit)
    rest = (s for s in trial.signals if s.quantity not in NO_RUDDER)
    boat = dataclasses.replace(
        trial,
        signals=(_as_angle(angle, kind), drive, *rest),
        beside=tuple((s, why) for s, why in trial.beside if s.quantity not in NO_RUDDER),
        made_over_ground=frozenset(),
    )
    live = {name: live_sources(trial.survey, name) for name in ("u", "v")}
    boat = with_velocity_over_ground(boat, live)
    return boat if boat.quantities >= {"u", "v"} else None


def _as_angle(rudder: Signal, kind: str) -> Signal:
    """What was read as a rudder as the angle to which it pushes, clockwise; a jet's is a rudder's.

    It stands aft: where it pushes to starboard her stern goes there, and she turns to port.
    """
    clockwise = rudder.positive == "port"
    as_it_is = clockwise is not (kind == "waterjet")
    return dataclasses.replace(
        rudder,
        quantity=f"{DRIVE}{ANGLE}",
        positive=None if as_it_is else "port",
        of_side=Reason(f"{CLOCKWISE if clockwise else TO_PORT} ({rudder.of_side.words})"),
        further=tuple(words for words in rudder.further if words != AS_RUDDER),
    )


def _varies(trials: Sequence[Chosen]) -> bool:
    """Whether what drives her goes up and down, within a log or from one to the next."""
    sources = [s.source for one in trials for s in one.signals if s.quantity == DRIVE]
    low, high = min(one.low for one in sources), max(one.high for one in sources)
    return high - low > VARIES * max(abs(low), abs(high))
