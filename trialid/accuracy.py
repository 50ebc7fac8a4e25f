"""How far each parameter can be trusted: Blanke & Knudsen (1999), Eq. 8 to 14, in their order.

Everything starts from the sensitivity matrix A = [Psi L / y_RMS] / sqrt(N n_y), one row per
compared value and one column per parameter, so that A^T A is the relative normed Hessian H_rn.
H_rn itself is never formed or inverted: sensitivities come from the singular values and the R
factor of A.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Final, Literal

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_triangular
from scipy.linalg.lapack import dtpqrt

Vector = NDArray[np.float64]
Mask = NDArray[np.bool_]

RANK: Final = 1e-10
"""Singular values below this share of the largest are zero: a direction nobody can see."""


ROWS: Final = 256
PANEL: Final = 8
"""Rows folded at a time and columns of a panel: small enough for the cache, whatever the record."""


def triangle(A: Vector) -> Vector:
    """R of A = Q R, so that R^T R = A^T A; (n_theta, n_theta).

    Blocks of rows are folded into the triangle one after another, five times as fast as a QR of
    the tall matrix at once.

    >>> np.abs(triangle(np.array([[3.0], [4.0]]))).tolist()
    [[5.0]]
    """
    n = A.shape[1]
    R = np.zeros((n, n), order="F")
    for at in range(0, len(A), ROWS):
        block = np.array(A[at : at + ROWS], order="F")  # a copy: LAPACK writes into it
        R = dtpqrt(0, min(PANEL, n), R, block, overwrite_a=1, overwrite_b=1)[0]
    return np.asarray(R)


def normed_rms(eps: Vector, y_rms: float) -> float:
    """Eq. 8: root mean square of the output error over that of the output.

    >>> normed_rms(np.array([0.5, -0.5]), 2.0)
    0.25
    """
    return float(np.sqrt(np.mean(np.square(eps))) / y_rms)


def relative_sensitivities(psi: Vector, reference: Vector) -> Vector:
    """Eq. 9: A with A^T A = H_rn = y_RMS^-2 L H L; (M, n_theta).

    Parameters
    ----------
    psi
        Normed sensitivities d(yhat / y_RMS) / d(theta) / sqrt(N n_y), all outputs and trials
        stacked; (M, n_theta).
    reference
        Diagonal of L: the estimate, or the typical size where the estimate is near zero.
    """
    return psi * reference


def minimum_sensitivity(A: Vector) -> Vector:
    """Eq. 10: S_imin = ([H_rn^-1]_ii)^-1/2, what is left of S_i when the others answer; (n_theta,).

    Zero for a parameter in a direction that leaves no trace.

    >>> minimum_sensitivity(np.array([[2.0, 0.0], [0.0, 3.0]])).tolist()
    [2.0, 3.0]
    """
    norms = np.linalg.norm(A, axis=0)
    if not np.all(norms > 0.0):
        return _with_dead_columns(A, norms > 0.0)
    R = triangle(A) / norms
    _, s, Vt = np.linalg.svd(R)
    unseen = s <= RANK * s[0]
    if unseen.any():
        hidden = (np.abs(Vt[unseen]) > 1e-6).any(axis=0)
        return np.where(hidden, 0.0, _from_svd(s, Vt, ~unseen)) * norms
    inverse = solve_triangular(R, np.eye(len(R)))
    result: Vector = norms / np.linalg.norm(inverse, axis=1)
    return result


def _with_dead_columns(A: Vector, alive: Mask) -> Vector:
    result = np.zeros(A.shape[1])
    if alive.any():
        result[alive] = minimum_sensitivity(A[:, alive])
    return result


def _from_svd(s: Vector, Vt: Vector, seen: Mask) -> Vector:
    result: Vector = 1.0 / np.sqrt(np.sum((Vt[seen] / s[seen, None]) ** 2, axis=0))
    return result


def sensitivity_range(A: Vector) -> tuple[float, float, float]:
    """Eq. 11: S_min, S_max over all directions of parameter space, and R = S_max / S_min.

    R depends on how the parameters are scaled; R_i (Eq. 13) does not.

    >>> sensitivity_range(np.diag([2.0, 4.0]))
    (2.0, 4.0, 2.0)
    """
    s = np.linalg.svd(triangle(A), compute_uv=False)
    ratio = float(s[0] / s[-1]) if s[-1] > RANK * s[0] else float("inf")
    return float(s[-1]), float(s[0]), ratio


def sensitivity(A: Vector) -> Vector:
    """Eq. 12: S_i = ([H_rn]_ii)^1/2, sensitivity to each parameter alone; (n_theta,)."""
    result: Vector = np.linalg.norm(A, axis=0)
    return result


def correlation_ratio(A: Vector) -> Vector:
    """Eq. 13: R_i = S_i / S_imin >= 1; its square is the variance inflation factor; (n_theta,)."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(sensitivity(A) / minimum_sensitivity(A))


def relative_error(
    noise: float, undermodelling: float, S_imin: Vector, samples: float | Vector
) -> tuple[Vector, Vector]:
    """Eq. 14: relative error of each parameter, its noise part and its model part; (n_theta,) each.

    The first is one standard deviation; it falls with the number of samples, which for coloured
    residuals is the effective one. The second is a bound over all model errors of this size; it
    does not fall, and assumes that the invisible part of the model error is about as large as the
    visible one.

    >>> [float(x[0]) for x in relative_error(0.1, 0.02, np.array([0.5]), 400)]
    [0.01, 0.04]
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        return noise / (S_imin * np.sqrt(samples)), undermodelling / S_imin


@dataclass(frozen=True)
class Stretch:
    """Rows of A that are one output of one trial; `compared` places them on the trial's clock.

    With `every` above 1 a row is so many samples of the trial's as one, and so is an instant of
    the clock; what is left over at the end is left out.
    """

    trial: int
    output: int
    rows: slice
    compared: Mask
    every: int = 1

    def taken(self, values: Vector) -> Vector:
        """The rows that samples of the whole trial make; (N, ...) to (rows, ...).

        Several samples as one are their sum over sqrt(every): a slow signal's squares add up to
        what they were, and white noise keeps its variance a row.
        """
        if self.every == 1:
            return np.asarray(values[self.compared])
        whole = values[: len(self.compared) * self.every]
        sums = whole.reshape(len(self.compared), self.every, *values.shape[1:]).sum(axis=1)
        return np.asarray(sums[self.compared] / np.sqrt(self.every))


def row_variance(A: Vector, residual: Vector) -> float:
    """Variance of one row of the residual, for as many parameters fitted as A has columns."""
    rows, columns = A.shape
    return float(residual @ residual) / max(rows - columns, 1)


def white_covariance(A: Vector, residual: Vector, held: Vector | None = None) -> Vector:
    """Covariance of the relative parameters if the residual were white; (n_theta, n_theta).

    `held` as in `coloured_covariance`.
    """
    inverse = np.linalg.pinv(_with_priors(A, held))
    return np.asarray(row_variance(A, residual) * inverse @ inverse.T)


def _with_priors(A: Vector, held: Vector | None) -> Vector:
    """R with R^T R = A^T A + diag(held)^2: each prior is one more row; (n_theta, n_theta)."""
    R = triangle(A)
    return R if held is None else triangle(np.concatenate([R, np.diag(held)]))


def coloured_covariance(
    A: Vector, residual: Vector, stretches: Sequence[Stretch], held: Vector | None = None
) -> Vector:
    """Covariance of the relative parameters for the residual's own colour; (n_theta, n_theta).

    A sandwich: (A^T A)^-1 A^T C A (A^T A)^-1, where C holds the autocovariance of each output in
    each trial up to a lag of three correlation times (Bartlett weights), no correlation between.
    Morelli & Klein (1997), `Accuracy of aerodynamic model parameters estimated from flight test
    data`, in the time domain.

    Parameters
    ----------
    held
        What priors weigh: root of the row variance over the prior's relative standard deviation,
        zero for a parameter without; (n_theta,).
    """
    rows, columns = A.shape
    narrow = np.linalg.pinv(_with_priors(A, held))
    inverse = narrow @ (A @ narrow).T
    meat = np.zeros((columns, columns))
    for stretch in stretches:
        e = _on_clock(residual[stretch.rows], stretch.compared)
        a = _on_clock(inverse[:, stretch.rows].T, stretch.compared)
        meat += a.T @ correlated(a, autocovariance(e, stretch.compared))
    meat *= rows / max(rows - columns, 1)
    if held is None:
        return meat
    pulled = (narrow @ narrow.T) * held
    return np.asarray(meat + row_variance(A, residual) * pulled @ pulled.T)


def _on_clock(values: NDArray[np.floating[Any]], compared: Mask) -> Vector:
    """Rows back on the trial's clock, zero where nothing was compared."""
    full = np.zeros((len(compared), *values.shape[1:]))
    full[compared] = values
    return full


def autocovariance(e: Vector, compared: Mask) -> Vector:
    """Bartlett-weighted autocovariance up to three correlation times; (lags,).

    Pairs are counted where both values were compared, so that gaps do not bias it.
    """
    n = len(e)
    size = 1 << (2 * n - 1).bit_length()
    spectrum = np.fft.rfft(e, size)
    presence = np.fft.rfft(compared.astype(float), size)
    products = np.fft.irfft(spectrum * spectrum.conj(), size)[:n]
    pairs = np.round(np.fft.irfft(presence * presence.conj(), size)[:n])
    c = products / np.maximum(pairs, 1.0)
    lags = window(c, n)
    weights: Vector = c[:lags] * (1.0 - np.arange(lags) / lags)
    return weights


def window(c: Vector, n: int) -> int:
    """Lags to keep: three times the longest correlation time, at most a quarter of the record.

    The correlation time is the last lag at which the autocorrelation leaves the band of twice
    its own standard error, counted until it has stayed inside for as long again.
    """
    longest = max(n // 4, 1)
    if c[0] <= 0.0:
        return 1
    rho = np.abs(c[:longest] / c[0])
    band = 2.0 / np.sqrt(n)
    last = 0
    for lag in range(1, longest):
        if rho[lag] > max(band, 0.05):
            last = lag
        elif lag > 2 * last + 10:
            break
    return min(3 * last + 1, longest)


def correlated(a: Vector, c: Vector) -> Vector:
    """The symmetric Toeplitz matrix of autocovariance c times a; (N, n_theta)."""
    n = len(a)
    size = 1 << (n + 2 * len(c)).bit_length()
    kernel = np.zeros(size)
    kernel[: len(c)] = c
    kernel[size - len(c) + 1 :] += c[1:][::-1]
    spectrum = np.fft.rfft(kernel).real[:, None]
    return np.fft.irfft(np.fft.rfft(a, size, axis=0) * spectrum, size, axis=0)[:n]


Kind = Literal["physical", "nuisance"]


@dataclass(frozen=True)
class ParameterAccuracy:
    """One row of the accuracy table; errors absolute unless called relative."""

    name: str
    kind: Kind
    unit: str
    value: float
    reference: float
    S_i: float
    S_imin: float
    R_i: float
    noise_error: float | None
    undermodelling_error: float | None
    standard_error: float
    white_error: float
    n_effective: float

    @property
    def relative_error(self) -> float | None:
        """Eq. 14 in full, where both parts are known."""
        if self.noise_error is None or self.undermodelling_error is None or self.reference == 0.0:
            return None
        return (self.noise_error + self.undermodelling_error) / abs(self.reference)


@dataclass(frozen=True)
class Weakness:
    """A direction of parameter space that the record hardly sees.

    `moves` is how far noise lets its parameters go together: one standard error of the
    combination, as a share of each parameter's size, up or down.
    """

    parameters: tuple[str, ...]
    sentence: str
    relative_error: float
    moves: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Accuracy:
    """Sensitivities and errors of a fit; S_min, S_max, R are of the physical parameters."""

    parameters: tuple[ParameterAccuracy, ...]
    S_min: float
    S_max: float
    R: float
    n_effective: float
    weak: tuple[Weakness, ...]
    covariance: Vector

    @property
    def physical(self) -> tuple[ParameterAccuracy, ...]:
        """The rows of the physical parameters."""
        return tuple(p for p in self.parameters if p.kind == "physical")


@dataclass(frozen=True)
class Subject:
    """What a parameter is, beside its column of A."""

    name: str
    kind: Kind
    unit: str
    value: float
    reference: float
    prior: float | None = None
    """Standard deviation of what is known of it beforehand, in its unit."""


def assess(
    subjects: Sequence[Subject],
    psi: Vector,
    residual: Vector,
    stretches: Sequence[Stretch],
    noise: float | None,
    undermodelling: float | None,
) -> Accuracy:
    """The accuracy of every parameter from the sensitivities and the residual of a fit.

    Parameters
    ----------
    subjects
        The parameters, in the order of the columns; (n_theta,).
    psi, residual
        Normed sensitivities (M, n_theta) and normed residual (M,), scaled so that the squares of
        the residual sum to eps_RMSn^2.
    noise, undermodelling
        eps^x_RMSn and eps^m_RMSn, None where they could not be separated.
    """
    reference = np.array([s.reference for s in subjects])
    A = relative_sensitivities(psi, reference)
    held = _held(subjects, np.sqrt(row_variance(A, residual)))
    covariance = coloured_covariance(A, residual, stretches, held)
    white = white_covariance(A, residual, held)
    # the pseudo-inverse would give an error of zero to what neither record nor prior knows
    hidden = minimum_sensitivity(_with_priors(A, held)) <= 0.0
    covariance[hidden, :] = covariance[:, hidden] = np.nan
    white[hidden, :] = white[:, hidden] = np.nan
    rows = _rows(subjects, A, white, covariance, noise, undermodelling)
    physical = np.array([s.kind == "physical" for s in subjects])
    clean = without_nuisance(A, physical)
    S_min, S_max, ratio = sensitivity_range(clean)
    seen = [r.n_effective for r in rows if r.kind == "physical" and np.isfinite(r.n_effective)]
    typical = float(np.median(seen)) if seen else float(len(residual))
    names = [s.name for s in subjects if s.kind == "physical"]
    error = float(np.linalg.norm(residual)) / np.sqrt(typical)
    weak = weak_directions(clean, names, error)
    scaled = covariance * np.outer(reference, reference)
    return Accuracy(rows, S_min, S_max, ratio, typical, weak, scaled)


def _held(subjects: Sequence[Subject], deviation: float) -> Vector | None:
    """What the priors weigh against rows of this deviation; None where there is no prior."""
    if all(s.prior is None for s in subjects):
        return None
    return np.array(
        [0.0 if s.prior is None else deviation * abs(s.reference) / s.prior for s in subjects]
    )


def _rows(
    subjects: Sequence[Subject],
    A: Vector,
    white: Vector,
    covariance: Vector,
    noise: float | None,
    undermodelling: float | None,
) -> tuple[ParameterAccuracy, ...]:
    R = triangle(A)  # R^T R = A^T A, and that is all that Eq. 10 to 13 look at
    S_i, S_imin, R_i = sensitivity(R), minimum_sensitivity(R), correlation_ratio(R)
    plain = np.sqrt(np.diag(white))
    coloured = np.sqrt(np.maximum(np.diag(covariance), 0.0))
    with np.errstate(divide="ignore", invalid="ignore"):
        n_effective = len(A) * (plain / coloured) ** 2
    x, m = relative_error(noise or 0.0, undermodelling or 0.0, S_imin, n_effective)
    return tuple(
        ParameterAccuracy(
            s.name, s.kind, s.unit, s.value, s.reference,
            float(S_i[i]), float(S_imin[i]), float(R_i[i]),
            _scaled(noise, x[i], s.reference), _scaled(undermodelling, m[i], s.reference),
            float(coloured[i] * abs(s.reference)),
            float(plain[i] * abs(s.reference)),
            float(n_effective[i]),
        )
        for i, s in enumerate(subjects)
    )  # fmt: skip


def _scaled(known: float | None, relative: float, reference: float) -> float | None:
    """A relative error in the parameter's unit, None where its source is not known."""
    return None if known is None else float(relative * abs(reference))


def without_nuisance(A: Vector, physical: Mask) -> Vector:
    """Columns of the physical parameters with everything projected out that nuisances can mimic."""
    nuisance = A[:, ~physical]
    if nuisance.shape[1] == 0:
        return A[:, physical]
    norms = np.linalg.norm(nuisance, axis=0)
    Q, _ = np.linalg.qr(nuisance[:, norms > 0.0] / norms[norms > 0.0])
    wanted = A[:, physical]
    return np.asarray(wanted - Q @ (Q.T @ wanted))


COLLINEAR: Final = 10.0
"""A collinearity index above this names a weak direction (Brun et al. 2001: 10 to 15)."""

WELL_KNOWN: Final = 0.1
"""A combination known better than this is not weak, however alike its parameters act."""

SHARE: Final = 0.3
"""A parameter with at least this share of a direction is named in it."""


def weak_directions(A: Vector, names: Sequence[str], error: float) -> tuple[Weakness, ...]:
    """Directions of the physical parameters that leave hardly a trace, in words.

    Columns are brought to length one first, so that the answer does not depend on how parameters
    are scaled; a direction is weak when its singular value is below 1 / `COLLINEAR` and noise
    leaves it open by more than `WELL_KNOWN`. `error` is the normed noise over the root of the
    effective samples, from which the relative error of the combination follows.
    """
    norms = np.linalg.norm(A, axis=0)
    alive = norms > 0.0
    found = [
        Weakness((n,), f"{spoken(n)} leaves no trace in this record", float("inf"))
        for n, on in zip(names, alive, strict=True)
        if not on
    ]
    kept = [n for n, on in zip(names, alive, strict=True) if on]
    if len(kept) < 2:
        return tuple(found)
    _, s, Vt = np.linalg.svd(triangle(A[:, alive]) / norms[alive])
    for value, direction in zip(s[::-1], Vt[::-1], strict=True):
        if value >= 1.0 / COLLINEAR:
            break
        shares = np.abs(direction)
        leading = np.argsort(-shares)
        parts = tuple(kept[i] for i in leading if shares[i] >= SHARE)
        along = direction / norms[alive]
        deviation = error / value if value > 0.0 else float("inf")
        relative = deviation * float(np.linalg.norm(along))
        if relative > WELL_KNOWN:
            words = _weak_sentence(parts, 1.0 / max(value, 1e-300))
            moves = {n: deviation * float(along[kept.index(n)]) for n in parts}
            found.append(Weakness(parts, words, relative, moves))
    return tuple(found)


def _weak_sentence(parts: tuple[str, ...], index: float) -> str:
    words = [spoken(p) for p in parts]
    if len(words) == 1:
        return f"{words[0]} is answered for by all the others together (collinearity {index:.3g})"
    listed = ", ".join(words[:-1]) + " and " + words[-1]
    return f"{listed} cannot be told apart here (collinearity {index:.3g})"


def spoken(name: str) -> str:
    """A coefficient as people write it: `av` and `ar` are moduli.

    >>> spoken("Yvar"), spoken("Nrar"), spoken("Kpap"), spoken("Nvav"), spoken("Yv")
    ('Yv|r|', 'Nr|r|', 'Kp|p|', 'Nv|v|', 'Yv')
    """
    for letter in "uvpr":
        if name.endswith("a" + letter) and len(name) > 3:
            return f"{name[:-2]}|{letter}|"
    return name
