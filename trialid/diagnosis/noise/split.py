"""How much of the error is noise and how much is the model's: the two parts of Eq. 14.

The paper names eps^x (noise) and eps^m (under-modelling) and gives no pipeline. Five routes, in the
order in which they are trusted; the first that holds is used and named:

a. the same manoeuvre was run twice: what differs between the runs is noise;
b. the test is periodic: scatter about the mean period is noise;
c. a stretch without excitation: nothing is there for the model to miss, so its error is noise;
d. what an input-driven basis predicts of the residual out of sample is model, the rest noise;
e. a stated sensor figure.

First differences are not a route: on wave noise they find about a tenth of the variance.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.arrays import Mask
from trialid.diagnosis.noise.between_runs import differences, may_be_unlike
from trialid.diagnosis.noise.coarse_counts import coarse_counts
from trialid.diagnosis.noise.error_parts import Interval, Split, may_be_noise, split_by_noise
from trialid.diagnosis.noise.excitation import (
    are_same,
    excitation,
    is_driven,
    period_of,
    quiet_seconds,
    rest_ends,
    what_drives,
)
from trialid.diagnosis.noise.residual import (
    OutputNoise,
    Residual,
    about_mean,
    heavy_tail,
    pool_variance,
    residuals,
    slowness,
)
from trialid.diagnosis.noise.variance import hac
from trialid.diagnosis.search.augment import Augmented
from trialid.diagnosis.search.carry_over import left_out
from trialid.identification.fit import Fit
from trialid.names import wording
from trialid.trial_rows import Stretch

Vector = NDArray[np.float64]

QUIET_RESPONSE: Final = 0.1
"""A stretch is quiet when the model itself moves less than this share of y_RMS in it."""

SEEN: Final = 0.02
"""A candidate that keeps less than this share of its sensitivity is part of the fit already."""

DISTINCT: Final = 0.05
"""Directions with singular values below this share of the largest are copies of others."""

INPUT_DRIVEN: Final = "dependence on the input"
STATED: Final = "stated sensor figure"


def split(
    fit: Fit,
    augmented: Augmented,
    stated: Mapping[str, float],
    quiet: Mapping[str, Sequence[Interval]] | None = None,
) -> tuple[Split, tuple[Split, ...]]:
    """The most trusted split of the error, and all five routes.

    Parameters
    ----------
    augmented
        Sensitivities to effects the model lacks.
    stated
        Sensor noise by output [SI].
    quiet
        Stretches [s] by trial name that the user declares to be without excitation.
    """
    coarse = coarse_counts(fit)
    able = _by_record(fit, augmented, quiet or {})
    if coarse:
        able = tuple(Split(r.method, coarse) for r in able)
    routes = (*able, _stated(fit, stated))
    for route in routes:
        if route.available:
            return route, routes
    why = "; ".join(f"{r.method}: {r.why}" for r in routes)
    return Split("not separable", coarse or why), routes


def _by_record(
    fit: Fit, augmented: Augmented, quiet: Mapping[str, Sequence[Interval]]
) -> tuple[Split, ...]:
    """Routes a to d."""
    return _repeated(fit), _periodic(fit), _quiet(fit, quiet), _input_driven(fit, augmented)


def _repeated(fit: Fit) -> Split:
    """Route a: pairs of trials that were steered and driven alike."""
    method, ship = "repeated manoeuvre", fit.model.ship
    found = residuals(fit, ("fit", "check"))
    pairs = [
        (one, other)
        for i, one in enumerate(found)
        for other in found[i + 1 :]
        if are_same(excitation(ship, one.trial), excitation(ship, other.trial))
    ]
    if not pairs:
        return Split(method, f"no two trials have the same {what_drives(ship)} record")
    pieces = [differences(one, other) for one, other in pairs]
    names = " and ".join(repr(r.trial.name) for r in pairs[0])
    unlike = [may_be_unlike(one, other) for one, other in pairs]
    return _from_pieces(fit, method, pieces, f"what differs between {names}", unlike)


def _periodic(fit: Fit) -> Split:
    """Route b: periods of one trial's record of what steers and drives against each other."""
    method, ship = "periods of a periodic test", fit.model.ship
    pieces, words, unlike = [], [], []
    for r in residuals(fit):
        moves = excitation(ship, r.trial)
        found = None if moves is None else period_of(moves)
        if found is not None:
            start, lag = found
            late, early = r.between(start + lag, None), r.between(start, -lag)
            pieces.append(differences(late, early))
            unlike.append(may_be_unlike(late, early))
            words.append(f"{lag * r.trial.period:.0f} s in {r.trial.name!r}")
    if not pieces:
        return Split(method, f"no {what_drives(ship)} record repeats itself")
    return _from_pieces(
        fit, method, pieces, "scatter between periods of " + ", ".join(words), unlike
    )


def _quiet(fit: Fit, declared: Mapping[str, Sequence[Interval]]) -> Split:
    """Route c: stretches in which rudder or drives rest and the model stands still."""
    method, ship = "quiet stretch", fit.model.ship
    pieces, words, seconds = [], [], quiet_seconds(ship)
    for r in residuals(fit, ("fit", "check")):
        moves = excitation(ship, r.trial)
        spans = declared.get(r.trial.name) or _still(r, moves, seconds)
        for start, stop in spans:
            a, b = round(start / r.trial.period), round(stop / r.trial.period)
            eps, mask = r.eps[a:b], r.compared[a:b]
            if mask.any():
                pieces.append((about_mean(eps, mask), mask))
                words.append(f"{start:.0f}-{stop:.0f} s of {r.trial.name!r}")
    if not pieces:
        return Split(method, f"no stretch of {seconds:.0f} s, {what_drives(ship)} at rest")
    return _from_pieces(fit, method, pieces, "residual in " + ", ".join(words))


def _still(r: Residual, moves: Vector | None, seconds: float) -> list[Interval]:
    """Longest stretch with prediction and all that drives at rest, if it is long enough."""
    if moves is None:
        return []
    columns = np.column_stack([moves, r.predicted / QUIET_RESPONSE])
    longest, needed, start = range(0), round(seconds / r.trial.period), 0
    while start + needed <= len(columns):
        stop = rest_ends(columns, start)
        if stop - start >= max(needed, len(longest) + 1):
            longest = range(start, stop)
        start = max(stop, start + needed // 4)
    return [(longest.start * r.trial.period, longest.stop * r.trial.period)] if longest else []


def _stated(fit: Fit, stated: Mapping[str, float]) -> Split:
    """Route e: the user's own figures."""
    method = STATED
    missing = [c for c in fit.problem.outputs if c not in stated]
    if missing:
        return Split(method, f"no figure in [diagnose] noise for {', '.join(missing)}")
    found = [
        OutputNoise((stated[c] / y) ** 2, 0.0)
        for c, y in zip(fit.problem.outputs, fit.problem.y_rms, strict=True)
    ]
    return split_by_noise(fit, method, "as stated in [diagnose] noise", found)


def _from_pieces(
    fit: Fit,
    method: str,
    pieces: Sequence[tuple[Vector, Mask]],
    why: str,
    unlike: Sequence[Vector] = (),
) -> Split:
    """A split from pieces of noise, (n, n_y) each, but for what is `unlike` in each, (n_y,)."""
    every, found = residuals(fit), []
    for c in range(len(fit.problem.outputs)):
        whole = [r.eps[:, c] for r in every], [r.compared[:, c] for r in every]
        own = [p[:, c] for p, _ in pieces], [m[:, c] for _, m in pieces]
        found.append(pool_variance(*own, slowness(*whole), heavy_tail(*whole)))
    for name, noise in zip(fit.problem.outputs, found, strict=True):
        if noise is None:
            return Split(method, f"{why}: nothing compared in {name}")
    known = [n for n in found if n is not None]
    if unlike:
        known = [
            replace(n, unlike=float(u)) for n, u in zip(known, np.mean(unlike, 0), strict=True)
        ]
    return split_by_noise(fit, method, why, known)


def _input_driven(fit: Fit, augmented: Augmented) -> Split:
    """Route d: what candidate effects explain of the residual, less what they explain of noise.

    Coefficients come from the whitened residual; their covariance says how much of the explained
    mean square they would explain of pure noise, and that much is taken off. What is left is what
    the same coefficients would explain of another record with the same input: out of sample.
    """
    method = INPUT_DRIVEN
    if not augmented.traces:
        return Split(method, "no candidate effect that acts linearly on the outputs")
    if not is_driven(fit.problem.simulator.equations.inputs, fit.problem.trials):
        return Split(method, "nothing that was recorded drives her: an input has to move")
    raw, white, parts = (
        augmented.evidence.raw, augmented.evidence.white, augmented.evidence.parts,
    )  # fmt: skip
    T = _visible_directions(raw.S, augmented.S, white.S)
    Z = white.S @ T
    if len(Z) < 20 * Z.shape[1]:
        many = wording.count_of(Z.shape[1], "direction")
        return Split(method, f"too short: {len(Z)} compared values for {many}")
    beta = np.asarray(np.linalg.lstsq(Z, white.residual, rcond=None)[0])
    inverse = np.linalg.inv(Z.T @ Z)
    left = white.residual - Z @ beta
    covariance = inverse @ hac(Z * left[:, None], parts) @ inverse
    found = [
        _unexplained(fit, c, raw.S @ T, beta, covariance, augmented.stretches)
        for c in range(len(fit.problem.outputs))
    ]
    many = wording.count_of(Z.shape[1], "direction")
    why = f"what {many} of candidate effects can explain beyond chance is model"
    return split_by_noise(fit, method, why, found, at_most=_at_most(fit, augmented, T, beta))


def _at_most(fit: Fit, augmented: Augmented, T: Vector, beta: Vector) -> float:
    """What noise may be though these directions explain some of it, as eps_RMSn.

    Noise may run with the rudder by chance, or because the helmsman answers it: what then seems to
    depend on the input does not carry over. The directions' coefficients `beta` are chosen on
    these rows, T are the directions by candidates' columns.
    """
    seen, raw, residual = augmented.fit, augmented.evidence.raw, augmented.residual
    blocks = left_out(seen, residual, augmented.psi, augmented.S @ T, augmented.stretches)
    whole, left = float(residual @ residual), raw.residual - raw.S @ (T @ beta)
    without, with_all = (sum(blocks.errors(c).whole) for c in ((), range(len(beta))))
    most = min(
        may_be_noise(seen, whole, without),
        may_be_noise(seen, float(left @ left), with_all, len(beta)),
    )
    return fit.eps_rmsn * float(np.sqrt(most / whole))


def _visible_directions(raw: Vector, whole: Vector, white: Vector) -> Vector:
    """Combinations of candidates that stand clear of each other and of the fit; (n_S, q)."""
    sizes = np.linalg.norm(whole, axis=0)
    seen = np.linalg.norm(raw, axis=0) > SEEN * sizes
    scale = np.where(seen, np.linalg.norm(white, axis=0), 1.0)
    columns = np.where(seen, white / np.where(scale > 0.0, scale, 1.0), 0.0)
    _, s, Vt = np.linalg.svd(np.linalg.qr(columns, mode="r"), full_matrices=False)
    kept = s > DISTINCT * s[0]
    return np.asarray(Vt[kept].T / np.where(scale > 0.0, scale, 1.0)[:, None])


def _unexplained(
    fit: Fit,
    output: int,
    Z: Vector,
    beta: Vector,
    covariance: Vector,
    parts: Sequence[Stretch],
) -> OutputNoise:
    """Noise of one output: its mean square less what the coefficients explain beyond chance."""
    rows = np.concatenate([np.arange(s.rows.start, s.rows.stop) for s in parts
                           if s.output == output])  # fmt: skip
    scale = fit.problem.weights[output] / np.sqrt(len(fit.problem.outputs))
    part = Z[rows] / scale
    explained = float(np.sum((part @ beta) ** 2))
    gram = part.T @ part
    chance = gram @ covariance
    model2 = max(explained - float(np.trace(chance)), 0.0)
    noise2 = max(fit.eps_by_output[fit.problem.outputs[output]] ** 2 - model2, 1e-30)
    spread2 = 2.0 * float(np.sum(chance * chance.T)) + 4.0 * float(beta @ gram @ covariance @ gram
                                                                   @ beta)  # fmt: skip
    return OutputNoise(noise2, float(np.sqrt(spread2)))
