"""Her speed ahead and to starboard by what is recorded over the ground and her heading."""

import dataclasses
from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np

from trialid.alignment.track.astern import moves_along
from trialid.alignment.track.body_velocity import slope, slope_of_positions
from trialid.alignment.track.position import plane
from trialid.arrays import Mask, Vector
from trialid.inspection.inspected import ChannelInspection
from trialid.inspection.positions import positions
from trialid.inspection.sketch import on_one_clock
from trialid.inspection.usual_units import to_si
from trialid.workflow.first_pipeline.choice import Live
from trialid.workflow.first_pipeline.chosen import Chosen, Signal
from trialid.workflow.first_pipeline.further_signals import OUTWARDS
from trialid.workflow.first_pipeline.signed_speed import Motion, angle_of, course_along

MADE: Final = (
    "over the ground: ahead and to starboard of it are u and v, by psi; CAREFUL: where its antenna "
    "stands off midships, [antenna] in her file takes what turning does there off, else it is sway"
)
AHEAD: Final = (
    "over the ground: ahead of it, by psi, is u, for want of a speed; CAREFUL: a current adds to it"
)
UNITS: Final = {"lat": ("deg", "rad"), "lon": ("deg", "rad"), "x": ("m", "m"), "y": ("m", "m")}
"""Unit of a position that states none, and that of what is made of it."""

SHARE: Final = 100
"""Times as long as the slope of a heading is a trial: 1 s of one and a half minutes. Of 60 logs of
three simulated boats half of it and twice tell sway in the same, all of them."""


def with_velocity_over_ground(trial: Chosen, live: Live) -> Chosen:
    """The trial with speed and course, or a position, of which `u` and `v` are made.

    As it is where a sway or a speed through the water is logged, where no heading is, where she
    does not go by it, and where a speed is logged and no sway shows.
    """
    by_name = {one.quantity: one for one in trial.signals}
    heading, speed = by_name.get("psi"), by_name.get("u")
    water = speed is not None and not speed.over_ground
    if heading is None or heading.open or live.get("v") or water:
        return trial
    read = _by_course(trial, speed, heading) if speed is not None else None
    read = read or _by_position(trial, heading, MADE)
    sways = read is not None and _goes_outwards(read[1])
    if read is None or (speed is not None and not sways):
        return trial
    made = frozenset(("u", "v") if sways else ("u",))
    kept = (one for one in trial.signals if one.quantity not in ("u", "cog"))
    return dataclasses.replace(trial, signals=(*kept, *read[0]), made_over_ground=made)


def with_speed_by_position(trials: Sequence[Chosen], stated: float | None) -> list[Chosen]:
    """The trials of a ship with a position of which `u` is made, where nothing tells a speed.

    As they are where one is stated, or any log has one: a speed through the water beside one over
    the ground is two. Her sway is left out of it: far from midships, where an antenna of a ship
    stands, it is another.
    """
    if stated is not None or any("u" in one.quantities for one in trials):
        return list(trials)
    return [_speed_by_position(one) for one in trials]


def _speed_by_position(trial: Chosen) -> Chosen:
    heading = next((one for one in trial.signals if one.quantity == "psi"), None)
    if heading is None or heading.open or "v" in trial.quantities:
        return trial
    if (read := _by_position(trial, heading, AHEAD)) is None:
        return trial
    made = frozenset(("u",))
    return dataclasses.replace(trial, signals=(*trial.signals, *read[0]), made_over_ground=made)


Read = tuple[tuple[Signal, ...], Motion]
"""Signals that tell a velocity, and what they tell."""


def _by_course(trial: Chosen, speed: Signal, heading: Signal) -> Read | None:
    """Speed and course over ground; None where no course is by her heading."""
    found = None if speed.open else course_along(trial, speed, heading)
    if found is None:
        return None
    course, motion = found
    told = dataclasses.replace(course, taken=f"{course.taken}, {MADE}", further=())
    return (dataclasses.replace(speed, quantity="sog", further=()), told), motion


def _by_position(trial: Chosen, heading: Signal, made: str) -> Read | None:
    """A position whose slope is by her heading; None where there is none.

    Of one in a plane it is not known which of its axes is to the north: the one by which she goes.
    """
    found = positions(trial.survey.channels.values())
    names = [*found]
    for order in (names, names[::-1]) if "x" in found else (names,):
        pair = {name: found[other] for name, other in zip(found, order, strict=True)}
        motion = _motion(pair, heading) if pair else None
        if motion is not None and moves_along(*motion):
            by = "by its name" if order is names else "by the heading that she goes by"
            told = f"{by}; its slope is {made}"
            return tuple(_position(name, one, told) for name, one in pair.items()), motion
    return None


def _position(name: str, one: ChannelInspection, told: str) -> Signal:
    unit = one.stated_unit or UNITS[name][0]
    return Signal(quantity=name, source=one, unit=unit, taken=told)


def _motion(pair: Mapping[str, ChannelInspection], heading: Signal) -> Motion | None:
    """What positions tell of a motion; None where they are too coarse, or too little is there."""
    common = on_one_clock(*(one.sketch for one in (*pair.values(), heading.source)))
    if common is None:
        return None
    period, (first, second, psi), whole = common
    fixed = whole & ((first != 0.0) | (second != 0.0))  # 0, 0 is no fix
    if (placed := _in_plane(pair, first, second, fixed)) is None:
        return None
    psi = angle_of(psi, heading)
    made = slope_of_positions(*placed, psi, fixed, period)
    if made is None:
        return None
    return np.hypot(made.north, made.east), np.arctan2(made.east, made.north), psi, made.known


def _in_plane(
    pair: Mapping[str, ChannelInspection], first: Vector, second: Vector, fixed: Mask
) -> tuple[Vector, Vector] | None:
    """Metres to the north and to the east; None where a unit is none of a place."""
    sizes = [to_si(one.stated_unit or UNITS[n][0], UNITS[n][1]) for n, one in pair.items()]
    if sizes[0] is None or sizes[1] is None or not fixed.any():
        return None
    north, east = sizes[0] * first, sizes[1] * second
    return plane(north, east, int(np.argmax(fixed))) if "lat" in pair else (north, east)


def _goes_outwards(motion: Motion) -> bool:
    """Whether a sway shows as one that is logged has to: a hull goes outwards in her turns.

    Beside what a current does, which carries her aside as she heads.
    """
    speed, course, psi, known = motion
    count = max(len(psi) // SHARE, 5) | 1
    if len(psi) <= count or known.sum() < count:
        return False
    turning, sway = slope(psi, count), speed * np.sin(course - psi)
    known = known & (np.convolve(np.ones(len(psi)), np.ones(count), mode="same") > count - 0.5)
    carried = np.column_stack([np.ones(len(psi)), np.cos(psi), np.sin(psi)])[known]
    both = np.column_stack([turning, sway])[known]
    left = both - carried @ np.linalg.lstsq(carried, both)[0]
    if not np.ptp(left, axis=0).all():
        return False
    return float(np.corrcoef(left.T)[0, 1]) <= -OUTWARDS
