"""Which physical effect is missing: the score test on augmented sensitivities.

What the fitted parameters, nuisances included, could mimic is projected out of every candidate's
trace; what remains is compared with the residual. The residual is coloured, so both are whitened
by an autoregression first, and what chance can do is drawn over blocks of time.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.diagnosis.augment import Augmented, Trace, augment
from trialid.diagnosis.chance import Chance, against_chance
from trialid.diagnosis.residual import effective_samples
from trialid.diagnosis.whitening import whitened
from trialid.identification.fit import Fit
from trialid.ship.effect import Effect

Vector = NDArray[np.float64]

VISIBLE: Final = 0.001
"""Below this share of its sensitivity left, an effect cannot be told from the free parameters."""


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
    allowed
        Whether the expected values lie in their physical range.
    """

    effect: Effect
    expected: Mapping[str, float]
    eps_predicted: float
    score: float
    p_value: float
    visibility: float
    family: tuple[str, ...]
    allowed: bool


@dataclass(frozen=True)
class Projected:
    """Residual and candidate columns with everything the base columns reach taken out.

    `Q` are orthonormal columns of what the base reaches.
    """

    residual: Vector
    S: Vector
    Q: Vector


def rank(
    fit: Fit, catalogue: Mapping[str, Effect], family_cos: float = 0.9, level: float = 0.05
) -> tuple[tuple[Candidate, ...], Augmented]:
    """Candidates by how much of the error they would explain, best first.

    Those that stand out against chance and are physical come before the others: the test says
    whether there is an effect, the fall of the error which.

    Parameters
    ----------
    family_cos
        |cos| between visible traces from which on two effects are one family.
    level
        Family-wise error rate over the whole catalogue.
    """
    augmented = augment(fit, catalogue)
    if not augmented.traces:
        return (), augmented
    raw = project(augmented.residual, augmented.psi, augmented.S)
    residual, psi, S, parts = whitened(augmented)
    white = project(residual, psi, S)
    seen = [t for t in augmented.traces if _leaves_a_trace(augmented, t)]
    visible = [t for t in seen if _visibility(augmented, raw, t) > VISIBLE]
    groups = [t.columns for t in visible]
    chances = against_chance(white.residual, white.Q, white.S, groups, parts)
    tested = dict(zip(map(id, visible), chances, strict=True))
    never = Chance(0.0, 1.0)
    made = [_candidate(fit, augmented, raw, t, tested.get(id(t), never)) for t in seen]
    samples = effective_samples(fit)

    def standing(c: Candidate) -> tuple[bool, bool, float]:
        return not c.allowed, c.p_value >= level, price(c, samples)

    scored = _families(_best_of_each(made), augmented, white.S, family_cos)
    return tuple(sorted(scored, key=standing)), augmented


def price(c: Candidate, samples: float) -> float:
    """Schwarz's cost of the model with this effect, by linearisation."""
    return cost(c.eps_predicted, len(c.effect.parameters), samples)


def cost(eps: float, parameters: int, samples: float) -> float:
    """Schwarz (1978): twice the negative log likelihood, each parameter at the price of ln(N).

    >>> cost(0.04, 1, 1000.0) < cost(0.04, 4, 1000.0) < cost(0.05, 1, 1000.0)
    True
    """
    return samples * 2.0 * float(np.log(max(eps, 1e-300))) + parameters * float(np.log(samples))


def project(residual: Vector, psi: Vector, S: Vector) -> Projected:
    """Take out of the residual and the candidates what the base columns reach."""
    norms = np.linalg.norm(psi, axis=0)
    Q, _ = np.linalg.qr(psi[:, norms > 0.0] / norms[norms > 0.0])
    return Projected(residual - Q @ (Q.T @ residual), S - Q @ (Q.T @ S), Q)


def _leaves_a_trace(augmented: Augmented, trace: Trace) -> bool:
    return bool(np.all(np.any(augmented.S[:, trace.columns] != 0.0, axis=0)))


def _visibility(augmented: Augmented, raw: Projected, trace: Trace) -> float:
    """Share of the squared trace left when the base columns have taken theirs, over columns."""
    whole = np.sum(augmented.S[:, trace.columns] ** 2, axis=0)
    return float(np.mean(np.sum(raw.S[:, trace.columns] ** 2, axis=0) / whole))


def _candidate(
    fit: Fit, augmented: Augmented, raw: Projected, trace: Trace, chance: Chance
) -> Candidate:
    """What one trace of an effect says.

    Value and fall come from the residual as it is: the whitening is estimated from a residual that
    holds the effect, and may take a strong one away; only the test of chance needs it.
    """
    visibility = _visibility(augmented, raw, trace)
    values, fall = _tried(raw, trace) if trace.tried else _explained(raw, trace)
    eps2 = max(fit.eps_rmsn**2 - (fall if visibility > VISIBLE else 0.0), 0.0)
    inside = all(trace.effect.parameters[n].low <= x <= trace.effect.parameters[n].high
                 for n, x in values.items())  # fmt: skip
    return Candidate(
        trace.effect, values, float(np.sqrt(eps2)), chance.score, chance.p_value, visibility,
        (trace.effect.name,), inside and (fall > 0.0 or not trace.tried),
    )  # fmt: skip


def _explained(raw: Projected, trace: Trace) -> tuple[dict[str, float], float]:
    """Parameter values, and the fall of eps_RMSn^2, by linearisation."""
    s = raw.S[:, trace.columns]
    sizes = np.maximum(np.linalg.norm(s, axis=0), 1e-300)
    beta = np.asarray(np.linalg.lstsq(s / sizes, raw.residual, rcond=1e-10)[0]) / sizes
    values = dict(zip(trace.parameters, map(float, beta), strict=True))
    return values, float(raw.residual @ (s @ beta))


def _tried(raw: Projected, trace: Trace) -> tuple[dict[str, float], float]:
    """The values tried, and the fall of eps_RMSn^2 with the effect at just these values."""
    [s] = raw.S[:, trace.columns].T
    return dict(trace.tried), float(2.0 * (raw.residual @ s) - s @ s)


def _best_of_each(made: Sequence[Candidate]) -> list[Candidate]:
    """Of every value tried for an effect the one that explains most; the chance of any of them."""
    best: dict[str, Candidate] = {}
    for c in made:
        known = best.get(c.effect.name)
        if known is None:
            best[c.effect.name] = c
        else:
            better = min(known, c, key=lambda x: x.eps_predicted)
            sure = min(known.p_value, c.p_value)
            best[c.effect.name] = replace(better, p_value=sure, score=max(known.score, c.score))
    return list(best.values())


def _families(
    scored: Sequence[Candidate], augmented: Augmented, S: Vector, limit: float
) -> list[Candidate]:
    """Name with each candidate those whose visible traces are nearly parallel to its own."""
    gram = S.T @ S
    columns = {c.effect.name: _columns(c, augmented) for c in scored}
    scales = {n: _inverse_root(gram[np.ix_(at, at)]) for n, at in columns.items()}

    def alike(one: Candidate, other: Candidate) -> bool:
        a, b = one.effect.name, other.effect.name
        shared = gram[np.ix_(columns[a], columns[b])]
        return float(np.linalg.norm(scales[a] @ shared @ scales[b].T, 2)) > limit

    return [
        replace(c, family=(c.effect.name, *(
            o.effect.name
            for o in scored
            if o is not c and o.visibility > VISIBLE and alike(c, o)
        )))
        for c in scored
    ]  # fmt: skip


def _columns(c: Candidate, augmented: Augmented) -> tuple[int, ...]:
    """Where the trace stands that the candidate was made of."""
    [trace] = [
        t
        for t in augmented.traces
        if t.effect.name == c.effect.name and (not t.tried or dict(t.tried) == dict(c.expected))
    ]
    return trace.columns


def _inverse_root(gram: Vector) -> Vector:
    """A^-1/2 of what is not singular in a Gram matrix; (q, q)."""
    sizes = np.sqrt(np.maximum(np.diag(gram), 1e-300))
    values, vectors = np.linalg.eigh(gram / np.outer(sizes, sizes))
    kept = values > 1e-10 * values[-1]
    root = (vectors[:, kept] / np.sqrt(values[kept])) @ vectors[:, kept].T
    return np.asarray(root / sizes)
