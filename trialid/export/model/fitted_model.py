"""All that an export of a fitted model says: equations, values, how sure, where from, how far."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.design.prediction.rudders_zero import with_rudders_zero
from trialid.design.prediction.seen_range import SeenRange
from trialid.identification.fit import Fit
from trialid.names.quantities import Quantity
from trialid.result.fit_rows import ParameterRow
from trialid.result.schema import Result
from trialid.ship.model import ShipModel, late, slope
from trialid.ship.quantity_of import quantity_of
from trialid.simulation.trace import Equations, trace
from trialid.version import VERSION

CENTRAL: Final = 1.96
"""Standard deviations from the middle of a 95 % range to its ends, where noise is normal."""


@dataclass(frozen=True, kw_only=True)
class FittedParameter:
    """One number of the model, in its unit.

    `deviation` is the standard deviation of which 1.96 reach the farther end of the likely range:
    what noise alone leaves is more sure than the run is. None for what was not fitted.
    """

    name: str
    value: float
    unit: str
    likely: tuple[float, float] | None = None
    deviation: float | None = None
    fitted: bool = False


@dataclass(frozen=True, kw_only=True)
class FittedModel:
    """A model to be handed over.

    Attributes
    ----------
    equations
        Without derivatives; parameters that are fixed at zero are left out.
    parameters
        Of the equations, in their order.
    covariance
        Of the fitted ones in their order, as wide as their likely ranges; (n, n).
    seen
        Ranges of inputs and motions in the trials [SI].
    words
        What anybody who uses it has to know, a sentence each.
    origin
        Pipeline, logs and version it comes from, by key.
    period
        The longest step it was integrated with [s].
    verdict
        Of the run; where that is `no fit`, nothing is to be built on this.
    """

    name: str
    model: ShipModel
    equations: Equations
    parameters: tuple[FittedParameter, ...]
    covariance: Vector
    seen: Mapping[str, SeenRange]
    words: tuple[str, ...]
    origin: Mapping[str, str]
    period: float
    verdict: str

    @property
    def fitted(self) -> tuple[FittedParameter, ...]:
        """The parameters that were fitted."""
        return tuple(p for p in self.parameters if p.fitted)

    @property
    def inputs(self) -> tuple[str, ...]:
        """Inputs a user gives: not those by which a late one was shifted."""
        made = {n for s in self.model.late_inputs for n in (late(s), slope(s))}
        return tuple(n for n in self.equations.inputs if n not in made)

    def quantity(self, name: str) -> Quantity:
        """What a state, an input or an output is."""
        return quantity_of(self.model, name)

    @property
    def starts(self) -> dict[str, float]:
        """Where states and inputs begin: straight ahead at the approach speed, engines as seen."""
        found = {}
        for name in (*self.equations.states, *self.inputs):
            seen = self.seen.get(name)
            middle = 0.0 if seen is None else 0.5 * (seen.low + seen.high)
            held = name in self.inputs and self.quantity(name).mirror > 0
            found[name] = middle if held else 0.0
            if name == "u":
                found[name] = self.model.ship.particulars["U0"]
        return found


def fitted_model(
    fit: Fit,
    unknowns: Sequence[str],
    covariance: Vector,
    result: Result,
    seen: Mapping[str, SeenRange],
    words: tuple[str, ...],
) -> FittedModel:
    """The model of a fit, ready to be written; `words` are what to know of it.

    `covariance` is that of the unknowns by noise; (n, n). Where each trial has a zero of the rudder
    of its own, the model has what they have together; how uncertain that is predictions know alone.
    """
    model = with_rudders_zero(fit)
    equations = trace(model, (), fit.problem.outputs)
    rows = {row.name: row for row in result.physical}
    parameters = tuple(_parameter(model, n, rows.get(n)) for n in equations.parameters)
    fitted = [p for p in parameters if p.fitted]
    places = [unknowns.index(p.name) for p in fitted]
    noise = covariance[np.ix_(places, places)]
    return FittedModel(
        name=result.pipeline,
        model=model,
        equations=equations,
        parameters=parameters,
        covariance=_widened(noise, np.array([p.deviation or np.nan for p in fitted])),
        seen=seen,
        words=(*words, *_left_out(model, equations)),
        origin=_origin(result),
        period=fit.problem.trials[0].period / fit.settings.substeps,
        verdict=result.verdict.kind or "no fit",
    )


def _parameter(model: ShipModel, name: str, row: ParameterRow | None) -> FittedParameter:
    unit, value = model.parameters[name].unit, model.value(name)
    if row is None:
        return FittedParameter(name=name, value=value, unit=unit)
    return FittedParameter(
        name=name,
        value=value,
        unit=unit,
        likely=row.likely,
        deviation=deviation_of(row),
        fitted=True,
    )


def deviation_of(row: ParameterRow) -> float | None:
    """Of which 1.96 reach the farther end of the likely range; by noise where it has none."""
    if row.value is not None and row.likely is not None:
        return max(abs(end - row.value) for end in row.likely) / CENTRAL
    off = row.off_by_noise
    return None if off is None or row.value is None else off * abs(row.value) / CENTRAL


def _widened(noise: Vector, deviations: Vector) -> Vector:
    """The covariance with these deviations, what goes together going together as by noise."""
    own = np.sqrt(np.diag(noise))
    scale = np.divide(deviations, own, out=np.full(len(own), np.nan), where=own > 0.0)
    return np.asarray(noise * np.outer(scale, scale))


def _left_out(model: ShipModel, equations: Equations) -> tuple[str, ...]:
    """What of the model is not in the equations of one instant."""
    late_ones = (
        f"{c} acts later than it is recorded; give it as it acts." for c in model.late_inputs
    )
    slow = (
        f"What is recorded of {c} is late or smoothed by its sensor; that is left out."
        for c in equations.outputs
        if equations.lags[c] or not equations.delays[c].is_constant(0.0)
    )
    return (*late_ones, *slow)


def _origin(result: Result) -> dict[str, str]:
    logs = {g.path: g.sha256 for trial in result.trials if trial.use == "fit" for g in trial.logs}
    listed = ", ".join(f"{path} (sha256 {digest[:12]})" for path, digest in logs.items())
    return {
        "made_by": f"trialid {VERSION}",
        "pipeline": result.file or result.pipeline,
        "fitted_to": listed,
        "verdict": result.verdict.sentence or result.verdict.kind or "",
        "ship": result.model.ship or "",
    }
