"""How much of the error an effect takes away where nobody fitted it: blocks left out in turn.

On a real record several smooth errors lie on top of each other. A test that takes what is smooth
for noise is then won by what is fast, a lag or a delay, however little of the error that explains.
So significance says whether there is an effect, and this says which: each block of time is left out
in turn, parameters and coefficient come from the other blocks, and the squared errors of the left
out are added, rows as they are. Where a test is of one kind only, all that it teaches is left out
with it: Stone (1974), Cross-validatory choice and assessment of statistical predictions, J R Stat
Soc B 36. All of it is linear algebra on columns that exist, no further simulation.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.special import stdtrit  # scipy.stats would take another 0.4 s to import

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

FALL: Final = 0.985
"""Ratio of squared errors from which on an effect is worth a name: 0.7 % of the error itself. Half
as strict, a speed logged half a percent wrong is named; twice as strict, weak damping is not."""

LARGE: Final = 0.90
"""Ratio of squared errors that needs no test of significance: on short or smooth records the noise
has no colour that could be told from the effect's. With nothing hidden 0.98 is hardly reached."""

FAINT: Final = 0.02
"""Share of its trace beside the parameters at which an effect's fall counts half: a centre of
gravity or a memory keeps less, and buys its fall with a coefficient that no ship has."""

EACH: Final = 0.01
"""What a further parameter must lower the error by, as a share of the squared error."""

CHANCE: Final = 0.975
"""Student's level beyond which the errors of two models differ by more than chance."""

_SINGULAR: Final = 1e-9
"""Share of the largest eigenvalue, of columns of length one, below which nothing is seen."""


@dataclass(frozen=True)
class Carried:
    """What an effect does to the error of blocks of time that did not choose its coefficient.

    Attributes
    ----------
    before, after
        Squared error of each block without and with the effect, parameters fitted to the others.
    seen
        Share of the effect's trace, the trials' own nuisances taken out, that no parameter which
        the trials share can mimic.
    steady
        Whether its coefficients keep their sign whichever block is left out.
    """

    before: tuple[float, ...]
    after: tuple[float, ...]
    seen: float = 1.0
    steady: bool = True

    @property
    def ratio(self) -> float:
        """Squared error with the effect over that without; not a number where there is none."""
        whole = sum(self.before)
        return sum(self.after) / whole if whole > 0.0 else float("nan")

    @property
    def better(self) -> int:
        """In how many blocks the error is smaller."""
        return sum(new < old for old, new in zip(self.before, self.after, strict=True))

    @property
    def blocks(self) -> int:
        """How many blocks there are."""
        return len(self.before)

    @property
    def falls(self) -> bool:
        """Whether so much carries over that it is worth a name, and in more than half of them.

        Of what is hardly seen it must be more: other errors of the model look like it.
        """
        return bool(self.believed < np.log(FALL)) and 2 * self.better > self.blocks

    @property
    def log_ratio(self) -> float:
        """Natural logarithm of the ratio; zero where there is nothing to compare."""
        return float(np.log(max(self.ratio, 1e-300))) if self.blocks else 0.0

    @property
    def believed(self) -> float:
        """The same by how much of the trace is seen."""
        return self.log_ratio * self.seen / (self.seen + FAINT)

    def price(self, parameters: int) -> float:
        """What candidates are ordered by: the fall that is believed, and something a parameter."""
        return self.believed + EACH * (parameters - 1)


def lead_in_errors(one: Sequence[float], other: Sequence[float]) -> float:
    """By how many of its standard errors the first list of squared errors is the smaller one."""
    gaps = np.subtract(other, one)
    if len(gaps) < 2:
        return 0.0
    return float(gaps.mean() / max(np.std(gaps, ddof=1) / np.sqrt(len(gaps)), 1e-300))


def as_good(one: Sequence[float], other: Sequence[float]) -> bool:
    """Whether the second list of squared errors is not greater than the first beyond chance."""
    return len(one) < 2 or lead_in_errors(one, other) < stdtrit(len(one) - 1, CHANCE)


@dataclass(frozen=True)
class LeftOut:
    """Sums of products of residual and candidates with each block left out in turn.

    The parameters that the trials share are fitted to the other blocks and taken out.

    Attributes
    ----------
    others, left
        Of the blocks that are fitted, and of the one that is left out, the residual first;
        (blocks, 1 + n_S, 1 + n_S).
    seen
        Share of each column that shared parameters cannot mimic; (n_S,).
    """

    others: Vector
    left: Vector
    seen: Vector

    def errors(self, columns: Sequence[int] = ()) -> Vector:
        """Squared error of each block with these columns fitted to the others; (blocks,)."""
        return self._with(columns)[0]

    def carried(self, columns: Sequence[int]) -> Carried:
        """What these columns do to the error of blocks that did not choose their coefficients."""
        errors, beta = self._with(columns)
        signs = np.sign(beta)
        return Carried(
            tuple(map(float, self.left[:, 0, 0])), tuple(map(float, errors)),
            float(np.mean(self.seen[list(columns)])), bool(np.all(signs == signs[:1])),
        )  # fmt: skip

    def _with(self, columns: Sequence[int]) -> tuple[Vector, Vector]:
        """Squared errors (blocks,) and coefficients (blocks, q)."""
        at = [1 + c for c in columns]
        gram, moment = self.others[:, at][:, :, at], self.others[:, at, 0]
        sizes = np.sqrt(np.maximum(np.diagonal(gram, axis1=1, axis2=2), 1e-300))
        scaled = gram / (sizes[:, :, None] * sizes[:, None, :])
        inverse = np.linalg.pinv(scaled, rcond=_SINGULAR, hermitian=True) if at else scaled
        beta = np.einsum("kij,kj->ki", inverse, moment / sizes) / sizes
        cross, own = self.left[:, at, 0], self.left[:, at][:, :, at]
        errors = (
            self.left[:, 0, 0]
            - 2.0 * np.einsum("ki,ki->k", beta, cross)
            + np.einsum("ki,kij,kj->k", beta, own, beta)
        )
        return errors, beta


def left_out(
    fit: Fit, residual: Vector, psi: Vector, S: Vector, parts: Sequence[Stretch]
) -> LeftOut:
    """Blocks of time left out in turn, each trial's own nuisances taken out over the whole of it.

    What is known of a parameter beforehand counts as in the fit; what lies at a bound stays there.

    Parameters
    ----------
    residual, psi, S
        Normed stacked rows, as `linearise` gives them at the fit; (M,), (M, n_theta), (M, n_S).
    """
    free = [i for i, x in enumerate(fit.problem.unknowns) if x.name not in fit.at_bounds]
    shared = [i for i in free if fit.problem.unknowns[i].trial is None]
    priors, grams = prior_rows(fit), []
    pieces = _pieces(len({p.trial for p in parts}))
    for trial in dict.fromkeys(p.trial for p in parts):
        mine = [p for p in parts if p.trial == trial]
        rows = np.concatenate([np.arange(p.rows.start, p.rows.stop) for p in mine])
        own = [i for i in free if fit.problem.unknowns[i].trial == trial]
        X = np.column_stack([psi[rows][:, shared], residual[rows], S[rows]])
        X = take_out(psi[rows][:, own], X, priors[own], len(shared))
        block = np.concatenate([_block(p, pieces) for p in mine])
        grams += [X[block == k].T @ X[block == k] for k in range(pieces) if np.any(block == k)]
    known = np.zeros_like(grams[0])
    at = np.arange(len(shared))
    known[at, at] = priors[shared, 0] ** 2
    known[at, len(shared)] = known[len(shared), at] = priors[shared, 0] * priors[shared, 1]
    return _reduced(np.array(grams), known, len(shared))


def prior_rows(fit: Fit) -> Vector:
    """Slope and gap of the row that each prior is, weighed as in the fit; (n_theta, 2)."""
    rows = np.zeros((len(fit.theta), 2))
    for i, x in enumerate(fit.problem.unknowns):
        if x.prior is not None:
            mean, deviation = x.prior
            rows[i] = fit.level / deviation, (mean - fit.theta[i]) * fit.level / deviation
    return rows


def own_errors(fit: Fit) -> tuple[float, ...]:
    """Left-out squared errors of a fit about its own optimum."""
    none = np.zeros((len(fit.residual), 0))
    found = left_out(fit, fit.residual, fit.psi, none, stretches(fit.problem))
    return tuple(map(float, found.errors()))


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


def _reduced(grams: Vector, known: Vector, shared: int) -> LeftOut:
    """The shared parameters, first of the columns, fitted to all blocks but one and taken out.

    `known` are the sums of products of their priors.
    """
    whole = grams.sum(axis=0)
    sizes = np.sqrt(np.maximum(np.diag(whole), 1e-300))
    lengths = np.outer(sizes, sizes)  # columns of length one
    grams, whole, known, scale = (
        grams / lengths, whole / lengths, known / lengths, lengths[shared:, shared:]
    )  # fmt: skip
    kept = np.diag(_taken(whole, shared)[0])[1:]
    seen = np.where(np.diag(whole)[shared + 1 :] > 0.0, np.maximum(kept, 0.0), 0.0)
    others, left = [], []
    for gram in grams:
        schur, B = _taken(whole - gram + known, shared)
        cross = B.T @ gram[:shared, shared:]
        others.append(schur * scale)
        rest = gram[shared:, shared:] - cross - cross.T + B.T @ gram[:shared, :shared] @ B
        left.append(rest * scale)
    return LeftOut(np.array(others), np.array(left), seen)


def _taken(gram: Vector, shared: int) -> tuple[Vector, Vector]:
    """Sums of products less what the shared columns reach, and the coefficients of that."""
    inverse = np.linalg.pinv(gram[:shared, :shared], rcond=_SINGULAR, hermitian=True)
    B = inverse @ gram[:shared, shared:]
    return np.asarray(gram[shared:, shared:] - gram[:shared, shared:].T @ B), np.asarray(B)
