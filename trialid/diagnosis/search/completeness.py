"""Whether the catalogue holds what is missing: its best effects against forces of any shape."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.special import chdtrc, chdtri  # scipy.stats would take another 0.4 s to import

from trialid.diagnosis.force.force_terms import MOTIONS
from trialid.diagnosis.noise.whitening import whiten_columns
from trialid.diagnosis.search.augment import Augmented
from trialid.diagnosis.search.carried import Carried
from trialid.diagnosis.search.carry_over import left_out
from trialid.diagnosis.search.projection import (
    Evidence,
    Projected,
    gather,
    likeliest,
    products,
    remainder,
    residual_after,
    take_out,
)
from trialid.diagnosis.search.simple_forces import Probes, probes
from trialid.ship.rigid_body import ROWS

Vector = NDArray[np.float64]
Group = tuple[int, ...]

STEPS: Final = 3
"""Effects, or forces, that may be missing at once."""

WORTH: Final = 30.0
"""Twice the log likelihood by which forces of any shape must be better to speak of a gap: gusts and
swell push a ship about by forces that no rudder explains, and among hundreds of shapes one fits. In
fifty such records with nothing missing the most was 27; what really is outside gains 40 and more,
but in one record 22. Half claims a gap in one of twenty-five, twice misses a kinked heel moment."""

SEEN: Final = 1e-3
"""Share of a column's length that the parameters must leave of it: less is what rounding left."""

NEARLY: Final = 0.75
"""Share of a force's fall, as a logarithm, that a named effect must take off to keep its name. Half
names drag for a kinked heel moment; at the whole a function of eleven knots takes names away."""

SHARE: Final = 0.25
"""Share of what they gain that the catalogue must miss."""

TOGETHER: Final = 1 << 13
"""Rows whose products are summed at once: with 300 columns 10 MB."""


@dataclass(frozen=True)
class Completeness:
    """What the catalogue explains, and what forces of any simple shape would.

    Both are gains in twice the log likelihood, with every coefficient and the search at their
    price. `carried` is what of the best force carries over, where there is a gap; `closed` says
    that there is none once what the catalogue does best is fitted.
    """

    catalogue: float
    any_shape: float
    carried: Carried | None = None
    closed: bool = False

    @property
    def gap(self) -> bool:
        """Whether the catalogue misses much of what can be explained."""
        missed = 0.0 if self.closed else self.any_shape - self.catalogue
        return missed > max(WORTH, SHARE * self.any_shape)

    @property
    def carries_over(self) -> bool:
        """Whether there is a gap, and most blocks that were left out follow its best force better.

        Among hundreds of shapes there is one that most follow by chance. Of 23 gaps of hidden
        forces each had four of six blocks at least. Of a linear ship in a sea a gap was claimed for
        a force of 57 in twice the log likelihood, and two of six follow the best one better.
        """
        return self.gap and (self.carried is None or self.carried.in_most)

    def outdoes(self, named: Carried) -> bool:
        """Whether there is a gap beside a named effect: the force takes far more off what is left.

        Likelihood of whitened residuals is won by what is fast; what is named takes off more.
        """
        if not self.carries_over or self.carried is None:
            return self.carries_over
        return named.log_ratio > NEARLY * self.carried.log_ratio


def completeness(augmented: Augmented) -> Completeness | None:
    """Forward selection from the catalogue, and from the catalogue and forces of any shape.

    None where there is nothing to compare, no equation that a force acts in, or, as of a ship that
    only goes ahead, no motion that a force could follow.
    """
    equations = augmented.fit.problem.simulator.equations
    moved = set(ROWS) & set(equations.states)
    follows = set(MOTIONS) & {*equations.states, *equations.inputs}
    if not augmented.traces or not moved or not follows:
        return None
    tried = probes(augmented.fit)
    evidence = _with_colour(augmented, tried)
    white, _ = whiten_columns(tried.columns, augmented.stretches, evidence.colour)
    sizes = _lengths(white)
    take_out(evidence.white.Q, white)
    first = evidence.white.S.shape[1]
    effects_left = _lengths(evidence.raw.S) > SEEN * _lengths(augmented.S)
    probes_left = _lengths(white) > SEEN * sizes
    gram, moment = _sums(evidence.white.S, white, evidence.white.residual)
    seen = np.append(effects_left, probes_left)
    search = _Search(gram * np.outer(seen, seen), moment * seen, len(white), evidence.inflation)
    effects = [t.columns for t in augmented.traces]
    forces = [tuple(first + i for i in g) for g in tried.groups]
    found = Completeness(search.gain(effects, []), search.gain(effects, forces))
    return replace(found, carried=_best_force(augmented, tried)) if found.gap else found


def close_gap(whole: Completeness, augmented: Augmented) -> Completeness:
    """What the catalogue explains, by slopes of a model with its best in it too.

    Slopes are those of the model as it was fitted, and where much is missing at once that fit lies
    so far from the truth that they foretell little of it. A gap that goes with what the catalogue
    does best in the model was none.
    """
    again = completeness(augmented)
    return whole if again is None or again.gap else replace(whole, closed=True)


def _sums(effects: Vector, forces: Vector, residual: Vector) -> tuple[Vector, Vector]:
    """Products of all columns with each other and with the residual; (n, n) and (n,).

    A few rows at a time: one table of both would be as large as they are. In single precision, for
    there are thousands of sums and they are compared by their tenths; each column at a length near
    one, whose square such numbers can hold.
    """
    count = effects.shape[1] + forces.shape[1]
    near_one = np.exp2(-np.frexp(np.append(_lengths(effects), _lengths(forces)))[1])
    gram, moment = np.zeros((count, count)), np.zeros(count)
    for start in range(0, len(residual), TOGETHER):
        rows = slice(start, start + TOGETHER)
        Z = (np.hstack([effects[rows], forces[rows]]) * near_one).astype(np.float32)
        gram += Z.T @ Z
        moment += Z.T @ residual[rows].astype(np.float32)
    return gram, moment


def _lengths(columns: Vector) -> Vector:
    return np.sqrt(np.einsum("ij,ij->j", columns, columns))  # a norm would copy them


def _best_force(augmented: Augmented, tried: Probes) -> Carried:
    """What carries over of the force that leaves least on blocks that did not choose it."""
    blocks = left_out(
        augmented.fit, augmented.residual, augmented.psi, tried.columns, augmented.stretches
    )
    return min((blocks.carried(g) for g in tried.groups), key=lambda c: c.log_ratio)


def _with_colour(augmented: Augmented, tried: Probes) -> Evidence:
    """The evidence, by the noise's colour without the best force where that beats every effect.

    Else what is missing would pass for the colour of the noise, and nothing would show.
    """
    known = augmented.evidence
    Q, residual = known.raw.Q, known.raw.residual
    gram, moment = products(Q, tried.columns, residual)
    forces = Projected(residual, tried.columns, Q, gram, moment)
    effects = [t.columns for t in augmented.traces]
    _, cost = likeliest(known.raw, effects, augmented.stretches)
    force, force_cost = likeliest(forces, tried.groups, augmented.stretches)
    if force_cost >= cost:
        return known
    noise = remainder(Q, residual_after(forces, force)[:, None])[:, 0]
    return gather(
        augmented.residual, augmented.psi, augmented.S, augmented.stretches, effects, noise
    )


@dataclass(frozen=True)
class _Search:
    """Sums of products of whitened columns, and what a gain has to pay."""

    gram: Vector
    moment: Vector
    rows: int
    inflation: float

    def gain(self, effects: Sequence[Group], forces: Sequence[Group]) -> float:
        """What a forward selection gains; effects and forces pay for the search among their own.

        One coefficient pays ln N (Schwarz, 1978), several what is as rare by chance; each step
        pays 2 ln J for one of J (Chen & Chen, 2008).
        """
        steps = [(g, len(effects)) for g in effects] + [(g, len(forces)) for g in forces]
        chosen, total = list[int](), 0.0
        for _ in range(STEPS):
            known = self._explained(chosen)
            found = [
                (self._net(chosen, g, known) - 2.0 * np.log(among), g)
                for g, among in steps
                if not set(g) & set(chosen)
            ]
            gained, group = max(found, key=lambda x: x[0], default=(0.0, ()))
            if gained <= 0.0:
                break
            chosen += group
            total += float(gained)
        return total

    def _net(self, chosen: Sequence[int], group: Group, known: float) -> float:
        gain = (self._explained([*chosen, *group]) - known) / self.inflation
        return gain - float(chdtri(len(group), chdtrc(1, np.log(self.rows))))

    def _explained(self, columns: Sequence[int]) -> float:
        """Fall of the whitened sum of squares with these columns."""
        if not columns:
            return 0.0
        gram = self.gram[np.ix_(columns, columns)]
        sizes = np.sqrt(np.maximum(np.diag(gram), 1e-300))
        scaled = self.moment[list(columns)] / sizes
        inverse = np.linalg.pinv(gram / np.outer(sizes, sizes), rcond=1e-5, hermitian=True)
        return float(scaled @ inverse @ scaled)
