"""The unit of a rudder whose numbers are small and that no log states."""

import dataclasses
from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np

from trialid.names import units
from trialid.workflow.first_pipeline.choice import AS_RADIANS, BY_SIZE, Chosen, Signal

TURNED: Final = 0.1
"""Rate of turn, in her own lengths and speed, over the rudder in radians: ships, boats and models
have 0.3 to 3 once they turn, in a fast zig-zag less. Degrees taken for radians give 0.005 to 0.05.
At half of it a ferry that is hardly steered is read in degrees still (0.02), as a cargo ship in a
sea is (0.04), and at twice; a fast zig-zag (0.2 and more) at twice no longer in radians."""


def with_rudder_units(trials: Sequence[Chosen], length: float, speed: float) -> list[Chosen]:
    """The trials, a rudder of small numbers in degrees where another log or her turning says so.

    Up to 1.6 may be radians, or degrees of a ship that is hardly steered.
    """
    known = _by_size(trials)
    return [_told(one, known, length / speed) for one in trials]


def _by_size(trials: Sequence[Chosen]) -> Mapping[str, str]:
    """Logs whose numbers leave degrees alone, by the name of the channel."""
    return {
        s.source.name: one.path.name
        for one in trials
        for s in one.signals
        if s.unit == "deg" and BY_SIZE in s.why
    }


def _told(trial: Chosen, known: Mapping[str, str], seconds: float) -> Chosen:
    """`seconds` is the time in which she goes her own length."""
    rate = next((s for s in trial.signals if s.quantity == "r" and not s.open), None)
    signals = []
    for one in trial.signals:
        if AS_RADIANS not in one.why:
            signals.append(one)
        elif one.source.name in known:
            signals.append(_in_degrees(one, f"deg as in {known[one.source.name]}"))
        elif rate is not None and (size := _turned(one, rate) * seconds) < TURNED:
            words = f"deg, for of radians she would turn by r L / U = {size:.2g} a radian only"
            signals.append(_in_degrees(one, words))
        else:
            signals.append(one)
    return dataclasses.replace(trial, signals=tuple(signals))


def _turned(rudder: Signal, rate: Signal) -> float:
    """How fast she turns [rad/s] by the rudder as logged, both by what is root mean square."""
    r = rate.source.sketch.y * units.factor(rate.unit or "rad/s", "rad/s")
    most = float(np.sqrt(np.mean(rudder.source.sketch.y**2)))
    return float(np.sqrt(np.mean(r**2))) / max(most, 1e-9)


def _in_degrees(rudder: Signal, words: str) -> Signal:
    why = rudder.why.replace(AS_RADIANS, f"no unit is stated: {words}")
    return dataclasses.replace(rudder, unit="deg", why=why)
