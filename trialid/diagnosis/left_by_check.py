"""Whether trials that were not fitted leave what noise of the fitted ones would leave in them.

Were noise all that is left, the mean square of a trial held out would be that of the fitted ones
and what the parameters, uncertain by that noise, move it by. Where it is much more, the trial was
noisier or does not follow this model, and nobody can say that nothing is missing. Its start and its
sensors are its own and count for nothing.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import fdtrc  # scipy.stats would take another 0.4 s to import

from trialid.arrays import Mask, Vector
from trialid.diagnosis.noise.residual import OutputNoise, heavy_tail, pool_variance, residuals
from trialid.diagnosis.objections import SEEN
from trialid.diagnosis.search.falls import fall, fall_of_all, fall_of_check
from trialid.diagnosis.search.refit import Refit
from trialid.diagnosis.verdict import SHARE, Verdict
from trialid.identification.check.own_sensor import OWN
from trialid.identification.fit import Fit
from trialid.identification.output_error import row_scale, stretches_of
from trialid.identification.remarks import zero_between_trials
from trialid.identification.trial_score import check_rows

Piece = tuple[Vector, Mask]
"""The residual of one output of one trial, and where it was compared; (N,) each."""


@dataclass(frozen=True)
class LeftByCheck:
    """What trials held out leave of one output, and what noise alone would; shares of y_RMS.

    `p_value` is the chance that noise alone leaves as much.
    """

    output: str
    left: float
    by_noise: float
    p_value: float

    @property
    def beyond_noise(self) -> float:
        """What noise does not leave of it, a share of y_RMS."""
        return float(np.sqrt(max(self.left**2 - self.by_noise**2, 0.0)))


def with_held_out(
    fit: Fit,
    verdict: Verdict,
    covariance: Callable[[], Vector],
    level: float,
    named: Refit | None = None,
) -> Verdict:
    """The verdict; `cannot tell` where trials held out leave more than noise, and nothing says why.

    So for `nothing missing`, and for a name that explains little of either.

    Parameters
    ----------
    covariance
        Of all unknowns of the fit, by noise; asked for where it is needed.
    level
        Chance of as much by noise, over all outputs, below which it is not believed.
    named
        What is to be named, if anything is, in a model that has not grown.
    """
    if fit.eps_check is None or (named is None and verdict.kind != "nothing missing"):
        return verdict
    if named is not None:
        named = replace(named, fit=named.fit.examined)
    fit = fit.examined
    found = left_by_check(fit, covariance())
    worst = min(found, key=lambda one: one.p_value, default=None)
    if worst is None or worst.p_value >= level / len(found) or worst.beyond_noise < SEEN:
        said = "" if named else _by_own_sensors(fit, found)
        return _with_own_sensors(fit, verdict, said) if said else verdict
    if named is not None and _explained(fit, named, worst) >= SHARE:
        return verdict
    return Verdict("cannot tell", None, (), _left_open(fit, named, worst))


def _explained(fit: Fit, named: Refit, worst: LeftByCheck) -> float:
    """What goes of the squared error with a name, fitted or not, by what noise does not leave."""
    fitted, held = fit.eps_rmsn**2, (fit.eps_check or 0.0) ** 2
    beyond = held * (1.0 - (worst.by_noise / worst.left) ** 2)
    return fall_of_all(fit, named) * (fitted + held) / beyond


def _left_open(fit: Fit, named: Refit | None, worst: LeftByCheck) -> str:
    """That something is missing in trials held out which no effect explains."""
    begins, lacks = "no effect stands out in the fitted trials, but those", "something"
    if named is not None:
        gone, held = fall(fit, named), fall_of_check(fit, named)
        begins = (
            f"{named.candidate.effect.name} takes {gone:.0%} of the squared error off the fitted "
            f"trials and {held:.0%} off the others, but those"
        )
        lacks = "something greater"
    return (
        f"{begins} held out leave {worst.left:.1%} of {worst.output}{_of_own(fit, worst)} where "
        f"noise would leave {worst.by_noise:.1%} (p = {worst.p_value:.2g}): {lacks} is missing "
        "that acts there, or it was rougher; fit them too and hold others out"
    )


def _of_own(fit: Fit, one: LeftByCheck) -> str:
    """That it is so little with sensors of their own alone, where the table has far more."""
    whole = fit.eps_check_by_output[one.output]
    return " with zeros and delays of their own" if whole >= OWN * one.left else ""


def _with_own_sensors(fit: Fit, verdict: Verdict, said: str) -> Verdict:
    """The verdict with that clause; none where a rudder's zero differs, too: a gear has one.

    Of a ship whose rudder read 0.85 of its angle in one log of four `nothing missing` was said,
    with 17 % left in the trial held out, of 6 % noise.
    """
    if not (between := zero_between_trials(fit)):
        return replace(verdict, sentence=f"{verdict.sentence}; {said}")
    zeros = {t.name: fit.value(f"delta_0 [{t.name}]") for t in fit.trials if t.use == "fit"}
    middle = float(np.median([*zeros.values()]))
    most = max(zeros, key=lambda name: abs(zeros[name] - middle))
    sentence = (
        f"no effect stands out against the noise; {said}; and the rudder's zero is another in "
        f"each trial, by {np.rad2deg(between):.2g} deg, in {most} most: something acts there that "
        "does not in others, or its rudder reads too much or too little"
    )
    return Verdict("cannot tell", None, (), sentence)


def _by_own_sensors(fit: Fit, found: Sequence[LeftByCheck]) -> str:
    """A clause on an output whose held-out error is mostly of sensors unlike the others' mean.

    They may be; or their zeros and delays, free in each trial, take up what is missing.
    """
    whole = fit.eps_check_by_output
    worst = max(found, key=lambda one: whole[one.output] / one.left, default=None)
    if worst is None or whole[worst.output] < OWN * worst.left:
        return ""
    return (
        f"of {worst.output} trials held out leave {whole[worst.output]:.1%}, but "
        f"{worst.left:.1%} with zeros and delays of their own: sensors differ so, or take up what "
        "is missing"
    )


def left_by_check(fit: Fit, covariance: Vector) -> tuple[LeftByCheck, ...]:
    """What the trials held out leave, output by output; none where that has no measure.

    They leave the model, or something moves them that no fitted trial tells.
    """
    problem, checks = fit.problem, [s for s in fit.scores if s.trial.use == "check"]
    rows = [check_rows(fit, s.trial) for s in checks]
    known = [r for r in rows if r is not None]
    if not known or len(known) < len(rows):
        return ()
    residual = np.concatenate([r.residual for r in known])
    psi, C = _moving(fit, np.vstack([r.psi for r in known]), covariance)
    if not np.isfinite(C).all():
        return ()
    scale = row_scale(problem) * problem.y_rms
    parts, fitted, told = stretches_of([s.compared for s in checks]), residuals(fit), []
    for c, output in enumerate(problem.outputs):
        mine = [p for p in parts if p.output == c]
        held = [(p.on_clock(residual[p.rows] / scale[c]), p.compared) for p in mine]
        own = [(r.eps[:, c], r.compared[:, c]) for r in fitted]
        slopes = np.concatenate([psi[p.rows] for p in mine]) / scale[c]
        told.append(_of_output(output, own, held, C @ (slopes.T @ slopes) / max(len(slopes), 1)))
    return tuple(one for one in told if one is not None)


def _of_output(
    output: str, own: Sequence[Piece], held: Sequence[Piece], moved: Vector
) -> LeftByCheck | None:
    """What is left of one output in fitted trials and in those held out; None of too little.

    The trace of `moved` is what uncertain parameters add to the mean square.
    """
    noise, left = _mean_square(own), _mean_square(held)
    if noise is None or left is None:
        return None
    share, chance = _by_noise(noise, left, moved)
    rms = np.sqrt(sum(e @ e for e, _ in held) / sum(mask.sum() for _, mask in held))
    return LeftByCheck(output, float(rms), float(share * rms), chance)


def _moving(fit: Fit, psi: Vector, covariance: Vector) -> tuple[Vector, Vector]:
    """Columns and covariance of the shared parameters that move these rows at all."""
    shared = [i for i, x in enumerate(fit.problem.unknowns) if x.trial is None]
    moving = np.any(psi != 0.0, axis=0)
    kept = np.array(shared, dtype=int)[moving]
    return psi[:, moving], covariance[np.ix_(kept, kept)]


def _mean_square(found: Sequence[Piece]) -> OutputNoise | None:
    pieces, masks = [e for e, _ in found], [mask for _, mask in found]
    return pool_variance(pieces, masks, tail=heavy_tail(pieces, masks))


def _by_noise(noise: OutputNoise, left: OutputNoise, moved: Vector) -> tuple[float, float]:
    """What noise would leave, as a share of what is left, and the chance of so much.

    F of the mean squares, with the degrees of freedom that their scatter leaves.
    """
    expected = noise.variance + float(np.trace(moved))
    own = left.deviation / left.variance * noise.variance
    spread = own**2 + 2.0 * float(np.trace(moved @ moved))
    upper = 2.0 * expected**2 / spread
    lower = 2.0 * (noise.variance / noise.deviation) ** 2
    chance = float(fdtrc(upper, lower, left.variance / expected))
    return float(np.sqrt(expected / left.variance)), chance
