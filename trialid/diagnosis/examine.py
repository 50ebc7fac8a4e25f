"""A fit examined by what its model may lack: its error, its accuracy, what stands out."""

from collections.abc import Mapping

from trialid.diagnosis.diagnosed import Diagnosed, DiagnoseSettings, examination
from trialid.diagnosis.objections import likeliest_refit
from trialid.diagnosis.search.augment import Augmented, augment
from trialid.diagnosis.search.completeness import Completeness, close_gap, completeness
from trialid.diagnosis.search.freed import candidates_to_free
from trialid.diagnosis.search.score import Candidate, ranking_of
from trialid.diagnosis.search.stand_in import Tried
from trialid.identification.fit import Fit
from trialid.progress import Progress, silent
from trialid.second_process import both
from trialid.ship.effect import Effect


def examine_fit(
    fit: Fit, asked: DiagnoseSettings, progress: Progress, known: Augmented | None = None
) -> tuple[Diagnosed, Augmented]:
    """The split, the accuracy that follows from it, and the traces that both rest on.

    `known` are the traces, where they are.
    """
    progress("looking for what is missing", 0.65)
    augmented = known or augment(fit, tried_effects(fit, asked))
    return examination(fit, augmented, asked), augmented


def examine_alone(
    fit: Fit, asked: DiagnoseSettings, progress: Progress
) -> tuple[Diagnosed, Mapping[str, str]]:
    """The fit examined, and what cannot be tried."""
    before, augmented = examine_fit(fit, asked, progress)
    return before, augmented.left_out


def examine_with_ranking(
    fit: Fit, asked: DiagnoseSettings, progress: Progress
) -> tuple[Diagnosed, Mapping[str, str], tuple[Candidate, ...], Completeness | None]:
    """The fit examined, what cannot be tried, what can, and whether that holds what is missing.

    With it go the columns of the whole catalogue, before there are those of the next model.
    """
    progress("looking for what is missing", 0.65)
    augmented = augment(fit, tried_effects(fit, asked))
    _ = augmented.evidence if augmented.traces else None  # once, for both
    (before, ranking), whole = both(
        lambda: (
            examine_fit(fit, asked, progress, augmented)[0],
            ranking_of(fit, augmented, asked.family_cos, asked.level),
        ),
        lambda: _any_shape(augmented),
    )
    return before, augmented.left_out, ranking, whole


def _any_shape(augmented: Augmented) -> Completeness | None:
    """Whether forces of any simple shape explain more; among sensors alone no force is missing."""
    return completeness(augmented) if augmented.fit.model.states else Completeness(0.0, 0.0)


def gap_with(whole: Completeness | None, fit: Fit, asked: DiagnoseSettings) -> bool:
    """Whether the catalogue misses something that it misses with this fit's effects, too."""
    if whole is None or not whole.gap:
        return False
    return close_gap(whole, augment(fit, tried_effects(fit, asked))).gap


def gap_beside_best(
    whole: Completeness | None,
    fit: Fit,
    tried: Tried,
    asked: DiagnoseSettings,
    *,
    grown: bool = False,
) -> Completeness | None:
    """What the catalogue explains, a gap held against the model with the best effect in it."""
    best = likeliest_refit(fit, tried.refits, asked.level, grown)
    if whole is None or not whole.gap or best is None:
        return whole
    return close_gap(whole, tried.augmented or augment(best.fit, tried_effects(best.fit, asked)))


def leaves_noise(fit: Fit, asked: DiagnoseSettings) -> bool:
    """Whether noise is told from model error in what a fit leaves, and may be all of it."""
    inside = examine_fit(fit, asked, silent)[0].split.undermodelling_interval
    return inside is not None and inside[0] == 0.0


def tried_effects(fit: Fit, asked: DiagnoseSettings) -> dict[str, Effect]:
    """What is tried: effects, and coefficients that are held."""
    return {**asked.candidates, **(candidates_to_free(fit) if asked.coefficients else {})}
