"""A logged speed held against the positions of the same log, and against what ships make."""

import dataclasses
from collections.abc import Sequence
from typing import Final

import numpy as np

from trialid.alignment.track.antenna import speeds_apart
from trialid.inspection.inspected import Inspection
from trialid.inspection.log_factor import log_factor
from trialid.inspection.name_words import is_through_water
from trialid.inspection.positions import usual_speed
from trialid.inspection.relations import unit_by_way, unit_of_speed
from trialid.inspection.sketch import Sketch
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
OFF: Final = 0.05
"""How far a speed log may be off before a word is said of it: of 34 logs that tell, and are right,
none is off by more than 0.011. Half and twice of it tell the same of them, and of one made to read
12 % high."""
SURE: Final = 3.0
"""Standard deviations by which it has to be off."""


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
    """The trial, its speed with a warning where its positions are sailed at quite another.

    Where she turns far enough the two are held against each other closely.
    """
    sailed = usual_speed(trial.survey.channels.values())
    if sailed is None:
        return trial
    psi = next((one for one in trial.signals if one.quantity == "psi"), None)
    signals = (
        _warned(one, sailed, psi, trial.survey) if one.quantity == "u" else one
        for one in trial.signals
    )
    return dataclasses.replace(trial, signals=tuple(signals))


def _warned(speed: Signal, sailed: float, psi: Signal | None, survey: Inspection) -> Signal:
    """The speed, with what its median says, or where that is about right what her turns say."""
    told = _by_median(speed, sailed) or _by_turns(speed, psi, survey)
    return dataclasses.replace(speed, further=(*speed.further, *told))


def _by_turns(speed: Signal, psi: Signal | None, survey: Inspection) -> tuple[str, ...]:
    """The factor that her positions say is on a speed log, where she turns and it is one.

    Of one through the water by its name: over the ground a current is in the log and in the ways.
    """
    if speed.others or not is_through_water(speed.source.name):
        return ()
    of_speed, of_heading = _in_si(speed, "m/s"), _in_si(psi, "rad") if psi else None
    if of_speed is None or of_heading is None:
        return ()
    found = log_factor(survey.channels.values(), of_speed, of_heading)
    if found is None or abs(found.value - 1.0) < max(OFF, SURE * found.sigma):
        return ()
    return (
        f"CAREFUL: by her positions she goes {found.value:.3f} +-{found.sigma:.3f} times as fast, "
        f"a current taken out while she turns by {np.degrees(found.turned):.0f} deg; where the "
        f"speed log is off, gain = {found.value:.3f} mends it, in each trial that it is in",
    )


def _in_si(signal: Signal, unit: str) -> Sketch | None:
    """What a signal reads, in our direction; None where its unit is not known."""
    size = to_si(signal.unit or signal.source.stated_unit or "", unit)
    if size is None or signal.source.angle == "speed":
        return None
    side = -1.0 if signal.positive == "port" else 1.0
    return dataclasses.replace(signal.source.sketch, y=side * size * signal.source.sketch.y)


def _by_median(speed: Signal, sailed: float) -> tuple[str, ...]:
    """That it is at quite another speed than her positions, by the usual one of both."""
    size = to_si(speed.unit or "", "m/s")
    y = speed.source.sketch.y
    usual = float(np.median(np.abs(y))) * size if size is not None and len(y) else 0.0
    if not usual:
        return ()
    ratio = sailed / usual
    return speeds_apart(ratio, f"CAREFUL: her positions are sailed at {ratio:.2f} times its median")


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
