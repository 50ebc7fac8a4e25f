"""What a missing force is made of: signed powers and products, chosen one by one.

Each term is a force that the model answers to; the answers, not the force, are compared with the
residual, so that what is uncertain about the force counts little and what free parameters can mimic
counts nothing. What the chosen terms leave of the force stays in the reckoning as a course of its
own, as large as is likely: it makes neighbouring samples count as the few they are worth.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.special import chdtrc

from trialid.diagnosis.force.force_likelihood import (
    COURSE,
    MEMORIES,
    Intensity,
    sums,
    without_course,
)
from trialid.diagnosis.force.force_record import Answers, Record
from trialid.diagnosis.force.force_terms import Term, parameter, pressure, prime_signals
from trialid.diagnosis.noise.noise_colour import Colour

Vector = NDArray[np.float64]

MOST: Final = 3
"""Terms."""

WORTH: Final = 0.15
"""A further term must gain this share of what the first one did: a strong force, of which the
linear response is a sketch, leaves weak terms that mean nothing."""

DECISIVE: Final = 10.0
"""Difference of twice the log likelihood that decides: odds of 150 to 1, for the noise's colour is
an estimate itself."""

SKETCH: Final = 0.1
"""A rival is a term that gains nearly as much: the linear response to a strong force is off by
about this much."""

SEEN: Final = 1e-3
"""Share of a term's answer that neither parameters nor chosen terms can mimic, at least."""


@dataclass(frozen=True)
class ShapeTerm:
    """One term of a force with its primed coefficient.

    Attributes
    ----------
    share
        Share of the squared error that it takes up when it is added.
    p_value
        Chance of its gain in likelihood from noise, over the dictionary.
    rivals
        Terms that in its place are as likely, within odds of 20 to 1 or what linearising costs.
    """

    name: str
    term: Term
    coefficient: float
    error: float
    share: float
    gain: float
    p_value: float
    rivals: tuple[Term, ...]


@dataclass(frozen=True)
class Shape:
    """Terms of a force in the order in which they were found, and what they are looked for among.

    `explains` is the share of the squared error that they take up together.
    """

    terms: tuple[ShapeTerm, ...]
    tried: tuple[Term, ...]
    explains: float

    def force(self, row: str, signals: Mapping[str, Vector]) -> Vector:
        """The force that the terms make [SI]; (n,)."""
        total, x = np.zeros_like(signals["U"]), prime_signals(signals)
        for t in self.terms:
            total = total + t.coefficient * pressure(row, signals) * t.term.of(x)
        return total

    @property
    def sentence(self) -> str:
        """The shape in words."""
        if not self.terms:
            return (
                "it follows no signal of the record: wind, waves or a sensor rather than an effect"
            )
        words = " and ".join(t.term.words for t in self.terms)
        others = self.terms[0].rivals
        alike = ", ".join(t.words for t in others[:3])
        more = f" and {len(others) - 3} more" if len(others) > 3 else ""
        twins = f" ({alike}{more} would do nearly as well)" if others else ""
        return f"it follows {words}{twins}, {self.symmetry}, which takes up {self.explains:.1%}"

    @property
    def symmetry(self) -> str:
        """What becomes of it when port and starboard are exchanged."""
        kinds = {t.term.mirror for t in self.terms}
        if kinds == {"odd"}:
            return "odd in the mirror"
        if kinds == {"even"}:
            return "the same to both sides"
        return "by the heading" if "by heading" in kinds else "odd and even in parts"

    @property
    def signals(self) -> tuple[str, ...]:
        """Signals that the terms read."""
        return tuple(dict.fromkeys(s for t in self.terms for s in t.term.signals if s != "U0"))


@dataclass(frozen=True)
class _Level:
    """S of one intensity of what terms leave over, and the determinant that goes with it."""

    S: Vector
    logdet: float


def shape(record: Record, of: Answers, noise: Colour, level: float) -> Shape:
    """Terms of the force in one equation, by forward selection at Schwarz's price."""
    columns = [np.concatenate([z[:, :, :-1], g, z[:, :, -1:]], axis=2)
               for z, g in zip(record.columns, of.G, strict=True)]  # fmt: skip
    made = sums(of.H, columns, record.compared, noise, record.free)
    levels = [_Level(*without_course(made, Intensity()))]
    for memory in MEMORIES:
        for course in COURSE:
            levels.append(_Level(*without_course(made, Intensity(course / made.knot, memory))))
    chosen: list[int] = []
    steps = list[tuple[float, float, tuple[int, ...]]]()
    least, _ = _least(levels, record.free, chosen, made.rows)
    for _ in range(MOST):
        found = _added(levels, record.free, chosen, made.rows)
        j = int(np.argmin(found))
        gain = float(least - found[j])
        p = min(1.0, max(len(of.terms) * float(chdtrc(1, max(gain, 0.0))), record.least_p))
        if gain < np.log(made.rows) or p >= level or (steps and gain < WORTH * steps[0][0]):
            break
        rivals = np.flatnonzero(found < found[j] + max(DECISIVE, SKETCH * gain))
        steps.append((gain, p, tuple(int(r) for r in rivals if r != j)))
        chosen.append(j)
        least = float(found[j])
    return _made(record, of, levels, chosen, steps, made.rows)


def _reduced(S: Vector, free: Sequence[int]) -> Vector:
    """S of the other columns once these are eliminated; those keep rows of zero."""
    d = np.sqrt(np.maximum(np.diag(S), 1e-300))
    N = S / d / d[:, None]
    index = list(free)
    w, U = np.linalg.eigh(N[np.ix_(index, index)])
    kept = w > 1e-11 * max(w.max(initial=0.0), 1e-300)
    R = (U[:, kept] / np.sqrt(w[kept])).T @ N[index]
    rest = (N - R.T @ R) * d * d[:, None]
    rest[index], rest[:, index] = 0.0, 0.0
    return np.asarray(rest)


def _eliminated(free: int, chosen: Sequence[int]) -> list[int]:
    return [*range(free), *(free + j for j in chosen)]


def _least(
    levels: Sequence[_Level], free: int, chosen: Sequence[int], rows: int
) -> tuple[float, int]:
    """Deviance with these terms at the likeliest intensity of the rest, and which that is."""
    found = [
        rows * float(np.log(_reduced(x.S, _eliminated(free, chosen))[-1, -1])) + x.logdet
        for x in levels
    ]
    return min(found), int(np.argmin(found))


def _added(levels: Sequence[_Level], free: int, chosen: Sequence[int], rows: int) -> Vector:
    """Deviance with each of the terms added; (n_G,)."""
    best = np.full(len(levels[0].S) - free - 1, np.inf)
    for x in levels:
        rest = _reduced(x.S, _eliminated(free, chosen))
        own, whole = np.diag(rest)[free:-1], np.diag(x.S)[free:-1]
        seen = own > SEEN * whole
        fall = np.where(seen, rest[free:-1, -1] ** 2 / np.where(seen, own, 1.0), 0.0)
        left = np.maximum(rest[-1, -1] - fall, 1e-300)
        best = np.minimum(best, np.where(seen, rows * np.log(left) + x.logdet, np.inf))
    return best


def _made(
    record: Record,
    of: Answers,
    levels: Sequence[_Level],
    chosen: Sequence[int],
    steps: Sequence[tuple[float, float, tuple[int, ...]]],
    rows: int,
) -> Shape:
    """Coefficients by generalised least squares, in the prime system, and shares of the error."""
    free, terms, taken = record.free, list[ShapeTerm](), 0.0
    _, at = _least(levels, free, chosen, rows)
    values, errors = _coefficients(levels[at].S, free, chosen, rows)
    for k, (j, (gain, p, rivals)) in enumerate(zip(chosen, steps, strict=True)):
        _, here = _least(levels, free, chosen[: k + 1], rows)
        share = _share(record, of, levels[here].S, chosen[: k + 1])
        size = _size(record, of, j)
        terms.append(
            ShapeTerm(
                name=parameter(of.row, of.terms[j]),
                term=of.terms[j],
                coefficient=values[k] / size,
                error=errors[k] / size,
                share=share - taken,
                gain=gain,
                p_value=p,
                rivals=tuple(of.terms[r] for r in rivals),
            )
        )
        taken = share
    return Shape(tuple(terms), of.terms, taken)


def _solution(S: Vector, free: int, chosen: Sequence[int]) -> tuple[Vector, Vector, list[int]]:
    """Coefficients of parameters and chosen terms, and the inverse of their S."""
    index = _eliminated(free, chosen)
    d = 1.0 / np.sqrt(np.maximum(np.diag(S)[index], 1e-300))
    inner = np.linalg.pinv(S[np.ix_(index, index)] * d * d[:, None], rcond=1e-11, hermitian=True)
    inverse = inner * d * d[:, None]
    return inverse @ S[index, -1], inverse, index


def _coefficients(S: Vector, free: int, chosen: Sequence[int], rows: int) -> tuple[Vector, Vector]:
    """Coefficients of the unit columns and their standard errors; (n_chosen,)."""
    found, inverse, index = _solution(S, free, chosen)
    left = float(S[-1, -1] - found @ S[index, -1])
    sigma2 = left / max(rows - len(index), 1)
    return found[free:], np.sqrt(sigma2 * np.diag(inverse)[free:])


def _share(record: Record, of: Answers, S: Vector, chosen: Sequence[int]) -> float:
    """Share of the squared error that terms take up, the parameters moving with them."""
    found, _, _ = _solution(S, record.free, chosen)
    left = total = 0.0
    for z, g, m in zip(record.columns, of.G, record.compared, strict=True):
        e = z[:, :, -1] - z[:, :, :-1] @ found[: record.free]
        e = e - g[:, :, list(chosen)] @ found[record.free :]
        left += float(np.sum(e[m] ** 2))
        total += float(np.sum(z[:, :, -1][m] ** 2))
    return 1.0 - left / total


def _size(record: Record, of: Answers, j: int) -> float:
    """What a column of unit size is of the primed term: its force over the term's own."""
    for p, forces in zip(record.paths, of.forces, strict=True):
        own = pressure(of.row, p.signals) * of.terms[j].of(prime_signals(p.signals))
        k = int(np.argmax(np.abs(own)))
        if own[k] != 0.0:
            return float(own[k] / forces[k, j])
    raise AssertionError("a term that moves nothing has no column")
