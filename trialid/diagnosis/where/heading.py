"""Heading sectors: what depends on where the ship points is of wind, current or waves."""

from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.arrays import Mask
from trialid.diagnosis.where import words
from trialid.diagnosis.where.bins import in_reports, members, share_of_means, weights
from trialid.diagnosis.where.finding import Examined, Finding
from trialid.diagnosis.where.leftover import Leftover
from trialid.diagnosis.where.slice_finding import slice_finding
from trialid.diagnosis.where.slice_test import Colour, Means, Squares, means, squares

Vector = NDArray[np.float64]

LEVEL: Final = 0.05
SECTOR: Final = 45.0
POINTS: Final = (
    "north", "north-east", "east", "south-east", "south", "south-west", "west", "north-west",
)  # fmt: skip
SPARSE: Final = 0.03
"""A sector with a smaller share of the samples is left out."""


def by_heading(left: Leftover, colour: Colour, output: int) -> Examined | str:
    """Whether an output's error depends on where the ship points: wind, current, waves."""
    psi = left.signal("psi")
    if psi is None:
        return "no heading in the record"
    place = np.floor(np.mod(np.degrees(psi) + 0.5 * SECTOR, 360.0) / SECTOR) + 0.5
    inside = members(place, np.arange(len(POINTS) + 1.0))
    counted = (inside & left.compared[:, output, None]).mean(axis=0)
    kept = np.flatnonzero(counted >= SPARSE)
    if len(kept) < 2:
        return f"the heading stays within {SECTOR:.0f} deg"
    inside = inside[:, kept]
    mean = means(left, colour, output, weights(inside, left.compared[:, output]))
    held = squares(left, colour, output, inside)
    least = min(2.0 * min(mean.joint, float(held.p.min()) * len(held.p)), 1.0)
    if least > LEVEL:
        return Examined(least)
    off = mean.p <= LEVEL if 2.0 * mean.joint <= LEVEL else np.zeros(len(kept), dtype=bool)
    return Examined(least, (_sector(left, output, kept, mean, held, off),))


def _sector(
    left: Leftover, output: int, kept: NDArray[np.intp], mean: Means, held: Squares, off: Mask
) -> Finding:
    """The sectors whose means stand out most to either side, else the one with most error."""
    factor = in_reports(left, output)
    names = [POINTS[k] for k in kept]
    if off.any():
        value = np.where(off, mean.value, 0.0)
        ends = dict.fromkeys(k for k in (int(value.argmax()), int(value.argmin())) if off[k])
        share = share_of_means(left, output, value, held)
        off_by = {k: float(mean.value[k]) * factor for k in ends}
        parts = [
            f"heading {names[k]} {words.how_far_off(left, output, m)}" for k, m in off_by.items()
        ]
        said = f"the prediction is, on average, {', '.join(parts)}"
        said += f"; such means are {words.share(share)} of its squared error"
        samples, standing = 0.0, off
    else:
        k = int(np.argmin(held.p))
        samples, share = float(held.samples[k]), float(held.share[k])
        said, standing = (
            f"heading {names[k]}, {words.share_sentence(samples, share)}",
            kept == kept[k],
        )
    return slice_finding(
        left,
        output,
        held,
        standing,
        kind="heading sector",
        said=said,
        share=share,
        samples=samples,
        by=("heading", ""),
        edges=np.arange(len(kept) + 1.0),
        mean=mean,
        names=names,
    )
