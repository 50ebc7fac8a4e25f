"""The unit of a yaw rate that no log states, by how fast a ship can turn."""

import dataclasses
from typing import Final

import numpy as np

from trialid.inspection.name_words import words
from trialid.inspection.relations import RATES
from trialid.names import units
from trialid.workflow.first_pipeline.choice import ASK_UNIT, OPEN, Chosen, Signal

TURNING: Final = (0.05, 2.5)
"""Rate of turn of a ship in a manoeuvre, in her own lengths and speed; rates in other units lie
further apart than this range is wide."""


def size_unit(trial: Chosen, length: float, speed: float) -> Chosen:
    """The same with the unit of a yaw rate by its size, where nothing else tells it.

    A ship in a manoeuvre turns with r L / U between 0.05 and 2.5, her own length [m] and speed
    [m/s]: faster she would spin about herself, slower is no manoeuvre. Units lie further apart.
    """
    signals = tuple(_sized(one, length / speed) for one in trial.signals)
    return dataclasses.replace(trial, signals=signals)


def _sized(signal: Signal, seconds: float) -> Signal:
    if signal.quantity != "r" or signal.unit != OPEN or _turns(signal):
        return signal
    largest = float(np.quantile(np.abs(signal.source.sketch.y), 0.99))
    sizes = {u: largest * units.factor(u, "rad/s") * seconds for u in RATES}
    fitting = [u for u, size in sizes.items() if TURNING[0] < size < TURNING[1]]
    if len(fitting) != 1:
        return signal
    told = ", ".join(f"{size:.2g} in {u}" for u, size in sizes.items())
    words = f"unit by its size: r L / U would be {told}"
    why = signal.why.replace(ASK_UNIT, words)
    return dataclasses.replace(signal, unit=fitting[0], why=why)


def _turns(signal: Signal) -> bool:
    """Whether its name ends with `rps`, radians or turns a second, which no size tells apart."""
    return "rps" in words(signal.source.name)
