"""What a verdict says: its sentence in words and figures."""

from collections.abc import Sequence
from typing import Final

import numpy as np

from trialid.diagnosis.force.missing_force import MissingForce
from trialid.diagnosis.noise.error_parts import Split
from trialid.diagnosis.noise.split import INPUT_DRIVEN
from trialid.diagnosis.objections import AS_SLOW
from trialid.diagnosis.search.carried import FALL
from trialid.diagnosis.search.completeness import Completeness
from trialid.diagnosis.search.falls import fall_of_check
from trialid.diagnosis.search.refit import Refit
from trialid.diagnosis.search.score import Candidate
from trialid.diagnosis.search.together import Together
from trialid.identification.fit import Fit
from trialid.names.wording import named_together

NONE_STANDS_OUT: Final = "no effect stands out"
NONE_HOLDS: Final = "no effect that stands out stands every check"
"""How a verdict begins that names none: what the table calls `stands out` is not denied."""

OF_SHAPE: Final = "a force of a simple shape"

MANY: Final = 8
"""Others that do as well from which on a name is the first of a list, and said so: a terminal cuts
the list. Half of it says so of families that are told whole, twice lets 15 stand behind one."""


def outdone_by_a_shape(named: Refit | None, whole: Completeness) -> str:
    """A force of some simple shape explains far more than any effect."""
    closest = f"; the closest is {named.candidate.effect.name}" if named else ""
    share = max(whole.catalogue, 0.0) / whole.any_shape
    return (
        "something is missing that the catalogue does not hold: its effects gain "
        f"{share:.0%} of what {OF_SHAPE} would{closest}"
    )


def other_cause(fit: Fit, found: Refit, why: str) -> str:
    """What was found may be something else: her own memory, her steering gear or an autopilot."""
    but = f"beside the effects that were added {why}, which does as much" if why == AS_SLOW else why
    return f"with {found.candidate.effect.name} {falls_by(fit, found.fit)}, but {but}"


def moved_otherwise(fit: Fit, found: Refit, outputs: Sequence[str]) -> str:
    """What the model leaves most of goes on as before: waves, or whatever else moves it."""
    rest = " and ".join(f"{found.fit.eps_by_output[c]:.0%} of {c}" for c in outputs)
    return (
        f"with {found.candidate.effect.name} {falls_by(fit, found.fit)}, but {rest} is left as "
        "before: something else moves that, as a swell does, and what it does to the rest may be "
        "all that was found"
    )


def contradiction(fit: Fit, found: Refit) -> str:
    """With this effect trials held out become worse, or are lost; or not better by anything."""
    lost = found.fit.eps_check is None or not np.isfinite(found.fit.eps_check)
    how = "are lost" if lost else f"go from {fit.eps_check:.2%} to {found.fit.eps_check:.2%}"
    hardly = not lost and -fall_of_check(fit, found) < 1.0 / FALL - 1.0
    means = "it does nothing there" if hardly else "the trials contradict each other about it"
    return (
        f"{found.candidate.effect.name} lowers the squared error where it was not fitted by "
        f"{1.0 - 1.0 / found.carried.worth:.0%}{_of_which(found)}, but with it the held-out trials "
        f"{how}: {means}"
    )


def _of_which(found: Refit) -> str:
    """That the fall is one of each output's own error, where in the whole it is less."""
    return "" if found.carried.worth * found.carried.ratio < 1.001 else " of each output's own"


def unfinished_lead(fit: Fit, named: Refit, ahead: Refit) -> str:
    """An effect leaves less although its search never arrived."""
    name = ahead.candidate.effect.name
    return (
        f"with {name} the error falls from {fit.eps_rmsn:.2%} to {ahead.fit.eps_rmsn:.2%} although "
        f"its search has not arrived, with {named.candidate.effect.name} to "
        f"{named.fit.eps_rmsn:.2%}: `trialid add PIPELINE {name}` and starts of its own may tell"
    )


def denied_lead(fit: Fit, named: Refit, lead: Refit, against: str) -> str:
    """An effect does far more than what stands every check, but something speaks against it."""
    name = lead.candidate.effect.name
    lost = fall_of_check(fit, lead) < -1.0  # twice the squared error of trials held out
    then = "" if lost else f"`trialid add PIPELINE {name}` and "
    return (
        f"with {name} {falls_by(fit, lead.fit)}, but {against}; {named.candidate.effect.name} "
        f"stands every check and leaves {named.fit.eps_rmsn:.2%}: {then}other trials may tell"
    )


def in_few(fit: Fit, lead: Refit) -> str:
    """An effect does far more than what held-out trials deny, in few of the blocks."""
    name, found = lead.candidate.effect.name, lead.carried
    return (
        f"with {name} {falls_by(fit, lead.fit)} (p = {lead.candidate.p_value:.2g}), but where it "
        f"was not fitted in {found.better} of {found.blocks} blocks only: another trial like those "
        f"in which it shows, and `trialid add PIPELINE {name}`, may tell"
    )


def correction(named: Refit) -> str:
    """It mends the shapes of the effects that were added."""
    return (
        f"{named.candidate.effect.name} would take another {1.0 - named.carried.ratio:.1%} off the "
        f"squared error where it was not fitted: beside the effects that were added that "
        "may be a correction of their shape, and has no name"
    )


def explains_little(named: Refit, share: float, parts: Split) -> str:
    """The best effect explains next to nothing of what is not noise."""
    most, route = ("", parts.method) if parts.available else ("at most ", INPUT_DRIVEN)
    return (
        f"something is missing that the catalogue does not hold: its best effect, "
        f"{named.candidate.effect.name}, explains {most}{share:.0%} of what is not noise ({route})"
    )


def untold(fit: Fit, found: Candidate) -> str:
    """An effect would explain what is left, where chance explains it as often."""
    return (
        f"{found.effect.name} would take the error from {fit.eps_rmsn:.2%} to "
        f"{found.eps_predicted:.2%}, but by this record chance does as well "
        f"{100.0 * found.p_value:.0f} times in 100"
    )


def no_force(claimed: str, found: MissingForce) -> str:
    """A gap was claimed, by a shape or because noise is less, and no force stands out."""
    if OF_SHAPE not in claimed:
        return f"{claimed}; nor does a force: {found.sentence}"
    return (
        "no effect of the catalogue explains what is left as a simple shape would, but "
        f"{found.sentence}: a fault of a sensor, or noise of another colour, may be all of it"
    )


def no_split(parts: Split, none: str) -> str:
    """Noise and model error cannot be told apart."""
    return f"{none}, but noise and model error cannot be separated on this record: " + parts.why


def little_more(low: float, high: float, method: str) -> str:
    """Something is left beside noise, and it is little of what moved."""
    return (
        f"an error of {low:.1%} to {high:.1%} is more than the noise ({method}), but of what moved "
        "that is little: an input that is logged too seldom leaves as much"
    )


def small_rest(left: float, none: str) -> str:
    """All of the error is little, and what it is made of is nothing to ask."""
    return f"{none}, and of no trial is more left than {left:.1%}, noise and model error together"


def one_of(
    fit: Fit, named: Refit, others: tuple[str, ...], unlike: Sequence[Candidate], level: float
) -> str:
    """Something is missing, and effects unlike each other mend it."""
    name, p = named.candidate.effect.name, named.candidate.p_value
    freed = " freed" if named.candidate.effect.held is not None else ""
    why = "against the noise none stands out"
    if p >= level and (shown := [c for c in unlike if c.p_value < level]):
        why = f"{shown[0].effect.name} stands out against the noise, {name} does not"
    if p < level:
        why = f"{name}, which is no force, stands out, but forces leave less where not fitted"
    return (
        f"something is missing, but this record cannot tell what: with {name}{freed} "
        f"{falls_by(fit, named.fit)}, and as well it may be {', '.join(others)}; {why} "
        f"(p = {p:.2g} over the catalogue)"
    )


def several_together(fit: Fit, found: Together) -> str:
    """Effects do what none of them does alone."""
    alike = "".join(f"; {named_together(names)} do as much" for names in found.alike[:1])
    return (
        f"more than one thing may be missing: no effect alone stands every check, but with "
        f"{named_together(found.names)} together {falls_by(fit, found.fit)}{alike}"
    )


def by_chance(candidate: Candidate, level: float) -> str:
    """How often noise alone would do it, or that no test says so."""
    if candidate.p_value < level:
        return f"p = {candidate.p_value:.2g} over the catalogue"
    return "blocks of time left out agree, though no test against the noise shows it"


def subject(fit: Fit, named: Refit, others: int = 0) -> str:
    """What is named: what the model lacks or has in its place, or a coefficient held wrong.

    With so many others that do as well it is no more than the first of them.
    """
    name, held = named.candidate.effect.name, named.candidate.effect.held
    many = f"one of {others + 1} is missing, first of them {name}" if others >= MANY else ""
    if placed := ", ".join(fit.model.displaced_by(named.candidate.effect)):
        belongs = f"{many} in the place" if many else f"{name} belongs in the place"
        return f"{belongs} of {placed}: with it"
    if held is None:
        return f"{many or f'{name} is missing'}: with it"
    return f"{name} is held at {held:.3g}; freed, it is {named.fit.estimates[name]:.3g} and"


def falls_by(before: Fit, after: Fit) -> str:
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


def significant_and_small(shown: Sequence[Candidate]) -> str:
    """What is significant although nobody would notice it."""
    if not shown:
        return ""
    first = min(shown, key=lambda c: c.price)
    if first.carried.ratio > 1.0:
        return (
            f"; {first.effect.name} stands out against the noise (p = {first.p_value:.2g}), but "
            f"where it was not fitted the squared error rises by {first.carried.ratio - 1.0:.1%}"
        )
    if not first.carried.in_most:
        return (
            f"; {first.effect.name} stands out against the noise (p = {first.p_value:.2g}), but "
            f"where it was not fitted the error falls in {first.carried.better} of "
            f"{first.carried.blocks} blocks only"
        )
    return (
        f"; {first.effect.name} is significant and small (p = {first.p_value:.2g}): where it was "
        f"not fitted it changes the squared error by {first.carried.ratio - 1.0:+.1%}"
    )


def by_herself(fit: Fit, named: Refit, two: Together) -> str:
    """What nobody recorded does no more than two effects of the ship at once."""
    before, after, other = (f"{x.eps_rmsn:.2%}" for x in (fit, named.fit, two.fit))
    return (
        f"{named.candidate.effect.name} takes the error from {before} to {after}, and "
        f"{' and '.join(two.names)} of the ship herself together to {other}: this record does not "
        "tell them apart, and what nobody recorded gives way to her"
    )
