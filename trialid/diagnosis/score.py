"""Which physical effect is missing: the score test on augmented sensitivities.

What the fitted parameters, nuisances included, could mimic is projected out of every candidate's
sensitivity; what remains is compared with the residual. The residual is coloured, so both are
whitened by an autoregression first, and the variance of the score is of the HAC kind.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.special import chdtrc  # scipy.stats would take another 0.4 s to import

from trialid.accuracy import Stretch
from trialid.diagnosis.augment import Augmented, augment, linear_parameters
from trialid.diagnosis.residual import effective_samples
from trialid.identification.fit import Fit
from trialid.ship.effect import Effect

Vector = NDArray[np.float64]
Mask = NDArray[np.bool_]

WINDOW_SHARE: Final = 1.0 / 20.0
"""Lag window of the score's variance over the length of the trials: 60 s of 20 minutes, a few times
the memory of waves and gusts, at full scale and, by Froude's law, at any other."""

WHITENING_SHARE: Final = 1.0 / 6.0
"""Memory of the autoregression that whitens the residual, over the lag window."""

VISIBLE: Final = 0.001
"""Below this share of its sensitivity left, an effect cannot be told from the free parameters."""


@dataclass(frozen=True)
class Candidate:
    """One effect the model lacks, and what the record says of it.

    Attributes
    ----------
    expected
        Parameter values by linearisation.
    eps_predicted
        eps_RMSn by linearisation with the effect in the model.
    p_value
        Of the score test, corrected for the whole catalogue (Holm).
    visibility
        Share of the effect's sensitivity that no free parameter can mimic.
    score
        The test statistic, chi-square of as many degrees as parameters.
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
    """Residual and candidate columns with everything the base columns reach taken out."""

    residual: Vector
    S: Vector

    def of(self, which: Sequence[int], sizes: Vector) -> Vector:
        """Some columns in units of their size; (M, q)."""
        return np.asarray(self.S[:, which] / sizes)


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
    if not augmented.effects:
        return (), augmented
    raw = project(augmented.residual, augmented.psi, augmented.S)
    residual, psi, S, parts = whitened(augmented)
    white = project(residual, psi, S)
    made = [_score(fit, augmented, effect, raw, white, parts) for effect in augmented.effects]
    scored = _families(_holm([c for c in made if c is not None]), augmented, white.S, family_cos)
    samples = effective_samples(fit)

    def standing(c: Candidate) -> tuple[bool, bool, float]:
        return not c.allowed, c.p_value >= level, cost(c.eps_predicted, len(c.expected), samples)

    return tuple(sorted(scored, key=standing)), augmented


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
    return Projected(residual - Q @ (Q.T @ residual), S - Q @ (Q.T @ S))


def lag_window(parts: Sequence[Stretch]) -> int:
    """Samples over which products of residual and sensitivity may be correlated."""
    lengths = {s.trial: len(s.compared) for s in parts}
    return max(round(WINDOW_SHARE * float(np.mean(list(lengths.values())))), 1)


def whitened(augmented: Augmented) -> tuple[Vector, Vector, Vector, tuple[Stretch, ...]]:
    """Residual, base and candidate columns filtered by the inverse of the residual's colour."""
    order = max(round(WHITENING_SHARE * lag_window(augmented.stretches)), 1)
    filters = _autoregressions(augmented, order)
    rows, made, at = [], [], 0
    every = np.column_stack([augmented.residual, augmented.psi, augmented.S])
    for stretch in augmented.stretches:
        full = np.zeros((len(stretch.compared), every.shape[1]))
        full[stretch.compared] = every[stretch.rows]
        out, valid = _filtered(full, stretch.compared, filters[stretch.output])
        count = int(valid.sum())
        rows.append(out[valid])
        made.append(Stretch(stretch.trial, stretch.output, slice(at, at + count), valid))
        at += count
    done = np.concatenate(rows)
    n = augmented.psi.shape[1]
    return done[:, 0], done[:, 1 : n + 1], done[:, n + 1 :], tuple(made)


def _autoregressions(augmented: Augmented, order: int) -> dict[int, Vector]:
    """Coefficients 1, -a_1, ... of each output's residual, by least squares over all trials."""
    filters = {}
    for output in sorted({s.output for s in augmented.stretches}):
        targets, lags = [], []
        for stretch in augmented.stretches:
            if stretch.output == output:
                e = np.zeros(len(stretch.compared))
                e[stretch.compared] = augmented.residual[stretch.rows]
                past = np.lib.stride_tricks.sliding_window_view(e, order)[:-1, ::-1]
                whole = np.lib.stride_tricks.sliding_window_view(stretch.compared, order + 1)
                keep = whole.all(axis=1)
                targets.append(e[order:][keep])
                lags.append(past[keep])
        X, y = np.concatenate(lags), np.concatenate(targets)
        if len(y) < 4 * order:
            filters[output] = np.array([1.0])
            continue
        a, *_ = np.linalg.lstsq(X, y, rcond=None)
        scale = float(np.std(y - X @ a)) or 1.0
        filters[output] = np.concatenate([[1.0], -a]) / scale
    return filters


def _filtered(full: Vector, compared: Mask, a: Vector) -> tuple[Vector, Mask]:
    """FIR-filtered columns, and where every tap fell on a compared sample."""
    n, reach = len(full), len(a) - 1
    out, valid = np.zeros_like(full), np.zeros(n, dtype=bool)
    valid[reach:] = True
    for k, tap in enumerate(a):
        out[reach:] += tap * full[reach - k : n - k]
        valid[reach:] &= compared[reach - k : n - k]
    return out, valid


def _score(
    fit: Fit,
    augmented: Augmented,
    effect: Effect,
    raw: Projected,
    white: Projected,
    parts: Sequence[Stretch],
) -> Candidate | None:
    """The score test of one effect; None when it leaves no trace at all."""
    names = linear_parameters(effect)
    which = [augmented.columns.index(p) for p in names]
    sizes = np.linalg.norm(augmented.S[:, which], axis=0)
    if not np.all(sizes > 0.0):
        return None
    visibility = float(np.mean(np.sum(raw.of(which, sizes) ** 2, axis=0)))
    # expected value and fall from the residual as it is: the whitening is estimated from a residual
    # that holds the effect, and may take a strong one away; the test of chance needs the whitening
    beta, fall = _explained(raw, which, sizes)
    s, e = white.of(which, sizes), white.residual
    # with the effect's own scatter in the variance: a large effect scores less than it could,
    # and noise is taken for one less often (measured: 1 of 16 records instead of 3)
    variance = hac(s * e[:, None], parts)
    g = s.T @ e
    score = float(g @ np.linalg.pinv(variance, rcond=1e-10, hermitian=True) @ g)
    expected = {p: float(b / z) for p, b, z in zip(names, beta, sizes, strict=True)}
    visible = visibility > VISIBLE
    eps2 = max(fit.eps_rmsn**2 - (fall if visible else 0.0), 0.0)
    p = max(float(chdtrc(len(which), score)), _least_p(parts)) if visible else 1.0
    return Candidate(
        effect, expected, float(np.sqrt(eps2)), score, p, visibility, (effect.name,),
        _allowed(effect, expected),
    )  # fmt: skip


def _least_p(parts: Sequence[Stretch]) -> float:
    """No smaller chance than the record's independent blocks can support: all of one sign."""
    lengths = {s.trial: len(s.compared) for s in parts}
    return float(0.5 ** (sum(lengths.values()) / lag_window(parts)))


def _explained(raw: Projected, which: Sequence[int], sizes: Vector) -> tuple[Vector, float]:
    """Coefficients in units of the sizes, and the fall of eps_RMSn^2, by linearisation."""
    s = raw.of(which, sizes)
    beta = np.asarray(np.linalg.lstsq(s, raw.residual, rcond=1e-10)[0])
    return beta, float(raw.residual @ (s @ beta))


def _allowed(effect: Effect, expected: Mapping[str, float]) -> bool:
    return all(
        effect.parameters[n].low <= x <= effect.parameters[n].high for n, x in expected.items()
    )


def hac(products: Vector, parts: Sequence[Stretch]) -> Vector:
    """Variance of a sum of correlated products; (q, q), Bartlett weights.

    The outputs of one trial share their disturbances, so their products are added on the clock.
    """
    lags = lag_window(parts)
    total = np.zeros((products.shape[1],) * 2)
    for trial in sorted({s.trial for s in parts}):
        mine = [s for s in parts if s.trial == trial]
        m = np.zeros((max(len(s.compared) for s in mine), products.shape[1]))
        for stretch in mine:
            m[stretch.compared] += products[stretch.rows]
        total += _long_run(m, lags)
    return total


def _long_run(m: Vector, lags: int) -> Vector:
    n = len(m)
    size = 1 << (n + lags).bit_length()
    spectrum = np.fft.rfft(m, size, axis=0)
    weights = np.maximum(1.0 - np.arange(lags + 1) / (lags + 1), 0.0)
    result = np.zeros((m.shape[1],) * 2)
    for i in range(m.shape[1]):
        for j in range(m.shape[1]):
            c = np.fft.irfft(spectrum[:, i].conj() * spectrum[:, j], size)
            result[i, j] = float(
                weights[0] * c[0] + weights[1:] @ (c[1 : lags + 1] + c[size - lags :][::-1])
            )
    return result


def _holm(scored: Sequence[Candidate]) -> list[Candidate]:
    """Holm's correction over the whole catalogue: family-wise error of all the tests at once."""
    order = sorted(range(len(scored)), key=lambda i: scored[i].p_value)
    corrected = dict[int, float]()
    largest = 0.0
    for rank_, i in enumerate(order):
        largest = max(largest, min(1.0, scored[i].p_value * (len(scored) - rank_)))
        corrected[i] = largest
    return [replace(c, p_value=corrected[i]) for i, c in enumerate(scored)]


def _families(
    scored: Sequence[Candidate], augmented: Augmented, S: Vector, limit: float
) -> list[Candidate]:
    """Name with each candidate those whose visible traces are nearly parallel to its own."""
    bases = {}
    for c in scored:
        columns = [augmented.columns.index(p) for p in c.expected]
        Q, _ = np.linalg.qr(
            S[:, columns] / np.maximum(np.linalg.norm(S[:, columns], axis=0), 1e-300)
        )
        bases[c.effect.name] = Q
    result = []
    for c in scored:
        mine = bases[c.effect.name]
        alike = [
            other.effect.name
            for other in scored
            if other is not c
            and other.visibility > VISIBLE
            and float(np.linalg.norm(mine.T @ bases[other.effect.name], 2)) > limit
        ]
        result.append(replace(c, family=(c.effect.name, *alike)))
    return result
