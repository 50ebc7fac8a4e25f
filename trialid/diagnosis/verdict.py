"""From scores and refits to a verdict: what is missing, in a sentence."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from trialid.diagnosis.noise.error_parts import Split
from trialid.diagnosis.search.carried import FALL, as_good
from trialid.diagnosis.search.completeness import Completeness
from trialid.diagnosis.search.refit import (
    AS_SLOW,
    HELD_OUT,
    NOT_ARRIVED,
    SLIGHT,
    Refit,
    best_of,
    fall,
    falls,
    likeliest_refit,
    objection,
    worse_held_out,
)
from trialid.diagnosis.search.rivals import rivals
from trialid.diagnosis.search.score import Candidate
from trialid.identification.fit import Fit

NAMED: Final = 1.10
"""Ratio of squared errors that a further effect must be worth to be named beside the first: below
it, of what was added to ships of another hull, half were corrections of a shape."""

SHARE: Final = 0.12
"""Share of what is not noise that the best effect must explain: the best of the catalogue explains
0.04 of what it does not hold, and 0.21 or more of what it holds."""

ANYTHING: Final = 0.5
"""Model error from which on what would not be seen may be anything: half of what moved."""


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
    grown: bool = False,
) -> Verdict:
    """From scores and refits to a verdict: missing, nothing missing, not in catalogue, cannot tell.

    An effect is named only if its score stands out over the whole catalogue, its refitted value
    is physical, held-out trials do not speak against it, and neither a force of another shape nor
    an effect whose search did not arrive explains far more; and where the blocks left out alone
    show it, only if none as good differs in trace. In a model that has `grown` by effects already
    it must be worth a tenth.
    """
    named = likeliest_refit(fit, refits, level, grown)
    if whole is not None and (whole.outdoes(named.carried) if named else whole.gap):
        return Verdict("not in catalogue", None, (), _gap(named, whole))
    if named is not None:
        return _judged(fit, named, ranking, refits, parts, level=level, grown=grown)
    if (against := _standing_but(HELD_OUT, fit, refits, level)) is not None:
        return Verdict("cannot tell", None, (), _against(fit, against))
    if grown and (slow := _standing_but(AS_SLOW, fit, refits, level)) is not None:
        return Verdict("cannot tell", None, (), _as_slow(fit, slow))
    if grown and (slight := _standing_but(SLIGHT, fit, refits, level)) is not None:
        return Verdict("cannot tell", None, (), _correction(slight, f", but {SLIGHT}"))
    small = [c for c in ranking if c.shown(level) and not c.carried.falls]
    return _unnamed(parts, whole, small)


def _judged(
    fit: Fit,
    named: Refit,
    ranking: Sequence[Candidate],
    refits: Sequence[Refit],
    parts: Split,
    *,
    level: float,
    grown: bool,
) -> Verdict:
    """What the likeliest effect is worth: a name, or why it has none."""
    if (ahead := _ahead(fit, named, refits, level)) is not None:
        return Verdict("cannot tell", None, (), _behind(fit, named, ahead))
    if grown and named.carried.ratio > 1.0 / NAMED:
        return Verdict("cannot tell", None, (), _correction(named))
    if (share := _explained(fit, named, parts)) < SHARE:
        return Verdict("not in catalogue", None, (), _little(named, share, parts))
    others = rivals(named, ranking, refits)
    if _open(named, others, ranking, level):
        return Verdict("cannot tell", None, (), _one_of(fit, named, others))
    return _missing(fit, named, others)


def gross_verdict(fit: Fit, faults: Sequence[Refit]) -> Verdict:
    """An actuator's fault without which the model does not follow the record at all."""
    names = tuple(r.candidate.effect.name for r in faults)
    alike = f"; this record cannot tell it from {', '.join(names[1:])}" if names[1:] else ""
    before = f"{fit.eps_rmsn:.2%}" if np.isfinite(fit.eps_rmsn) else "no motion at all"
    said = (
        f"{names[0]} is missing: with it the error falls from {before} to "
        f"{faults[0].fit.eps_rmsn:.2%}, further than with any other fault of an actuator{alike}"
    )
    return Verdict("missing", names[0], names, said)


def _unnamed(parts: Split, whole: Completeness | None, shown: Sequence[Candidate]) -> Verdict:
    """What to say where no effect is worth a name."""
    said = _unnamed_plainly(parts, whole)
    return replace(said, sentence=f"{said.sentence}{_small(shown)}")


def _small(shown: Sequence[Candidate]) -> str:
    """What is significant although nobody would notice it."""
    if not shown:
        return ""
    first = min(shown, key=lambda c: c.price)
    return (
        f"; {first.effect.name} is significant and small (p = {first.p_value:.2g}): where it was "
        f"not fitted it changes the squared error by {first.carried.ratio - 1.0:+.1%}"
    )


def _unnamed_plainly(parts: Split, whole: Completeness | None) -> Verdict:
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
        "nothing missing" if high < ANYTHING else "cannot tell", None, (),
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


def _standing_but(why: str, fit: Fit, refits: Sequence[Refit], level: float) -> Refit | None:
    """The best effect that stands every check but this one, in a model that has grown."""
    able = [r for r in refits if objection(fit, r, level, True) == why and falls(fit, r)]
    return best_of(able, level)


def _as_slow(fit: Fit, found: Refit) -> str:
    return (
        f"with {found.candidate.effect.name} {_falls(fit, found.fit)}, but beside the effects that "
        f"were added {AS_SLOW}, which does as much"
    )


def _against(fit: Fit, found: Refit) -> str:
    lost = found.fit.eps_check is None or not np.isfinite(found.fit.eps_check)
    how = "are lost" if lost else f"go from {fit.eps_check:.2%} to {found.fit.eps_check:.2%}"
    return (
        f"{found.candidate.effect.name} lowers the squared error where it was not fitted by "
        f"{1.0 - found.carried.ratio:.0%}, but with it the held-out trials {how}: the trials "
        "contradict each other about it"
    )


def _ahead(fit: Fit, named: Refit, refits: Sequence[Refit], level: float) -> Refit | None:
    """The best effect that leaves less than the named one, although its search never arrived."""
    unfinished = [r for r in refits if objection(fit, r, level) == NOT_ARRIVED]
    better = [
        r
        for r in unfinished
        if r.fit.eps_rmsn < named.fit.eps_rmsn
        and not as_good(r.carried.after, named.carried.after)
        and not worse_held_out(fit, r.fit)
    ]
    return best_of(better, level)


def _behind(fit: Fit, named: Refit, ahead: Refit) -> str:
    name = ahead.candidate.effect.name
    return (
        f"with {name} the error falls from {fit.eps_rmsn:.2%} to {ahead.fit.eps_rmsn:.2%} although "
        f"its search has not arrived, with {named.candidate.effect.name} to "
        f"{named.fit.eps_rmsn:.2%}: `trialid add PIPELINE {name}` and starts of its own may tell"
    )


def _correction(named: Refit, against: str = "") -> str:
    return (
        f"{named.candidate.effect.name} would take another {1.0 - named.carried.ratio:.1%} off the "
        f"squared error where it was not fitted{against}: beside the effects that were added this "
        "is a correction of their shape, and has no name"
    )


def _explained(fit: Fit, named: Refit, parts: Split) -> float:
    """Share of what is not noise that goes with an effect; 1 where noise is not known."""
    if parts.noise is None:
        return 1.0
    rest = 1.0 - min(parts.noise / fit.eps_rmsn, 1.0) ** 2
    return fall(fit, named) / rest if rest > 0.0 else 1.0


def _little(named: Refit, share: float, parts: Split) -> str:
    return (
        f"something is missing that the catalogue does not hold: its best effect, "
        f"{named.candidate.effect.name}, explains {share:.0%} of what is not noise ({parts.method})"
    )


def _no_split(parts: Split) -> str:
    return (
        "no effect stands out, but noise and model error cannot be separated on this record: "
        + parts.why
    )


def _missing(fit: Fit, named: Refit, others: tuple[str, ...]) -> Verdict:
    candidate = named.candidate
    alike = f"; this record cannot tell it from {', '.join(others)}" if others else ""
    return Verdict(
        "missing", candidate.effect.name, (candidate.effect.name, *others),
        f"{_what(fit, named)} {_falls(fit, named.fit)} "
        f"(p = {candidate.p_value:.2g} over the catalogue){alike}",
    )  # fmt: skip


def _open(
    named: Refit, others: tuple[str, ...], ranking: Sequence[Candidate], level: float
) -> bool:
    """Whether effects unlike in trace may be meant, and none stands out against the noise."""
    meant = {named.candidate.effect.name, *others}
    return not meant <= {*named.candidate.family} and all(
        c.p_value >= level for c in ranking if c.effect.name in meant
    )


def _one_of(fit: Fit, named: Refit, others: tuple[str, ...]) -> str:
    """Something is missing by the blocks alone, and effects unlike each other mend it."""
    freed = " freed" if named.candidate.effect.held is not None else ""
    return (
        f"something is missing, but this record cannot tell what: with "
        f"{named.candidate.effect.name}{freed} {_falls(fit, named.fit)}, and as well it may be "
        f"{', '.join(others)}; against the noise none stands out "
        f"(p = {named.candidate.p_value:.2g} over the catalogue)"
    )


def _what(fit: Fit, named: Refit) -> str:
    """What is named: what the model lacks or has in its place, or a coefficient held wrong."""
    name, held = named.candidate.effect.name, named.candidate.effect.held
    if placed := fit.model.displaced_by(named.candidate.effect):
        return f"{name} belongs in the place of {', '.join(placed)}: with it"
    if held is None:
        return f"{name} is missing: with it"
    return f"{name} is held at {held:.3g}; freed, it is {named.fit.estimates[name]:.3g} and"


def _falls(before: Fit, after: Fit) -> str:
    """How the error falls: of all outputs, or of the one that shows it where others hide it."""
    whole = _from_to(before.eps_rmsn, after.eps_rmsn, before.eps_check, after.eps_check)
    if (after.eps_rmsn / before.eps_rmsn) ** 2 < FALL:
        return f"the error falls {whole}"
    old, new = before.eps_by_output, after.eps_by_output
    name = min(old, key=lambda output: new[output] / old[output])
    held = (fit.eps_check_by_output.get(name) for fit in (before, after))
    return (
        f"the error of {name} falls {_from_to(old[name], new[name], *held)}; of all outputs {whole}"
    )


def _from_to(old: float, new: float, held: float | None, after: float | None) -> str:
    said = f"from {old:.2%} to {new:.2%}"
    both = held is not None and after is not None
    return f"{said}, on held-out trials from {held:.2%} to {after:.2%}" if both else said
