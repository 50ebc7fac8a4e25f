"""What the workbench shows at one moment: frozen, and replaced as a whole when more is known."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from operator import is_
from typing import Literal

from trialid.errors import EffectError, LogError, PipelineError, TrialidError
from trialid.identification.fit import Fit
from trialid.pipeline_file import Pipeline
from trialid.result.series import TrialSeries
from trialid.ship.effect import Effect
from trialid.ship.model import ShipModel
from trialid.trial import Trial
from trialid.workflow.outcome import Outcome

Place = Literal["pipeline", "effects", "logs", "fit"]
"""Where a mistake was made."""


@dataclass(frozen=True)
class Working:
    """What is being computed: because of what, which part of it, and the share that is done."""

    why: str
    words: str
    share: float | None


@dataclass(frozen=True)
class Trouble:
    """A mistake that stands until it is mended, and where it was made."""

    where: Place
    words: str


@dataclass(frozen=True)
class Shown:
    """One model as far as it is known.

    Attributes
    ----------
    pipeline
        The pipeline as its file has it.
    catalogue
        Every effect that can be added, the user's own among them.
    model
        With the fitted values once there is a fit; None before it could be built.
    trials
        Aligned; empty while the logs are read.
    series
        Measured, and predicted where there is a fit; until then by the model before, or NaN.
    fit
        The fit of this model: its error is known a second before what it is made of. None while it
        is sought, and where `run` was computed earlier and kept.
    run
        Everything about this model; None until it is all known.
    before
        Everything about the model before the last change, to be shown beside, or greyed meanwhile.
    named
        What was done to come to a step of the history, by its place there, as far as it was here.
    """

    pipeline: Pipeline
    catalogue: Mapping[str, Effect]
    model: ShipModel | None = None
    trials: tuple[Trial, ...] = ()
    series: tuple[TrialSeries, ...] = ()
    fit: Fit | None = None
    run: Outcome | None = None
    before: Outcome | None = None
    named: Mapping[int, str] = field(default_factory=dict)

    @property
    def stage(self) -> Literal["reading", "measured", "fitted", "diagnosed"]:
        """How far it is known."""
        if self.run is not None:
            return "diagnosed"
        if self.fit is not None:
            return "fitted"
        return "measured" if self.trials else "reading"


def goes_on(shown: Shown, further: Shown) -> bool:
    """Whether only trials came after those shown, measured and no more: their curves stay."""
    read = shown.trials
    measured = shown.fit is further.fit is None and shown.run is further.run is None
    same = measured and shown.pipeline is further.pipeline and shown.before is further.before
    return same and bool(read) and all(map(is_, read, further.trials))


def place_of(error: TrialidError) -> Place:
    """Where a mistake was made."""
    if isinstance(error, EffectError):
        return "effects"
    if isinstance(error, LogError):
        return "logs"
    return "pipeline" if isinstance(error, PipelineError) else "fit"
