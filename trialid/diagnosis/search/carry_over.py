"""How much of the error an effect takes away where nobody fitted it: blocks left out in turn.

On a real record several smooth errors lie on top of each other. A test that takes what is smooth
for noise is then won by what is fast, a lag or a delay, however little of the error that explains.
So significance says whether there is an effect, and this says which: each block of time is left out
in turn, parameters and coefficient come from the other blocks, and the squared errors of the left
out are added, rows as they are. Where a test is of one kind only, all that it teaches is left out
with it: Stone (1974), Cross-validatory choice and assessment of statistical predictions, J R Stat
Soc B 36. All of it is linear algebra on columns that exist, no further simulation.
"""

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.diagnosis.search.carried import Carried, Errors
from trialid.identification.fit import Fit
from trialid.identification.output_error import stretches
from trialid.trial_rows import Stretch

Vector = NDArray[np.float64]

BLOCKS: Final = 6
"""Blocks of fewer trials: with three whole trials a block is another kind of manoeuvre, to which
anything extrapolates better or worse by chance; six to thirty-six gave the same answers."""

WHOLE: Final = 5
"""Trials from which on each is a block: what is named has to hold in a trial that was not seen. The
halves of a trial share its wind and its water, and a true effect is worse in half of them."""

_SINGULAR: Final = 1e-9
"""Share of the largest eigenvalue, of columns of length one, below which nothing is seen."""


@dataclass(frozen=True)
class LeftOut:
    """Sums of products of residual and candidates with each block left out in turn.

    The parameters that the trials share are fitted to the other blocks and taken out.

    Attributes
    ----------
    others, left, own
        Of the blocks that are fitted, and of the one that is left out, the residual first, as the
        fit weighs outputs and with each output held against its own error;
        (blocks, 1 + n_S, 1 + n_S).
    seen
        Share of each column that shared parameters cannot mimic; (n_S,).
    """

    others: Vector
    left: Vector
    own: Vector
    seen: Vector

    def errors(self, columns: Sequence[int] = ()) -> Errors:
        """Squared error of each block with these columns fitted to the others, and the own one."""
        beta = self.coefficients(columns)
        whole, own = (_left_with(left, columns, beta) for left in (self.left, self.own))
        return Errors(whole, own)

    def carried(self, columns: Sequence[int]) -> Carried:
        """What these columns do to the error of blocks that did not choose their coefficients."""
        signs = np.sign(self.coefficients(columns))
        return Carried.between(
            self.errors(), self.errors(columns),
            float(np.mean(self.seen[list(columns)])), steady=bool(np.all(signs == signs[:1])),
        )  # fmt: skip

    def coefficients(self, columns: Sequence[int]) -> Vector:
        """Coefficients fitted to the other blocks; (blocks, q)."""
        at = [1 + c for c in columns]
        gram, moment = self.others[:, at][:, :, at], self.others[:, at, 0]
        sizes = np.sqrt(np.maximum(np.diagonal(gram, axis1=1, axis2=2), 1e-300))
        scaled = gram / (sizes[:, :, None] * sizes[:, None, :])
        inverse = np.linalg.pinv(scaled, rcond=_SINGULAR, hermitian=True) if at else scaled
        return np.asarray(np.einsum("kij,kj->ki", inverse, moment / sizes) / sizes)


def _left_with(left: Vector, columns: Sequence[int], beta: Vector) -> tuple[float, ...]:
    """Squared error of each block left out, with columns at these coefficients."""
    at = [1 + c for c in columns]
    cross, square = left[:, at, 0], left[:, at][:, :, at]
    errors = (
        left[:, 0, 0]
        - 2.0 * np.einsum("ki,ki->k", beta, cross)
        + np.einsum("ki,kij,kj->k", beta, square, beta)
    )
    return tuple(map(float, errors))


def levels(fit: Fit) -> Vector:
    """What a squared error of each output counts: the inverse of what the fit leaves there; (n_y,).

    As the likelihood of noise of unknown size in each output has it. The sum over all outputs stays
    what it is, and the user's own weights count.
    """
    squares = np.square(list(fit.eps_by_output.values()))
    weights = fit.problem.weights**2
    whole = float(weights @ squares / weights.sum())
    return np.asarray(whole / np.maximum(squares, _SINGULAR * max(whole, 1e-300)))


def left_out(
    fit: Fit,
    residual: Vector,
    psi: Vector,
    S: Vector,
    parts: Sequence[Stretch],
    weights: Vector | None = None,
    held: Collection[str] = (),
) -> LeftOut:
    """Blocks of time left out in turn, each trial's own nuisances taken out over the whole of it.

    What is known of a parameter beforehand counts as in the fit; what lies at a bound stays there.

    Parameters
    ----------
    residual, psi, S
        Normed stacked rows, as `linearise` gives them at the fit; (M,), (M, n_theta), (M, n_S).
    weights
        What a squared error of each output counts by its own; `levels` of the fit unless given.
    held
        Names of what stays where it is, beside what lies at a bound.
    """
    weights = levels(fit) if weights is None else weights
    stays = {*fit.at_bounds, *held}
    free = [i for i, x in enumerate(fit.problem.unknowns) if x.name not in stays]
    shared = [i for i in free if fit.problem.unknowns[i].trial is None]
    priors, grams, owns = prior_rows(fit), [], []
    parts = [p for p in parts if p.compared.any()]  # nothing of a trial too short for its delays
    pieces = _pieces(len({p.trial for p in parts}))
    for trial in dict.fromkeys(p.trial for p in parts):
        mine = [p for p in parts if p.trial == trial]
        rows = np.concatenate([np.arange(p.rows.start, p.rows.stop) for p in mine])
        own = [i for i in free if fit.problem.unknowns[i].trial == trial]
        X = np.column_stack([psi[rows][:, shared], residual[rows], S[rows]])
        X = take_out(psi[rows][:, own], X, priors[own], len(shared))
        block = np.concatenate([_block(p, pieces) for p in mine])
        weigh = np.concatenate(
            [np.full((p.rows.stop - p.rows.start, 1), weights[p.output]) for p in mine]
        )
        blocks = [block == k for k in range(pieces) if np.any(block == k)]
        grams += [X[here].T @ X[here] for here in blocks]
        owns += [X[here].T @ (weigh * X)[here] for here in blocks]
    known = np.zeros_like(grams[0])
    at = np.arange(len(shared))
    known[at, at] = priors[shared, 0] ** 2
    known[at, len(shared)] = known[len(shared), at] = priors[shared, 0] * priors[shared, 1]
    return _reduced(np.array(grams), np.array(owns), known, len(shared))


def prior_rows(fit: Fit) -> Vector:
    """Slope and gap of the row that each prior is, weighed as in the fit; (n_theta, 2)."""
    rows = np.zeros((len(fit.theta), 2))
    for i, x in enumerate(fit.problem.unknowns):
        if x.prior is not None:
            mean, deviation = x.prior
            rows[i] = fit.level / deviation, (mean - fit.theta[i]) * fit.level / deviation
    return rows


def own_errors(fit: Fit, weights: Vector | None = None, held: Collection[str] = ()) -> Errors:
    """Left-out squared errors of a fit about its own optimum; `weights` of another's `levels`."""
    none, parts = np.zeros((len(fit.residual), 0)), stretches(fit.problem)
    return left_out(fit, fit.residual, fit.psi, none, parts, weights, held=held).errors()


def carried_between(
    before: Fit, after: Fit, seen: float = 1.0, weights: Vector | None = None
) -> Carried:
    """What lies between two fits, each about its own optimum.

    What either has at its bound is moved in neither: moved in one alone, all that a single block
    teaches of it would count against that one. Of a boat in a current that goes astern in one of
    six blocks the gain astern ended at zero, with the current in the model it did not: the error
    fell from 48 to 20 %, and of that it was said that it hardly falls.

    Parameters
    ----------
    weights
        What a squared error of each output counts by its own; `levels` of `before` unless given.
    """
    weights = levels(before) if weights is None else weights
    held = {*before.at_bounds, *after.at_bounds}
    old, new = (own_errors(fit, weights, held) for fit in (before, after))
    return Carried.between(old, new, seen)


def _pieces(trials: int) -> int:
    """Into how many pieces of time each trial is cut."""
    return 1 if trials >= WHOLE else -(-BLOCKS // trials)


def _block(part: Stretch, pieces: int) -> NDArray[np.int_]:
    """Which piece of its trial's clock each row of one output lies in; outputs share the clock."""
    return np.asarray(np.flatnonzero(part.compared) * pieces // len(part.compared))


def take_out(N: Vector, X: Vector, priors: Vector, place: int) -> Vector:
    """Columns less what those of N reach, each as far as its prior lets it.

    Parameters
    ----------
    place
        Which column of X is the residual, that priors have a gap in.
    """
    norms = np.sqrt(np.sum(N**2, axis=0) + priors[:, 0] ** 2)
    if not np.any(norms > 0.0):
        return X
    known = np.zeros((len(priors), X.shape[1]))
    known[:, place] = priors[:, 1]
    slopes = np.concatenate([N, np.diag(priors[:, 0])])[:, norms > 0.0] / norms[norms > 0.0]
    Q, _ = np.linalg.qr(slopes)
    top = Q[: len(N)]
    return np.asarray(X - top @ (top.T @ X + Q[len(N) :].T @ known))


def _reduced(grams: Vector, owns: Vector, known: Vector, shared: int) -> LeftOut:
    """The shared parameters, first of the columns, fitted to all blocks but one and taken out.

    `known` are the sums of products of their priors.
    """
    whole = grams.sum(axis=0)
    squares = np.diag(whole)
    squares = np.where(squares > 0.0, squares, np.diag(known))  # of what moves nothing here
    sizes = np.sqrt(np.maximum(squares, 1e-300))
    lengths = np.outer(sizes, sizes)  # columns of length one
    grams, owns, whole, known = (x / lengths for x in (grams, owns, whole, known))
    scale = lengths[shared:, shared:]
    kept = np.diag(_taken(whole, shared)[0])[1:]
    seen = np.where(np.diag(whole)[shared + 1 :] > 0.0, np.maximum(kept, 0.0), 0.0)
    others, left, by_own = [], [], []
    for gram, own in zip(grams, owns, strict=True):
        schur, B = _taken(whole - gram + known, shared)
        others.append(schur * scale)
        left.append(_rest(gram, B, shared) * scale)
        by_own.append(_rest(own, B, shared) * scale)
    return LeftOut(np.array(others), np.array(left), np.array(by_own), seen)


def _rest(gram: Vector, B: Vector, shared: int) -> Vector:
    """Sums of products of a block with the shared parameters at the others' coefficients."""
    cross = B.T @ gram[:shared, shared:]
    inside = B.T @ gram[:shared, :shared] @ B
    return np.asarray(gram[shared:, shared:] - cross - cross.T + inside)


def _taken(gram: Vector, shared: int) -> tuple[Vector, Vector]:
    """Sums of products less what the shared columns reach, and the coefficients of that."""
    inverse = np.linalg.pinv(gram[:shared, :shared], rcond=_SINGULAR, hermitian=True)
    B = inverse @ gram[:shared, shared:]
    return np.asarray(gram[shared:, shared:] - gram[:shared, shared:].T @ B), np.asarray(B)
