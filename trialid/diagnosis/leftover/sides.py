"""Port against starboard, heading sectors, and a plain offset: the signed mean by where it points.

A ship whose two sides are alike makes errors that mirror: too little turn on one side is too
little on the other. What does not mirror is an asymmetry: of rudder, propeller, wind or sensor.
"""

from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.diagnosis.leftover import words
from trialid.diagnosis.leftover.bins import bars, in_reports, members, weights
from trialid.diagnosis.leftover.chance import Colour, Means, Squares, means, squares
from trialid.diagnosis.leftover.finding import Examined, Finding
from trialid.diagnosis.leftover.record import Leftover, mirror
from trialid.trial import Mask

Vector = NDArray[np.float64]

LEVEL: Final = 0.05
STRAIGHT: Final = 0.25
"""Below this share of its rms a rate of turn, or a rudder angle, is to no side."""

SECTOR: Final = 45.0
POINTS: Final = (
    "north", "north-east", "east", "south-east", "south", "south-west", "west", "north-west",
)  # fmt: skip
SPARSE: Final = 0.03


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
    said = [f"{doing[worse]}, {words.held(samples, share)}"]
    standing = np.arange(2) == worse
    if apart:
        off = [words.off(left, output, float(m) * factor) for m in mean.value[1:]]
        said = [
            f"port and starboard differ: {doing[0]} the prediction is on average {off[0]}, "
            f"{doing[1]} {off[1]}"
        ]
        share = _explained_by(left, output, np.repeat(mean.value[0], 2), held)
        samples, standing = 0.0, np.ones(2, dtype=bool)
        said[0] += f"; what does not mirror is {words.share(share)} of its squared error"
    both = Means(mean.value[1:], mean.error[1:], mean.p[1:], mean.joint)
    picture = bars(
        left, output, ("side", ""), np.array([0.0, 1.0, 2.0]), held, both, standing, doing
    )
    excess = float(held.share[standing].sum() / held.samples[standing].sum())
    return _named(left, output, "side", share, samples, excess, "; ".join(said), picture)


def _explained_by(left: Leftover, output: int, mean: Vector, held: Squares) -> float:
    """Share of an output's squared error that means in slices make up."""
    power = float((left.eps[:, output] ** 2).sum() / left.compared[:, output].sum())
    return min(float(held.samples @ mean**2) / power, 1.0)


def _named(left, output, kind, share, samples, excess, said, picture, trial=None):  # type: ignore[no-untyped-def]
    return Finding(
        left.outputs[output], kind, share, share - samples, excess, 1.0,
        f"{words.name(left.outputs[output])}: {said}", picture, trial,
    )  # fmt: skip


def heading(left: Leftover, colour: Colour, output: int) -> Examined | str:
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
        share = _explained_by(left, output, value, held)
        parts = [f"heading {names[k]} {words.off(left, output, float(mean.value[k]) * factor)}"
                 for k in ends]  # fmt: skip
        said = f"the prediction is, on average, {', '.join(parts)}"
        said += f"; such means are {words.share(share)} of its squared error"
        samples, standing = 0.0, off
    else:
        k = int(np.argmin(held.p))
        samples, share = float(held.samples[k]), float(held.share[k])
        said, standing = f"heading {names[k]}, {words.held(samples, share)}", kept == kept[k]
    excess = float(held.share[standing].sum() / held.samples[standing].sum())
    picture = bars(left, output, ("heading", ""), np.arange(len(kept) + 1.0), held, mean, standing,
                   names)  # fmt: skip
    return _named(left, output, "heading sector", share, samples, excess, said, picture)


def offset(left: Leftover, colour: Colour, output: int) -> Examined:
    """Whether an output is off on average in any of the trials."""
    inside = np.zeros((len(left.eps), len(left.spans)), dtype=bool)
    for k, span in enumerate(left.spans):
        inside[span, k] = True
    mean = means(left, colour, output, weights(inside, left.compared[:, output]))
    least = min(float(mean.p.min()) * len(mean.p), 1.0)
    if least > LEVEL:
        return Examined(least)
    held = squares(left, colour, output, inside)
    standing = mean.p <= LEVEL / len(mean.p)
    worst = int(np.argmin(mean.p))
    share = _explained_by(left, output, np.where(standing, mean.value, 0.0), held)
    names = [r.trial.name for r in left.parts]
    value = float(mean.value[worst]) * in_reports(left, output)
    said = f"in {names[worst]!r} the prediction is on average {words.off(left, output, value)}"
    others = int(standing.sum()) - 1
    said += f", and {others} other trials are off too" if others else ""
    said += f"; such offsets are {words.share(share)} of its squared error"
    excess = float(held.share[standing].sum() / held.samples[standing].sum())
    picture = bars(left, output, ("trial", ""), np.arange(len(names) + 1.0), held, mean, standing,
                   names)  # fmt: skip
    return Examined(
        least, (_named(left, output, "mean offset", share, 0.0, excess, said, picture, names[worst]),)
    )
