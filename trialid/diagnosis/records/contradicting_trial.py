"""Whether one trial contradicts all others, where no effect of the model explains it.

It is of another ship or loading, in a current, or its log is wrong: fitted beside it the others
cannot be followed, and without it they can. A model that only lacks a force loses little by any one
trial, unless she did in that what she does in no other; such a trial contradicts nothing.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from trialid.diagnosis.records.further import is_no_further, left_of_each, stands_out
from trialid.diagnosis.records.left_without import OTHERS, falls_without
from trialid.diagnosis.records.own_gain import gain_in_doubt, held_gain_in_doubt
from trialid.diagnosis.records.rate_and_angle import rate_in_doubt
from trialid.diagnosis.search.refit import Refit
from trialid.diagnosis.search.together import Together
from trialid.diagnosis.verdict import NAMED, Verdict
from trialid.errors import TrialidError
from trialid.identification.fit import Fit, identify

FALL: Final = 0.5
"""Share of the squared error of the others that goes without it, of those held out too. Of 24 sets
of four trials, one of which is of a ship whose nine numbers are off by 30 % each, in 5 of the 13
where it is fitted and asks for no more it is 0.61 to 0.78, and none is told wrongly; of 150 sets of
one ship with an effect missing, of 45 of a tanker's model and 21 of a model on a pond in wind it is
0.11 at most. Half of it finds 9 of the 13, twice none."""

APART: Final = 3.0
"""Times what is left of any other, in one held out that is told: of such sets 9 of 12, by 3.3 to
8.2, of 24 of one ship's 1.3 at most, of the tanker's and the pond's 2.7 and 1.9. Half of it finds
11 and looks at 8 of the 66, twice finds 4."""


@dataclass(frozen=True)
class Contradicting:
    """A trial without which the others are followed far better, or that they do not foretell.

    Attributes
    ----------
    alone, beside
        The fit of the others, and of all with it.
    held
        Whether it was held out.
    """

    trial: str
    alone: Fit
    beside: Fit
    held: bool

    @property
    def fall(self) -> float:
        """Share of the others' squared error that goes without it."""
        return _fall(self.beside, self.alone, _others(self.beside, self.trial))

    @property
    def fall_of_held(self) -> float | None:
        """The same of those held out; None where there are no others."""
        out = [t.name for t in self.beside.trials if t.use == "check" and t.name != self.trial]
        return _fall(self.beside, self.alone, out) if out else None

    @property
    def falls(self) -> bool:
        """Whether more goes than with a force that the model lacks."""
        out = self.fall_of_held
        return self.fall >= FALL and (out is None or out >= FALL)

    @property
    def stays(self) -> bool:
        """Whether it is followed no better for being fitted."""
        left = left_of_each(self.beside)
        return left[self.trial] >= 0.5 * APART * _most(left, _others(self.beside, self.trial))

    def is_explained_by(self, named: Fit) -> bool:
        """Whether a model with an effect follows all others as closely as one without this trial.

        Of two ships with a trial of another loading and of another ship an effect took as much off
        the fitted ones, and nothing off the one held out.
        """
        others = [t.name for t in self.beside.trials if t.name != self.trial]
        return _squares(named, others) < NAMED * _squares(self.alone, others)

    @property
    def sentence(self) -> str:
        """What was seen, and what it may be."""
        left, out = left_of_each(self.alone), self.fall_of_held
        both = "" if out is None else f" and of those held out by {out:.0%}"
        loses = f"without it their squared error falls by {self.fall:.0%}{both}, and "
        return (
            f"{self.trial} contradicts the others: {'' if self.held else loses}the model of the "
            f"others leaves an error of {left[self.trial]:.0%} in it, in each of them "
            f"{_most(left, _others(self.alone, self.trial)):.0%} at most, though she is asked for "
            "no more there: another ship or loading, a current or wind, or a fault in its log"
        )


def settle_trials(
    fit: Fit, verdict: Verdict, named: Fit | None, refits: Sequence[Fit] = ()
) -> Verdict:
    """The verdict; where a fitted trial contradicts the others, that, and nothing is named.

    A factor of one of its logs comes first, which says more than that the trial does; of effects
    all that were fitted may do as much (`refits`). A name stays where the effect does as much for
    the others as leaving that trial out, and where none contradicts the model with it.
    """
    if verdict.doubts:
        return verdict
    if gain := gain_in_doubt(fit.examined, [one.examined for one in refits]):
        return _in_doubt(gain)
    found = contradicting_trial(fit.examined)
    if named and (found is None or found.is_explained_by(named.examined)):
        found = contradicting_trial(named.examined)
    return verdict if found is None else _in_doubt(found.sentence)


def settle_held_out(fit: Fit, verdict: Verdict, named: Refit | Together | None) -> Verdict:
    """The verdict, with a trial held out that contradicts those that were fitted.

    What these agree on keeps its name, and that is told beside it.
    """
    if verdict.doubts or verdict.kind == "no fit":
        return verdict
    judged = (named.fit if named else fit).examined
    if (seen := _held_out_in_doubt(judged)) is None:
        return verdict
    if verdict.kind not in ("nothing missing", "cannot tell") or _tells(verdict):
        return replace(verdict, sentence=f"{verdict.sentence}; {seen}")
    return _in_doubt(seen)


def _tells(verdict: Verdict) -> bool:
    """Whether it says what may be missing, or what is to be freed."""
    return bool(verdict.family or verdict.together or verdict.held_as_well)


def _held_out_in_doubt(fit: Fit) -> str | None:
    """What the trial held out that stands out most contradicts; None where none does clearly."""
    left = left_of_each(fit)
    held = [t.name for t in fit.trials if t.use == "check"]
    worst = max(held, key=lambda name: left[name], default=None)
    if worst is None or not stands_out(fit, worst):
        return None
    seen = rate_in_doubt(fit, held=worst) or held_gain_in_doubt(fit, worst)
    found = None if seen else contradicting_held_out(fit)
    return found.sentence if found else seen


def _in_doubt(seen: str) -> Verdict:
    said = f"{seen}; until that is settled no effect is named"
    return Verdict("cannot tell", None, (), said, doubts=(seen,))


def contradicting_trial(fit: Fit) -> Contradicting | None:
    """The fitted trial that contradicts the others most; None where none does clearly.

    Slopes foretell by how much the error of the others falls without it; a fit has to agree.
    """
    falls = falls_without(fit)
    able = [n for n in _fitted(fit) if falls.get(n, 0.0) >= FALL and is_no_further(fit, n)]
    tried = (_told(fit, name) for name in sorted(able, key=lambda n: -falls[n]))
    return next((found for found in tried if found is not None and found.falls), None)


def contradicting_held_out(fit: Fit) -> Contradicting | None:
    """The trial held out that is foretold worst, where it stays so when it is fitted, too."""
    left, fitted = left_of_each(fit), _fitted(fit)
    most = APART * max(left[n] for n in fitted)
    able = [t.name for t in fit.trials if t.use == "check" and left[t.name] >= most]
    within = [n for n in able if len(fitted) >= OTHERS and is_no_further(fit, n)]
    found = _told(fit, max(within, key=lambda n: left[n])) if within else None
    return found if found and found.stays else None


def _fitted(fit: Fit) -> list[str]:
    return [t.name for t in fit.problem.trials]


def _told(fit: Fit, name: str) -> Contradicting | None:
    """What a fit without that trial says, with it where it was held out; None if it fails."""
    held = name not in _fitted(fit)
    moved = [
        replace(t, use="fit" if held else "check") if t.name == name else t for t in fit.trials
    ]
    try:
        again = identify(moved, fit.model, fit.settings, near=fit.estimates)
    except TrialidError:  # the others alone tell too little
        return None
    return Contradicting(name, *((fit, again) if held else (again, fit)), held)


def _others(fit: Fit, name: str) -> list[str]:
    """The fitted trials but this one."""
    return [t.name for t in fit.problem.trials if t.name != name]


def _most(left: Mapping[str, float], names: Sequence[str]) -> float:
    return max(left[n] for n in names)


def _fall(beside: Fit, alone: Fit, names: Sequence[str]) -> float:
    return 1.0 - _squares(alone, names) / max(_squares(beside, names), 1e-300)


def _squares(fit: Fit, names: Sequence[str]) -> float:
    """Squared error of these trials in the outputs' own units, each over what moved in all."""
    outputs, whole = fit.problem.outputs, 0.0
    for score in fit.scores:
        if score.trial.name not in names:
            continue
        for c, eps in score.eps_rmsn.items():
            moved = np.mean([np.var(s.trial.signals[c]) for s in fit.scores if c in s.eps_rmsn])
            whole += (eps * fit.problem.y_rms[outputs.index(c)]) ** 2 * score.counts[c] / moved
    return float(whole)  # of one that is lost it is endless, and proves nothing
