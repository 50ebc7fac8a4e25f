"""Rows of `result.json` about trials, model, fit, the error's parts and accuracy."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import inf
from typing import Final, Literal

from trialid.accuracy.likely import student
from trialid.accuracy.ranges import share_off
from trialid.names.quantities import POSITION

Interval = tuple[float, float]

UNTOLD: Final = 1e-3
"""Share of what is known that is the record's: with less it says nothing against a prior."""


Part = Literal["noise", "undermodelling"]


@dataclass(frozen=True, kw_only=True)
class LogRow:
    """One log of a trial."""

    path: str
    sha256: str
    adapter: str


@dataclass(frozen=True, kw_only=True)
class TrialRow:
    """One trial; `eps_rmsn` by output, None where its simulation was lost.

    `inside` is the share of samples within the band of `FitPart`, by output.
    """

    name: str
    use: Literal["fit", "check"]
    logs: tuple[LogRow, ...] = ()
    samples: int | None = None
    period: float | None = None
    duration: float | None = None
    remarks: tuple[str, ...] = ()
    eps_rmsn: Mapping[str, float | None] = field(default_factory=dict)
    inside: Mapping[str, float | None] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True)
class ModelPart:
    """What was fitted; `particulars` are the ship's, SI."""

    ship: str | None = None
    particulars: Mapping[str, float] = field(default_factory=dict)
    rudder_positive: str = "starboard"
    states: tuple[str, ...] = ()
    effects: tuple[str, ...] = ()
    free: tuple[str, ...] = ()
    inputs: tuple[str, ...] = ()
    outputs: tuple[str, ...] = ()
    nuisance: tuple[str, ...] = ()

    @property
    def turns(self) -> bool:
        """Whether orders can be sailed: a model of her roll alone has no course."""
        return "r" in self.states

    @property
    def by_rudder(self) -> bool:
        """Whether one rudder angle steers."""
        return self.turns and bool({"delta", "delta_order"} & {*self.inputs})

    @property
    def by_rudders(self) -> bool:
        """Whether several rudders steer, which move as one."""
        return self.turns and "rudders" in self.effects

    @property
    def by_thrusters(self) -> bool:
        """Whether thrusters steer and no rudder does."""
        return self.turns and "thrusters" in self.effects and not self.by_rudder


@dataclass(frozen=True, kw_only=True)
class IterationRow:
    """One step of the search: Eq. 4, its root as an error, and the damping's share of the step."""

    V: float
    eps_rmsn: float
    step: float


@dataclass(frozen=True, kw_only=True)
class StartsPart:
    """How many starts reached this optimum, of how many."""

    agreeing: int
    of: int


NO_MODEL: Final = 1.96
"""RMS values of a motion within which 95 % of it lies, whatever a model says."""


@dataclass(frozen=True, kw_only=True)
class FitPart:
    """How the search ended; errors are shares of the measured RMS.

    `band` is the half-width about the prediction of a trial that was not fitted that holds 95 % of
    what is measured, by output [SI]; empty where fewer than two trials were fitted. `search` is
    what the search did beyond going down from the stated start, `remarks` what to read beside the
    parameters: values at a bound, priors that the record contradicts; a line each.
    """

    eps_rmsn: float | None = None
    eps_rmsn_by_output: Mapping[str, float | None] = field(default_factory=dict)
    eps_rmsn_check: float | None = None
    eps_rmsn_check_by_output: Mapping[str, float | None] | None = None
    V: float | None = None
    iterations: tuple[IterationRow, ...] = ()
    converged: bool | None = None
    reason: str | None = None
    starts: StartsPart | None = None
    samples: int | None = None
    step_halving: Mapping[str, float] | None = None
    substeps: int | None = None
    weighting: str | None = None
    y_rms: Mapping[str, float] = field(default_factory=dict)
    band: Mapping[str, float] = field(default_factory=dict)
    search: tuple[str, ...] = ()
    remarks: tuple[str, ...] = ()

    @property
    def untold_band(self) -> tuple[str, ...]:
        """Outputs, but for positions, whose band is as wide as with no model: twice their RMS."""
        every = ((n, half, self.y_rms.get(n)) for n, half in self.band.items() if n not in POSITION)
        return tuple(name for name, half, moved in every if moved and half > NO_MODEL * moved)


@dataclass(frozen=True, kw_only=True)
class IntervalPart:
    """95 % intervals of the two parts of an error."""

    noise: Interval | None = None
    undermodelling: Interval | None = None


@dataclass(frozen=True, kw_only=True)
class PartsRow:
    """One output's error: its noise and its model part."""

    noise: float | None = None
    undermodelling: float | None = None

    def ends(self, part: Part) -> Interval | None:
        """One output's parts have no intervals of their own."""
        return None


@dataclass(frozen=True, kw_only=True)
class RouteRow:
    """One way of telling noise from model error, and what it gave."""

    noise: float | None = None
    undermodelling: float | None = None
    method: str | None = None
    why: str | None = None
    interval: IntervalPart | None = None
    available: bool = False


@dataclass(frozen=True, kw_only=True)
class SplitPart:
    """What the error is made of, by the route that is trusted most of those that hold."""

    noise: float | None = None
    undermodelling: float | None = None
    method: str | None = None
    why: str | None = None
    interval: IntervalPart | None = None
    by_output: Mapping[str, PartsRow] | None = None
    routes: tuple[RouteRow, ...] = ()

    def ends(self, part: Part) -> Interval | None:
        """The 95 % interval of a part, where it has one."""
        if self.interval is None:
            return None
        return self.interval.noise if part == "noise" else self.interval.undermodelling

    def of(self, output: str) -> PartsRow:
        """The parts of one output's error, unknown where they were not told apart."""
        return (self.by_output or {}).get(output, PartsRow())


@dataclass(frozen=True, kw_only=True)
class ParameterRow:
    """One unknown; the parts of Eq. 14 and their sum are relative, other errors in `unit`.

    `freedom` are the degrees of freedom of `standard_error`. `likely` is where the value lies at
    95 % whatever is missing, in `unit`; `widened_by` the effect that widens this most, empty where
    that is what was held fixed, `scales of the logs` where these may be off by as much, `another
    GM` where the record does not tell it, `the usual forces at once` where all together do,
    `sensors that are not early` where one was taken to be. `prior` is what was known of it
    beforehand, mean and standard deviation; `prior_share` how much of what is known now that is.
    """

    name: str
    value: float | None = None
    unit: str = "1"
    S_i: float | None = None
    S_imin: float | None = None
    R_i: float | None = None
    relative_error: float | None = None
    noise_error: float | None = None
    undermodelling_error: float | None = None
    standard_error: float | None = None
    white_error: float | None = None
    n_effective: float | None = None
    freedom: float | None = None
    likely: Interval | None = None
    widened_by: str | None = None
    kind: Literal["physical", "nuisance"] = "physical"
    prior: tuple[float, float] | None = None
    prior_share: float | None = None

    @property
    def may_be_off(self) -> float | None:
        """How far the likely range goes from the value, as a share of it; None where unknown."""
        return share_off(self.value, self.likely)

    @property
    def reach(self) -> float | None:
        """How far noise alone may put the value, 95 times of 100, in `unit`."""
        if self.standard_error is None:
            return None
        return float(student(inf if self.freedom is None else self.freedom)) * self.standard_error

    @property
    def off_by_noise(self) -> float | None:
        """The same as a share of the value."""
        return abs(self.reach / self.value) if self.reach is not None and self.value else None

    @property
    def off_prior(self) -> float | None:
        """How far the record and the prior lie apart, in standard deviations of their difference.

        Where the two of them meet in the estimate, it lies from the prior's mean by what its
        deviation and the one that is left leave: sqrt(std^2 - left^2).
        """
        if self.prior is None or self.prior_share is None or self.value is None:
            return None
        mean, deviation = self.prior
        told = 1.0 - self.prior_share
        return (self.value - mean) / (deviation * told**0.5) if told > UNTOLD else None


@dataclass(frozen=True, kw_only=True)
class WeakRow:
    """A direction of parameter space that the record hardly sees."""

    sentence: str | None = None
    parameters: tuple[str, ...] = ()
    relative_error: float | None = None
    moves: Mapping[str, float | None] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True)
class LeversPart:
    """Eq. 15 and 16, primed; the error by noise alone, likely is the margin whatever is missing."""

    L_r: float | None = None
    L_v: float | None = None
    margin: float | None = None
    standard_error: float | None = None
    likely: Interval | None = None
    stable: bool | None = None


@dataclass(frozen=True, kw_only=True)
class StabilityPart(LeversPart):
    """Directional stability, and the same with heel."""

    roll_coupled: LeversPart | None = None


@dataclass(frozen=True, kw_only=True)
class AccuracyPart:
    """Eq. 8 to 14; `narrowed_by` says which trial would narrow the widest likely range."""

    S_min: float | None = None
    S_max: float | None = None
    R: float | None = None
    n_effective: float | None = None
    weighting: str | None = None
    scaling: str | None = None
    parameters: tuple[ParameterRow, ...] = ()
    weak: tuple[WeakRow, ...] = ()
    narrowed_by: str | None = None
    stability: StabilityPart | None = None
