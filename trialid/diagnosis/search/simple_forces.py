"""Forces of any simple shape in any equation: what an incomplete catalogue would leave.

The catalogue holds the effects somebody has described. A record may show another, and then some
effect of the catalogue, most often a constant one, takes up a little of it and would be named.
Probes stand for no effect: in each equation any function of one signal, and products of two. Where
they explain the residual far better than the catalogue does, it does not hold what is missing.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, pairwise, permutations
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.diagnosis.force.force_terms import MOTIONS, pressure, prime_signals
from trialid.diagnosis.force.linear_response import Path, path
from trialid.identification.fit import Fit
from trialid.identification.output_error import stretches
from trialid.trial_rows import Stretch

Vector = NDArray[np.float64]

KNOTS: Final = 11
"""Of a function of one signal: enough for a kink at zero, a dead band, a few bends."""

FINE: Final = 4.0
"""Steps of the clock in sqrt(L / g), the time in which a ship answers at its quickest."""

TOGETHER: Final = 4096
"""Samples that are made of a coarser clock at a time."""

EQUATIONS: Final = "YKN"
"""Where probes act; surge shows in turning and rolling only through these."""


@dataclass(frozen=True)
class Probes:
    """Columns of normed outputs (M, n), and which of them belong to one probe."""

    columns: Vector
    groups: tuple[tuple[int, ...], ...]


@dataclass(frozen=True)
class _Shape:
    """A force over the signals: one column, or one for each knot of a function."""

    signal: str
    other: str = ""
    modulus: bool = False

    @property
    def width(self) -> int:
        return 1 if self.other else KNOTS

    def of(self, moves: Mapping[str, Vector], ranges: Mapping[str, tuple[float, float]]) -> Vector:
        """Its columns over time; (n, width)."""
        x = moves[self.signal]
        if self.other:
            y = moves[self.other]
            return (x * (np.abs(y) if self.modulus else y))[:, None]
        knots = np.linspace(*ranges[self.signal], KNOTS)
        return np.column_stack([np.interp(x, knots, line) for line in np.eye(KNOTS)])


def probes(fit: Fit) -> Probes:
    """What each probe would cause along the fitted trials."""
    problem = fit.problem
    particulars = problem.simulator.model.ship.particulars
    step = float(np.sqrt(particulars["L"] / particulars["g"])) / FINE
    every = [max(int(step / t.period), 1) for t in problem.trials]
    paths = [path(fit, i, n) for i, n in enumerate(every)]
    moves = [_moves(p.signals) for p in paths]
    ranges = {
        s: (min(float(m[s].min()) for m in moves), max(float(m[s].max()) for m in moves))
        for s in moves[0]
        if all(s in m for m in moves)  # not every trial need record a heading
    }
    shapes = tuple(_shapes([s for s, (low, high) in ranges.items() if high > low]))
    rows = [r for r in paths[0].rows if r in EQUATIONS]
    edges = np.cumsum([0, *[s.width for _ in rows for s in shapes]])
    groups = tuple(tuple(range(a, b)) for a, b in pairwise(edges))
    parts = stretches(problem)
    columns = np.empty((parts[-1].rows.stop, int(edges[-1])))
    for i, (p, m) in enumerate(zip(paths, moves, strict=True)):
        y = _responses(p, rows, np.column_stack([s.of(m, ranges) for s in shapes]))
        for part in (one for one in parts if one.trial == i):
            _fill(columns[part.rows], part, y[:, part.output], every[i])
    return Probes(columns, groups)


def _moves(signals: Mapping[str, Vector]) -> dict[str, Vector]:
    moves = {s: x for s, x in prime_signals(signals).items() if s in MOTIONS}
    return moves | ({"psi": signals["psi"]} if "psi" in signals else {})


def _shapes(known: Sequence[str]) -> Iterator[_Shape]:
    yield from (_Shape(s) for s in known)
    motions = [s for s in known if s in MOTIONS]
    yield from (_Shape(x, y, modulus=True) for x, y in permutations(motions, 2))
    yield from (_Shape(x, y) for x, y in combinations(motions, 2))


def _responses(along: Path, rows: Sequence[str], shapes: Vector) -> Vector:
    """Normed outputs on the path's clock, equation by equation; (n, n_y, rows * shapes)."""
    forces = [pressure(r, along.signals)[:, None] * shapes for r in rows]
    forces = [f / np.maximum(np.sqrt(np.mean(f**2, axis=0)), 1e-300) for f in forces]
    held = np.stack([0.5 * (f[1:] + f[:-1]) for f in forces], axis=1)
    drive = along.D[:, :, [along.rows.index(r) for r in rows]]
    z = np.zeros((along.E.shape[1], held[0].size))
    y = np.zeros((len(along.at), along.C.shape[1], z.shape[1]))
    for k in range(len(along.at) - 1):
        z = along.E[k] @ z + (drive[k][:, :, None] * held[k]).reshape(z.shape)
        y[k + 1] = along.C[k + 1] @ z
    return y


def _fill(columns: Vector, part: Stretch, y: Vector, every: int) -> None:
    """Rows of one output of a trial, some at a time: all its samples are far more."""
    at = 0
    for start in range(0, len(part.compared), TOGETHER):
        stop = min(start + TOGETHER, len(part.compared))
        some = part.within(slice(start, stop), at)
        columns[some.rows] = some.taken(_between(y, every, slice(start, stop)))
        at = some.rows.stop


def _between(y: Vector, every: int, samples: slice) -> Vector:
    """Straight lines between the samples of a coarser clock; (N, ...)."""
    if every == 1:
        return y[samples]
    place = np.minimum(np.arange(samples.start, samples.stop) / every, len(y) - 1.0)
    before = np.minimum(place.astype(int), len(y) - 2)
    share = (place - before)[:, None]
    return np.asarray((1.0 - share) * y[before] + share * y[before + 1])
