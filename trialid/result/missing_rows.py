"""Candidates and the verdict as rows of a result."""

import numpy as np

from trialid.design.separation import Separation
from trialid.diagnosis.diagnosed import Diagnosis
from trialid.diagnosis.search.score import VISIBLE, Candidate
from trialid.diagnosis.verdict import Verdict
from trialid.identification.fit import Fit
from trialid.result.finding_rows import (
    CandidateParameterRow,
    CandidateRow,
    NextTrialPart,
    VerdictPart,
)


def missing_rows(found: Diagnosis) -> tuple[CandidateRow, ...]:
    """Every candidate by rank, the named one first, then what fitted does as well."""
    refitted = {r.candidate.effect.name: r.fit for r in found.refits}
    # what was foreseen by linearisation gives way to what was fitted
    fitted = set(refitted).intersection(found.verdict.family)
    named = found.verdict.effect
    ordered = sorted(
        found.ranking, key=lambda c: (c.effect.name != named, c.effect.name not in fitted)
    )
    return tuple(
        _candidate(i + 1, c, refitted.get(c.effect.name), found) for i, c in enumerate(ordered)
    )


def _candidate(rank: int, c: Candidate, refit: Fit | None, found: Diagnosis) -> CandidateRow:
    return CandidateRow(
        rank=rank,
        effect=c.effect.name,
        equation=c.effect.equation,
        family=tuple(c.family),
        cosines=dict(c.cosines),
        parameters={n: _expected(c, n, refit) for n in c.expected},
        eps_rmsn_predicted=c.eps_predicted,
        eps_rmsn_refitted=refit.eps_rmsn if refit else None,
        eps_rmsn_check=refit.eps_check if refit else None,
        score=c.score,
        p_value=None if np.isnan(c.p_value) else c.p_value,
        visibility=c.visibility,
        left_out_ratio=c.carried.ratio,
        better_in=c.carried.better,
        blocks=c.carried.blocks,
        sign_kept=c.carried.steady,
        verdict=place_in_ranking(c, found),
        sentence=_sentence(c, refit, found),
        held=c.effect.held,
    )


def _expected(c: Candidate, name: str, refit: Fit | None) -> CandidateParameterRow:
    """A parameter of a candidate, with the ends of its physical range; None where open."""
    parameter = c.effect.parameters[name]
    return CandidateParameterRow(
        expected=c.expected[name] if c.visibility > VISIBLE else None,
        refitted=refit.estimates.get(name, c.expected[name]) if refit else None,
        unit=parameter.unit,
        low=parameter.low,
        high=parameter.high,
    )


def place_in_ranking(c: Candidate, found: Diagnosis) -> str:
    """What a candidate is called in the ranking."""
    if c.effect.name == found.verdict.effect:
        return "missing"
    if found.verdict.effect is not None and c.effect.name in found.verdict.family:
        return "same family"
    if c.visibility <= VISIBLE:
        return "not visible"
    if not c.allowed:
        return "unphysical"
    return _by_evidence(c, found) if c.shown(0.05) else "no evidence"


def _by_evidence(c: Candidate, found: Diagnosis) -> str:
    """What one is called that is there against the noise, or in the blocks left out."""
    name = c.effect.name
    fitted = (r.carried for r in found.refits if r.candidate.effect.name == name)
    carried = next(fitted, c.carried)  # what was fitted tells more than what its slope foretold
    if carried.falls:
        return "stands out" if c.p_value < 0.05 else "lowers the error"
    if carried.ratio > 1.0:
        return "does not carry over"
    return "significant and small" if carried.in_most else "not in most blocks"


def _chance(candidate: Candidate) -> str:
    """How likely chance would do as well, empty where that was not tested."""
    return "" if np.isnan(candidate.p_value) else f" (p = {candidate.p_value:.2g})"


def _sentence(c: Candidate, refit: Fit | None, found: Diagnosis) -> str:
    eps = found.before.fit.eps_rmsn
    if c.visibility <= VISIBLE:
        said = f"{c.effect.name} leaves no trace here that the free parameters could not leave too"
        if refit is None:
            return said
        return f"{said}, but fitted it brings the error from {eps:.2%} to {refit.eps_rmsn:.2%}"
    who = (
        c.effect.name
        if c.effect.held is None
        else f"{c.effect.name}, freed from {c.effect.held:.3g},"
    )
    said = f"would bring the error from {eps:.2%} to {c.eps_predicted:.2%}{_chance(c)}"
    if refit is not None:
        said += f"; fitted, it brings it to {refit.eps_rmsn:.2%}"
    return f"{who} {said}"


def verdict_part(v: Verdict, proposal: Separation | None) -> VerdictPart:
    """The verdict, and the trial that would tell rivals apart."""
    return VerdictPart(
        kind=v.kind,
        effect=v.effect,
        family=tuple(v.family),
        together=v.together,
        pair_as_well=v.pair_as_well,
        held_as_well=v.held_as_well,
        doubts=v.doubts,
        sentence=v.sentence,
        next_trial=None if proposal is None else _next_trial(proposal),
    )


def _next_trial(proposal: Separation) -> NextTrialPart:
    """The trial that would tell rivals apart, or that none of those any crew can run does."""
    name = proposal.programme[0].name
    told = f"{name}: {proposal.sentence}" if proposal.separate else proposal.sentence
    return NextTrialPart(
        sentence=told,
        test=name if proposal.separate else None,
        effects=tuple(proposal.names),
        cosine=proposal.after.cosine,
        cosine_before=None if proposal.before is None else proposal.before.cosine,
    )
