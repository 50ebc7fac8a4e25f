"""The fitted model of a finished run, with how sure it is, from the run's folder and its logs."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

from trialid.design.prediction.seen_range import SeenRange, seen_ranges
from trialid.diagnosis.diagnose import diagnose
from trialid.errors import NotIdentifiable, PipelineError, TrialidError
from trialid.identification.fit import Fit, revive
from trialid.names.quantities import SIGNALS, Quantity
from trialid.pipeline_file import Pipeline
from trialid.progress import Progress
from trialid.report.words.doubt import doubtful, missing_words, records_doubt
from trialid.result.schema import Result
from trialid.ship.actuators import actuator_quantities
from trialid.ship.quantity_of import quantity_of
from trialid.threads import one_thread
from trialid.trial import Trial
from trialid.workflow.build_model import available, build_model, settings_of
from trialid.workflow.findings import diagnose_settings
from trialid.workflow.read_trials import align_trials
from trialid.workflow.repeat import Earlier, earlier
from trialid.workflow.use.kept_models import Known
from trialid.workflow.use.kept_standing import standing_of

NO_FIT: Final = "no fit"
"""The verdict of a fit that nothing may be built on."""


@dataclass(frozen=True)
class FinishedModel:
    """A finished run taken up again: the same values, and what they rest on.

    Attributes
    ----------
    where
        What a mistake is told of: the run's folder.
    seen
        What the fitted trials hold of every input and motion, by name [SI].
    """

    where: str
    result: Result
    done: Known
    seen: dict[str, SeenRange]

    @property
    def fit(self) -> Fit:
        """The fit, its search over."""
        return self.done.fit

    @property
    def others(self) -> "tuple[FinishedModel, ...]":
        """Models whose ranges this one's hold, each as if it were the run's."""
        return tuple(replace(self, done=other) for _, other in self.done.others)

    @property
    def quantities(self) -> Mapping[str, Quantity]:
        """What may be ordered or given by name: the dictionary's, and the model's own signals."""
        model = self.fit.model
        drives = actuator_quantities(model.ship.actuators)
        own = {name: quantity_of(model, name) for one in model.effects for name in one.own}
        return {**SIGNALS, **drives, **own}

    @property
    def doubts(self) -> tuple[str, ...]:
        """What anybody who uses the model has to know of it, a sentence each."""
        verdict = self.result.verdict
        said = [verdict.sentence or "no fit"] if verdict.kind == NO_FIT else []
        doubts = records_doubt(verdict), missing_words(verdict), doubtful(self.result.physical)
        said += filter(None, doubts)
        return (*said, *(f"{line}." for line in self.result.fit.remarks))


@one_thread
def finished_model(folder: Path, progress: Progress, *, anyway: bool = False) -> FinishedModel:
    """The model of a run's folder; its logs are read again, and checked by their hashes.

    Parameters
    ----------
    anyway
        Take a fit that carries no verdict too.

    Raises
    ------
    TrialidError
        The folder holds no run, what it rests on has changed, or its fit carries no verdict.
    """
    run = earlier(folder)
    check_verdict(run.result, str(folder), anyway=anyway)
    if not run.result.model.states:
        raise TrialidError(
            f"{folder}: compares sensors alone; nothing is simulated that could be put under "
            "orders or handed over"
        )
    done = _known(run, progress)
    return FinishedModel(str(folder), run.result, done, seen_ranges(done.fit))


def _known(run: Earlier, progress: Progress) -> Known:
    """The fit of a run with how sure it is: as its folder keeps it, or worked out again."""
    catalogue = available(run.pipeline)
    kept = standing_of(run.folder, catalogue)
    if kept is not None:
        return kept.of(
            revived_fit(run.pipeline, kept.trials, run.result, str(run.folder)), catalogue
        )
    progress("reading", 0.1)
    trials = align_trials(run.pipeline, progress)
    fit = revived_fit(run.pipeline, trials, run.result, str(run.folder))
    asked, grown = diagnose_settings(run.pipeline, catalogue), bool(run.result.grown)
    return diagnose(fit, asked, progress, grown=grown).before


def check_verdict(result: Result, where: str, *, anyway: bool) -> None:
    """Refuse a fit that carries no verdict, unless somebody wants it anyway.

    Raises
    ------
    TrialidError
        It carries none; the message says why.
    """
    if result.verdict.kind == NO_FIT and not anyway:
        raise TrialidError(
            f"{where}: {result.verdict.sentence or NO_FIT}; nothing is built on it; mend the fit, "
            "or say --anyway (in Python anyway=True), which marks what comes out"
        )


def revived_fit(asked: Pipeline, trials: Sequence[Trial], result: Result, where: str) -> Fit:
    """The fit of a finished run, its values taken as they are written.

    Parameters
    ----------
    where
        What a mistake is told of: the folder, or the option that names it.

    Raises
    ------
    PipelineError
        The run is of another model, or of other trials.
    """
    model = build_model(asked, available(asked))
    kept, here = list(result.model.effects), [e.name for e in model.effects]
    if kept != here:
        apart = sorted({*kept} ^ {*here}) or ["their order"]
        raise PipelineError(
            f"{where}: is of another model than {asked.path.name} (apart in "
            f"{', '.join(apart)}); name a run of this pipeline, or run it anew"
        )
    settings = replace(settings_of(asked, model), substeps=result.fit.substeps or 1)
    values = {p.name: p.value for p in result.accuracy.parameters if p.value is not None}
    try:
        return revive(trials, model, settings, values)
    except NotIdentifiable as error:
        raise PipelineError(
            f"{where}: does not fit {asked.path.name}: {error}; run it anew"
        ) from error
