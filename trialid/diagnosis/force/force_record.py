"""The record that a missing force is sought in, and what forces in one equation would do to it."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.arrays import Mask
from trialid.diagnosis.force.force_terms import Term, dictionary, pressure, prime_signals
from trialid.diagnosis.force.linear_response import Path, path, response
from trialid.diagnosis.noise.noise_colour import order_for
from trialid.identification.fit import Fit
from trialid.identification.output_error import stretches

Vector = NDArray[np.float64]

FINENESS: Final = 8
"""Steps of the clock between two knots of the force."""

MOST_KNOTS: Final = 900
"""Knots over all trials; longer records get wider ones."""

MEMORY: Final = 20.0
"""Knots after which a record is taken to be independent of what was before: the longest memory."""

DISTINCT: Final = 1e-5
"""Combinations of terms that answer with less than this share of the largest are left out."""


@dataclass(frozen=True)
class Record:
    """Residual and gradient of every trial to fit, on the clock of its path.

    Attributes
    ----------
    columns
        Gradient by the unknowns, then the residual, both normed; (n, n_y, n_theta + 1) each.
    """

    paths: tuple[Path, ...]
    knots: tuple[Vector, ...]
    columns: tuple[Vector, ...]
    compared: tuple[Mask, ...]
    order: int

    @property
    def residual(self) -> list[Vector]:
        """The residual of each trial, zero where nothing was compared; (n, n_y)."""
        return [z[:, :, -1] for z in self.columns]

    @property
    def least_p(self) -> float:
        """No smaller chance than independent stretches of the record can support."""
        return float(0.5 ** (sum(len(k) for k in self.knots) / MEMORY))

    @property
    def free(self) -> int:
        """Number of unknowns of the fit."""
        return self.columns[0].shape[2] - 1


@dataclass(frozen=True)
class Answers:
    """What forces in one equation do to the outputs.

    Attributes
    ----------
    H, G
        Responses to hats at the knots and to terms, of each trial; (n, n_y, K), (n, n_y, n_G).
    hats, forces
        The same forces themselves [SI]; (n, K), (n, n_G).
    mixing
        Combinations of terms that answer apart, all of one size; (n_G, q).
    """

    row: str
    terms: tuple[Term, ...]
    H: tuple[Vector, ...]
    G: tuple[Vector, ...]
    hats: tuple[Vector, ...]
    forces: tuple[Vector, ...]
    mixing: Vector

    @property
    def mixed(self) -> list[Vector]:
        """Responses to those combinations; (n, n_y, q) each."""
        return [g @ self.mixing for g in self.G]


def force_record(fit: Fit) -> Record:
    """The record that forces are sought in.

    Knots stand sqrt(L/g) apart, the time a ship of this length needs to answer; between two of
    them the clock has `FINENESS` steps, over which faster records are averaged.
    """
    trials = fit.problem.trials
    p, period = fit.problem.simulator.model.ship.particulars, trials[0].period
    duration = sum(t.duration for t in trials)
    spacing = max(float(np.sqrt(p["L"] / p["g"])), duration / MOST_KNOTS, 4.0 * period)
    every = max(int(spacing / FINENESS / period), 1)
    paths = tuple(path(fit, i, every) for i in range(len(trials)))
    knots = tuple(np.arange(0.0, x.t[-1] + spacing, spacing) for x in paths)
    pieces = [_thinned(fit, i, every) for i in range(len(trials))]
    compared = tuple(m for _, m in pieces)
    return Record(paths, knots, tuple(z for z, _ in pieces), compared, order_for(compared))


def _thinned(fit: Fit, index: int, every: int) -> tuple[Vector, Mask]:
    """Gradient and residual of one trial as means about each tick of the clock; (n, n_y, ...)."""
    both = np.column_stack([fit.psi, fit.residual])
    ticks = len(range(0, fit.problem.trials[index].samples, every))
    mine = [s for s in stretches(fit.problem) if s.trial == index]
    z, m = np.zeros((ticks, len(mine), both.shape[1])), np.zeros((ticks, len(mine)), dtype=bool)
    for s in mine:
        tick = np.minimum((np.flatnonzero(s.compared) + every // 2) // every, ticks - 1)
        count = np.bincount(tick, minlength=ticks)
        m[:, s.output] = 2 * count >= every
        np.add.at(z[:, s.output], tick, both[s.rows])
        z[:, s.output] *= (m[:, s.output] / np.maximum(count, 1))[:, None]
    return z, m


def answers(record: Record, row: str) -> Answers:
    """Responses to hats at the knots and to terms, each of unit size over the record.

    A term that moves nothing is left out.
    """
    known = tuple(n for n in record.paths[0].signals if all(_whole(p, n) for p in record.paths))
    terms = dictionary(row, known)
    hats, forces, H, G = [], [], [], []
    for p, knots in zip(record.paths, record.knots, strict=True):
        x = prime_signals(p.signals)
        hats.append(np.maximum(1.0 - np.abs(p.t[:, None] - knots) / (knots[1] - knots[0]), 0.0))
        forces.append(np.column_stack([pressure(row, p.signals) * t.of(x) for t in terms]))
        both = response(p, row, np.concatenate([hats[-1], forces[-1]], axis=1))
        H.append(both[:, :, : len(knots)])
        G.append(both[:, :, len(knots) :])
    # the size of a hat is that of all hats, a term's its own: a knot early in a trial shows more
    knot = float(np.sqrt(np.mean([np.sum(h**2, axis=(0, 1)).mean() for h in H]))) or 1.0
    size = np.sqrt(np.sum([np.sum(g**2, axis=(0, 1)) for g in G], axis=0))
    seen = size > 0.0
    G = [g[:, :, seen] / size[seen] for g in G]
    return Answers(
        row=row,
        terms=tuple(t for t, s in zip(terms, seen, strict=True) if s),
        H=tuple(h / knot for h in H),
        G=tuple(G),
        hats=tuple(h / knot for h in hats),
        forces=tuple(f[:, seen] / size[seen] for f in forces),
        mixing=_apart(G),
    )


def _whole(path: Path, signal: str) -> bool:
    """Whether a trial has this signal all the time."""
    return signal in path.signals and bool(np.all(np.isfinite(path.signals[signal])))


def _apart(G: Sequence[Vector]) -> Vector:
    """Combinations of columns of unit size that answer apart; (n_G, q)."""
    w, U = np.linalg.eigh(np.sum([np.tensordot(g, g, ((0, 1), (0, 1))) for g in G], axis=0))
    return np.asarray(U[:, w > DISTINCT * w.max(initial=0.0)])
