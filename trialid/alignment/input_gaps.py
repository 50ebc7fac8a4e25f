"""Gaps of what steers a ship: what she does after one does not follow from what is recorded.

The outputs of a gap are masked, but the ship goes on: where her rudder was not recorded for long, a
simulation comes out of the gap with another state than she did, and a fit bends its parameters to
it. A trial keeps its longest stretch without such a gap, and says which windows the others are.
"""

from collections.abc import Collection
from dataclasses import replace
from typing import Final

import numpy as np

from trialid.alignment.fault_samples import joined_runs
from trialid.alignment.resample import HALF_LENGTH
from trialid.arrays import Mask
from trialid.trial import Trial

LENGTHS: Final = 0.5
"""Own lengths sailed in a gap up to which a straight line through it does. Of twelve gaps at random
in zig-zags of a container ship, 12 s for 0.5 lengths, these move no parameter by more than 0.6 of a
standard error and raise the error by up to 1.5 %; 0.9 lengths raise it by 6 %, 3.5 by up to 54 %.
"""

MOST: Final = 0.25
"""Share of a trial that its longest stretch must have: what has gaps all over may be sent only when
it changes. Half of it leaves an eighth of such a log, twice leaves a gap of a third in the middle
where it is."""


def without_input_gaps(trial: Trial, inputs: Collection[str], longest: float) -> Trial:
    """The longest stretch of a trial in which no input is unknown for longer than that [s]."""
    gaps = {
        n: _long_gaps(trial.valid[n], longest / trial.period) for n in trial.valid if n in inputs
    }
    known = ~np.any([np.zeros(trial.samples, np.bool_), *gaps.values()], axis=0)
    ends = _stretches(known)
    if known.all() or not ends:
        return trial
    begin, end = max(ends, key=lambda one: one[1] - one[0])
    said = _words(trial, [name for name, gap in gaps.items() if gap.any()], ends)
    if end - begin < MOST * trial.samples:
        kept = "it has gaps all over, and what she does after one rests on a straight line"
        return replace(trial, remarks=(*trial.remarks, f"{said}; left as it is: {kept}"))
    others = [_window(trial, one) for one in ends if one != (begin, end)]
    advice = f"; for a trial of their own: window = {' or '.join(others)}" if others else ""
    remark = f"{said}: only {_window(trial, (begin, end))} s is used{advice}"
    return trial.part(begin, end, remark)


def recorded_parts(trial: Trial, longest: float) -> list[tuple[int, int]]:
    """The stretches between pauses of the recorder: longer than that [s] it measured nothing.

    Each from its first sample to one past its last; a speed that is stated is no record.
    """
    measured = np.any([known for name, known in trial.valid.items() if name != "u"], axis=0)
    return _stretches(~_long_gaps(measured, longest / trial.period))


def _stretches(known: Mask) -> list[tuple[int, int]]:
    return [(i, j + 1) for i, j in joined_runs(known[1:] & known[:-1]) if known[i]]


def _long_gaps(valid: Mask, longest: float) -> Mask:
    """Where a signal is unknown for more than so many samples between two that are known.

    A low-pass takes some more on each side. At the ends nothing is simulated through.
    """
    gaps = np.zeros(len(valid), np.bool_)
    for i, j in joined_runs(valid[1:] == valid[:-1]):
        inside = i > 0 and j + 1 < len(valid)
        if inside and not valid[i] and j - i + 1 > longest + 2 * HALF_LENGTH:
            gaps[i : j + 1] = True
    return gaps


def _words(trial: Trial, names: list[str], ends: list[tuple[int, int]]) -> str:
    """That these inputs are unknown, and where: beside the stretches in which they are known."""
    edges = [0, *(edge for one in ends for edge in one), trial.samples]
    gaps = [(i, j) for i, j in zip(edges[::2], edges[1::2], strict=True) if j > i]
    places = ", ".join(_window(trial, one) for one in gaps[:3])
    return f"{' and '.join(names)} not recorded in {places}{', ...' if gaps[3:] else ''} s"


def _window(trial: Trial, ends: tuple[int, int]) -> str:
    """A stretch as a pipeline's window states it [s]."""
    begin, end = (trial.opening + k * trial.period for k in (ends[0], ends[1] - 1))
    return f"[{begin:.1f}, {end:.1f}]"
