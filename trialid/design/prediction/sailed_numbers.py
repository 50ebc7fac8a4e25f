"""Numbers read from the track that a fitted ship sails, with their 95 %, and what a wind does."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.design.imo.measure_slopes import SMALL
from trialid.design.imo.sailed_trial import PLACE, Numbers, SailedTrial, Track
from trialid.design.prediction.likely_spread import Range
from trialid.errors import DesignError

NORMAL: Final = 1.96


def numbers(
    sailed: SailedTrial, read: Numbers, beyond: Mapping[str, float] | None = None
) -> dict[str, tuple[float, Range | None]]:
    """What the model comes to by name, each with its 95 % range; empty where it does not get there.

    Parameters
    ----------
    read
        Reads the numbers from a track; DesignError where there are none.
    beyond
        Standard error of each by what acts on a single run and is not in the model.
    """
    try:
        found = read(sailed.track)
        slopes = _slopes(sailed, read, found)
    except DesignError:
        return {}
    own = np.array([(beyond or {}).get(n, 0.0) for n in found])
    own = np.hypot(own, np.linalg.norm(_by_noise(sailed, read, found), axis=1))
    ranges = sailed.spread.ranges([*found.values()], slopes, own)
    return {n: (x, r) for (n, x), r in zip(found.items(), ranges, strict=True)}


@dataclass(frozen=True)
class Drift:
    """What the wind does to a number: without it less with it, and where 95 % of that lies."""

    value: float
    range: Range | None


def drift(windy: SailedTrial | None, calm: SailedTrial, read: Numbers) -> dict[str, Drift]:
    """What is to be added to the numbers of a record to take the wind off, by the model.

    Empty where the model does not get there with the wind or without.
    """
    if windy is None:
        return {}
    try:
        blown, calmly = read(windy.track), read(calm.track)
        names = [n for n in calmly if n in blown]
        with_wind, without = ({n: x[n] for n in names} for x in (blown, calmly))
        by = _slopes(calm, read, without) - _slopes(windy, read, with_wind)
        noise = _by_noise(calm, read, without) - _by_noise(windy, read, with_wind)
    except DesignError:
        return {}
    values = [x - with_wind[n] for n, x in without.items()]
    off = NORMAL * np.linalg.norm(noise, axis=1)
    each = zip(without, values, calm.spread.ranges(values, by), off, strict=True)
    return {n: Drift(x, None if r is None else _wider(r, x, o)) for n, x, r, o in each}


def _by_noise(sailed: SailedTrial, read: Numbers, found: Mapping[str, float]) -> Vector:
    """By how much noise of each sensor moves the numbers; (n_numbers, m)."""
    if sailed.noise is None:
        return np.zeros((len(found), 1))
    return _slopes(replace(sailed, by=sailed.noise, others=()), read, found)


def _wider(known: Range, value: float, off: float) -> Range:
    """A range about a value with as much again to either side, independent of it."""
    low, high = known
    return value - float(np.hypot(value - low, off)), value + float(np.hypot(high - value, off))


def _slopes(sailed: SailedTrial, read: Numbers, found: Mapping[str, float]) -> Vector:
    """Slopes of the numbers, by moving the track a little to either side; (n_numbers, n)."""
    by, slopes = sailed.by, np.zeros((len(found), sailed.by.shape[-1]))
    span = max(float(np.ptp(sailed.track["x"])), float(np.ptp(sailed.track["y"])), 1.0)
    sizes = np.max(np.abs(by) / np.array([1.0, span, span])[:, None], axis=(0, 1))
    for i in np.flatnonzero(sizes):
        step = SMALL / sizes[i]
        up, down = (read(_moved(sailed.track, side * by[..., i])) for side in (step, -step))
        slopes[:, i] = [(up.get(n, x) - down.get(n, x)) / (2.0 * step) for n, x in found.items()]
    for track, columns in sailed.others:
        other = read(track)
        slopes[:, list(columns)] = np.array([other.get(n, x) - x for n, x in found.items()])[
            :, None
        ]
    return slopes


def _moved(track: Track, change: Vector) -> Track:
    return {n: track[n] + change[:, k] for k, n in enumerate(PLACE)}
