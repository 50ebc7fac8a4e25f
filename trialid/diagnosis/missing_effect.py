"""From scores to a verdict: refit the best candidates, confirm them, and say what is missing."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from trialid.diagnosis.noise import Split
from trialid.diagnosis.residual import effective_samples
from trialid.diagnosis.score import Candidate
from trialid.errors import TrialidError
from trialid.identification.fit import Fit, identify
from trialid.identification.pose import Settings
from trialid.ship.effect import Effect
from trialid.trial import Trial


@dataclass(frozen=True)
class Refit:
    """A candidate added to the model and fitted."""

    candidate: Candidate
    fit: Fit


Progress = Callable[[str], None]


def refit(
    fit: Fit, trials: Sequence[Trial], candidates: Sequence[Candidate], progress: Progress
) -> list[Refit]:
    """Each candidate added and fitted from its expected value; those that fail are left out."""
    done = []
    for candidate in candidates:
        progress(f"trying {candidate.effect.name}")
        start = {n: _inside(candidate.effect, n, x) for n, x in candidate.expected.items()}
        settings = _settings_with(fit.settings, candidate.effect)
        try:
            model = (fit.model + candidate.effect).with_values(start)
            near = fit.estimates | start
            done.append(Refit(candidate, identify(trials, model, settings, near=near)))
        except TrialidError:  # it cannot be fitted on this record: it is not the missing one
            continue
    return done


def _inside(effect: Effect, name: str, value: float) -> float:
    p = effect.parameters[name]
    return float(np.clip(value, p.low, p.high))


def _settings_with(settings: Settings, effect: Effect) -> Settings:
    new = tuple(p for p in effect.parameters if p not in settings.free)
    return replace(settings, free=(*settings.free, *new))


@dataclass(frozen=True)
class Verdict:
    """What the record says is missing, in one of four kinds, with the sentence a person reads."""

    kind: str
    effect: str | None
    family: tuple[str, ...]
    sentence: str


def decide(
    fit: Fit, ranking: Sequence[Candidate], refits: Sequence[Refit], parts: Split, level: float
) -> Verdict:
    """From scores and refits to a verdict: missing, nothing missing, not in catalogue, cannot tell.

    An effect is named only if its score stands out over the whole catalogue, its refitted value
    is physical, and the error falls on the held-out trials too where there are any.
    """
    named = confirmed(fit, refits, level)
    if named is not None:
        return _missing(fit, named)
    if parts.undermodelling_interval is None:
        return Verdict("cannot tell", None, (), _no_split(parts))
    low, high = parts.undermodelling_interval
    if low > 0.0:
        return Verdict(
            "not in catalogue", None, (),
            f"the model leaves an error of {low:.1%} to {high:.1%} that is not noise "
            f"({parts.method}), and no effect of the catalogue explains it",
        )  # fmt: skip
    return Verdict(
        "nothing missing", None, (),
        f"no effect stands out against the noise; a model error of up to {high:.1%} would not "
        f"be seen ({parts.method})",
    )  # fmt: skip


def _no_split(parts: Split) -> str:
    return (
        "no effect stands out, but noise and model error cannot be separated on this record: "
        + parts.why
    )


def confirmed(fit: Fit, refits: Sequence[Refit], level: float) -> Refit | None:
    """The best of the refits that stand every check, a parameter more paying its price.

    The price is that of Schwarz (1978) with the effective number of samples: an effect of four
    parameters must explain more than one of one parameter.
    """
    able = [
        r
        for r in refits
        if r.candidate.p_value < level
        and r.candidate.allowed
        and r.fit.eps_rmsn < fit.eps_rmsn
        and (fit.eps_check is None or (r.fit.eps_check or np.inf) < fit.eps_check)
    ]
    samples = effective_samples(fit)

    def cost(r: Refit) -> float:
        return samples * 2.0 * np.log(r.fit.eps_rmsn) + len(r.candidate.expected) * np.log(samples)

    return min(able, key=cost, default=None)


def _missing(fit: Fit, named: Refit) -> Verdict:
    candidate = named.candidate
    others = [n for n in candidate.family if n != candidate.effect.name]
    alike = f"; this record cannot tell it from {', '.join(others)}" if others else ""
    held = ""
    if fit.eps_check is not None and named.fit.eps_check is not None:
        held = f", on held-out trials from {fit.eps_check:.2%} to {named.fit.eps_check:.2%}"
    return Verdict(
        "missing", candidate.effect.name, candidate.family,
        f"{candidate.effect.name} is missing: with it the error falls from {fit.eps_rmsn:.2%} to "
        f"{named.fit.eps_rmsn:.2%}{held} (p = {candidate.p_value:.2g} over the catalogue){alike}",
    )  # fmt: skip
