"""All that is found out about a fitted model: its error, its accuracy, and what is missing."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial

from trialid.diagnosis.diagnosed import Diagnosed, DiagnoseSettings, Diagnosis
from trialid.diagnosis.examine import (
    examine_alone,
    examine_fit,
    examine_with_ranking,
    gap_beside_best,
    gap_with,
    leaves_noise,
    tried_effects,
)
from trialid.diagnosis.force.missing_force import MissingForce, missing_force
from trialid.diagnosis.force.usual_forces import hull_at_once
from trialid.diagnosis.gap_untold import without_gap
from trialid.diagnosis.left_by_check import with_held_out
from trialid.diagnosis.left_out_motion import with_motion
from trialid.diagnosis.meant_as_well import beside_others
from trialid.diagnosis.noise.noise_bound import OF_NO_FIT, held_against
from trialid.diagnosis.noise.thinning import with_means
from trialid.diagnosis.objections import likeliest_refit, more_on_course, refit_best
from trialid.diagnosis.plain_damping import dampings
from trialid.diagnosis.records.contradicting_trial import settle_held_out, settle_trials
from trialid.diagnosis.records.course_keeping import zigzag_first
from trialid.diagnosis.records.in_doubt import in_doubt, settle
from trialid.diagnosis.records.unrecorded import name_records
from trialid.diagnosis.search.completeness import Completeness
from trialid.diagnosis.search.gross_fault import gross_faults, whole_faults, with_other_fault
from trialid.diagnosis.search.refit import Refit, refit
from trialid.diagnosis.search.rivals import foretold, to_fit
from trialid.diagnosis.search.score import Candidate
from trialid.diagnosis.search.stand_in import Tried, foretell_far_more, further_ones, look_beside
from trialid.diagnosis.search.together import Together, two_at_once
from trialid.diagnosis.verdict import Verdict, decide, gross_verdict, verdict_on_several
from trialid.diagnosis.where.misfit import where
from trialid.identification.adequacy import why_no_fit
from trialid.identification.fit import Fit
from trialid.identification.inadequate import Inadequate
from trialid.progress import Progress, silent
from trialid.second_process import meanwhile
from trialid.threads import one_thread


@one_thread
def diagnose(
    fit: Fit,
    settings: DiagnoseSettings | None = None,
    progress: Progress = silent,
    *,
    force: bool = False,
    grown: bool = False,
) -> Diagnosis:
    """What the error is made of, where it is, what is missing, and the model with it.

    With `force` the missing force is sought whatever the verdict; `grown`: effects were added.
    """
    asked, fit = settings or DiagnoseSettings(), with_means(fit)
    if faults := gross_faults(fit, asked.candidates, progress, partial(leaves_noise, asked=asked)):
        return _gross(fit, *examine_alone(fit, asked, progress), faults, asked)
    if (failed := why_no_fit(fit)) is not None and not failed.may_lack:
        return _no_fit(fit, *examine_alone(fit, asked, progress), failed)
    before, left_out, ranking, whole = examine_with_ranking(fit, asked, progress)
    tried = refits_of(fit, ranking, asked, lambda words: progress(words, 0.7), grown)
    if faults := _whole(fit, ranking, tried.refits, asked, progress):
        return _gross(fit, before, left_out, faults, asked)
    with meanwhile(partial(_after, tried.best, tried, asked, progress), _of(tried.best)) as best:
        whole = gap_beside_best(whole, fit, tried, asked, grown=grown)
        before = _bounded(before, tried.refits, whole)
        found = _verdict(fit, ranking, tried, before, whole, asked, grown=grown, progress=progress)
        named = _named(found, tried.refits)
        verdict, together = _or_of_several(fit, found, whole, tried.refits, asked, progress)
        verdict = settle_held_out(fit, verdict, named or together)
        if failed is not None and together is None and not _mended(named):
            return _no_fit(fit, before, left_out, failed)
        missing = _force(force, verdict, named.fit if named else fit, asked.level, progress)
        verdict = without_gap(fit, verdict, ranking, before.split, missing, asked.level)
        after = best() if named is tried.best else _after(named, tried, asked, progress)
    return Diagnosis(
        before=before.beside(verdict.effect, after),
        ranking=ranking,
        left_out=left_out,
        refits=tried.refits,
        verdict=verdict,
        where=where(fit),
        after=after,
        force=missing,
        together=together,
    )


def _mended(named: Refit | None) -> bool:
    """Whether a fit that carries no verdict does so with what is named, and its slope said so.

    Where it did not, others that were not fitted may do more: a boat that parted from her model had
    the name of a coefficient that she does not have in 4 of 4 records.
    """
    return named is not None and foretold(named) and why_no_fit(named.fit) is None


def _of(refit: Refit | None) -> tuple[Fit, ...]:
    return () if refit is None else (refit.fit,)


def _verdict(
    fit: Fit,
    ranking: Sequence[Candidate],
    tried: Tried,
    before: Diagnosed,
    whole: Completeness | None,
    asked: DiagnoseSettings,
    *,
    grown: bool,
    progress: Progress,
) -> Verdict:
    """What is missing, held against a motion left out, trials held out, and what nobody logged.

    And beside two effects at once, and what the model holds.
    """
    refits = tried.refits
    found = decide(fit, ranking, refits, before.split, whole, level=asked.level, grown=grown)
    found = with_motion(fit, found, ranking, refits, asked.level)
    named = None if grown else _named(found, refits)
    found = with_held_out(fit, found, lambda: before.own_accuracy.covariance, asked.level, named)
    found = name_records(fit, found, asked.candidates.values())
    found = settle(fit, found, asked.candidates.get(found.effect or ""))
    named = _named(found, refits)
    found = settle_trials(fit, found, named.fit if named else None, [r.fit for r in refits])
    if found.doubts:
        return found

    def said(words: str) -> None:
        progress(words, 0.85)

    return beside_others(fit, found, named, before.split, whole, asked=asked, progress=said)


def _or_of_several(
    fit: Fit,
    verdict: Verdict,
    whole: Completeness | None,
    refits: Sequence[Refit],
    asked: DiagnoseSettings,
    progress: Progress,
) -> tuple[Verdict, Together | None]:
    """The verdict, and effects at once, where none has a name.

    Two of them, or where no two do it all that a hull usually has; where nothing else shows that
    anything is missing, these alone may: each is small. Where the fit carries no verdict they alone
    may as well: two would be chosen by the slopes of a fit that stands nowhere. Where the catalogue
    seems to miss something, it must not seem so with them.
    """
    if verdict.effect or verdict.family or verdict.held_as_well or verdict.doubts or in_doubt(fit):
        return verdict, None
    found = None
    if why_no_fit(fit) is None and verdict.kind != "nothing missing":
        found = two_at_once(fit, asked.candidates, asked.refit, lambda words: progress(words, 0.8))
        found = found and with_other_fault(fit, found, asked.candidates, progress)
    found = found or hull_at_once(fit, asked.candidates)
    if found and (
        more_on_course(fit, refits, asked.level, found) or gap_with(whole, found.fit, asked)
    ):
        found = None
    return (verdict if found is None else verdict_on_several(fit, found)), found


def _named(verdict: Verdict, refits: Sequence[Refit]) -> Refit | None:
    """The model with what is named; None where nothing is."""
    return next((r for r in refits if r.candidate.effect.name == verdict.effect), None)


def _after(
    named: Refit | None, tried: Tried, asked: DiagnoseSettings, progress: Progress
) -> Diagnosed | None:
    """The model with what is named, examined, with its accuracy; None where nothing is."""
    if named is None:
        return None
    known = tried.augmented if named is tried.best else None
    done = _bounded(examine_fit(named.fit, asked, progress, known)[0], tried.refits)
    _ = done.own_accuracy  # all that follows asks for it
    return done


def _whole(
    fit: Fit,
    ranking: Sequence[Candidate],
    refits: Sequence[Refit],
    asked: DiagnoseSettings,
    progress: Progress,
) -> tuple[Refit, ...]:
    """Faults of actuators that explain what no refit does; mostly none."""
    by_noise = partial(leaves_noise, asked=asked)
    return whole_faults(
        fit, asked.candidates, ranking, others=refits, progress=progress, leaves_noise=by_noise
    )


def _force(
    asked: bool, verdict: Verdict, fit: Fit, level: float, progress: Progress
) -> MissingForce | None:
    """The missing force, None where nobody asks or nothing is simulated that it could push."""
    if not (asked or verdict.kind == "not in catalogue") or not fit.model.states:
        return None
    progress("looking for the missing force", 0.9)
    return missing_force(fit, level)


def _no_fit(
    fit: Fit, before: Diagnosed, left_out: Mapping[str, str], failed: Inadequate
) -> Diagnosis:
    """Nothing is concluded from a fit that carries no verdict: no ranking, no names."""
    return Diagnosis(
        before=replace(before, split=OF_NO_FIT),
        left_out=left_out,
        verdict=settle(fit, Verdict("no fit", None, (), f"no fit: {zigzag_first(fit, failed)}")),
        where=where(fit),
    )


def _gross(
    fit: Fit,
    before: Diagnosed,
    left_out: Mapping[str, str],
    faults: Sequence[Refit],
    asked: DiagnoseSettings,
) -> Diagnosis:
    """A fault of an actuator that alone explains the record; slopes without it say nothing."""
    return Diagnosis(
        before=before,
        ranking=tuple(r.candidate for r in faults),
        left_out=left_out,
        refits=tuple(faults),
        verdict=gross_verdict(fit, faults),
        where=where(fit),
        after=examine_fit(faults[0].fit, asked, silent)[0],
    )


def _bounded(
    done: Diagnosed, refits: Sequence[Refit], whole: Completeness | None = None
) -> Diagnosed:
    """The same with no more noise than any of these fits leaves, and no split routes deny."""
    fits = [r.fit for r in refits]
    return replace(done, split=held_against(done.split, done.routes, done.fit, fits, whole))


def refits_of(
    fit: Fit,
    ranking: Sequence[Candidate],
    asked: DiagnoseSettings,
    progress: Callable[[str], None],
    grown: bool = False,
) -> Tried:
    """The best candidates fitted, what else would be said to do as well, and what they cover."""
    worth = [c for c in ranking if c.worth_a_name(asked.level)]
    best = refit_best(fit, worth, asked.refit, asked.level, progress)
    named = likeliest_refit(fit, best, asked.level, grown)
    best += refit(fit, _surer(ranking, best, named, asked)[: asked.refit], progress)
    named = likeliest_refit(fit, best, asked.level, grown)
    if named:
        best += refit(fit, foretell_far_more(fit, ranking, best), progress)
        named = likeliest_refit(fit, best, asked.level, grown)
    if named:
        fitted = [r.candidate.effect.name for r in best]
        best += refit(fit, dampings(named.candidate, ranking, fitted), progress)
        named = likeliest_refit(fit, best, asked.level, grown)
    if further := further_ones(fit, named, ranking, best):
        best += refit(fit, further, progress)
        named = likeliest_refit(fit, best, asked.level, grown)
    others = to_fit(named, ranking, best, grown) if named else ()
    return look_beside(
        fit,
        ranking,
        (*best, *refit(fit, others, progress)),
        partial(tried_effects, asked=asked),
        most=asked.refit,
        level=asked.level,
        grown=grown,
        progress=progress,
    )


def _surer(
    ranking: Sequence[Candidate],
    done: Sequence[Refit],
    named: Refit | None,
    asked: DiagnoseSettings,
) -> list[Candidate]:
    """What the test shows more surely than the effect that would be named, whatever its slope says.

    Of four turns in a measured wind the wind's slope foretold a rise of 18 %, and fitted it takes
    three quarters off one held out; beside it a current that nobody measured stood out less.
    """
    sure = named.candidate.p_value if named else asked.level
    fitted = {r.candidate.effect.name for r in done}
    shown = (c for c in ranking if c.shown(asked.level) and c.p_value < sure)
    return [c for c in shown if c.effect.name not in fitted]
