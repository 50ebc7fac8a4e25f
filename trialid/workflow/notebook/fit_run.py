"""A run without a pipeline file: from a fit of trials in memory."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from trialid import own_files
from trialid.diagnosis.diagnose import diagnose
from trialid.diagnosis.diagnosed import DiagnoseSettings
from trialid.effects import find
from trialid.errors import EffectError, nearest
from trialid.identification.fit import Fit, identify
from trialid.report.pages.page import write_page
from trialid.result.build import Findings, result_from, steps_from
from trialid.result.force_series import force_series
from trialid.result.json_file import text_of
from trialid.result.schema import Result
from trialid.result.series import TrialSeries, write_csv
from trialid.ship.effect import Effect
from trialid.ship.model import ShipModel
from trialid.user_files import path_of
from trialid.workflow.findings import narrowing_trial, proposal
from trialid.workflow.fit_model import time_series
from trialid.workflow.notebook.arguments import effect_name
from trialid.workflow.notebook.run_view import RunView


@dataclass(frozen=True, repr=False)
class FitRun(RunView):
    """A fit with all that was found out about it."""

    settings: DiagnoseSettings
    findings: Findings
    result: Result
    series: tuple[TrialSeries, ...]

    def add(self, effect: str | Effect) -> "FitRun":
        """The run of the model with an effect more, its parameters free; nothing is written.

        Raises
        ------
        TrialidError
            There is no such effect, the model has it already, or it cannot be fitted.
        """
        own = dict(self.settings.candidates)
        added = effect if isinstance(effect, Effect) else find(effect_name(effect, "add"), own)
        if added.name in [e.name for e in self.fit.model.effects]:
            raise EffectError(f"{added.name!r} is in the model already")
        lost = self.fit.model.lost_to(added)
        kept = (n for n in self.fit.settings.free if n not in lost)
        return self._again(self.fit.model + added, tuple(dict.fromkeys([*kept, *added.parameters])))

    def drop(self, name: str) -> "FitRun":
        """The run of the model with an effect less; nothing is written.

        Raises
        ------
        TrialidError
            The model has no such effect, or cannot be fitted without it.
        """
        present = {e.name: e for e in self.fit.model.effects}
        name = effect_name(name, "drop")
        if name not in present:
            raise EffectError(f"{name!r} is not in the model; {nearest(name, present)}")
        model = self.fit.model - name
        free = tuple(n for n in self.fit.settings.free if n in model.parameters)
        return self._again(model, free)

    def _again(self, model: ShipModel, free: tuple[str, ...]) -> "FitRun":
        settings = replace(self.fit.settings, free=free)
        near: Mapping[str, float] = self.fit.estimates
        fit = identify(self.trials, model, settings, near=near)
        return diagnosed_run(fit, self.settings, self.findings.name)

    def write(self, folder: str | Path) -> Path:
        """`report.html`, `result.json` and `series.csv` in a folder; the report's path.

        Raises
        ------
        TrialidError
            A file that is not ours stands in the way, or the folder cannot be written.
        """
        place = path_of(folder, "write")
        forces = () if self.findings.force is None else force_series(self.findings.force)
        with own_files.write_or_say_why(place), own_files.replacing(place) as work:
            (work / "result.json").write_text(text_of(self.result), encoding="utf-8")
            write_csv(work / "series.csv", self.series)
            write_page(work / "report.html", self.result, self.series, forces)
        return place / "report.html"


def diagnosed_run(fit: Fit, settings: DiagnoseSettings, name: str) -> FitRun:
    """A fit diagnosed."""
    found = diagnose(fit, settings)
    findings = Findings(
        **vars(found),
        name=name,
        pipeline="",
        proposal=proposal(found.before.fit.examined, found.verdict, settings.candidates),
        narrowing=narrowing_trial(found, settings.candidates),
    )
    result = result_from(findings, history=steps_from(findings))
    return FitRun(settings, findings, result, time_series(fit))
