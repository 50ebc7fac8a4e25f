"""Rows of `result.json` about where the model fails and what is missing."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Annotated

from pydantic import Discriminator

from trialid.diagnosis.where.finding import Bars, Spectrum

Picture = Annotated[Bars | Spectrum, Discriminator("form")]
"""Told apart by `form`, so that an edited one is refused with the key that was edited."""


@dataclass(frozen=True, kw_only=True)
class FindingRow:
    """One slice of a record in which an output is predicted worse than chance would have it."""

    output: str
    finding: str
    doing: str | None = None
    share: float | None = None
    excess: float | None = None
    p_value: float | None = None
    t_start: float | None = None
    t_end: float | None = None
    trial: str | None = None
    sentence: str | None = None
    picture: Picture | None = None


@dataclass(frozen=True, kw_only=True)
class ShareRow:
    """What an output holds of the squared error."""

    output: str
    share: float
    sentence: str


@dataclass(frozen=True, kw_only=True)
class RestRow:
    """What is no finding: an output's noise, described."""

    output: str
    sentence: str
    picture: Picture | None = None


@dataclass(frozen=True, kw_only=True)
class WhereElsePart:
    """What is no finding: shares by output, the noise, what could not be examined."""

    by_output: tuple[ShareRow, ...] = ()
    rest: tuple[RestRow, ...] = ()
    not_examined: tuple[str, ...] = ()
    questions: int | None = None


@dataclass(frozen=True, kw_only=True)
class CandidateParameterRow:
    """A parameter of a candidate with the ends of its physical range; None where open."""

    expected: float | None = None
    refitted: float | None = None
    unit: str | None = None
    low: float | None = None
    high: float | None = None


@dataclass(frozen=True, kw_only=True)
class CandidateRow:
    """An effect that was tried, in the order of the ranking.

    `held` is of a coefficient of the model that would be freed: the value it is held at.
    """

    rank: int
    effect: str
    equation: str = ""
    family: tuple[str, ...] = ()
    cosines: Mapping[str, float] = field(default_factory=dict)
    parameters: Mapping[str, CandidateParameterRow] = field(default_factory=dict)
    eps_rmsn_predicted: float | None = None
    eps_rmsn_refitted: float | None = None
    eps_rmsn_check: float | None = None
    score: float | None = None
    p_value: float | None = None
    visibility: float | None = None
    left_out_ratio: float | None = None
    better_in: int | None = None
    blocks: int | None = None
    sign_kept: bool | None = None
    verdict: str = ""
    sentence: str = ""
    held: float | None = None


@dataclass(frozen=True, kw_only=True)
class ShapeTermRow:
    """A term of a missing force."""

    name: str | None = None
    term: str | None = None
    coefficient: float | None = None
    standard_error: float | None = None
    share: float | None = None
    p_value: float | None = None
    symmetry: str | None = None
    rivals: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class ForceEquationRow:
    """One equation that a force may be missing in."""

    equation: str
    unit: str
    explains: float | None = None
    log_likelihood_ratio: float | None = None
    p_value: float | None = None
    shape: tuple[ShapeTermRow, ...] = ()
    symmetry: str | None = None
    signals: tuple[str, ...] = ()
    shape_explains: float | None = None
    terms_tried: int | None = None
    sentence: str | None = None


@dataclass(frozen=True, kw_only=True)
class MissingForcePart:
    """A force that no effect of the catalogue makes."""

    equations: tuple[ForceEquationRow, ...] = ()
    named: str | None = None
    possible: tuple[str, ...] = ()
    effects: tuple[str, ...] = ()
    sentence: str | None = None


@dataclass(frozen=True, kw_only=True)
class NextTrialPart:
    """The trial that would tell rivals apart."""

    sentence: str
    test: str | None = None
    effects: tuple[str, ...] = ()
    cosine: float | None = None
    cosine_before: float | None = None

    @property
    def heading(self) -> str:
        """What stands before the sentence: that there is such a trial, or none that is known."""
        return "Next trial" if self.test else "No next trial"


@dataclass(frozen=True, kw_only=True)
class VerdictPart:
    """What is missing, in one word and in one sentence; `no fit` says why nothing can be said.

    `family` are the effect and what it is not told from; without an effect those of which one is
    missing. `together` are two effects that do at once what none does alone. Of a name that two
    others do as well as, both at once, these are `pair_as_well`. Numbers that are held and do as
    well as the best effect, off by what their source allows, are `held_as_well`, those moved most
    first; then nothing has a name. `doubts` are what the records leave in doubt about themselves,
    with how to settle it.
    """

    kind: str | None = None
    effect: str | None = None
    family: tuple[str, ...] = ()
    together: tuple[str, ...] = ()
    pair_as_well: tuple[str, ...] = ()
    held_as_well: tuple[str, ...] = ()
    doubts: tuple[str, ...] = ()
    sentence: str | None = None
    next_trial: NextTrialPart | None = None
