"""What a finished run is, and what of it stays."""

from dataclasses import dataclass

from trialid.diagnosis.force.missing_force import MissingForce
from trialid.pipeline_file import Pipeline
from trialid.result.build import Findings
from trialid.result.force_series import ForceSeries, force_series
from trialid.result.schema import Result
from trialid.result.series import TrialSeries


@dataclass(frozen=True)
class Outcome:
    """What a finished run leaves behind: plain data, the time series, the force where sought.

    `grown` where its model was judged as one that effects were added to.
    """

    pipeline: Pipeline
    result: Result
    series: tuple[TrialSeries, ...]
    force: MissingForce | None
    grown: bool = False

    @property
    def forces(self) -> tuple[ForceSeries, ...]:
        """The missing force in time, as pages draw it; empty where it was not sought."""
        return () if self.force is None else force_series(self.force)


@dataclass(frozen=True)
class Run:
    """A finished run of a pipeline: its findings, the same as its result, and the time series.

    `grown` where its model was judged as one that effects were added to.
    """

    pipeline: Pipeline
    findings: Findings
    result: Result
    series: tuple[TrialSeries, ...]
    grown: bool = False

    @property
    def force(self) -> MissingForce | None:
        """The missing force, where it was sought."""
        return self.findings.force

    @property
    def outcome(self) -> Outcome:
        """The run without the matrices of its fits, which take most of the room."""
        return Outcome(self.pipeline, self.result, self.series, self.force, self.grown)
