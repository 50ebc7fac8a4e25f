"""Which physical effect is missing: the score test on augmented sensitivities.

What the fitted parameters, nuisances included, could mimic is projected out of every candidate's
trace; what remains is compared with the residual. The residual is coloured, so both are whitened
by an autoregression first, and what chance can do is drawn over blocks of time. That says whether
there is an effect; which one, `carry_over` says by the error that goes on blocks left out.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.diagnosis.search.augment import Augmented, Trace, augment
from trialid.diagnosis.search.carried import Carried
from trialid.diagnosis.search.carry_over import left_out
from trialid.diagnosis.search.p_value import Chance, against_chance
from trialid.diagnosis.search.projection import Evidence, Projected, least_squares_fall
from trialid.identification.fit import Fit
from trialid.ship.effect import Effect

Vector = NDArray[np.float64]

VISIBLE: Final = 0.001
"""Below this share of its sensitivity left, an effect cannot be told from the free parameters."""


OUTSIDE: Final = 2.5
"""Standard errors by which a value must lie outside its range to be unphysical."""


@dataclass(frozen=True)
class Candidate:
    """One effect the model lacks, and what the record says of it.

    Attributes
    ----------
    expected
        Parameter values by linearisation, or the best of those tried.
    eps_predicted
        eps_RMSn by linearisation with the effect in the model.
    score
        The test statistic, chi-square of as many degrees as parameters.
    p_value
        How often chance alone would give the best of the catalogue such a score.
    visibility
        Share of the effect's trace that no free parameter can mimic.
    family
        Effects this record cannot separate from it, |cos| above the limit.
    cosines
        |cos| between its visible trace and that of each other member of the family.
    allowed
        Whether the expected values lie in their physical range, chance apart.
    carried
        What it does to the error of blocks that did not choose its coefficients.
    """

    effect: Effect
    expected: Mapping[str, float]
    eps_predicted: float
    score: float
    p_value: float
    visibility: float
    family: tuple[str, ...]
    allowed: bool
    cosines: Mapping[str, float] = field(default_factory=dict)
    carried: Carried = field(default_factory=lambda: Carried((), ()))

    @property
    def price(self) -> float:
        """What it is ordered by, the least first.

        The log of the error that is left where it was not fitted, by how much of its trace is
        seen, and something for each further parameter.
        """
        return self.carried.price(len(self.effect.parameters))

    def shown(self, level: float) -> bool:
        """Whether it is there: by the test, or by the blocks left out, one like the other.

        Of what the free parameters can mimic blocks tell nothing: with it these are others where
        they were fitted, and what that does elsewhere is theirs.
        """
        by_blocks = self.carried.large and self.visibility > VISIBLE
        return self.allowed and (self.p_value < level or by_blocks)

    def worth_a_name(self, level: float) -> bool:
        """Whether it is there and so much of it carries over that somebody would notice."""
        return self.shown(level) and self.carried.falls


def rank(
    fit: Fit, catalogue: Mapping[str, Effect], family_cos: float = 0.9, level: float = 0.05
) -> tuple[tuple[Candidate, ...], Augmented]:
    """The `ranking_of` a catalogue, and the traces that they were ranked by."""
    augmented = augment(fit, catalogue)
    return ranking_of(fit, augmented, family_cos, level), augmented


def ranking_of(
    fit: Fit, augmented: Augmented, family_cos: float, level: float
) -> tuple[Candidate, ...]:
    """Candidates by how much of the error they take away where they were not fitted, best first.

    Those that are physical, stand out against chance and are worth a name come before the others:
    the test says whether there is an effect, the fall that carries over which.

    Parameters
    ----------
    augmented
        Of this fit, or of one to means of its samples.
    family_cos
        |cos| between visible traces from which on two effects are one family.
    level
        Family-wise error rate over the whole catalogue.
    """
    seen = [t for t in augmented.traces if _leaves_a_trace(augmented, t)]
    if not seen:
        return ()
    evidence = augmented.evidence
    visible = [t for t in seen if _visibility(augmented, t) > VISIBLE]
    white = evidence.white
    groups = [t.columns for t in visible]
    chances = against_chance(white.residual, white.Q, white.S, groups, evidence.parts)
    tested = dict(zip(map(id, visible), chances, strict=True))
    blocks = left_out(
        augmented.fit, augmented.residual, augmented.psi, augmented.S, augmented.stretches
    )
    made = [
        replace(_candidate(fit, augmented, t, tested.get(id(t))), carried=blocks.carried(t.columns))
        for t in seen
    ]

    def standing(c: Candidate) -> tuple[bool, bool, bool, float]:
        return not c.allowed, not c.worth_a_name(level), not c.shown(level), c.price

    scored = _families(_best_of_each(made), augmented, family_cos)
    return tuple(sorted(scored, key=standing))


def _leaves_a_trace(augmented: Augmented, trace: Trace) -> bool:
    return bool(np.all(np.any(augmented.S[:, trace.columns] != 0.0, axis=0)))


def _visibility(augmented: Augmented, trace: Trace) -> float:
    """Share of the squared trace left when the base columns have taken theirs, over columns."""
    whole = np.sum(augmented.S[:, trace.columns] ** 2, axis=0)
    left = np.sum(augmented.evidence.raw.S[:, trace.columns] ** 2, axis=0)
    return float(np.mean(left / whole))


def _candidate(fit: Fit, augmented: Augmented, trace: Trace, chance: Chance | None) -> Candidate:
    """What one trace of an effect says; one that is not visible explains nothing.

    Value and fall come from the residual as it is: they are what a refit will find.
    """
    evidence = augmented.evidence
    values, fall = _explained(evidence.raw, trace)
    if chance is None:
        chance, fall = Chance(0.0, 1.0), 0.0
    return Candidate(
        effect=trace.effect,
        expected=values,
        eps_predicted=float(np.sqrt(max(fit.eps_rmsn**2 - fall, 0.0))),
        score=chance.score,
        p_value=chance.p_value,
        visibility=_visibility(augmented, trace),
        family=(trace.effect.name,),
        allowed=fall > 0.0 if trace.tried else _in_range(evidence, trace),
    )


def _in_range(evidence: Evidence, trace: Trace) -> bool:
    """Whether no parameter lies outside its physical range by more than chance would put it there.

    By the whitened rows, which know the values best: a weakly seen term of several must not reject
    the others, and a wrong sign of a single one is as sure as its score.
    """
    rows, parameters = evidence.white, trace.effect.parameters
    beta, _ = least_squares_fall(rows, trace.columns)
    gram = rows.gram[np.ix_(trace.columns, trace.columns)]
    sizes = np.sqrt(np.maximum(np.diag(gram), 1e-300))
    inverse = np.linalg.pinv(gram / np.outer(sizes, sizes), rcond=1e-10, hermitian=True)
    errors = np.sqrt(evidence.inflation * np.diag(inverse)) / sizes
    return all(
        parameters[n].low - OUTSIDE * e <= x <= parameters[n].high + OUTSIDE * e
        for (n, x), e in zip(_values(trace, beta).items(), errors, strict=True)
    )


def _explained(rows: Projected, trace: Trace) -> tuple[dict[str, float], float]:
    """Parameter values, and the fall of the sum of squares, by linearisation or as tried."""
    if trace.tried:
        [i] = trace.columns
        return dict(trace.tried), float(2.0 * rows.moment[i] - rows.gram[i, i])
    beta, fall = least_squares_fall(rows, trace.columns)
    return _values(trace, beta), fall


def _values(trace: Trace, beta: Vector) -> dict[str, float]:
    """The parameters, by how far they are from where the effect is absent or held."""
    nulls = trace.effect.nulls
    return {n: nulls[n] + float(x) for n, x in zip(trace.parameters, beta, strict=True)}


def _best_of_each(made: Sequence[Candidate]) -> list[Candidate]:
    """Of every value tried for an effect the one that carries over; the chance of any of them."""
    best: dict[str, Candidate] = {}
    for c in made:
        known = best.get(c.effect.name)
        if known is None:
            best[c.effect.name] = c
        else:
            better = min(known, c, key=lambda x: (not x.allowed, x.price))
            sure = min(known.p_value, c.p_value)
            best[c.effect.name] = replace(better, p_value=sure, score=max(known.score, c.score))
    return list(best.values())


def _families(scored: Sequence[Candidate], augmented: Augmented, limit: float) -> list[Candidate]:
    """Name with each candidate those whose visible traces are nearly parallel to its own."""
    gram = augmented.evidence.white.gram
    columns = {c.effect.name: _columns(c, augmented) for c in scored}
    sizes = np.sqrt(np.maximum(np.diag(gram), 1e-300))
    alone = np.abs(gram / np.outer(sizes, sizes))  # most have one column
    scales = {n: _inverse_root(gram[np.ix_(at, at)]) for n, at in columns.items() if len(at) > 1}

    def cosine(one: Candidate, other: Candidate) -> float:
        a, b = columns[one.effect.name], columns[other.effect.name]
        if len(a) == len(b) == 1:
            return float(alone[a[0], b[0]])
        left, right = (
            scales.get(x.effect.name, np.array([[1.0 / sizes[at[0]]]]))
            for x, at in ((one, a), (other, b))
        )
        cosines = left @ gram[np.ix_(a, b)] @ right.T
        if min(cosines.shape) == 1:  # a vector's length, without a decomposition
            return float(np.sqrt(np.sum(cosines**2)))
        return float(np.linalg.norm(cosines, 2))

    def alike(c: Candidate) -> dict[str, float]:
        others = [o for o in scored if o is not c and o.visibility > VISIBLE]
        found = {o.effect.name: cosine(c, o) for o in others}
        return {name: min(cos, 1.0) for name, cos in found.items() if cos > limit}

    return [
        replace(c, family=(c.effect.name, *near), cosines=near)
        for c, near in zip(scored, map(alike, scored), strict=True)
    ]


def _columns(c: Candidate, augmented: Augmented) -> tuple[int, ...]:
    """Where the trace stands that the candidate was made of."""
    own = [t for t in augmented.traces if t.effect.name == c.effect.name]
    exact = [t for t in own if t.tried and dict(t.tried) == dict(c.expected)]
    trace = (exact or own)[0]
    return trace.columns


def _inverse_root(gram: Vector) -> Vector:
    """A^-1/2 of what is not singular in a Gram matrix; (q, q)."""
    sizes = np.sqrt(np.maximum(np.diag(gram), 1e-300))
    values, vectors = np.linalg.eigh(gram / np.outer(sizes, sizes))
    kept = values > 1e-10 * values[-1]
    root = (vectors[:, kept] / np.sqrt(values[kept])) @ vectors[:, kept].T
    return np.asarray(root / sizes)
