"""Jumps of a heading: a step off the pace of the steps beside it, after which it goes on.

A ship's heading goes on from where it was. A compass that swings through a deviation, is switched
over or loses its reference, and two logs put one after the other, leave a step that no helm makes;
its model then looks for a force that did it.
"""

from collections.abc import Iterator

import numpy as np

from trialid.alignment.clocks import Series
from trialid.alignment.fault_samples import Fault, available_samples, resolution
from trialid.alignment.spikes import SHARP, usual_size
from trialid.arrays import Vector

LEAST = np.deg2rad(2.0)
"""[rad] What is less drowns in a model's error. A compass on a real bus made steps of 0.05 deg that
are eight times its usual ones; of 420 simulated records none is told to jump, with
half of this or twice, and of a jump of 5 deg put into each 408 are, 406 with twice."""
BESIDE = 3
"""Steps to each side whose middle is the pace: a jump that takes two samples does not move it. A
step over a gap tells nothing."""


def jumps(series: Series, zero: float) -> Iterator[Fault]:
    """Steps of a heading unlike those beside them; `zero` plays no part."""
    s = available_samples(series)
    if series.quantity.name != "psi" or len(s.y) < 4 * BESIDE:
        return
    dt = np.maximum(np.diff(s.t), series.period)  # what was held up on a bus comes in bursts
    pace = np.where(s.near[1:], np.diff(s.y) / dt, np.nan)
    off = np.nan_to_num(np.abs(pace - _usual(pace)) * dt)
    far = max(SHARP * usual_size(off), 4.0 * resolution(s.y), LEAST)
    if (found := off > far).any():
        samples = np.zeros(len(series.y), np.bool_)
        samples[s.at[1:][found]] = True
        words = f"jumped by up to {np.rad2deg(off.max()):.2g} deg off the pace of its neighbours"
        yield Fault("jumps", words, samples, False)


def _usual(pace: Vector) -> Vector:
    """Median of the pace around each step, of those that are there."""
    padded = np.pad(pace, BESIDE, constant_values=np.nan)
    around = np.lib.stride_tricks.sliding_window_view(padded, 2 * BESIDE + 1)
    there = np.isfinite(around).any(axis=1)
    usual = np.zeros(len(pace))
    usual[there] = np.nanmedian(around[there], axis=1)
    return usual
