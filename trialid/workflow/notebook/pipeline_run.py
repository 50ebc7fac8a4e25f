"""A run of a pipeline in a notebook: its tables, and the loop of adding and dropping effects."""

from dataclasses import dataclass, replace
from pathlib import Path

from trialid.own_files import write_or_say_why
from trialid.pipeline_file import Pipeline
from trialid.progress import silent
from trialid.result.build import Findings
from trialid.result.schema import Result
from trialid.result.series import TrialSeries
from trialid.threads import one_thread
from trialid.user_files import path_of
from trialid.workflow import history
from trialid.workflow.edit_model import fit_edit, foresee_edit, set_beside
from trialid.workflow.edit_pipeline import Edit, add_to_pipeline, drop_from_pipeline
from trialid.workflow.notebook.arguments import effect_name
from trialid.workflow.notebook.run_view import RunView
from trialid.workflow.outcome import Run
from trialid.workflow.run import examine
from trialid.workflow.run_folder import check_replaceable
from trialid.workflow.write_run import write


@dataclass(frozen=True, repr=False)
class PipelineRun(RunView):
    """A finished run of a pipeline file; nothing is written before `write`."""

    pipeline: Pipeline
    findings: Findings
    result: Result
    series: tuple[TrialSeries, ...]

    def add(self, effect: str) -> "PipelineRun":
        """The run of the pipeline with an effect more, its parameters free.

        The numbers are those of `trialid add`, and the result holds both models side by side.

        Raises
        ------
        TrialidError
            There is no such effect, the model has it already, or it cannot be fitted.
        """
        return self._edited(add_to_pipeline(self.pipeline, effect_name(effect, "add")))

    def drop(self, effect: str) -> "PipelineRun":
        """The run of the pipeline with an effect less.

        Raises
        ------
        TrialidError
            The model has no such effect, or cannot be fitted without it.
        """
        return self._edited(drop_from_pipeline(self.pipeline, effect_name(effect, "drop")))

    @one_thread
    def _edited(self, edit: Edit) -> "PipelineRun":
        foreseen = foresee_edit(edit, self.fit)
        edit, fit = fit_edit(edit, self.trials, foreseen, silent)
        grown = edit.grows or history.has_joined(self.result.history, edit.after.model.effects)
        after = examine(edit.after, self.trials, silent, fit, grown=grown)
        result, _ = set_beside(edit, after.result, self.result, foreseen)
        return pipeline_run(replace(after, result=result))

    def write(self, folder: str | Path) -> Path:
        """The run's folder, as `trialid run --out` writes it; the report's path.

        Raises
        ------
        TrialidError
            A file that is not ours stands in the way.
        """
        place = path_of(folder, "write")
        check_replaceable(place, self.pipeline)
        grown = history.has_joined(self.result.history, self.pipeline.model.effects)
        with write_or_say_why(place):
            write(Run(self.pipeline, self.findings, self.result, self.series, grown), place)
        return place / "report.html"


def pipeline_run(run: Run) -> PipelineRun:
    """A finished run as a notebook shows it."""
    return PipelineRun(run.pipeline, run.findings, run.result, run.series)
