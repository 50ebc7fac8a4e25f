"""The result of a run, schema trialid-result/1: these frozen rows are what `result.json` holds.

A field is a key of the file, in its order; numbers are SI unless a unit stands beside them; what is
not known is None, never 0, and no number is infinite. `trialid.result.json_file` reads and writes
them; the JSON Schema is derived from them.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from trialid.result.change_rows import ChangePart, GrownRow, StepRow
from trialid.result.finding_rows import (
    CandidateRow,
    FindingRow,
    MissingForcePart,
    VerdictPart,
    WhereElsePart,
)
from trialid.result.fit_rows import (
    AccuracyPart,
    FitPart,
    ModelPart,
    ParameterRow,
    SplitPart,
    TrialRow,
)
from trialid.result.imo_rows import ImoPart, SailedPart

SCHEMA: Literal["trialid-result/1"] = "trialid-result/1"


@dataclass(frozen=True, kw_only=True)
class SourceRow:
    """A file beside the logs that the result rests on."""

    path: str
    sha256: str


@dataclass(frozen=True, kw_only=True)
class SignalRow:
    """Which channel a signal of a trial was read from."""

    trial: str
    signal: str
    channel: str


@dataclass(frozen=True, kw_only=True)
class Result:
    """All that a run found: `result.json`."""

    schema: Literal["trialid-result/1"] = SCHEMA
    version: str = ""
    versions: Mapping[str, str] = field(default_factory=dict)
    pipeline: str = ""
    file: str = ""
    trials: tuple[TrialRow, ...] = ()
    model: ModelPart = field(default_factory=ModelPart)
    fit: FitPart = field(default_factory=FitPart)
    split: SplitPart = field(default_factory=SplitPart)
    accuracy: AccuracyPart = field(default_factory=AccuracyPart)
    where: tuple[FindingRow, ...] = ()
    where_else: WhereElsePart = field(default_factory=WhereElsePart)
    missing: tuple[CandidateRow, ...] = ()
    not_tried: Mapping[str, str] = field(default_factory=dict)
    missing_force: MissingForcePart | None = None
    verdict: VerdictPart = field(default_factory=VerdictPart)
    imo: ImoPart | None = None
    sailed: SailedPart | None = None
    history: tuple[StepRow, ...] = ()
    before_after: ChangePart | None = None
    history_remark: str | None = None
    sources: tuple[SourceRow, ...] = ()
    signals: tuple[SignalRow, ...] = ()
    change: ChangePart | None = None
    grown: tuple[GrownRow, ...] = ()

    @property
    def present(self) -> StepRow:
        """The step of the history that is the result's own model."""
        return next(row for row in reversed(self.history) if row.step != "proposed")

    @property
    def comparable(self) -> tuple[StepRow, ...]:
        """The steps whose errors are of the same logs as the present one's."""
        done = [sorted(row.logs) for row in self.history if row.step != "proposed"]
        return tuple(row for row in self.history if sorted(row.logs) in done[-1:])

    @property
    def physical(self) -> tuple[ParameterRow, ...]:
        """The parameters of the ship, those of trials and sensors apart."""
        return tuple(row for row in self.accuracy.parameters if row.kind == "physical")

    @property
    def nuisance(self) -> tuple[ParameterRow, ...]:
        """The parameters of trials and sensors."""
        return tuple(row for row in self.accuracy.parameters if row.kind == "nuisance")
