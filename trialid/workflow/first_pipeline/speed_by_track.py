"""A logged speed held against the positions of the same log, and against what ships make."""

import dataclasses
from collections.abc import Sequence
from typing import Final

import numpy as np

from trialid.alignment.track.antenna import speeds_apart
from trialid.inspection.inspected import Inspection
from trialid.inspection.positions import usual_speed
from trialid.inspection.relations import unit_by_way, unit_of_speed
from trialid.inspection.usual_units import to_si
from trialid.names import units
from trialid.workflow.first_pipeline.choice import speeds_of
from trialid.workflow.first_pipeline.chosen import Chosen, Signal

FAST: Final = 0.45
"""Froude number of a ship, over which few go: a ferry of 170 m at 21 knots has 0.26, a destroyer's
32 are 0.42, a fast catamaran's 38 are 0.6. At half of it a ferry is doubted, at twice of it no ship
whose knots are called metres a second."""
OF_SHIPS: Final = 30.0
"""[m] Shorter ones may plane."""


def with_speed_units(surveys: Sequence[Inspection], stated: float | None) -> list[Inspection]:
    """The logs, speeds without a unit in the one of the approach speed that is `stated` [m/s].

    Where nobody states one, or it fits no unit, in the one by which she goes as her positions do.
    """
    return [_sized(survey, stated) for survey in surveys]


def _sized(survey: Inspection, stated: float | None) -> Inspection:
    sailed = usual_speed(survey.channels.values())
    found = dict(survey.channels)
    for one in speeds_of(survey):
        if one.stated_unit is None:
            unit = unit_of_speed(one, stated) if stated else None
            unit = unit or (unit_by_way(one, sailed) if sailed else None)
            found[one.key] = dataclasses.replace(one, unit_by_size=unit)
    for sway in survey.sources("v"):
        ahead = (c for c in survey.sources("u") if c.message == sway.message)
        unit = next((found[c.key].unit_by_size for c in ahead), None)
        if sway.stated_unit is None and unit is not None:  # as the speed ahead beside it
            found[sway.key] = dataclasses.replace(sway, unit_by_size=unit)
    return dataclasses.replace(survey, channels=found)


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
    return dataclasses.replace(speed, further=(*speed.further, *told))


def with_doubtful_speeds(trials: Sequence[Chosen], length: float) -> list[Chosen]:
    """The trials, a speed that few ships of this length [m] have with what it would be in knots."""
    return [
        dataclasses.replace(t, signals=tuple(_doubted(s, t.speed, length) for s in t.signals))
        for t in trials
    ]


def _doubted(signal: Signal, speed: float | None, length: float) -> Signal:
    froude = (speed or 0.0) / float(np.sqrt(9.81 * length))
    if signal.quantity != "u" or length < OF_SHIPS or froude < FAST:
        return signal
    said = (
        f"CAREFUL: {speed:.3g} m/s of {length:.3g} m is a Froude number of {froude:.2f}, a fast "
        f"craft's; as knots it would be {froude * units.factor('kn', 'm/s'):.2f}"
    )
    return dataclasses.replace(signal, further=(*signal.further, said))
