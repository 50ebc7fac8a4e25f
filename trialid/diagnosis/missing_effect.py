"""From scores to a verdict: refit the best candidates, confirm them, and say what is missing."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from trialid.diagnosis.completeness import Completeness
from trialid.diagnosis.likelihood import check_gain, misfits, speaks_against
from trialid.diagnosis.noise import Split
from trialid.diagnosis.score import Candidate, price
from trialid.errors import TrialidError
from trialid.identification.fit import Fit, identify
from trialid.identification.pose import Settings
from trialid.ship.effect import Effect, Force, Mass, Rate
from trialid.trial import Trial

DECISIVE: Final = 10.0
"""Difference of twice the log likelihood that decides: odds of 150 to 1, for the noise's colour is
an estimate itself."""

BEYOND_DOUBT: Final = 100.0
"""The same for effects whose traces look alike: fitted, they are this far apart."""

CLOSE: Final = 6.0
"""The same for what is tried first: odds of 20 to 1 and less are no preference."""

FAINT: Final = 0.025
"""Share of its trace that an effect must keep beside the free parameters to be named for a small
part of the error: a centre of gravity or a scale keeps less, and other errors look like it."""

DOMINANT: Final = 0.2
"""Share of the squared error from which on an effect is named however little of it shows."""

TRIFLE: Final = 0.01
"""Share of the squared error below which a likely effect is hardly worth its name, ..."""

FAR_MORE: Final = 10.0
"""... where another that stands out lowers the error by so many times as much: the likelihood is of
whitened residuals, and on smooth records it is won by what is fast."""


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
    fit: Fit,
    ranking: Sequence[Candidate],
    refits: Sequence[Refit],
    parts: Split,
    whole: Completeness | None,
    level: float,
) -> Verdict:
    """From scores and refits to a verdict: missing, nothing missing, not in catalogue, cannot tell.

    An effect is named only if its score stands out over the whole catalogue, its refitted value
    is physical, held-out trials do not speak against it, and no force of another shape explains
    far more.
    """
    named = confirmed(fit, refits, level)
    if whole is not None and whole.gap:
        return Verdict("not in catalogue", None, (), _gap(named, whole))
    if named is not None and _is_faint(fit, named):
        return Verdict("cannot tell", None, (), _faint(named))
    larger = None if named is None else _larger(fit, named, refits, level)
    if named is not None and larger is not None:
        return Verdict("cannot tell", None, (), _trifle(fit, named, larger))
    if named is not None:
        return _missing(fit, named, rivals(fit, named, ranking, refits))
    return _unnamed(parts, whole)


def _unnamed(parts: Split, whole: Completeness | None) -> Verdict:
    """What to say where no effect stands out."""
    if parts.undermodelling_interval is None:
        return Verdict("cannot tell", None, (), _no_split(parts))
    low, high = parts.undermodelling_interval
    if low > 0.0 and whole is not None and whole.any_shape <= 0.0:
        return Verdict(
            "cannot tell", None, (),
            f"an error of {low:.1%} to {high:.1%} is more than the noise ({parts.method}), but no "
            "effect and no force of a simple shape shows in it: rougher weather looks the same",
        )  # fmt: skip
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


def _gap(named: Refit | None, whole: Completeness) -> str:
    closest = f"; the closest is {named.candidate.effect.name}" if named else ""
    share = max(whole.catalogue, 0.0) / whole.any_shape
    return (
        "something is missing that the catalogue does not hold: its effects gain "
        f"{share:.0%} of what a force of a simple shape would{closest}"
    )


def _is_faint(fit: Fit, named: Refit) -> bool:
    """Whether little of the effect shows, and it explains little: other errors may look so."""
    return named.candidate.visibility < FAINT and _fall(fit, named) < DOMINANT


def _fall(fit: Fit, refit: Refit) -> float:
    """Share of the squared error that goes with an effect."""
    return float(1.0 - (refit.fit.eps_rmsn / fit.eps_rmsn) ** 2)


def _larger(fit: Fit, named: Refit, refits: Sequence[Refit], level: float) -> Refit | None:
    """What lowers the error far more than the likeliest effect, where that hardly lowers it."""
    if _fall(fit, named) >= TRIFLE:
        return None
    more = [
        r
        for r in refits
        if r.candidate.p_value < level
        and r.candidate.allowed
        and _fall(fit, r) > max(FAR_MORE * _fall(fit, named), TRIFLE)
        and _helps_held_out(fit, r.fit)
    ]
    return max(more, key=lambda r: _fall(fit, r), default=None)


def _helps_held_out(before: Fit, after: Fit) -> bool:
    """Whether held-out trials, where there are any, come out better."""
    old, new = before.eps_check, after.eps_check
    return old is None or (new is not None and new < old)


def _trifle(fit: Fit, named: Refit, larger: Refit) -> str:
    one, other = named.candidate.effect.name, larger.candidate.effect.name
    held = f" (held out {larger.fit.eps_check:.2%})" if larger.fit.eps_check is not None else ""
    return (
        f"{one} is the likeliest by what is left when the noise's colour is taken out, but lowers "
        f"the error from {fit.eps_rmsn:.2%} to {named.fit.eps_rmsn:.2%} only; {other} would bring "
        f"it to {larger.fit.eps_rmsn:.2%}{held}: this record cannot tell which is missing"
    )


def _faint(named: Refit) -> str:
    candidate = named.candidate
    return (
        f"{candidate.effect.name} would explain a part of the error, but "
        f"{1.0 - candidate.visibility:.1%} of what it does the free parameters do as well: a small "
        "error elsewhere in the model looks the same"
    )


def _no_split(parts: Split) -> str:
    return (
        "no effect stands out, but noise and model error cannot be separated on this record: "
        + parts.why
    )


def confirmed(fit: Fit, refits: Sequence[Refit], level: float) -> Refit | None:
    """The likeliest of the refits that stand every check, a parameter more paying its price.

    The price is that of Schwarz (1978): an effect of four parameters must explain more than one of
    one parameter. Where a sensor, a clock or the rudder's zero explains the record as well as a
    force does, it is tried first.
    """
    able = [r for r in refits if r.candidate.p_value < level and r.candidate.allowed]
    if not able:
        return None
    plain, *costs = _costs(fit, able)
    _, colour, _ = misfits([fit, *(r.fit for r in able)])
    standing = [
        (c, r)
        for c, r in zip(costs, able, strict=True)
        if c < plain and not speaks_against(check_gain(fit, r.fit, colour))
    ]
    if not standing:
        return None
    least = min(c for c, _ in standing)
    close = [(c, r) for c, r in standing if c < least + CLOSE]
    faint = [x for x in close if _is_faint(fit, x[1])]  # one of them makes all of them doubtful
    return min(faint or close, key=lambda x: (not _is_instrumental(x[1]), x[0]))[1]


def _is_instrumental(refit: Refit) -> bool:
    """Whether it is about sensors, clocks or the rudder's record, not about the ship."""
    return not {Force, Rate, Mass} & set(refit.candidate.effect.forms)


def _costs(fit: Fit, refits: Sequence[Refit]) -> list[float]:
    """Schwarz's cost of the fit as it is, then with each effect in it."""
    squares, _, rows = misfits([fit, *(r.fit for r in refits)])
    each = float(np.log(rows))
    added = [0, *(len(r.candidate.effect.parameters) for r in refits)]
    inflation = refits[0].candidate.inflation
    return [s / inflation + n * each for s, n in zip(squares, added, strict=True)]


def rivals(
    fit: Fit, named: Refit, ranking: Sequence[Candidate], refits: Sequence[Refit]
) -> tuple[str, ...]:
    """Effects that this record cannot tell from the named one: alike in trace, or as good."""
    plain, *costs = _costs(fit, refits)
    known = {r.candidate.effect.name: c for r, c in zip(refits, costs, strict=True)}
    _, _, rows = misfits([fit])
    best = known[named.candidate.effect.name]
    close = [
        c.effect.name
        for c in ranking
        if c.allowed
        and c is not named.candidate
        and known.get(c.effect.name, plain + price(c, rows)) < best + DECISIVE
    ]
    apart = {n for n, c in known.items() if c > best + BEYOND_DOUBT}
    alike = [n for n in named.candidate.family[1:] if n not in close and n not in apart]
    return (*close, *alike)


def _missing(fit: Fit, named: Refit, others: tuple[str, ...]) -> Verdict:
    candidate = named.candidate
    alike = f"; this record cannot tell it from {', '.join(others)}" if others else ""
    held = ""
    if fit.eps_check is not None and named.fit.eps_check is not None:
        held = f", on held-out trials from {fit.eps_check:.2%} to {named.fit.eps_check:.2%}"
    return Verdict(
        "missing", candidate.effect.name, (candidate.effect.name, *others),
        f"{candidate.effect.name} is missing: with it the error falls from {fit.eps_rmsn:.2%} to "
        f"{named.fit.eps_rmsn:.2%}{held} (p = {candidate.p_value:.2g} over the catalogue){alike}",
    )  # fmt: skip
