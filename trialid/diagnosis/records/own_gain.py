"""Whether one trial's log of a signal reads by another factor than it does in the others.

A rudder indicator that was set anew, a speed log that is 12 % high in one run: fitted together with
the others such a record asks for a force that no ship has, mostly of large angles. The factor is a
number of that trial alone, so that slopes by it cost one simulation of one trial each.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Final, Literal

import numpy as np

from trialid.arrays import Vector
from trialid.diagnosis.records.further import is_no_further, stands_out
from trialid.diagnosis.records.left_without import OTHERS
from trialid.diagnosis.search.carry_over import prior_rows
from trialid.errors import TrialidError
from trialid.identification.adequacy import why_no_fit
from trialid.identification.check.log_scales import rows_of, slope_of_scale, with_a_scale
from trialid.identification.fit import Fit, identify
from trialid.trial import Trial

FALL: Final = 0.2
"""Share of the squared error that goes with it. Of 194 ships with an effect hidden it is 0.08 at
most, of 22 choices of real zig-zags on a pond and in a basin less. Of 48 records of which one trial
reads 5 to 18 % otherwise it is told in 18, each time of the right trial and its right sensor; half
as much tells 28, all right, and twice 13. Of an outsider's 53 runs it is told of ten with such a
log, rightly, and of one with a wind in that trial alone, wrongly."""

LEAST: Final = 0.02
"""By which a factor is another than 1: a record of a basin shows less, and no indicator is as good.
All that were told are 5 % off and more: half of it and twice tell the same."""

AHEAD: Final = 1.1
"""An effect that leaves this many times what is left with a factor gives way to it, and so does
another log of the same trial; one that leaves less does not. Of those 18 records any other log of
the trial leaves 1.08 to 13 times as much, the best effect of nine more 1.48 times and more: half as
far beyond 1 and twice decide alike of effects; twice leaves three of the 18 with two logs."""

TRIED: Final = 3
"""Of what slopes foretell most of; fitted."""

ARRIVED: Final = 0.003
"""Of the factor, by which it no longer moves: a third of a percent is no other calibration."""
ROUNDS: Final = 4
UNSEEN: Final = 1e-9
"""Share of a slope's square below which what is free does the same."""
_SINGULAR: Final = 1e-9
"""Share of the largest singular value below which a direction moves nothing."""
RANGE: Final = (0.5, 2.0)
"""Of the factor: what is further off is another unit, and looked for as that."""


@dataclass(frozen=True)
class Factor:
    """What a trial's log of a signal is multiplied by."""

    trial: str
    signal: str
    by: float = 1.0

    def taken(self, trials: Sequence[Trial]) -> tuple[Trial, ...]:
        """The trials with that log multiplied."""
        return tuple(self._scaled(t) if t.name == self.trial else t for t in trials)

    def _scaled(self, trial: Trial) -> Trial:
        signals = {**trial.signals, self.signal: trial.signals[self.signal] * self.by}
        return replace(trial, signals=signals)


@dataclass(frozen=True)
class OwnGain:
    """A factor of one trial's log, and the fit of all trials with it."""

    factor: Factor
    before: Fit
    fit: Fit

    @property
    def left(self) -> float:
        """Share of the squared error of the fitted trials that is left with it."""
        return left_of(self.before, self.fit, self.factor)

    @property
    def held(self) -> float:
        """The same of trials held out."""
        return left_of(self.before, self.fit, self.factor, "check")

    def leaves_as_much(self, other: Fit) -> bool:
        """Whether another fit leaves about as little, of fitted trials and of those held out."""
        held = left_of(self.before, other, use="check")
        return left_of(self.before, other) < AHEAD * self.left and held < AHEAD * self.held

    @property
    def falls(self) -> bool:
        """Whether much goes with it, nothing of trials held out is lost, and no force does so.

        What a model lacks at large angles makes the one trial that has them look so, and of another
        ship it explains a part.
        """
        much = self.left <= 1.0 - FALL and self.held <= 1.0 and abs(self.factor.by - 1.0) >= LEAST
        trial = self.factor.trial
        return much and is_no_further(self.fit, trial) and not stands_out(self.fit, trial)

    @property
    def words(self) -> str:
        """What the trial's record would be multiplied by."""
        return f"{self.factor.signal} times {self.factor.by:.3g}"


def gain_in_doubt(fit: Fit, refits: Sequence[Fit] = ()) -> str | None:
    """What one trial's log may read otherwise than in the others; None where none clearly does.

    Nothing where any effect that was fitted leaves about as little, of trials held out, too.
    """
    found = own_gains(fit)
    if not found or any(found[0].leaves_as_much(other) for other in refits):
        return None
    return _sentence(found, "with")


def held_gain_in_doubt(fit: Fit, held: str) -> str | None:
    """The same with a trial held out fitted beside the others: it may be one of these that is off.

    Of an outsider's ship whose log read 6 % high in one that was fitted the faultless one was told.
    """
    if len(fit.problem.trials) < OTHERS or why_no_fit(fit):
        return None
    trials = [replace(t, use="fit") if t.name == held else t for t in fit.trials]
    try:
        beside = identify(trials, fit.model, fit.settings, near=fit.estimates)
    except TrialidError:
        return None
    if not (found := own_gains(beside)):
        return None
    its = found[0].factor.trial == held
    return _sentence(found, "fitted beside them with" if its else f"with {held} fitted too and")


def _sentence(found: Sequence[OwnGain], begins: str) -> str:
    """What was seen, and what it may be."""
    best = found[0]
    same = [g for g in found if g.factor.trial == best.factor.trial]
    as_good = [g.words for g in same if g.left < AHEAD * best.left]
    held = (best.before.eps_check, best.fit.eps_check)
    out = "" if None in held else f", on held-out trials from {held[0]:.2%} to {held[1]:.2%}"
    return (
        f"{best.factor.trial} reads otherwise than the others: {begins} its "
        f"{' or '.join(as_good)} the error falls from {best.before.eps_rmsn:.2%} to "
        f"{best.fit.eps_rmsn:.2%}{out}; that log is off, or load, depth, wind or current was "
        "another there: where a second sensor agrees multiply its gain in the trial's "
        "[trial.signals] by that, or leave the trial out"
    )


def own_gains(fit: Fit) -> list[OwnGain]:
    """Factors of one trial's log with which much goes, the one that leaves least first."""
    if len(fit.problem.trials) <= OTHERS or not fit.model.states or why_no_fit(fit):
        return []
    explained = _Explained.by(fit)
    steps = ((_foretold(fit, explained, f), f) for f in _factors(fit))
    able = sorted((s for s in steps if s[0][0] >= 0.5 * FALL), key=lambda s: -s[0][0])[:TRIED]
    found = (_fitted(fit, replace(f, by=1.0 + step)) for (_, step), f in able)
    return sorted((g for g in found if g is not None and g.falls), key=lambda g: g.left)


def left_of(
    before: Fit, fit: Fit, factor: Factor | None = None, use: Literal["fit", "check"] = "fit"
) -> float:
    """Squared error of one fit in that of another, of trials of this use; 1 where there are none.

    What is left of a log that was multiplied counts as it was recorded.
    """
    whole = _squares(before, before, None, use)
    return _squares(before, fit, factor, use) / whole if whole > 0.0 else 1.0


def _squares(norm: Fit, fit: Fit, factor: Factor | None, use: str) -> float:
    """Squared error, each output by the norm, the weight and the samples of the first fit."""
    whole, outputs = 0.0, fit.problem.outputs
    counts = {
        c: sum(s.counts.get(c, 0) for s in norm.scores if s.trial.use == use) for c in outputs
    }
    for score in (s for s in fit.scores if s.trial.use == use):
        for c, eps in score.eps_rmsn.items():
            i = outputs.index(c)
            own = factor and (factor.trial, factor.signal) == (score.trial.name, c)
            by = factor.by if factor and own else 1.0
            size = fit.problem.y_rms[i] / norm.problem.y_rms[i] / by
            share = score.counts[c] / max(counts[c], 1)
            whole += share * (norm.problem.weights[i] * eps * size) ** 2
    return float(whole)


def _factors(fit: Fit) -> Iterator[Factor]:
    """Of every log that is read and has a scale."""
    for place, trial in enumerate(fit.problem.trials):
        yield from (Factor(trial.name, name) for name in with_a_scale(fit.problem, place))


@dataclass(frozen=True)
class _Explained:
    """What all unknowns of a fit together move, and what they leave.

    Attributes
    ----------
    basis
        Orthonormal columns that span it, priors as rows of their own below; (M + n_theta, k).
    left
        The residual without it; (M + n_theta,).
    """

    basis: Vector
    left: Vector

    @classmethod
    def by(cls, fit: Fit) -> "_Explained":
        """Of all that is free in a fit."""
        slope, gap = prior_rows(fit).T
        psi, residual = np.vstack([fit.psi, np.diag(slope)]), np.concatenate([fit.residual, gap])
        psi = psi[:, [x.name not in fit.at_bounds for x in fit.problem.unknowns]]
        sizes = np.linalg.norm(psi, axis=0)
        U, s, _ = np.linalg.svd(psi / np.where(sizes > 0.0, sizes, 1.0), full_matrices=False)
        basis = U[:, s > _SINGULAR * s.max(initial=0.0)]
        return cls(basis, residual - basis @ (basis.T @ residual))


def _foretold(fit: Fit, explained: _Explained, factor: Factor) -> tuple[float, float]:
    """Share of the squared error that goes by the slope of a factor, and the factor's step."""
    place = next(i for i, t in enumerate(fit.problem.trials) if t.name == factor.trial)
    rows, slope = rows_of(fit.problem, place), -slope_of_scale(fit, place, factor.signal)
    inside = explained.basis[rows].T @ slope
    whole = float(slope @ slope)
    square, moment = whole - float(inside @ inside), float(slope @ explained.left[rows])
    if square <= UNSEEN * whole:
        return 0.0, 0.0
    return moment**2 / square / float(fit.residual @ fit.residual), moment / square


def _fitted(fit: Fit, factor: Factor) -> OwnGain | None:
    """The factor and all unknowns fitted in turn; None where they do not arrive, or far off."""
    near = fit.estimates
    for _ in range(ROUNDS):
        if not RANGE[0] <= factor.by <= RANGE[1]:
            return None
        try:
            found = identify(factor.taken(fit.trials), fit.model, fit.settings, near=near)
        except TrialidError:  # the others alone tell too little
            return None
        _, step = _foretold(found, _Explained.by(found), factor)
        if abs(step) <= ARRIVED:
            return OwnGain(factor, fit, found)
        factor, near = replace(factor, by=factor.by * (1.0 + step)), found.estimates
    return None
