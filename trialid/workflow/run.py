"""The whole chain: logs, alignment, fit, accuracy, what the error is made of, what is missing."""

from trialid.identification.fit import Fit
from trialid.pipeline_file import Pipeline
from trialid.progress import Progress
from trialid.result.build import result_from, steps_from
from trialid.threads import one_thread
from trialid.trial import Trial
from trialid.workflow import history
from trialid.workflow.build_model import (
    available,
    check_quiet,
)
from trialid.workflow.findings import find_out
from trialid.workflow.fit_model import fit_of, time_series
from trialid.workflow.origin import signals_of, sources_of
from trialid.workflow.outcome import Run
from trialid.workflow.read_trials import align_trials


@one_thread
def run(
    pipeline: Pipeline,
    progress: Progress = lambda words, share: None,
    force: bool = False,
    grown: bool = False,
) -> Run:
    """Everything from a pipeline, nothing written.

    With `force` the missing force is sought whatever the verdict, beside a named effect; `grown`
    as of `examine`.

    Raises
    ------
    TrialidError
        The input is wrong; nothing is left behind.
    """
    trials = align_trials(pipeline, progress)
    return examine(pipeline, trials, progress, force=force, grown=grown)


@one_thread
def examine(
    pipeline: Pipeline,
    trials: tuple[Trial, ...],
    progress: Progress,
    fit: Fit | None = None,
    force: bool = False,
    grown: bool = False,
) -> Run:
    """Everything from aligned trials on; `fit` where the model is fitted already.

    `grown` where effects were added to the model; what its history says of that is known.

    Raises
    ------
    TrialidError
        As `run`.
    """
    check_quiet(pipeline, trials)
    steps, remark = history.read(pipeline.path)
    catalogue = available(pipeline)
    fit = fit or fit_of(pipeline, trials, catalogue, progress)
    grown = grown or history.has_joined(steps, pipeline.model.effects)
    findings = find_out(pipeline, fit, catalogue, progress, force=force, grown=grown)
    progress("done", 1.0)
    present, *proposed = steps_from(findings)
    result = result_from(
        findings,
        history=(*history.continue_steps(steps, present), *proposed),
        history_remark=remark or None,
        sources=sources_of(pipeline),
        signals=signals_of(pipeline),
    )
    return Run(pipeline, findings, result, time_series(fit), grown)
