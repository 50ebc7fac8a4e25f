"""One drive that is turned: an outboard, a jet or a pod that pushes and steers at once."""

import dataclasses
from collections.abc import Sequence
from typing import Final

import numpy as np

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

USUAL: Final = (0.05, 0.95)
"""Shares of a log's time between which it is usual: a start from rest and a lost value are not."""

NO_RUDDER: Final = ("delta", "delta_order", "phi", "n", *UNITS)
"""What a model of a rudder reads and that of a push does not."""


def with_turned_drive(trials: Sequence[Chosen], ship: Ship | None) -> list[Chosen]:
    """The trials with what drives her and the angle it is turned to, in the place of a rudder.

    A rudder's force goes with the square of her speed, a push with what drives it. As they are
    where that hardly varies, where some log does not tell her sway, or where by her own file
    another drives her, or it stands ahead, from where it turns her to the other side.
    """
    kind = "azimuth" if ship is None else _lone_kind(ship)
    if kind is None:
        return list(trials)
    found = [_turned(one, kind) for one in trials]
    made = [one for one in found if one is not None]
    return made if len(made) == len(trials) and _varies(made) else list(trials)


def _lone_kind(ship: Ship) -> str | None:
    """What her own file has it as: all that drives her, aft; None where it is not so."""
    drives = [one for one in ship.actuators if one.drive and one.kind != "tunnel"]
    aft = [one.kind for one in drives if one.kind in TURNED and one.x < 0.0]
    return aft[0] if len(drives) == len(aft) == 1 else None


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
        beside=tuple((s, why) for s, why in trial.beside if s.quantity != "n"),
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
    seen = rudder.of_side.rests_on("measured")
    taken = f"taken to turn her to {rudder.positive} where it is positive"
    sense = (CLOCKWISE if clockwise else TO_PORT) if seen else taken
    as_it_is = clockwise is not (kind == "waterjet")
    return dataclasses.replace(
        rudder,
        quantity=f"{DRIVE}{ANGLE}",
        positive=None if as_it_is else "port",
        of_side=Reason(f"{sense} ({rudder.of_side.words})"),
        further=tuple(words for words in rudder.further if words != AS_RUDDER),
    )


def _varies(trials: Sequence[Chosen]) -> bool:
    """Whether what drives her goes up and down, within a log or from one to the next."""
    drives = [s for one in trials for s in one.signals if s.quantity == DRIVE]
    if len({one.unit for one in drives}) > 1:
        return False
    ends = np.concatenate([np.quantile(one.source.sketch.y, USUAL) for one in drives])
    return bool(np.ptp(ends) > VARIES * np.abs(ends).max())
