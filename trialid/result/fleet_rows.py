"""Rows of a fleet's tables: `runs.parquet`, `parameters.parquet`, and the changes found in them.

A field is a column, in its order; the line under it says what it holds.
"""

import datetime
from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True, kw_only=True)
class RunLabel:
    """What tells one run of a fleet from the others."""

    run: str
    """The run's name, which its folder below `runs/` has."""
    ship: str
    """The ship, as the fleet file names her."""
    voyage: str
    """The voyage's folder or file, or the pipeline's."""
    date: datetime.date | None = None
    """When that was, as far as it is stated."""
    left_out: str = ""
    """The trial held out in this run; empty where none was beside the pipeline's own."""
    structure: str = ""
    """The list of `[structures]` in this run; empty for the pipeline's own effects."""
    seed: int | None = None
    """The seed in place of the pipeline's; null where that is kept."""
    draw: int | None = None
    """The bootstrap draw of trials; null where the trials are those recorded."""

    @property
    def varied(self) -> tuple[str, str, int | None, int | None]:
        """In which way this run of a voyage was done; runs alike in this are compared."""
        return self.left_out, self.structure, self.seed, self.draw

    @property
    def as_written(self) -> bool:
        """Whether nothing of this run varies beside ship and voyage."""
        return self.varied == ("", "", None, None)


@dataclass(frozen=True, kw_only=True)
class RunRow(RunLabel):
    """One run: a row of `runs.parquet`."""

    failure: str | None = None
    """Why there is no result, in one line; then nothing below is known."""
    verdict: str | None = None
    """`missing`, `nothing missing`, `not in catalogue`, `cannot tell` or `no fit`."""
    effect: str | None = None
    """The effect named, where one is missing."""
    family: str | None = None
    """All effects that the record cannot tell from it, itself first, with commas."""
    sentence: str | None = None
    """The verdict in words."""
    eps_rmsn: float | None = None
    """Error over the fitted trials, a share of the measured RMS."""
    eps_rmsn_check: float | None = None
    """The same over the held-out trials."""
    noise: float | None = None
    """The noise's part of `eps_rmsn`."""
    undermodelling: float | None = None
    """The model's part of it."""
    converged: bool | None = None
    """Whether the search arrived."""
    trials: int | None = None
    """Trials, held-out ones among them."""
    samples: int | None = None
    """Samples of the fitted trials."""
    effects: str | None = None
    """The effects of the model that was fitted, with commas."""
    free: str | None = None
    """Its free parameters, with commas."""
    logs: str | None = None
    """SHA-256 of each log, a colon, and the samples that its trial has; with commas."""
    key: str = ""
    """SHA-256 of all that went into the run."""
    version: str | None = None
    """The version of trialid that did it."""

    @property
    def model(self) -> tuple[frozenset[str], frozenset[str]]:
        """Effects and free parameters; estimates are compared within one model."""
        return frozenset((self.effects or "").split(", ")), frozenset((self.free or "").split(", "))


@dataclass(frozen=True, kw_only=True)
class FittedRow(RunLabel):
    """One parameter of one run: a row of `parameters.parquet`."""

    parameter: str
    """Its name."""
    kind: str
    """`physical` for the ship's own, `nuisance` for those of trials and sensors."""
    unit: str
    """Unit of the numbers."""
    value: float | None = None
    """The estimate."""
    standard_error: float | None = None
    """What noise leaves open."""
    likely_low: float | None = None
    """Lower end of the likely range: at 95 %, whatever effect is missing."""
    likely_high: float | None = None
    """Its upper end."""


@dataclass(frozen=True, kw_only=True)
class Remark:
    """What is to be known of a ship beside her changes."""

    ship: str
    words: str


@dataclass(frozen=True, kw_only=True)
class ChangeRow:
    """What changes of a parameter in the course of a ship's voyages."""

    ship: str
    """The ship."""
    parameter: str
    """What changed."""
    unit: str
    """Unit of `size`."""
    form: Literal["step", "drift", "varies"]
    """A step keeps its size from `voyage` on; a drift begins there and goes on to the last, evenly
    in time where voyages are dated; `varies`: from voyage to voyage, as neither a step nor a drift
    tells."""
    voyage: str
    """The first voyage that shows it; of what varies the one furthest off its level."""
    date: datetime.date | None
    """When that was, where it is stated."""
    earliest: str
    """At 95 % it was after this voyage, any day before the next; of what varies the first one."""
    latest: str
    """At 95 % it was there by this voyage; of what varies the last one."""
    size: float
    """How much it is: of a drift, from its begin to the last voyage; of what varies, how far that
    voyage lies off."""
    relative: float | None
    """The same as a share of the level before, above zero where it grows: a resistance of -0.0012
    that becomes -0.0017 grows by 0.4."""
    p_value: float
    """How often a fleet without any change shows this much in any parameter of any ship."""
    beyond_likely: bool
    """Whether it is more than the likely ranges before and after leave open; where it is not,
    trials sailed otherwise can show the same through what the model lacks."""
