"""What a run's folder keeps of a fit: how sure it is, what may be missing, what makes it again."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final, Protocol

from trialid.accuracy.likely import Standing
from trialid.accuracy.one_missing import Reduced, Rival
from trialid.arrays import Vector
from trialid.diagnosis.may_be_off import Doubts
from trialid.diagnosis.search.augment import Trace
from trialid.identification.fit import Fit, revive
from trialid.identification.nuisance.of_each_trial import Nuisance
from trialid.ship.effect import Effect

COVARIANCE: Final = "covariance"
ARRAYS: Final = ("gram", "moves", "deviations", "scales")


class Named(Protocol):
    """Anything with a name."""

    @property
    def name(self) -> str:
        """The name."""


class Trusted(Protocol):
    """How sure a fit is by noise: its unknowns and their covariance."""

    @property
    def parameters(self) -> Sequence[Named]:
        """The unknowns."""

    @property
    def covariance(self) -> Vector:
        """Of the unknowns; (n, n)."""


class Known(Protocol):
    """A fit with how sure it is and what may be missing in it."""

    @property
    def fit(self) -> Fit:
        """The fit."""

    @property
    def own_accuracy(self) -> Trusted:
        """How sure it is, by itself."""

    @property
    def doubts(self) -> Doubts:
        """What may be missing or held wrong."""

    @property
    def others(self) -> "Sequence[tuple[str, Known]]":
        """Models of the ship whose ranges its ranges hold, with what each has."""


@dataclass(frozen=True, kw_only=True)
class TraceRow:
    """A way in which an effect may be missing, the effect by its name."""

    effect: str
    columns: tuple[int, ...]
    parameters: tuple[str, ...]
    tried: Mapping[str, float]


@dataclass(frozen=True, kw_only=True)
class AboutModel:
    """All of a model's fit that is no array.

    Attributes
    ----------
    has
        What it has besides the run's, nothing for the run's own.
    effects, free, nuisance, estimates
        What makes it again: effects by name, what was estimated of the ship and of each trial, and
        every unknown.
    """

    has: str
    effects: tuple[str, ...]
    free: tuple[str, ...]
    nuisance: tuple[Nuisance, ...]
    estimates: Mapping[str, float]
    unknowns: tuple[str, ...]
    variance: float
    independent: float
    rivals: tuple[Rival, ...]
    held: tuple[str, ...]
    missing: tuple[TraceRow, ...]


@dataclass(frozen=True)
class Unknown:
    """The name of something that was fitted."""

    name: str


@dataclass(frozen=True)
class KeptAccuracy:
    """Unknowns and their covariance by noise."""

    parameters: tuple[Unknown, ...]
    covariance: Vector


@dataclass(frozen=True)
class KeptFit:
    """A fit with what was kept of it."""

    fit: Fit
    own_accuracy: KeptAccuracy
    doubts: Doubts
    others: "tuple[tuple[str, KeptFit], ...]" = ()


@dataclass(frozen=True)
class KeptModel:
    """How sure a fit is and what may be missing in it; of another model what makes it again."""

    accuracy: KeptAccuracy
    doubts: Doubts
    about: AboutModel

    def of(self, fit: Fit) -> KeptFit:
        """A fit with it."""
        return KeptFit(fit, self.accuracy, self.doubts)

    def beside(self, fit: Fit, catalogue: Mapping[str, Effect]) -> KeptFit:
        """The other model's fit to the trials of one, with it."""
        model, about = fit.model, self.about
        there = [e.name for e in model.effects]
        for name in (n for n in there if n not in about.effects):
            model = model - name
        for name in (n for n in about.effects if n not in there):
            model = model + catalogue[name]
        settings = replace(fit.settings, free=about.free, nuisance=about.nuisance)
        trials = [score.trial for score in fit.scores]
        return self.of(revive(trials, model, settings, about.estimates))


def about_model(has: str, done: Known) -> AboutModel:
    """What a fit is, without its arrays; `has` is what it has besides the run's."""
    doubts, model = done.doubts, done.fit.model
    reduced = doubts.standing.known
    return AboutModel(
        has=has,
        effects=tuple(e.name for e in model.effects),
        free=done.fit.settings.free,
        nuisance=done.fit.settings.nuisance,
        estimates=dict(done.fit.estimates),
        unknowns=tuple(p.name for p in done.own_accuracy.parameters),
        variance=reduced.variance,
        independent=reduced.independent,
        rivals=doubts.standing.rivals,
        held=doubts.held,
        missing=tuple(
            TraceRow(
                effect=t.effect.name, columns=t.columns, parameters=t.parameters, tried=t.tried
            )
            for t in doubts.missing
        ),
    )


def arrays_of(done: Known) -> dict[str, Vector]:
    """The arrays of a fit by name."""
    reduced = done.doubts.standing.known
    return {COVARIANCE: done.own_accuracy.covariance, **{n: getattr(reduced, n) for n in ARRAYS}}


def kept_model(
    about: AboutModel, arrays: Mapping[str, Vector], catalogue: Mapping[str, Effect]
) -> KeptModel:
    """What was kept of a fit, from the arrays of its own.

    Raises
    ------
    KeyError
        An effect or an array is not there.
    """
    reduced = Reduced(
        variance=about.variance,
        independent=about.independent,
        **{name: arrays[name] for name in ARRAYS},
    )
    missing = tuple(
        Trace(catalogue[t.effect], t.columns, t.parameters, t.tried) for t in about.missing
    )
    if about.has:  # its effects are needed, too
        _ = [catalogue[name] for name in about.effects]
    covariance = arrays[COVARIANCE]
    return KeptModel(
        KeptAccuracy(tuple(map(Unknown, about.unknowns)), covariance),
        Doubts(Standing(reduced, about.rivals), about.held, missing),
        about,
    )
