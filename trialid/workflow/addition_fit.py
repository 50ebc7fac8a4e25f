"""The pipeline's file with what joins a grown model, fitted as whoever reads it will fit it.

A refit began where the model before had ended; the file begins at its own starts. Where these lead
elsewhere it is given the refit's, so that the file alone gives the fit again.
"""

from collections.abc import Iterator
from dataclasses import replace

from trialid.diagnosis.objections import objection
from trialid.diagnosis.search.carry_over import carried_between
from trialid.diagnosis.search.refit import Refit
from trialid.diagnosis.search.together import Together, stands
from trialid.errors import TrialidError
from trialid.identification.file_of_ship import left_by_file
from trialid.identification.fit import Fit
from trialid.pipeline_file import Pipeline
from trialid.progress import Progress
from trialid.trial import Trial
from trialid.workflow.build_model import available
from trialid.workflow.edit_model import AS_FORESEEN, BETTER, all_started_at, started_at
from trialid.workflow.edit_pipeline import add_to_pipeline
from trialid.workflow.fit_model import fit_of


def fit_addition(
    pipeline: Pipeline,
    trials: tuple[Trial, ...],
    before: Fit,
    up: Refit | Together,
    progress: Progress,
) -> tuple[Pipeline, Fit, str]:
    """The file with what is added, its fit, and what speaks against that; as good as the refit.

    Raises
    ------
    TrialidError
        The file with it cannot be fitted.
    """
    level = pipeline.diagnose.level
    best: tuple[Pipeline, Fit, str] | None = None
    for count, after in enumerate(_ways(pipeline, up)):
        try:
            fit = fit_of(after, trials, available(after), progress)
        except TrialidError:
            if best is None:
                raise
            break  # what was fitted stands, though it is not as good as the refit was
        trouble = _trouble(before, up, fit, level)
        if best is None or (not trouble and (best[2] or fit.eps_rmsn < BETTER * best[1].eps_rmsn)):
            best = after, fit, trouble
        if not best[2] and (count or best[1].eps_rmsn <= AS_FORESEEN * up.fit.eps_rmsn):
            break
    assert best is not None
    return best


def _ways(pipeline: Pipeline, up: Refit | Together) -> Iterator[Pipeline]:
    """The file with what is added at its typical values, or where the refit ended; then all there.

    The file has to give the fit again, so it is the file that is fitted.
    """
    plain = near = pipeline
    placed = True
    for effect in up.effects:
        plain = add_to_pipeline(plain, effect.name).after
        begun = started_at(add_to_pipeline(near, effect.name), up.fit.model.values)
        near, placed = (begun.after, placed) if begun is not None else (near, False)
    yield plain
    if placed:
        yield near
        # coefficients with starts of their own are not held against her file any more: now they are
        if left_by_file(up.fit) is None:
            yield all_started_at(near, up.fit.estimates)


def _trouble(before: Fit, up: Refit | Together, fit: Fit, level: float) -> str:
    """What speaks against what is added as it is fitted from the file, empty where nothing does."""
    if isinstance(up, Together):
        found = replace(up, fit=fit, carried=carried_between(before, fit))
        return "" if stands(before, found) else "the file does not give the fit again"
    carried = carried_between(before, fit, up.candidate.carried.seen)
    return objection(before, Refit(up.candidate, fit, carried), level)
