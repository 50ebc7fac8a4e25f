"""A speed over ground has no sign: the course beside it tells where a boat goes astern."""

import dataclasses

import numpy as np

from trialid.alignment.track.astern import astern, moves_along
from trialid.arrays import Mask, Vector
from trialid.inspection.channel_names import is_course
from trialid.inspection.inspected import ChannelInspection
from trialid.inspection.sketch import Sketch, on_one_clock
from trialid.inspection.usual_units import to_si
from trialid.workflow.first_pipeline.choice import OPEN, Chosen, Signal

TOLD = "CAREFUL: more than 90 deg off the heading"
ACROSS = (
    "FILL IN the unit after settling this: course and heading are so far apart that she is carried "
    "across as much as she goes ahead, or one of them is wrong: a speed over ground is not hers "
    "there. Log sog cos(cog - heading), or take windows in which she goes ahead"
)


def with_course(trial: Chosen) -> Chosen:
    """The trial with the course over ground where the boat goes astern; the run signs u by it.

    Without a heading in it nothing tells, and nothing is read; nor of a speed through the water. Of
    a boat that holds her place against wind and current the speed over ground is no speed ahead: in
    a model of one a dead band of 38 % of full had a name that she did not have.
    """
    by_name = {one.quantity: one for one in trial.signals}
    speed, heading = by_name.get("u"), by_name.get("psi")
    if speed is None or heading is None or _logs_water(speed.source):
        return trial
    course = _course(trial, speed.source, heading)
    common = _on_one_clock(speed, course, heading) if course else None
    if course is None or common is None:
        return trial
    period, motion = common
    if not moves_along(*motion):
        asked = dataclasses.replace(speed, unit=OPEN, why=f"{speed.why}; {ACROSS}")
        return _with(trial, speed, asked)
    if (back := astern(*motion)) is None:
        return trial
    seconds = float(back.sum()) * period
    why = f"{TOLD} in {seconds:.3g} s: there the run reads u, which has no sign, as astern"
    told = dataclasses.replace(course, why=f"{course.why}; {why}")
    signed = dataclasses.replace(speed, why=f"{speed.why}; negative where cog says astern")
    return _with(trial, speed, signed, told)


def _with(trial: Chosen, speed: Signal, read: Signal, *more: Signal) -> Chosen:
    signals = (read if one is speed else one for one in trial.signals)
    return dataclasses.replace(trial, signals=(*signals, *more))


def _course(trial: Chosen, speed: ChannelInspection, heading: Signal) -> Signal | None:
    """The course of the velocity that the speed is of, counted as the heading; or by its name."""
    channels = trial.survey.channels
    if speed.angle == "speed":
        x, y = (channels[f"{speed.name}.{axis}"].sketch for axis in "xy")
        seen = Sketch(x.t, np.unwrap(np.arctan2(y.y, x.y)))
        source = dataclasses.replace(speed, angle="course", unit="rad", sketch=seen)
        return Signal("cog", source, None, heading.positive, "the direction of that velocity", ())
    for one in channels.values():
        unit = one.unit or one.unit_in_name
        if not one.constant and is_course(one.name, one.description, unit):
            return Signal("cog", one, unit or "deg", None, "by its name", ())
    return None


Motion = tuple[Vector, Vector, Vector, Mask]
"""Speed, course and heading [rad], and where all are known."""


def _on_one_clock(speed: Signal, course: Signal, heading: Signal) -> tuple[float, Motion] | None:
    """The period [s] and the motion; None where they have too little in common."""
    common = on_one_clock(*(one.source.sketch for one in (speed, course, heading)))
    if common is None:
        return None
    period, (u, chi, psi), whole = common
    return period, (u, _angle(chi, course), _angle(psi, heading), whole)


def _angle(y: Vector, signal: Signal) -> Vector:
    """Clockwise, in rad."""
    factor = to_si(signal.unit or signal.source.unit or "rad", "rad") or 1.0
    return -factor * y if signal.positive == "port" else factor * y


def _logs_water(source: ChannelInspection) -> bool:
    """Whether a log in the water tells it, by its name or its format."""
    return source.guess is not None and source.guess.quantity == "u"
