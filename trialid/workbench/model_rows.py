"""The model as rows: every effect, its parameters, and what the pipeline says of them."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from math import inf
from typing import Any

from trialid.errors import EffectError
from trialid.quantities import MASS_PARAMETERS
from trialid.report import bars
from trialid.report.bars import ParameterBar
from trialid.ship.effect import Effect, Parameter
from trialid.ship.model import ShipModel
from trialid.workbench.shown import Shown


@dataclass(frozen=True)
class ParameterRow:
    """A parameter in its own unit; None or empty where nothing is known or written.

    `error` is the standard error; `relative`, `noise`, `model` are those of Eq. 14. `low`, `high`
    and `given` are what the pipeline says, as it may be edited; `limits` the physical range;
    `own` the value without the pipeline's, and `source` where the present one is from. `stale`
    says that value and errors are those of the model before.
    """

    name: str
    unit: str
    free: bool
    value: float | None
    error: float | None = None
    relative: float | None = None
    noise: float | None = None
    model: float | None = None
    bar: ParameterBar | None = None
    low: str = ""
    high: str = ""
    limits: tuple[str, str] = ("", "")
    given: str = ""
    own: float | None = None
    source: str = ""
    prior: tuple[float, float] | None = None
    stale: bool = False


@dataclass(frozen=True)
class EffectRow:
    """An effect of the model; `there` is False where no effect has the name."""

    name: str
    equation: str
    source: str
    parameters: tuple[ParameterRow, ...]
    there: bool = True


def effects(shown: Shown) -> tuple[EffectRow, ...]:
    """Every effect of the pipeline's model, in its order."""
    return tuple(_effect(name, shown) for name in shown.recipe.model.effects)


def _effect(name: str, shown: Shown) -> EffectRow:
    effect = shown.catalogue.get(name)
    if effect is None:
        return EffectRow(name, "", "", (), there=False)
    return EffectRow(name, effect.equation, effect.source, parameters(effect, shown))


def parameters(effect: Effect, shown: Shown) -> tuple[ParameterRow, ...]:
    """The rows of an effect's parameters."""
    return _rows(effect.parameters, shown)


def masses(shown: Shown) -> tuple[ParameterRow, ...]:
    """The rigid body's and the added masses; none where nothing moves or no model is built yet."""
    if shown.model is None or not shown.recipe.model.states:
        return ()
    known = shown.model.parameters
    return _rows({name: known[name] for name in MASS_PARAMETERS}, shown)


def _rows(found: Mapping[str, Parameter], shown: Shown) -> tuple[ParameterRow, ...]:
    estimated = _estimated(shown)
    lengths = _bars(estimated.values())
    free = shown.recipe.identify.free
    return tuple(
        _free(name, p, shown, estimated.get(name), lengths.get(name))
        if name in free
        else _held(name, p, shown)
        for name, p in found.items()
    )


def _estimated(shown: Shown) -> dict[str, Mapping[str, Any]]:
    """What is known of the estimates; until there is a fit it is that of the model before."""
    known = shown.before if shown.run is None and shown.fit is None else shown.run
    rows = known.result["accuracy"]["parameters"] if known else ()
    return {row["name"]: row for row in rows if row["kind"] != "nuisance"}


def _bars(rows: Iterable[Mapping[str, Any]]) -> dict[str, ParameterBar]:
    """The two terms of Eq. 14 of each parameter, on one axis."""
    known = [row for row in rows if row["relative_error"] is not None]
    _, lengths = bars.parameter_bars(known)
    return {row["name"]: bar for row, bar in zip(known, lengths, strict=True)}


def _free(
    name: str,
    p: Parameter,
    shown: Shown,
    row: Mapping[str, Any] | None,
    bar: ParameterBar | None,
) -> ParameterRow:
    said = shown.recipe.identify
    low, high = said.bounds.get(name, (-inf, inf))
    prior = said.priors.get(name)
    made = ParameterRow(
        name, p.unit, True, _estimate(name, shown), bar=bar, low=written(low), high=written(high),
        limits=(written(p.low), written(p.high)),
        prior=None if prior is None else (prior.mean, prior.std),
    )  # fmt: skip
    if row is None:
        return made
    return replace(
        made, value=row["value"], error=row["standard_error"], relative=row["relative_error"],
        noise=row["noise_error"], model=row["undermodelling_error"], stale=shown.run is None,
    )  # fmt: skip


def _estimate(name: str, shown: Shown) -> float | None:
    return None if shown.fit is None else shown.fit.estimates.get(name)


def _held(name: str, p: Parameter, shown: Shown) -> ParameterRow:
    """A parameter that is not sought: the pipeline's value, the ship file's, or none."""
    given = shown.recipe.model.values.get(name)
    model = shown.model
    value = _value(model, name)
    if value is None and given is not None and given.unit is None:
        value = given.value
    own = None if model is None else _value(_without(model, name), name)
    source = "given here" if given else "" if value is None else "from the ship file"
    if value == 0.0 and model is not None and model.stated(name) is None:
        source = "acts on nothing that is simulated"
    shown_value = "" if given is None or value is None else written(value)
    return ParameterRow(name, p.unit, False, value, given=shown_value, own=own, source=source)


def _without(model: ShipModel, name: str) -> ShipModel:
    return replace(model, values={n: x for n, x in model.values.items() if n != name})


def _value(model: ShipModel | None, name: str) -> float | None:
    """A parameter's value, None where nobody gives one."""
    try:
        return None if model is None else model.value(name)
    except EffectError:
        return None


def written(value: float) -> str:
    """A number as one types it; an open end is empty.

    >>> written(-0.0125), written(inf)
    ('-0.0125', '')
    """
    return "" if abs(value) == inf else f"{value:.12g}"
