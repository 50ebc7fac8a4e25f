"""The fit of a pipeline's model."""

from collections.abc import Callable, Mapping

import numpy as np

from trialid.errors import PipelineError
from trialid.identification.fit import Fit, identify
from trialid.identification.problem import Settings
from trialid.least_squares.gauss_newton import Iteration
from trialid.names.quantities import OVER_GROUND
from trialid.pipeline_file import Pipeline, where
from trialid.progress import Progress
from trialid.result.series import OutputSeries, TrialSeries
from trialid.ship.effect import Effect
from trialid.ship.model import ShipModel
from trialid.trial import Trial
from trialid.workflow.build_model import (
    build_model,
    check_bounds,
    check_headway,
    settings_of,
)
from trialid.workflow.track_prediction import track_of


def check_current(pipeline: Pipeline) -> None:
    """PipelineError where speeds are outputs beside a current, and not all are over the ground."""
    outputs = {*pipeline.identify.outputs}
    if "current" not in pipeline.identify.nuisance or not {"u", "v"} <= outputs:
        return
    water = [trial.name for trial in pipeline.trials if not trial.over_ground]
    placed = [name for name in OVER_GROUND if name in outputs]
    at = where(pipeline, "identify.nuisance")
    if placed and len(water) < len(pipeline.trials):
        raise PipelineError(
            f"{at}: u and v over the ground and {placed[0]} are outputs, and the current is taken "
            "off one of them; keep u and v, or the other"
        )
    if water and not placed:
        raise PipelineError(
            f"{at}: in a speed through the water no current shows, and trial {water[0]!r} has no "
            "over_ground = true; take the current out, or let each trial make u and v so"
        )


def fit_of(
    pipeline: Pipeline,
    trials: tuple[Trial, ...],
    catalogue: Mapping[str, Effect],
    progress: Progress,
) -> Fit:
    """The fit of the pipeline's model.

    Raises
    ------
    TrialidError
        The model or the record does not allow one.
    """
    model = build_model(pipeline, catalogue)
    settings = settings_of(pipeline, model)
    check_bounds(pipeline, model, settings)
    check_current(pipeline)
    check_headway(pipeline, model, trials)
    progress("fitting", 0.3)
    return fit_with_progress(trials, model, settings, progress)


def fit_with_progress(
    trials: tuple[Trial, ...], model: ShipModel, settings: Settings, progress: Progress
) -> Fit:
    """The fit, telling how far it is."""

    def finer(substeps: int) -> None:
        progress(f"fitting again with {substeps} steps a sample", None)

    return identify(trials, model, settings, _fit_progress(progress), finer=finer)


def _fit_progress(progress: Progress) -> Callable[[Iteration], None]:
    count = 0

    def tell(iteration: Iteration) -> None:
        nonlocal count
        count += 1
        share = 0.3 + 0.3 * count / (count + 10.0)
        progress(f"fitting: iteration {count}, error {np.sqrt(2.0 * iteration.V):.2%}", share)

    return tell


def time_series(fit: Fit) -> tuple[TrialSeries, ...]:
    """Measured and predicted of every trial, for the report."""
    outputs = fit.problem.outputs
    names = fit.problem.simulator.equations.inputs
    return tuple(
        TrialSeries(
            name=s.trial.name,
            use=s.trial.use,
            t=s.trial.t,
            inputs={n: s.trial.signals[n] for n in names if n in s.trial.signals},
            outputs=tuple(
                OutputSeries(c, s.trial.signals[c], s.response.y[:, i], s.compared[:, i])
                for i, c in enumerate(outputs)
            ),
            track=track_of(fit, s),
            units=fit.model.own_units,
        )
        for s in fit.scores
    )
