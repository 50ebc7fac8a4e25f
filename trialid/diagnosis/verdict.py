"""From scores and refits to a verdict: what is missing, in a sentence."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from trialid.diagnosis.best_refit import best_of
from trialid.diagnosis.noise.error_parts import Split
from trialid.diagnosis.objections import (
    AS_A_GEAR,
    AS_SLOW,
    BESIDE,
    HELD_OUT,
    MOST,
    NOT_ARRIVED,
    ON_COURSE,
    SEEN,
    SLIGHT,
    SWELL,
    likeliest_refit,
    more_on_course,
    objection,
    outputs_beside,
    standing_but,
)
from trialid.diagnosis.search.carried import as_good
from trialid.diagnosis.search.completeness import Completeness
from trialid.diagnosis.search.falls import fall, worse_held_out
from trialid.diagnosis.search.refit import Refit
from trialid.diagnosis.search.rivals import is_open, rivals, unlike_in_trace
from trialid.diagnosis.search.score import Candidate
from trialid.diagnosis.search.stand_in import far_ahead, shown_in_few
from trialid.diagnosis.search.together import Together
from trialid.diagnosis.verdict_sentences import (
    NONE_HOLDS,
    NONE_STANDS_OUT,
    by_chance,
    contradiction,
    correction,
    denied_lead,
    explains_little,
    falls_by,
    in_few,
    little_more,
    moved_otherwise,
    no_split,
    one_of,
    other_cause,
    outdone_by_a_shape,
    several_together,
    significant_and_small,
    small_rest,
    subject,
    unfinished_lead,
)
from trialid.identification.fit import Fit

NAMED: Final = 1.10
"""Ratio of squared errors that a further effect must be worth to be named beside the first: below
it, of what was added to ships of another hull, half were corrections of a shape."""

SHARE: Final = 0.12
"""Share of what is not noise that the best effect must explain: the best of the catalogue explains
0.04 of what it does not hold, and 0.21 or more of what it holds."""

ANYTHING: Final = 0.5
"""Model error from which on what would not be seen may be anything: half of what moved."""

MOSTLY: Final = 0.5
"""Share of the squared error from which on it is not known that most of it is noise. Of 66 records
of 33 effects each in white noise and in a sea nothing was missing in 8 and 13, with shares up to
0.21 and 0.31; in gusts in 15, of which three lie at 0.51 to 0.63. Half of it takes six of the 13
in a sea away; twice says that nothing is missing of a boat whose compass jumped, at 0.92."""

LITTLE: Final = 0.03
"""Model error that is little whatever the noise is: of a model's roll decay and of two rate sensors
side by side all that is left is less. Half of it and twice say the same of both."""


HARDLY: Final = 0.01
"""All of any trial's error that is little where nobody knows what of it is noise, and what is not
noise at most where that is known. Of a real roll
decay 3.0, 1.6 and 0.3 % are left by the linear model, with the arm and with the damping too: half
of it says the same of them, with twice nothing is missing while the damping is."""


@dataclass(frozen=True, kw_only=True)
class AsWell:
    """What a name is not told from beside single effects, and why there may be none.

    Two others at once, that do as well as it; numbers that are held and do as well as the best
    effect, which then has no name; what the records leave in doubt about themselves.
    """

    pair_as_well: tuple[str, ...] = ()
    held_as_well: tuple[str, ...] = ()
    doubts: tuple[str, ...] = ()


@dataclass(frozen=True)
class Verdict(AsWell):
    """What the record says is missing, in one of four kinds, with the sentence a person reads.

    `family` are the effect and what it is not told from; without an effect those of which one is
    missing. `together` are effects that do at once what none does alone.
    """

    kind: str
    effect: str | None
    family: tuple[str, ...]
    sentence: str
    together: tuple[str, ...] = ()


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
    is physical, held-out trials do not speak against it, and neither a force of another shape, nor
    an effect that chance or they deny, nor one whose search did not arrive explains far more; and
    where the blocks left out alone show it, only if none as good differs in trace. In a model that
    has `grown` by effects already it must be worth a tenth.
    """
    named = likeliest_refit(fit, refits, level, grown)
    if (answer := more_on_course(fit, refits, level, named)) is not None:
        return Verdict("cannot tell", None, (), other_cause(fit, answer, ON_COURSE))
    if named and (lead := far_ahead(fit, named, refits, level, grown=grown)):
        why = objection(fit, lead, level, grown)
        return Verdict("cannot tell", None, (), denied_lead(fit, named, lead, why))
    gap = whole is not None and (whole.outdoes(named.carried) if named else whole.carries_over)
    if whole is not None and gap and fit.eps_rmsn >= SEEN:  # of less nobody notices all of it
        return Verdict("not in catalogue", None, (), outdone_by_a_shape(named, whole))
    if named is not None:
        return _judged(fit, named, ranking, refits, parts, level=level, grown=grown)
    if (denied := _denied(fit, refits, level, grown=grown)) is not None:
        return Verdict("cannot tell", None, (), denied)
    return _unnamed(parts, whole, [c for c in ranking if c.shown(level)], fit.eps_of_own)


def _denied(fit: Fit, refits: Sequence[Refit], level: float, *, grown: bool) -> str | None:
    """What one check alone denies, where nothing stands them all; None where that is nothing."""
    against = standing_but(HELD_OUT, fit, refits, level)
    if against is not None:
        if (lead := shown_in_few(fit, against, refits, level)) is not None:
            return in_few(fit, lead)
        ahead = _ahead(fit, against, refits, level)
        return unfinished_lead(fit, against, ahead) if ahead else contradiction(fit, against)
    if (apart := standing_but(BESIDE, fit, refits, level)) is not None:
        return moved_otherwise(fit, apart, outputs_beside(fit, apart))
    for why in (SWELL, AS_A_GEAR, AS_SLOW) if grown else (SWELL, AS_A_GEAR):
        if (other := standing_but(why, fit, refits, level)) is not None:
            return other_cause(fit, other, why)
    if grown and (slight := standing_but(SLIGHT, fit, refits, level)) is not None:
        return correction(slight)
    return None


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
        return Verdict("cannot tell", None, (), unfinished_lead(fit, named, ahead))
    if grown and named.carried.ratio > 1.0 / NAMED:
        return Verdict("cannot tell", None, (), correction(named))
    if (share := _explained(fit, named, parts)) < SHARE:
        return Verdict("not in catalogue", None, (), explains_little(named, share, parts))
    others = rivals(named, ranking, refits)
    unlike = unlike_in_trace(named, others, ranking)
    if is_open(named, unlike, level, most=fall(fit, named) >= MOST):
        either = (named.candidate.effect.name, *others)
        return Verdict("cannot tell", None, either, one_of(fit, named, others, unlike, level))
    return _missing(fit, named, others, level)


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


def verdict_on_several(fit: Fit, found: Together) -> Verdict:
    """Effects without which the model fails, none of which has a name alone."""
    return Verdict("cannot tell", None, (), several_together(fit, found), found.names)


def _unnamed(
    parts: Split, whole: Completeness | None, shown: Sequence[Candidate], left: float
) -> Verdict:
    """What to say where no effect is worth a name; `left` is all of the trial worst followed."""
    small = [c for c in shown if not c.carried.falls]
    none = NONE_STANDS_OUT if len(small) == len(shown) else NONE_HOLDS
    said = _unnamed_plainly(parts, whole, none)
    if parts.undermodelling_interval is None and left < HARDLY:
        said = Verdict("nothing missing", None, (), small_rest(left, none))
    return replace(said, sentence=f"{said.sentence}{significant_and_small(small)}")


def _unnamed_plainly(parts: Split, whole: Completeness | None, none: str) -> Verdict:
    if parts.undermodelling_interval is None:
        return Verdict("cannot tell", None, (), no_split(parts, none))
    low, high = parts.undermodelling_interval
    if low > 0.0 and high < HARDLY:
        return Verdict("cannot tell", None, (), little_more(low, high, parts.method))
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
    total = float(np.hypot(parts.noise or 0.0, parts.undermodelling or 0.0))
    little = _is_little(high, total)
    much = f", which is not little beside an error of {total:.1%}"
    return Verdict(
        "nothing missing" if little else "cannot tell", None, (),
        f"{none}{' against the noise' * (none == NONE_STANDS_OUT)}; a model error of up to "
        f"{high:.1%} would not be seen ({parts.method}){'' if little else much}",
    )  # fmt: skip


def _is_little(unseen: float, total: float) -> bool:
    """Whether a model error that would not be seen is little, of what moved or of the error."""
    most = max(np.sqrt(MOSTLY) * total, LITTLE)
    return unseen < min(ANYTHING, total, most)


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


def _explained(fit: Fit, named: Refit, parts: Split) -> float:
    """Share of what is not noise that goes with an effect; 1 where nothing is known of the noise.

    At most so much where no more is known of it than what it cannot exceed.
    """
    noise = parts.at_most if parts.noise is None else parts.noise
    if noise is None:
        return 1.0
    rest = 1.0 - min(noise / fit.eps_rmsn, 1.0) ** 2
    return fall(fit, named) / rest if rest > 0.0 else 1.0


def _missing(fit: Fit, named: Refit, others: tuple[str, ...], level: float) -> Verdict:
    candidate = named.candidate
    alike = f"; this record cannot tell it from {', '.join(others)}" if others else ""
    return Verdict(
        "missing", candidate.effect.name, (candidate.effect.name, *others),
        f"{subject(fit, named, len(others))} {falls_by(fit, named.fit)} "
        f"({by_chance(candidate, level)}){alike}",
    )  # fmt: skip
