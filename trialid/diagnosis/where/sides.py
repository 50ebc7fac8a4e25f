"""Port against starboard.

A ship whose two sides are alike makes errors that mirror: too little turn on one side is too
little on the other. What does not mirror is an asymmetry: of rudder, propeller, wind or sensor.
"""

from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.arrays import Mask
from trialid.diagnosis.where import words
from trialid.diagnosis.where.bins import in_reports, share_of_means, weights
from trialid.diagnosis.where.finding import Examined, Finding
from trialid.diagnosis.where.leftover import Leftover, mirror
from trialid.diagnosis.where.slice_finding import slice_finding
from trialid.diagnosis.where.slice_test import Colour, Means, Squares, means, squares

Vector = NDArray[np.float64]

LEVEL: Final = 0.05
STRAIGHT: Final = 0.25
"""Below this share of its rms a rate of turn, or a rudder angle, is to no side."""


def side(left: Leftover, colour: Colour, output: int) -> Examined | str:
    """Whether turns to port and to starboard are predicted alike."""
    found = _turning(left)
    if found is None:
        return "neither rate of turn nor rudder in the record"
    inside, doing = found
    if not (inside & left.compared[:, output, None]).any(axis=0).all():
        return f"the record holds no {doing[0]} or no {doing[1]}"
    w = weights(inside, left.compared[:, output])
    odd = mirror(left.outputs[output]) < 0
    apart = 0.5 * (w[:, 0] + w[:, 1]) if odd else 0.5 * (w[:, 1] - w[:, 0])
    mean = means(left, colour, output, np.column_stack([apart, w]))
    held = squares(left, colour, output, inside)
    p = np.array([mean.p[0], *held.p])
    least = min(float(p.min()) * len(p), 1.0)
    if least > LEVEL:
        return Examined(least)
    made = _side(left, output, doing, mean, held, float(p[0]) * 3 <= LEVEL)
    return Examined(least, (made,))


def _turning(left: Leftover) -> tuple[Mask, tuple[str, str]] | None:
    """Samples to port and to starboard (N, 2), and what the ship does there."""
    for x, doing in (
        (left.signal("r"), ("turning to port", "turning to starboard")),
        (left.rudder(), ("rudder to port", "rudder to starboard")),
    ):
        if x is not None and np.any(x):
            limit = STRAIGHT * float(np.sqrt(np.mean(x**2)))
            return np.column_stack([x < -limit, x > limit]), doing
    return None


def _side(
    left: Leftover, output: int, doing: tuple[str, str], mean: Means, held: Squares, apart: bool
) -> Finding:
    factor = in_reports(left, output)
    worse = int(np.argmax(held.ratio))
    samples, share = float(held.samples[worse]), float(held.share[worse])
    said = f"{doing[worse]}, {words.share_sentence(samples, share)}"
    standing = np.arange(2) == worse
    if apart:
        off = [words.how_far_off(left, output, float(m) * factor) for m in mean.value[1:]]
        said = (
            f"port and starboard differ: {doing[0]} the prediction is on average {off[0]}, "
            f"{doing[1]} {off[1]}"
        )
        share = share_of_means(left, output, np.repeat(mean.value[0], 2), held)
        samples, standing = 0.0, np.ones(2, dtype=bool)
        said += f"; what does not mirror is {words.share(share)} of its squared error"
    both = Means(mean.value[1:], mean.error[1:], mean.p[1:], mean.joint)
    return slice_finding(
        left,
        output,
        held,
        standing,
        kind="side",
        said=said,
        share=share,
        samples=samples,
        by=("side", ""),
        edges=np.array([0.0, 1.0, 2.0]),
        mean=both,
        names=doing,
    )
