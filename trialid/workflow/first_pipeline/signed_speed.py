"""A speed over ground has no sign: the course beside it tells where a boat goes astern."""

import dataclasses

import numpy as np

from trialid.alignment.track.astern import astern
from trialid.arrays import Vector
from trialid.inspection.channel_names import is_course
from trialid.inspection.inspected import ChannelInspection
from trialid.inspection.sketch import Sketch, on_one_clock
from trialid.inspection.usual_units import to_si
from trialid.workflow.first_pipeline.choice import Chosen, Signal

TOLD = "CAREFUL: more than 90 deg off the heading"


def with_course(trial: Chosen) -> Chosen:
    """The trial with the course over ground where the boat goes astern; the run signs u by it.

    Without a heading in it nothing tells, and nothing is read; nor of a speed through the water.
    """
    by_name = {one.quantity: one for one in trial.signals}
    speed, heading = by_name.get("u"), by_name.get("psi")
    if speed is None or heading is None or _logs_water(speed.source):
        return trial
    course = _course(trial, speed.source, heading)
    seconds = _astern(speed, course, heading) if course else 0.0
    if course is None or not seconds:
        return trial
    why = f"{TOLD} in {seconds:.3g} s: there the run reads u, which has no sign, as astern"
    told = dataclasses.replace(course, why=f"{course.why}; {why}")
    signed = dataclasses.replace(speed, why=f"{speed.why}; negative where cog says astern")
    signals = (signed if one is speed else one for one in trial.signals)
    return dataclasses.replace(trial, signals=(*signals, told))


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


def _astern(speed: Signal, course: Signal, heading: Signal) -> float:
    """How long she goes astern [s]."""
    sketches = [one.source.sketch for one in (speed, course, heading)]
    common = on_one_clock(*sketches)
    if common is None:
        return 0.0
    period, (u, *angles), whole = common
    chi, psi = (_angle(y, one) for y, one in zip(angles, (course, heading), strict=True))
    back = astern(u, chi, psi, whole)
    return 0.0 if back is None else float(back.sum()) * period


def _angle(y: Vector, signal: Signal) -> Vector:
    """Clockwise, in rad."""
    factor = to_si(signal.unit or signal.source.unit or "rad", "rad") or 1.0
    return -factor * y if signal.positive == "port" else factor * y


def _logs_water(source: ChannelInspection) -> bool:
    """Whether a log in the water tells it, by its name or its format."""
    return source.guess is not None and source.guess.quantity == "u"
