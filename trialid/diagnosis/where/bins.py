"""Bins with edges that can be said aloud, and the numbers a picture of them needs."""

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.arrays import Mask
from trialid.diagnosis.where.finding import Bars
from trialid.diagnosis.where.leftover import Leftover, shown_factor, unit
from trialid.diagnosis.where.slice_test import Means, Squares

Vector = NDArray[np.float64]

MOST: Final = 7
SPARSE: Final = 0.03
"""A bin with a smaller share of the samples joins its neighbour."""


def nice_edges(x: Vector, between: bool = False) -> Vector:
    """Edges over the range of x at round numbers, about six bins, none of them sparse; (bins + 1,).

    `between` puts them half a step off: what is held at round numbers, as a rudder is, would
    otherwise lie on an edge.

    >>> nice_edges(np.linspace(0.0, 1.0, 1000)).tolist()
    [0.0, 0.2, 0.4, 0.6, 0.8, 1.0]
    >>> nice_edges(np.repeat([0.0, 10.0, 20.0], 100), between=True).tolist()
    [0.0, 7.5, 17.5, 22.5]
    """
    low, high = float(x.min()), float(x.max())
    if high <= low:
        return np.array([low, high])
    step = _step((high - low) / MOST)
    shift = 0.5 * step if between else 0.0
    first, last = np.floor((low - shift) / step), np.ceil((high - shift) / step - 1e-9)
    edges = [round(float(k * step + shift), 12) for k in np.arange(first, last + 1)]
    if low >= 0.0:
        edges = [max(e, 0.0) for e in edges]
    return np.asarray(_merged(x, sorted(set(edges))))


def _step(least: float) -> float:
    """The smallest of 1, 2, 5, 10, ... that is not below."""
    power = 10.0 ** np.floor(np.log10(least))
    return float(next(k * power for k in (1.0, 2.0, 5.0, 10.0) if k * power >= least * (1 - 1e-9)))


def _merged(x: Vector, edges: list[float]) -> list[float]:
    """Edges less those that leave a bin nearly empty, from the sparsest on."""
    while len(edges) > 2:
        counts = np.histogram(x, edges)[0] / len(x)
        least = int(np.argmin(counts))
        if counts[least] >= SPARSE:
            break
        beside = [i for i in (least - 1, least + 1) if 0 <= i < len(counts)]
        other = min(beside, key=lambda i: counts[i])
        edges = [e for k, e in enumerate(edges) if k != max(least, other)]
    return edges


def members(x: Vector, edges: Vector) -> Mask:
    """Which samples lie in which bin; (N, bins)."""
    place = np.clip(np.searchsorted(edges, x, side="right") - 1, 0, len(edges) - 2)
    return np.asarray(place[:, None] == np.arange(len(edges) - 1))


def weights(inside: Mask, compared: Mask, sign: Vector | None = None) -> Vector:
    """Weights whose product with the residual is its mean in each slice; (N, q)."""
    counted = (inside & compared[:, None]).astype(float)
    counts = np.maximum(counted.sum(axis=0), 1.0)
    return np.asarray(counted / counts * (1.0 if sign is None else sign[:, None]))


def bars(
    left: Leftover,
    output: int,
    by: tuple[str, str],
    edges: Vector,
    held: Squares,
    mean: Means | None,
    standing: Mask,
    names: Sequence[str] = (),
) -> Bars:
    """A picture's numbers, in the units of reports; `by` is what the bins are of, and its unit."""
    factor = in_reports(left, output)
    what, in_unit = by
    return Bars(
        by=what,
        unit=in_unit,
        edges=_plain(edges),
        names=tuple(names),
        samples=_plain(held.samples),
        share=_plain(held.share),
        mean_square=_plain(held.ratio),
        low=_plain(held.low),
        high=_plain(held.high),
        mean=None if mean is None else _plain(mean.value * factor),
        error=None if mean is None else _plain(mean.error * factor),
        mean_unit=unit(left.outputs[output]),
        standing=tuple(bool(b) for b in standing),
    )


def in_reports(left: Leftover, output: int) -> float:
    """Factor from a normed residual to the unit reports show the output in."""
    return float(left.fit.problem.y_rms[output]) * shown_factor(left.outputs[output])


def share_of_means(left: Leftover, output: int, mean: Vector, held: Squares) -> float:
    """Share of an output's squared error that normed means in slices make up."""
    power = float((left.eps[:, output] ** 2).sum() / left.compared[:, output].sum())
    return min(float(held.samples @ mean**2) / power, 1.0)


def _plain(values: Vector) -> tuple[float, ...]:
    return tuple(float(v) for v in values)
