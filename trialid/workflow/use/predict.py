"""A finished run's model under orders: series, ranges, numbers, and what to know of them."""

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, replace
from functools import reduce
from itertools import chain
from types import MappingProxyType
from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.design.following import sailed_ship, steady_inputs
from trialid.design.helm import Vessel, vessel
from trialid.design.imo.speed_loss import logged_loss, loses_speed
from trialid.design.prediction.embrace import embrace
from trialid.design.prediction.likely_spread import LikelySpread, likely_spread
from trialid.design.prediction.predicted_motion import Manoeuvre, sail_manoeuvre, sail_orders
from trialid.design.prediction.ranged_motion import PredictedMotion
from trialid.design.prediction.rudders_zero import with_rudders_zero
from trialid.design.prediction.seen_range import beyond_words
from trialid.design.rudder_rate import GEAR
from trialid.design.rudders import steered_signals
from trialid.design.standard import AT_SEA
from trialid.errors import DesignError, TrialidError, list_names
from trialid.identification.fit import Fit
from trialid.names import labels
from trialid.names.quantities import RUDDERS, SIGNALS
from trialid.pipeline_file.contradictions import nearest_signal
from trialid.second_process import each
from trialid.ship.effect import Steered
from trialid.threads import one_thread
from trialid.trial import Trial
from trialid.workflow.use.finished_model import FinishedModel
from trialid.workflow.use.orders import OrderTable, complete_rows
from trialid.workflow.use.what_if import (
    AS_FITTED,
    WhatIf,
    change_words,
    changed_ship,
    known_changes,
)

LONGEST: Final = 1_000_000
"""Samples that are simulated at most."""
EVEN: Final = 1e-3
"""Share of a step by which times may differ and count as even."""


@dataclass(frozen=True)
class Prediction:
    """What a model does under orders, and every sentence that belongs beside it."""

    name: str
    motion: PredictedMotion
    words: tuple[str, ...]


@one_thread
def predict_manoeuvre(
    model: FinishedModel, asked: Manoeuvre, what_if: WhatIf = AS_FITTED
) -> Prediction:
    """A manoeuvre by name, as the run's standard measures are sailed.

    Raises
    ------
    DesignError
        The model cannot be steered by a rudder.
    """

    def sail(one: FinishedModel) -> PredictedMotion:
        ship = changed_ship(sailed_ship(one.fit), what_if)
        spread = known_changes(spread_of(one), what_if)
        return sail_manoeuvre(ship, asked, spread, model.result.fit.band)

    return with_words(model, asked.name, as_wide_as_others(model, sail), what_if)


@one_thread
def predict_orders(
    model: FinishedModel, table: OrderTable, name: str, what_if: WhatIf = AS_FITTED
) -> Prediction:
    """Orders of a table.

    Raises
    ------
    TrialidError
        None of them is an input of the model, or there are too many.
    """

    def sail(one: FinishedModel) -> PredictedMotion:
        ship, orders, more = ready_orders(one, table, name, what_if)
        spread = known_changes(spread_of(one), what_if)
        return sail_orders(ship, orders, spread, model.result.fit.band, more.every)

    made = as_wide_as_others(model, sail)
    more = ready_orders(model, table, name, what_if)[-1]
    return with_words(model, name, made, what_if, more)


def as_wide_as_others(
    model: FinishedModel, sail: Callable[[FinishedModel], PredictedMotion]
) -> PredictedMotion:
    """What a model does, its ranges as wide as other models say beside which its fit stands.

    One that cannot do it, as it lacks what is changed, or has no rudder, widens none.
    """

    def sailed(one: FinishedModel) -> list[PredictedMotion]:
        try:
            return [sail(one)]
        except TrialidError:
            if one is model:
                raise
            return []

    return reduce(embrace, chain.from_iterable(each(sailed, [model, *model.others])))


@dataclass(frozen=True)
class OnClock:
    """What became of a table of orders: samples a row, inputs held, columns that nothing reads.

    `loses`: how the speed falls where none is given, in words; empty where it is held. `unknown`:
    columns whose names no signal has.
    """

    every: int
    held: Mapping[str, float]
    unread: Collection[str]
    loses: str = ""
    unknown: tuple[str, ...] = ()


ALL: Final = OnClock(1, MappingProxyType({}), ())
"""Every input is given, and read."""


def ready_orders(
    model: FinishedModel, table: OrderTable, name: str, what_if: WhatIf = AS_FITTED
) -> tuple[Vessel, Trial, OnClock]:
    """The ship and the orders of a table on an even clock; see `predict_orders`."""
    table = _as_recorded(model.fit, table)
    ship, held = _ship_for(model, {*table.signals}, what_if)
    inputs = {*ship.simulator.equations.inputs}
    acting = inputs | {f"{name}_order" for name in inputs}  # as of a perfect gear
    if not {*table.signals} & acting:
        raise TrialidError(
            f"{name}: holds no input of the model; expected {', '.join(sorted(inputs))}, it has "
            f"{', '.join(table.signals)}"
        )
    table = complete_rows(table, acting, name)
    clock = model.fit.problem.trials[0].period / model.fit.settings.substeps
    t, every = _clock(table.t, clock)
    signals = {n: np.interp(t, table.t, x) for n, x in table.signals.items()}
    signals |= {n: np.full(len(t), x) for n, x in held.items()}
    orders = Trial(name, "check", float(t[1] - t[0]), signals, {})
    unread = {*table.signals} - acting - {*ship.model.all_states} - RUDDERS
    loses = _loses(ship) if "u" in held else ""
    return ship, orders, OnClock(every, held, unread, loses, table.unknown)


def _as_recorded(fit: Fit, table: OrderTable) -> OrderTable:
    """The table with what is told to a thruster as its order, where the trials have that alone."""
    known = {*fit.problem.trials[0].signals}
    told = {n: f"{n}_order" for n in table.signals if n not in SIGNALS and n not in known}
    signals = {told[n] if told.get(n) in known else n: x for n, x in table.signals.items()}
    return replace(table, signals=signals)


def spread_of(model: FinishedModel) -> LikelySpread:
    """All that a prediction of a finished run is uncertain by."""
    off = model.done.doubts
    covariance = model.done.own_accuracy.covariance
    return likely_spread(model.fit, covariance, off.standing, off.held, off.missing)


def ready_ship(fit: Fit) -> Vessel:
    """The fitted ship, losing speed in turns; as she is where no rudder steers her."""
    try:
        return sailed_ship(fit)
    except DesignError:
        steady = steady_inputs(fit)
        return vessel(with_rudders_zero(fit), fit.problem.trials[0].period, steady, GEAR)


def _ship_for(
    model: FinishedModel, given: set[str], what_if: WhatIf
) -> tuple[Vessel, dict[str, float]]:
    """The ship, losing speed in turns where no speed is given; inputs held as in her trials."""
    steered = ready_ship(model.fit)
    if "u" in given and "u" not in model.fit.model.states:
        kept = with_rudders_zero(model.fit)
        steered = vessel(kept, steered.period, steered.constants, steered.rudder_rate)
    steered = changed_ship(steered, what_if)
    own = {*steered_signals(steered.model), *steered.model.all_states, "t"}
    needed = ({*steered.simulator.equations.inputs} | _of_ranges(model)) - given - own
    needed = {name for name in needed if f"{name}_order" not in given}
    return steered, {n: steered.constants[n] for n in sorted(needed) if n in steered.constants}


def _of_ranges(model: FinishedModel) -> set[str]:
    """What effects read that may be missing: its ranges count with them, the model does not."""
    read = {name for one in model.done.doubts.missing for name in one.effect.signals}
    return read - AT_SEA


def _loses(ship: Vessel) -> str:
    """How a speed that is given falls, in words; empty where it stays as it is."""
    model = ship.model
    acting = [e for e in model.effects if "u" in e.acts_on(Steered) and e is not logged_loss]
    own = [e.name for e in acting if e.parameters]  # what has none only says how a speed is read
    if own:
        return f"as {own[0]} has it"
    known = {n: model.value(n) for n in logged_loss.parameters if n in model.parameters}
    return "as in the logs" if loses_speed(known) else ""


def _clock(t: Vector, longest: float) -> tuple[Vector, int]:
    """Even times no farther apart than the fit's, and how many there are to one of the table's."""
    steps = np.diff(t)
    own = float(np.median(steps))
    even = bool(np.all(np.abs(steps - own) <= EVEN * own))
    every = max(int(np.ceil(own / longest - EVEN)), 1) if even else 1
    period = own / every if even else longest
    count = round(float(t[-1]) / period) if even else int(np.ceil(t[-1] / period))
    if count >= LONGEST:
        raise TrialidError(
            f"the orders take {count} steps of {period:.3g} s, at most {LONGEST}; give fewer"
        )
    return np.asarray(np.arange(max(count, 1) + 1) * period), every


def with_words(
    model: FinishedModel,
    name: str,
    made: PredictedMotion,
    what_if: WhatIf,
    orders: OnClock = ALL,
) -> Prediction:
    """A prediction with every sentence that belongs beside it."""
    words = [*model.doubts, *change_words(model, what_if)]
    words += filter(
        None, [beyond_words(model.fit.model.ship, model.seen, {**made.given, **made.motion})]
    )
    if orders.unread:
        words.append(f"Not read by the model: {', '.join(sorted(orders.unread))}.")
    if orders.unknown:
        hints = {n: nearest_signal(n) for n in orders.unknown}
        named = [f"{n} ({h})" if h.startswith("did") else n for n, h in hints.items()]
        words.append(f"Columns passed over, as no signal has their names: {list_names(named)}.")
    shown = {n: f"{n} = {labels.shown_text(n, x)}" for n, x in orders.held.items()}
    if orders.loses:
        begun = shown.pop("u")
        words.append(
            f"Not among the orders: {begun} is how she approaches; turns cost speed {orders.loses}."
        )
    if shown:
        words.append(f"Not among the orders, held as in the trials: {', '.join(shown.values())}.")
    if model.fit.model.states and "v" not in model.fit.model.states:
        words.append("No sway is simulated: the track goes where she heads, and holds no drift.")
    if made.ended_by_departure:
        words.append(f"The ship leaves her model: {made.departure}; nothing is given beyond.")
    return Prediction(name, made, tuple(words))
