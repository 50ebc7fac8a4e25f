"""The model as rows: every effect, its parameters, and what the pipeline says of them."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from math import inf

from trialid.errors import EffectError, PipelineError
from trialid.names.quantities import MASS_PARAMETERS
from trialid.pipeline_file.prior_section import OfTheShip
from trialid.report.pictures import bars
from trialid.report.pictures.bars import RangeBar
from trialid.result import fit_rows
from trialid.ship.effect import Effect, Parameter
from trialid.ship.model import ShipModel
from trialid.workbench.shown import Shown
from trialid.workflow.build_model import priors_of


@dataclass(frozen=True)
class ParameterRow:
    """A parameter in its own unit; None or empty where nothing is known or written.

    `error` is the standard error, `likely` the likely range. `low`, `high`
    and `given` are what the pipeline says, as it may be edited; `limits` the physical range;
    `own` the value without the pipeline's, and `source` where the present one is from. `stale`
    says that value and errors are those of the model before.
    """

    name: str
    unit: str
    free: bool
    value: float | None
    error: float | None = None
    likely: tuple[float, float] | None = None
    may_be_off: float | None = None
    bar: RangeBar | None = None
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
    return tuple(_effect(name, shown) for name in shown.pipeline.model.effects)


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
    if shown.model is None or not shown.pipeline.model.states:
        return ()
    known = shown.model.parameters
    return _rows({name: known[name] for name in MASS_PARAMETERS}, shown)


def _rows(found: Mapping[str, Parameter], shown: Shown) -> tuple[ParameterRow, ...]:
    estimated = _estimated(shown)
    lengths = _bars(estimated.values())
    free = shown.pipeline.identify.free
    return tuple(
        _free(name, p, shown, estimated.get(name), lengths.get(name))
        if name in free
        else _held(name, p, shown)
        for name, p in found.items()
    )


def _estimated(shown: Shown) -> dict[str, fit_rows.ParameterRow]:
    """What is known of the estimates; until there is a fit it is that of the model before."""
    known = shown.before if shown.run is None and shown.fit is None else shown.run
    return {row.name: row for row in known.result.physical} if known else {}


def _bars(rows: Collection[fit_rows.ParameterRow]) -> dict[str, RangeBar | None]:
    """The likely ranges, on one axis."""
    _, drawn = bars.range_bars(list(rows))
    return {row.name: bar for row, bar in zip(rows, drawn, strict=True)}


def _free(
    name: str,
    p: Parameter,
    shown: Shown,
    row: fit_rows.ParameterRow | None,
    bar: RangeBar | None,
) -> ParameterRow:
    said = shown.pipeline.identify
    low, high = said.bounds.get(name, (-inf, inf))
    prior = _known(shown).get(name)
    made = ParameterRow(
        name,
        p.unit,
        True,
        _estimate(name, shown),
        bar=bar,
        low=number_text(low),
        high=number_text(high),
        limits=(number_text(p.low), number_text(p.high)),
        prior=prior,
    )
    if row is None:
        return made
    return replace(
        made, value=row.value, error=row.standard_error, likely=row.likely,
        may_be_off=row.may_be_off, stale=shown.run is None,
    )  # fmt: skip


def _known(shown: Shown) -> Mapping[str, tuple[float, float]]:
    """What is known beforehand; nothing while a ship file cannot say what it is asked for."""
    said = shown.pipeline.identify.priors
    if not isinstance(said, OfTheShip):
        return {n: p.known for n, p in said.items()}
    try:
        return {} if shown.model is None else priors_of(shown.pipeline, shown.model)
    except PipelineError:
        return {}


def _estimate(name: str, shown: Shown) -> float | None:
    return None if shown.fit is None else shown.fit.estimates.get(name)


def _held(name: str, p: Parameter, shown: Shown) -> ParameterRow:
    """A parameter that is not sought: the pipeline's value, the ship file's, or none."""
    given = shown.pipeline.model.values.get(name)
    model = shown.model
    value = _value(model, name)
    if value is None and given is not None and given.unit is None:
        value = given.value
    own = None if model is None else _value(_without(model, name), name)
    source = "given here" if given else "" if value is None else "from the ship file"
    if value == 0.0 and model is not None and model.stated(name) is None:
        source = "acts on nothing that is simulated"
    shown_value = "" if given is None or value is None else number_text(value)
    return ParameterRow(name, p.unit, False, value, given=shown_value, own=own, source=source)


def _without(model: ShipModel, name: str) -> ShipModel:
    return replace(model, values={n: x for n, x in model.values.items() if n != name})


def _value(model: ShipModel | None, name: str) -> float | None:
    """A parameter's value, None where nobody gives one."""
    try:
        return None if model is None else model.value(name)
    except EffectError:
        return None


def number_text(value: float) -> str:
    """A number as one types it; an open end is empty.

    >>> number_text(-0.0125), number_text(inf)
    ('-0.0125', '')
    """
    return "" if abs(value) == inf else f"{value:.12g}"
