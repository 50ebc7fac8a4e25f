"""The force that is missing: in which equation, how it goes over time, and what it is made of.

For each force equation the force F(t) is sought that, added to that equation alone, explains the
residual best: a course of its own and powers and products of the ship's signals (see
`force_likelihood`), through the linear response of the fitted model along its path. Noise is an
autoregression of each output. How strong the force is and how the noise is coloured is decided by
likelihood together, so that a record of noise has no force and a slow force is no noise; the
equation with the most likely force is the deficient one (Kristensen, Madsen & Jorgensen, 2004, do
so with Wiener processes).

What a free parameter can mimic is not seen: the parameters are free to move while the force is
sought, and the band of the force is as wide as that leaves it.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.special import chdtrc

from trialid.diagnosis.force.force_likelihood import (
    NONE,
    Estimate,
    Intensity,
    deviance,
    draws,
    estimate,
    most_likely,
    sums,
)
from trialid.diagnosis.force.force_record import Answers, Record, answers, force_record
from trialid.diagnosis.force.force_shape import DECISIVE, Shape, shape
from trialid.diagnosis.noise.noise_colour import Colour, colour
from trialid.identification.fit import Fit
from trialid.threads import one_thread

Vector = NDArray[np.float64]

PASSES: Final = 3
"""Times the noise is estimated from what a force leaves over."""

DRAWS: Final = 4
"""Forces drawn from what the record leaves possible, to estimate the noise from: what the best one
alone leaves over is less than the noise (Wei & Tanner, 1990)."""

SETTLED: Final = 0.5
"""Fall of the deviance below which another pass is not worth it."""

WORDS: Final = {"X": "surge force", "Y": "sway force", "K": "roll moment", "N": "yaw moment"}


@dataclass(frozen=True)
class Course:
    """A force over one trial [SI], with its standard error, what terms make of it, and signals."""

    trial: str
    t: Vector
    force: Vector
    error: Vector
    terms: Vector
    signals: Mapping[str, Vector]


@dataclass(frozen=True)
class Equation:
    """What the record says of a force in one equation.

    Attributes
    ----------
    gain
        Twice the logarithm of the likelihood ratio to a record without a force.
    shape
        Without terms, and none tried, where another equation is much likelier.
    p_value
        Chance of such a gain from noise, over all the equations.
    explains
        Share of the squared error that the force takes up, the parameters moving with it.
    """

    row: str
    gain: float
    p_value: float
    explains: float
    courses: tuple[Course, ...]
    shape: Shape


@dataclass(frozen=True)
class MissingForce:
    """The forces that would explain the residual of a model, one equation at a time.

    Attributes
    ----------
    effects, free
        The model that the force is missing in: its effects and its free parameters.
    named
        The deficient equation, None where none stands out.
    possible
        Equations with a force, as likely as the best within odds of 20 to 1.
    """

    effects: tuple[str, ...]
    parameters: tuple[str, ...]
    free: tuple[str, ...]
    equations: tuple[Equation, ...]
    named: str | None
    possible: tuple[str, ...]
    sentence: str

    def equation(self, row: str) -> Equation:
        """What is said of one of them."""
        return next(e for e in self.equations if e.row == row)


@one_thread
def missing_force(fit: Fit, level: float = 0.05) -> MissingForce:
    """The missing force in every equation, the most likely first.

    `level` is the family-wise error rate at which an equation, and a term, is named.
    """
    record = force_record(fit)
    every = [answers(record, row) for row in record.paths[0].rows]
    plain = colour(record.residual, record.compared, record.order)
    start = colour(_beyond(record, every), record.compared, record.order)
    null = _no_force(record, plain)
    sought = {a.row: _seek(record, a, start, null) for a in every}
    said = [_equation(record, s, len(every)) for s in sought.values()]
    said.sort(key=lambda e: -e.gain)
    possible = tuple(e.row for e in said if e.p_value < level and e.gain > said[0].gain - DECISIVE)
    found = tuple(
        _shaped(record, sought[e.row], e, level) if e.row in possible else e for e in said
    )
    named = possible[0] if len(possible) == 1 else None
    model = fit.model
    return MissingForce(
        effects=tuple(e.name for e in model.effects),
        parameters=tuple(model.parameters),
        free=fit.settings.free,
        equations=found,
        named=named,
        possible=possible,
        sentence=_sentence(found, possible, fit.settings.free),
    )


@dataclass(frozen=True)
class _Sought:
    """The most likely force in one equation and the noise beside it."""

    answers: Answers
    gain: float
    intensity: Intensity
    noise: Colour
    estimate: Estimate


def _seek(record: Record, of: Answers, start: Colour, null: float) -> _Sought:
    """The force, the noise it leaves over, and again, as long as both become more likely."""
    mixed = of.mixed
    columns = [_beside(z, g) for z, g in zip(record.columns, mixed, strict=True)]
    best = _with_noise(record, of, columns, start, NONE, null)
    for _ in range(PASSES - 1):
        drawn = [e for one in draws(best.estimate, DRAWS) for e in _left(record, of.H, mixed, one)]
        noise = colour(drawn, record.compared * DRAWS, record.order)
        found = _with_noise(record, of, columns, noise, best.intensity, null)
        if found.gain < best.gain + SETTLED:
            break
        best = found
    return best


def _with_noise(
    record: Record,
    of: Answers,
    columns: Sequence[Vector],
    noise: Colour,
    near: Intensity,
    null: float,
) -> _Sought:
    """The most likely force beside noise of this colour."""
    made = sums(of.H, columns, record.compared, noise, record.free)
    force, found = most_likely(made, near)
    return _Sought(of, float(null - found), force, noise, estimate(made, force))


def _beside(columns: Vector, more: Vector) -> Vector:
    """Further columns between the gradient and the residual."""
    return np.concatenate([columns[:, :, :-1], more, columns[:, :, -1:]], axis=2)


def _left(
    record: Record, H: Sequence[Vector], G: Sequence[Vector], found: Estimate
) -> list[Vector]:
    """What the force, and the parameters that moved with it, leave of the residual; (n, n_y)."""
    n = record.free
    theta, c = found.columns[:n], found.columns[n:]
    rest = []
    for i, (z, m) in enumerate(zip(record.columns, record.compared, strict=True)):
        e = z[:, :, -1] - z[:, :, :-1] @ theta - G[i] @ c - H[i] @ found.knots[i]
        rest.append(np.where(m, e, 0.0))
    return rest


def _beyond(record: Record, every: Sequence[Answers]) -> list[Vector]:
    """The residual less what terms in all the equations explain; (n, n_y) each.

    Its colour is where the search begins: the residual's own would take a strong effect for noise.
    """
    X = np.concatenate(
        [np.concatenate([z[:, :, :-1], *(a.G[i] for a in every)], axis=2)[m]
         for i, (z, m) in enumerate(zip(record.columns, record.compared, strict=True))]
    )  # fmt: skip
    y = np.concatenate([e[m] for e, m in zip(record.residual, record.compared, strict=True)])
    norms = np.linalg.norm(X, axis=0)
    X = X[:, norms > 0.0] / norms[norms > 0.0]
    w, U = np.linalg.eigh(X.T @ X)
    kept = w > 1e-9 * w[-1]
    left = y - X @ (U[:, kept] @ ((U[:, kept].T @ (X.T @ y)) / w[kept]))
    rest, at = [], 0
    for m in record.compared:
        e = np.zeros(m.shape)
        e[m] = left[at : at + int(m.sum())]
        at += int(m.sum())
        rest.append(e)
    return rest


def _no_force(record: Record, noise: Colour) -> float:
    """Deviance of a record of noise alone."""
    nothing = [np.zeros((*m.shape, 0)) for m in record.compared]
    return deviance(sums(nothing, record.columns, record.compared, noise, record.free), NONE)


def _equation(record: Record, of: _Sought, equations: int) -> Equation:
    """What is said of one equation, before its shape is sought.

    A force that leaves more error than it found is none, however likely: the colour of the noise
    then lets slow errors pass.
    """
    total = sum(float(np.sum(e**2)) for e in record.residual)
    left = _left(record, of.answers.H, of.answers.mixed, of.estimate)
    explained = 1.0 - sum(float(np.sum(e**2)) for e in left) / total
    gain = of.gain if explained > 0.0 else 0.0
    gain = max(gain, 0.0)
    p = min(1.0, max(equations * float(chdtrc(2, gain)), record.least_p))
    none = Shape((), (), 0.0)
    courses = _courses(record, of, none)
    return Equation(of.answers.row, gain, p, max(explained, 0.0), courses, none)


def _shaped(record: Record, of: _Sought, e: Equation, level: float) -> Equation:
    """The same with its shape."""
    made = shape(record, of.answers, of.noise, level)
    return replace(e, shape=made, courses=_courses(record, of, made))


def _courses(record: Record, of: _Sought, made: Shape) -> tuple[Course, ...]:
    """The force over each trial, with the standard error it has."""
    found, n, courses = of.estimate, record.free, []
    for i, p in enumerate(record.paths):
        terms = of.answers.forces[i] @ of.answers.mixing
        hats = of.answers.hats[i]
        force = hats @ found.knots[i] + terms @ found.columns[n:]
        lever = np.concatenate([np.zeros((len(hats), n)), terms], axis=1) - hats @ found.follow[i]
        variance = np.sum((hats @ found.spread[i]) * hats, axis=1)
        variance += np.sum((lever @ found.covariance) * lever, axis=1)
        error = np.sqrt(np.maximum(variance, 0.0))
        fitted = made.force(of.answers.row, p.signals)
        courses.append(Course(p.name, p.t, force, error, fitted, p.signals))
    return tuple(courses)


def _sentence(found: Sequence[Equation], possible: Sequence[str], free: Sequence[str]) -> str:
    """The finding in words."""
    best = found[0]
    if not possible:
        return (
            f"no force in any equation stands out against noise of any colour "
            f"(best: {WORDS[best.row]} {best.row}, p = {best.p_value:.2g})"
        )
    unseen = f"; what {_listed(free)} can take by changing is not seen" if free else ""
    if len(possible) > 1:
        names = " or ".join(f"{WORDS[r]} {r}" for r in possible)
        return f"a force is missing, but this record cannot tell in which equation: {names}{unseen}"
    than = ""
    if len(found) > 1:
        powers = 0.5 * (best.gain - found[1].gain) / np.log(10.0)
        than = f", {powers:.0f} powers of ten likelier than one in {found[1].row}"
    return (
        f"a {WORDS[best.row]} {best.row} is missing that takes up {best.explains:.1%} of the "
        f"squared error (p = {best.p_value:.2g}{than}); {best.shape.sentence}{unseen}"
    )


def _listed(names: Sequence[str]) -> str:
    return ", ".join(names[:6]) + (" ..." if len(names) > 6 else "")
