"""The result of comparing structures, schema trialid-structures/1: what `structures.json` holds."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from trialid.result.fit_rows import LogRow
from trialid.result.schema import SourceRow

SCHEMA: Literal["trialid-structures/1"] = "trialid-structures/1"
NAME = "structures.json"


@dataclass(frozen=True, kw_only=True)
class StructureRow:
    """One structure: its effects, its size, and its error on trials that were left out.

    `eps_rmsn` is of the fit of all trials, `eps_rmsn_check` on the pipeline's held-out trials,
    `left_out` of each fitted trial when it was left out, all as shares of the measured RMS of the
    fitted trials. `unforetold` are those that were foretold worse than by their own means.
    `behind` is the mean of the left-out errors less the best structure's, `as_good` whether that is
    within its standard error. `why_not` says why a structure is not in the choice.
    """

    name: str
    effects: tuple[str, ...] = ()
    free: tuple[str, ...] = ()
    parameters: int | None = None
    eps_rmsn: float | None = None
    eps_rmsn_check: float | None = None
    left_out: Mapping[str, float] = field(default_factory=dict)
    unforetold: tuple[str, ...] = ()
    eps_rmsn_left_out: float | None = None
    behind: float | None = None
    behind_standard_error: float | None = None
    as_good: bool = False
    why_not: str | None = None


@dataclass(frozen=True, kw_only=True)
class Structures:
    """All that comparing structures found: `structures.json`.

    `chosen_without` is the choice made again without any use of a trial, by that trial; None where
    no structure stood; empty where it was not asked for or too few trials are left.
    """

    schema: Literal["trialid-structures/1"] = SCHEMA
    version: str = ""
    pipeline: str = ""
    file: str = ""
    trials: tuple[str, ...] = ()
    logs: tuple[LogRow, ...] = ()
    sources: tuple[SourceRow, ...] = ()
    rows: tuple[StructureRow, ...] = ()
    not_tried: Mapping[str, str] = field(default_factory=dict)
    best: str | None = None
    chosen: str | None = None
    chosen_without: Mapping[str, str | None] = field(default_factory=dict)
    sentences: tuple[str, ...] = ()

    def row(self, name: str) -> StructureRow:
        """The row of a structure."""
        return next(each for each in self.rows if each.name == name)
