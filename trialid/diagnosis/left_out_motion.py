"""No name for what a motion explains that the model neither simulates nor reads.

A model of surge and yaw alone lacks the sway, which every ship has: what acts with it, in turns,
was taken for yaw damping that changes with the speed.
"""

from collections.abc import Sequence

from trialid.diagnosis.objections import objection
from trialid.diagnosis.search.refit import Refit, refit
from trialid.diagnosis.search.score import Candidate
from trialid.diagnosis.verdict import Verdict
from trialid.identification.fit import Fit
from trialid.names.quantities import SIGNALS


def with_motion(
    fit: Fit,
    verdict: Verdict,
    ranking: Sequence[Candidate],
    refits: Sequence[Refit],
    level: float,
) -> Verdict:
    """The verdict; `cannot tell` where a motion left out does as well as the effect that it names.

    Unless that effect is worth a name beside the motion too: then both are missing.
    """
    meant = [c for c in ranking if c.effect.name in verdict.family]
    motion = next((c for c in meant if c.effect.stands_for), None)
    named = next((r for r in refits if r.candidate.effect.name == verdict.effect), None)
    if motion is None or named is None or motion.effect is named.candidate.effect:
        return verdict
    if _stands_beside(fit, named, motion, refits, level):
        return verdict
    signal = motion.effect.stands_for
    words = SIGNALS[signal].meaning.partition(",")[0]
    said = (
        f"with {verdict.effect} the error falls from {fit.eps_rmsn:.2%} to "
        f"{named.fit.eps_rmsn:.2%}; the {words} that the model does not have, and every ship has, "
        f"does as much: record {signal}, or `trialid add PIPELINE {motion.effect.name}`"
    )
    return Verdict("cannot tell", None, (), said)


def _stands_beside(
    fit: Fit, named: Refit, motion: Candidate, refits: Sequence[Refit], level: float
) -> bool:
    """Whether an effect is worth its name in a model that has the motion already."""
    done = [r for r in refits if r.candidate.effect.name == motion.effect.name]
    for moving in done or refit(fit, [motion], _quiet):
        both = refit(moving.fit, [named.candidate], _quiet)
        return any(not objection(moving.fit, r, level) for r in both)
    return False


def _quiet(words: str) -> None:
    """Nobody waits for one fit more."""
