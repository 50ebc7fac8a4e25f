"""A fitted model as JSON: values, how sure, units, what was seen, and the equations in words."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Final, Literal

import numpy as np

from trialid.export.model.fitted_model import FittedModel
from trialid.result.json_file import finite, json_schema

SCHEMA: Final[Literal["trialid-model/1"]] = "trialid-model/1"


@dataclass(frozen=True, kw_only=True)
class ModelSignal:
    """A state, an input or an output; `seen` is its smallest and largest in the trials."""

    name: str
    unit: str
    meaning: str
    seen: tuple[float, float] | None = None


@dataclass(frozen=True, kw_only=True)
class ModelParameter:
    """A number of the model in its unit; `1` is one in the prime system.

    `likely` is where it lies at 95 % whatever effect of the catalogue is missing, None where nobody
    knows or it was held fixed.
    """

    name: str
    value: float
    unit: str
    fitted: bool
    likely: tuple[float, float] | None = None


@dataclass(frozen=True, kw_only=True)
class ModelEffect:
    """An effect of the model: its equation in words, and where it is from."""

    name: str
    equation: str
    source: str
    parameters: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class ModelFile:
    """All of a fitted model: `trialid export --as json`.

    Attributes
    ----------
    verdict
        Of the run; where that is `no fit`, nothing is to be built on this. How sure each number is
        stands beside it.
    covariance
        Of the parameters named in `covariance_of`, as wide as their likely ranges: 1.96 standard
        deviations reach the farther end. None where nobody knows.
    period
        The longest step [s] of the run's integration.
    """

    schema: Literal["trialid-model/1"] = SCHEMA
    name: str
    verdict: str
    words: tuple[str, ...] = ()
    origin: Mapping[str, str] = field(default_factory=dict)
    period: float
    particulars: Mapping[str, float] = field(default_factory=dict)
    states: tuple[ModelSignal, ...] = ()
    inputs: tuple[ModelSignal, ...] = ()
    outputs: tuple[ModelSignal, ...] = ()
    effects: tuple[ModelEffect, ...] = ()
    parameters: tuple[ModelParameter, ...] = ()
    covariance_of: tuple[str, ...] = ()
    covariance: tuple[tuple[float | None, ...], ...] = ()


def model_file(made: FittedModel) -> ModelFile:
    """The content of the file."""
    eq = made.equations
    effects = (
        ModelEffect(
            name=e.name, equation=e.equation, source=e.source, parameters=tuple(e.parameters)
        )
        for e in made.model.effects
    )
    parameters = (
        ModelParameter(name=p.name, value=p.value, unit=p.unit, fitted=p.fitted, likely=p.likely)
        for p in made.parameters
    )
    found: ModelFile = finite(
        ModelFile(
            name=made.name,
            verdict=made.verdict,
            words=made.words,
            origin=dict(made.origin),
            period=made.period,
            particulars=dict(made.model.ship.particulars),
            states=_signals(made, eq.states),
            inputs=_signals(made, made.inputs),
            outputs=_signals(made, tuple(eq.outputs)),
            effects=tuple(effects),
            parameters=tuple(parameters),
            covariance_of=tuple(p.name for p in made.fitted),
            covariance=tuple(tuple(row) for row in np.asarray(made.covariance).tolist()),
        )
    )
    return found


def _signals(made: FittedModel, names: tuple[str, ...]) -> tuple[ModelSignal, ...]:
    found = []
    for name in names:
        known, seen = made.quantity(name), made.seen.get(name)
        ends = None if seen is None else (seen.low, seen.high)
        found.append(ModelSignal(name=name, unit=known.unit, meaning=known.meaning, seen=ends))
    return tuple(found)


def model_schema() -> dict[str, Any]:
    """The JSON Schema of the file."""
    return json_schema(ModelFile)
