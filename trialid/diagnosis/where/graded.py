"""Error by the size of something: amplitude of rudder, turn rate and roll; speed."""

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.arrays import Mask
from trialid.diagnosis.where import words
from trialid.diagnosis.where.bins import (
    in_reports,
    members,
    nice_edges,
    share_of_means,
    weights,
)
from trialid.diagnosis.where.finding import Examined, Finding
from trialid.diagnosis.where.leftover import Leftover, mirror, shown_factor, unit
from trialid.diagnosis.where.slice_finding import slice_finding
from trialid.diagnosis.where.slice_test import Colour, Means, Squares, means, squares, trend

Vector = NDArray[np.float64]

LEVEL: Final = 0.05
STEADY: Final = 0.03
"""A speed whose range is below this share of its mean is one speed."""


@dataclass(frozen=True)
class Scale:
    """What the error is graded by.

    Attributes
    ----------
    size
        In the unit of reports; (N,).
    sign
        The side a mirrored output's error is counted to, +1 or -1; None where it has none.
    side
        That side in words.
    """

    kind: str
    words: str
    unit: str
    signal: str
    size: Vector
    sign: Vector | None
    side: str
    between: bool = False


SIDES: Final = {
    "delta": "to the side of the rudder",
    "r": "to the side the ship turns to",
    "phi": "to the side of the heel",
}


def scales(left: Leftover) -> tuple[list[Scale], dict[str, str]]:
    """What this record can be graded by, and why not by the rest."""
    found, absent = [], {}
    for kind, made in (
        ("rudder amplitude", _amplitude(left, "delta", "rudder angle")),
        ("turn-rate amplitude", _amplitude(left, "r", "rate of turn")),
        ("roll amplitude", _amplitude(left, "phi", "roll")),
        ("speed", _speed(left)),
    ):
        if isinstance(made, Scale):
            found.append(made)
        else:
            absent[kind] = made
    return found, absent


def _amplitude(left: Leftover, signal: str, spoken: str) -> Scale | str:
    x = left.rudder() if signal == "delta" else left.signal(signal)
    if x is None:
        return f"no {'single ' * (signal == 'delta')}{spoken} in the record"
    if float(np.ptp(x)) == 0.0:
        return f"the {spoken} never changes"
    size = np.abs(x)
    if signal == "phi":  # a roll that passes through zero is no small roll
        size = np.concatenate([_envelope(x[span]) for span in left.spans])
    kinds = {"delta": "rudder amplitude", "r": "turn-rate amplitude", "phi": "roll amplitude"}
    return Scale(
        kind=kinds[signal],
        words=f"{spoken} amplitude" if signal == "phi" else spoken,
        unit=unit(signal),
        signal=signal,
        size=size * shown_factor(signal),
        sign=np.sign(x),
        side=SIDES[signal],
        between=signal == "delta",
    )


def _envelope(x: Vector) -> Vector:
    """Amplitude of an oscillation at every moment, by its analytic signal; (n,)."""
    spectrum = np.fft.fft(x)
    frequency = np.fft.fftfreq(len(x))
    return np.asarray(np.abs(np.fft.ifft(spectrum * (1.0 + np.sign(frequency)))))


def _speed(left: Leftover) -> Scale | str:
    name = next((n for n in ("u", "U") if left.signal(n) is not None), None)
    if name is None:
        return "no speed in the record"
    u = left.signal(name)
    assert u is not None
    middle = float(np.abs(u.mean()))
    if float(np.quantile(u, 0.99) - np.quantile(u, 0.01)) < STEADY * middle or middle == 0.0:
        return f"the speed stays within {words.share(STEADY)} of its mean"
    turn = left.signal("r")
    sign = None if turn is None else np.sign(turn)
    return Scale(
        kind="speed",
        words="speed",
        unit=unit(name),
        signal="u",
        size=u * shown_factor(name),
        sign=sign,
        side=SIDES["r"],
    )


def amplitude_dependence(left: Leftover, colour: Colour, output: int, scale: Scale) -> Examined:
    """Whether an output's error depends on a size: upward, downward, and on average."""
    edges = nice_edges(scale.size, scale.between)
    inside = members(scale.size, edges)
    bins = inside.shape[1]
    if bins < 2:
        return Examined(1.0)
    each = squares(left, colour, output, inside)
    parts = _contiguous(bins)
    some = squares(left, colour, output, inside @ parts)
    mirrored = mirror(left.outputs[output]) < 0
    sign = scale.sign if mirrored else np.ones(len(left.eps))
    mean = None
    if sign is not None:
        w = weights(inside, left.compared[:, output], sign)
        mean = means(left, colour, output, w)
    tests = [trend(left, colour, output, scale.size), float(some.p.min()) * len(some.p)]
    tests += [] if mean is None else [mean.joint]
    least = min(len(tests) * min(tests), 1.0)
    if least > LEVEL:
        return Examined(least)
    limit = LEVEL / len(tests)
    finding = _finding(
        left=left,
        output=output,
        scale=scale,
        edges=edges,
        part=parts[:, int(np.argmin(some.p))],
        each=each,
        mean=mean if tests[-1] <= limit else None,
        squares=min(tests[:2]) <= limit,
    )
    return Examined(least, (finding,))


def _finding(
    left: Leftover, output: int, scale: Scale, edges: Vector, part: Mask, each: Squares,
    mean: Means | None, squares: bool,
) -> Finding:  # fmt: skip
    """The bins that together stand out most, and those whose means do."""
    standing = np.zeros(len(each.ratio), dtype=bool)
    said, samples, share = [], 0.0, 0.0
    if squares:
        standing = part if _worse(each, part) else ~part
        samples, share = float(each.samples[standing].sum()), float(each.share[standing].sum())
        said.append(_place(scale, edges, standing, each) + words.share_sentence(samples, share))
    if mean is not None:
        off = _apart(mean)
        said.append(_means(left, output, scale, edges, off, mean))
        if not squares:
            standing[off] = True
            share = share_of_means(left, output, np.where(standing, mean.value, 0.0), each)
            said[-1] += f" ({words.share(share)} of its squared error)"
    label = f"|{scale.signal}|" if scale.kind != "speed" else scale.signal
    by = (f"{scale.words} {label}", scale.unit)
    return slice_finding(
        left,
        output,
        each,
        standing,
        kind=scale.kind,
        said="; ".join(said),
        share=share,
        samples=samples,
        by=by,
        edges=edges,
        mean=mean,
    )


def _apart(mean: Means) -> list[int]:
    """The mean most sure to be off, and the one most sure to be off the other way, if it is."""
    z = mean.value / mean.error * (mean.p < 1.0)
    first = int(np.argmax(np.abs(z)))
    other = int(np.argmin(z * np.sign(z[first])))
    return [first, other] if abs(z[other]) > 2.0 and z[other] * z[first] < 0.0 else [first]


def _contiguous(bins: int) -> Mask:
    """All above an edge, and every bin that is neither the first nor the last; (bins, q)."""
    above = [np.arange(bins) > j for j in range(bins - 1)]
    alone = [np.arange(bins) == j for j in range(1, bins - 1)]
    return np.column_stack(above + alone)


def _worse(each: Squares, part: Mask) -> bool:
    """Whether bins hold more of the squared error than of the samples."""
    return bool(each.share[part].sum() > each.samples[part].sum())


def _place(scale: Scale, edges: Vector, standing: Mask, each: Squares) -> str:
    """Which sizes stand out, and how the error goes with the size where the bins bear it out."""
    first, last = (int(k) for k in np.flatnonzero(standing)[[0, -1]])
    low, high = f"{edges[first]:g}", f"{edges[last + 1]:g} {scale.unit}"
    if not standing[first:last].all():
        gap = np.flatnonzero(~standing)
        place = f"outside {edges[gap[0]]:g} to {edges[gap[-1] + 1]:g} {scale.unit}"
    elif last + 1 == len(standing):
        place = f"above {low} {scale.unit}"
    else:
        place = f"below {high}" if first == 0 else f"between {low} and {high}"
    up = last + 1 == len(standing)
    steps = float(np.sign(np.diff(each.ratio)).sum()) * (1.0 if up else -1.0)
    if (up or first == 0) and steps >= 0.6 * (len(standing) - 1):
        return f"its error {'grows' if up else 'falls'} with the {scale.words}: {place}, "
    return f"{place} of {scale.words}, "


def _means(
    left: Leftover, output: int, scale: Scale, edges: Vector, bins: list[int], mean: Means
) -> str:
    """What the prediction lacks in some bins."""
    name = left.outputs[output]
    low, high = ("low", "high") if mirror(name) > 0 else ("little", "much")
    parts = []
    for k in sorted(bins):
        value = float(mean.value[k]) * in_reports(left, output)
        amount = f"{words.figure(value)} {unit(name)} too {low if value > 0.0 else high}"
        parts.append(f"{amount} between {edges[k]:g} and {edges[k + 1]:g} {scale.unit}")
    counted = "" if mirror(name) > 0 or name == scale.signal else f" and counted {scale.side}"
    by = f", by {scale.words}{counted}"
    return f"the prediction is on average {' and '.join(parts)}{by}"
