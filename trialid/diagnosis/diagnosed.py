"""What is asked of a diagnosis, and what it finds out."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

from trialid.accuracy.parameter_table import Accuracy
from trialid.accuracy.ranges import IN_TIME, USUAL_FORCES
from trialid.accuracy.widened import embrace
from trialid.diagnosis.force.missing_force import MissingForce
from trialid.diagnosis.force.usual_forces import beside_usual_forces
from trialid.diagnosis.may_be_off import Doubts, doubts
from trialid.diagnosis.noise.error_parts import Split
from trialid.diagnosis.noise.split import split
from trialid.diagnosis.prediction_band import prediction_band
from trialid.diagnosis.records.early_sensor import beside_in_time
from trialid.diagnosis.search.augment import Augmented, augment
from trialid.diagnosis.search.refit import Refit
from trialid.diagnosis.search.score import Candidate
from trialid.diagnosis.search.together import Together
from trialid.diagnosis.trust import accuracy_of
from trialid.diagnosis.verdict import Verdict
from trialid.diagnosis.where.misfit import Where
from trialid.effects import CATALOGUE
from trialid.identification.fit import Fit
from trialid.ship.effect import Effect


@dataclass(frozen=True, kw_only=True)
class DiagnoseSettings:
    """How to diagnose; see the pipeline's `[diagnose]`.

    Attributes
    ----------
    candidates
        Effects to try, by name.
    coefficients
        Whether coefficients that the model holds fixed are tried too.
    noise
        Stated sensor figures by output [SI].
    quiet
        Stretches declared to be without excitation [s], by trial.
    """

    candidates: Mapping[str, Effect] = field(default_factory=lambda: CATALOGUE)
    coefficients: bool = True
    family_cos: float = 0.95
    level: float = 0.05
    refit: int = 4
    noise: Mapping[str, float] = field(default_factory=dict)
    quiet: Mapping[str, list[tuple[float, float]]] = field(default_factory=dict)


@dataclass(frozen=True)
class Diagnosed:
    """One fit with what its error is made of and how far its parameters can be trusted.

    `named` is the model with the effect that is missing in it, where one has a name.
    """

    fit: Fit
    split: Split
    routes: tuple[Split, ...]
    doubts: Doubts
    named: "tuple[str, Diagnosed] | None" = None

    def beside(self, effect: str | None, named: "Diagnosed | None") -> "Diagnosed":
        """The same beside the model with the effect that is missing, where one has a name."""
        if effect is None or named is None:
            return self
        beside = replace(self, named=(effect, named))
        vars(beside)["own_accuracy"] = self.own_accuracy  # of the same fit and split
        return beside

    @cached_property
    def own_accuracy(self) -> Accuracy:
        """Eq. 8 to 14 and likely ranges of every unknown, of this model alone."""
        return accuracy_of(self.fit, self.split, self.doubts.averaged)

    @cached_property
    def others(self) -> "tuple[tuple[str, Diagnosed], ...]":
        """Models that the ranges of whatever follows from this one hold, with what each has.

        The model with the effect that is missing, and what belongs beside that; where none has a
        name, those with all usual forces, and the one with its sensors in time if any is early.
        """
        if self.named is not None:
            return (self.named, *self.named[1].others)
        usual, in_time = (
            beside(self.fit, lambda fit: examination(fit, augment(fit, {})))
            for beside in (beside_usual_forces, beside_in_time)
        )
        return (*((USUAL_FORCES, one) for one in usual), *((IN_TIME, one) for one in in_time))

    @cached_property
    def accuracy(self) -> Accuracy:
        """Eq. 8 to 14 and likely ranges of every unknown, as wide as the other models say."""
        return embrace(self.own_accuracy, [(n, one.own_accuracy) for n, one in self.others])

    @cached_property
    def band(self) -> dict[str, float]:
        """Half-width of the 95 % band of a trial that was not fitted, by output [SI]."""
        return prediction_band(self.fit)


def examination(fit: Fit, augmented: Augmented, asked: DiagnoseSettings | None = None) -> Diagnosed:
    """A fit with what its error is made of, from the traces of what may be missing."""
    known = asked or DiagnoseSettings()
    best, routes = split(fit, augmented, known.noise, known.quiet)
    return Diagnosed(fit, best, routes, doubts(augmented))


@dataclass(frozen=True, kw_only=True)
class Diagnosis:
    """All that was found out about a fit.

    `after` is the confirmed refit, diagnosed in its turn; None where no effect was named. `force`
    is None where nobody asked and the verdict is another, `together` where an effect has a name,
    or no two explain more than any alone.
    """

    before: Diagnosed
    left_out: Mapping[str, str]
    verdict: Verdict
    where: Where
    ranking: tuple[Candidate, ...] = ()
    refits: tuple[Refit, ...] = ()
    after: Diagnosed | None = None
    force: MissingForce | None = None
    together: Together | None = None
