"""A logged speed held against the positions of the same log."""

import dataclasses

import numpy as np

from trialid.alignment.track.antenna import speeds_apart
from trialid.inspection.positions import usual_speed
from trialid.inspection.usual_units import to_si
from trialid.workflow.first_pipeline.choice import Chosen, Signal


def held_against_track(trial: Chosen) -> Chosen:
    """The trial, its speed with a warning where its positions are sailed at quite another."""
    sailed = usual_speed(trial.survey.channels.values())
    if sailed is None:
        return trial
    signals = (_warned(one, sailed) if one.quantity == "u" else one for one in trial.signals)
    return dataclasses.replace(trial, signals=tuple(signals))


def _warned(speed: Signal, sailed: float) -> Signal:
    size = to_si(speed.unit or "", "m/s")
    y = speed.source.sketch.y
    usual = float(np.median(np.abs(y))) * size if size is not None and len(y) else 0.0
    if not usual:
        return speed
    ratio = sailed / usual
    told = speeds_apart(ratio, f"CAREFUL: her positions are sailed at {ratio:.2f} times its median")
    return dataclasses.replace(speed, why="; ".join((speed.why, *told)))
