"""A speed over ground has no sign: the course beside it tells where a boat goes astern."""

import dataclasses
from collections.abc import Iterator
from typing import Final

import numpy as np

from trialid.alignment.track.astern import ALONG, astern, moves_along
from trialid.arrays import Mask, Vector
from trialid.inspection.channel_names import is_course
from trialid.inspection.inspected import ChannelInspection
from trialid.inspection.name_words import words
from trialid.inspection.sketch import Sketch, on_one_clock
from trialid.inspection.usual_units import to_si
from trialid.workflow.first_pipeline.chosen import OPEN, Chosen, Signal

TOLD = "CAREFUL: more than 90 deg off the heading"
ACROSS = (
    "FILL IN the unit after settling this: course and heading are so far apart that she is carried "
    "across as much as she goes ahead, or one of them is wrong: a speed over ground is not hers "
    "there. Log sog cos(cog - heading), or take windows in which she goes ahead"
)

FROM_EAST: Final = -1.5708
"""[rad] What turns an angle that counts from the east to port into one from the north."""


Motion = tuple[Vector, Vector, Vector, Mask]
"""Speed, course and heading [rad], and where all are known."""
Timed = tuple[Signal, float, Motion]
"""A course over ground, the period [s] of a clock, and the motion on it."""


def from_east(source: ChannelInspection, positive: str | None) -> bool:
    """Whether an angle is one of the axes of ROS, x to the east and y to the north (REP-103)."""
    of_ros = source.angle in ("yaw", "course") or "orientation" in words(source.name)
    return of_ros and positive == "port"


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
    read, along = _read(trial, speed, heading)
    courses = [course for course, *_ in read]
    if not read or (along is None and _of_her_own_axes(speed.source, courses[0])):
        return trial
    if along is None:
        asked = dataclasses.replace(speed, unit=OPEN, further=(*speed.further, ACROSS))
        return _with(trial, speed, asked)
    course, period, motion = along
    if (back := astern(*motion)) is None:
        return trial
    seconds = float(back.sum()) * period
    why = f"{TOLD} in {seconds:.3g} s: there the run reads u, which has no sign, as astern"
    told = dataclasses.replace(course, further=(why,))
    further = (*speed.further, "negative where cog says astern")
    signed = dataclasses.replace(speed, further=further)
    return _with(trial, speed, signed, told)


def course_along(trial: Chosen, speed: Signal, heading: Signal) -> tuple[Signal, Motion] | None:
    """The course by which she goes ahead or astern of her heading, and how; None where none is.

    Of a trial with a speed over ground.
    """
    along = _read(trial, speed, heading)[1]
    return None if along is None else (along[0], along[2])


def _read(trial: Chosen, speed: Signal, heading: Signal) -> tuple[list[Timed], Timed | None]:
    """Courses on one clock with speed and heading, and the first that she goes along."""
    courses = _courses(trial, speed.source)
    read = [(c, *m) for c in courses if (m := _on_one_clock(speed, c, heading)) is not None]
    return read, next((one for one in read if moves_along(*one[2])), None)


def _with(trial: Chosen, speed: Signal, read: Signal, *more: Signal) -> Chosen:
    signals = (read if one is speed else one for one in trial.signals)
    return dataclasses.replace(trial, signals=(*signals, *more))


def _courses(trial: Chosen, speed: ChannelInspection) -> Iterator[Signal]:
    """The course of the velocity that the speed is of, in either axes; or one by its name."""
    channels = trial.survey.channels
    if speed.angle == "speed":
        x, y = (channels[f"{speed.name}.{axis}"].sketch for axis in "xy")
        seen = Sketch(x.t, np.unwrap(np.arctan2(y.y, x.y)))
        source = dataclasses.replace(speed, angle="course", unit="rad", sketch=seen)
        for positive in ("port", None):  # east and north, or north and east
            yield Signal(
                quantity="cog",
                source=source,
                unit=None,
                positive=positive,
                taken="the direction of that velocity",
            )
        return
    for one in channels.values():
        unit = one.stated_unit
        if not one.constant and is_course(one.name, one.description, unit):
            yield Signal(quantity="cog", source=one, unit=unit or "deg", taken="by its name")
            return


def _of_her_own_axes(speed: ChannelInspection, course: Signal) -> bool:
    """Whether a velocity is ahead and across, whatever she is heading, as odometry has it."""
    along = np.abs(np.cos(course.source.sketch.y))
    return speed.angle == "speed" and float(np.mean(along)) >= ALONG


def _on_one_clock(speed: Signal, course: Signal, heading: Signal) -> tuple[float, Motion] | None:
    """The period [s] and the motion; None where they have too little in common."""
    common = on_one_clock(*(one.source.sketch for one in (speed, course, heading)))
    if common is None:
        return None
    period, (u, chi, psi), whole = common
    return period, (u, angle_of(chi, course), angle_of(psi, heading), whole)


def angle_of(y: Vector, signal: Signal) -> Vector:
    """An angle as a signal is read, clockwise from north [rad]."""
    factor = to_si(signal.unit or signal.source.unit or "rad", "rad") or 1.0
    turned = factor * y + (FROM_EAST if from_east(signal.source, signal.positive) else 0.0)
    return -turned if signal.positive == "port" else turned


def _logs_water(source: ChannelInspection) -> bool:
    """Whether a log in the water tells it, by its name or its format."""
    return source.guess is not None and source.guess.quantity == "u"
