"""What a fitted ship does under orders: every motion with where it is likely to lie.

A manoeuvre by name is sailed as the standard ones are, in calm deep water, and the helmsman answers
the ship; orders written down act as they are written. The range at each time is that of a number
that follows from the fit, as of the standard measures; where the run says how far a measurement may
lie from a prediction, the wider of the two counts.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from trialid.accuracy.ranges import FROM_ZERO, cut_to_ends
from trialid.arrays import Vector
from trialid.design.helm import Instructions, Passage, Vessel, carry_out
from trialid.design.imo.measure_slopes import (
    Shows,
    motion_slopes,
    reading_slopes,
    tried_ship,
    until_amidships,
    with_columns,
)
from trialid.design.prediction.likely_spread import LikelySpread
from trialid.design.prediction.ranged_motion import PredictedMotion, Read, read_numbers, with_ranges
from trialid.design.rudders import GEAR_STATE, ramp
from trialid.design.standard import (
    AT_SEA,
    LENGTHS,
    STEPS,
    STRAIGHT,
    Reading,
    acts_in_calm,
    in_calm,
)
from trialid.errors import DesignError
from trialid.names.quantities import SIGNALS
from trialid.ship.effect import Effect
from trialid.ship.model import moves_her
from trialid.simulation.integrate import respond
from trialid.trial import Trial


@dataclass(frozen=True)
class Manoeuvre:
    """A manoeuvre by name: what the helmsman is told, and what is read from it."""

    name: str
    told: Callable[[], Instructions]
    reading: Reading


def sail_manoeuvre(
    ship: Vessel, manoeuvre: Manoeuvre, spread: LikelySpread, band: Mapping[str, float]
) -> PredictedMotion:
    """A manoeuvre by name, sailed as the standard measures are: one number for one ship.

    Parameters
    ----------
    band
        How far a measurement may lie from a prediction, by output [SI].

    Raises
    ------
    DesignError
        The ship cannot be steered, or does nothing that could be read.
    """
    base = in_calm(ship)
    passage = _sailed(base, manoeuvre)
    short = until_amidships(passage)
    acting = [m for m in spread.missing if acts_in_calm(m.effect)]
    moved = with_columns(base, spread.known, acting, motions(base))
    outputs = moved.ship.simulator.outputs
    by = np.zeros((short.trial.samples, len(outputs), len(spread.known) + spread.width))
    if moved.places:
        by[..., moved.places] = motion_slopes(moved.ship, short)
    found, remark = _numbers(passage, manoeuvre.reading)
    slopes = np.zeros((len(found), by.shape[-1]))
    if found and moved.places:
        read = reading_slopes(moved.ship, passage, manoeuvre.reading)
        slopes[:, moved.places] = np.array([read[n] for n in found])
    for one in (m for m in acting if m.tried):
        again, places = _sailed(tried_ship(base, one), manoeuvre), _places(spread, one)
        by[..., places] = _apart(outputs, again.trial, short.trial)[..., None]
        other, _ = _numbers(again, manoeuvre.reading)
        apart = np.array([other.get(n, x) - x for n, x in found.items()])
        slopes[:, places] = apart[:, None]
    made = with_ranges(moved.ship, short.trial, by, spread, band)
    # ways and angles from an order on: none of them is below zero, whatever slopes say
    ends = [cut_to_ends(r, FROM_ZERO) for r in spread.ranges([*found.values()], slopes)]
    numbers = {n: (x, r) for (n, x), r in zip(found.items(), ends, strict=True)}
    return replace(made, numbers=numbers, remark=remark, departure=passage.departure)


def sail_orders(
    ship: Vessel,
    orders: Trial,
    spread: LikelySpread,
    band: Mapping[str, float],
    every: int = 1,
    read: Read | None = None,
) -> PredictedMotion:
    """Orders written down, acting as they are written, straight between their times.

    Parameters
    ----------
    orders
        Every input of the ship's equations; of a motion that is simulated, where it begins.
    every
        Samples of the orders from one that is given back to the next.
    read
        Numbers of the signals, the track `x` and `y` among them, that are wanted with ranges.
    """
    orders = _with_rudder(ship, orders)
    given = {*orders.signals}
    acting = [m for m in spread.missing if acts_under(m.effect, given)]
    moved = with_columns(ship, spread.known, acting, motions(ship))
    free = moved.ship.simulator.equations.free
    values = {n: moved.ship.model.value(n) for n in free}
    response = respond(moved.ship.simulator, orders, values, {})
    assert response.S is not None
    gone = response.departure
    kept = orders.samples if gone is None else max(round(gone.t / orders.period), 2)
    outputs = moved.ship.simulator.outputs
    by = np.zeros((orders.samples, len(outputs), len(spread.known) + spread.width))
    by[..., moved.places] = response.S[..., : len(free)]
    for one in (m for m in acting if m.tried):
        other = with_columns(tried_ship(ship, one), (), (), motions(ship)).ship
        again = respond(other.simulator, orders, {}, {}, sensitivities=False)
        by[..., _places(spread, one)] = (again.y - response.y)[..., None]
    motion = dict(zip(outputs, response.y.T, strict=True))
    signals = {**orders.signals, **motion}
    thin = {n: np.array(x[:kept:every]) for n, x in signals.items()}
    short = Trial(orders.name, orders.use, orders.period * every, thin, {})
    by = np.nan_to_num(by[:kept:every])
    made = with_ranges(moved.ship, short, by, spread, band)
    numbers = read_numbers(read, moved.ship, short, by, spread) if read is not None else {}
    return replace(made, departure=gone, numbers=numbers)


def _with_rudder(ship: Vessel, orders: Trial) -> Trial:
    """The orders with the rudder that follows them, where the model has no gear of its own."""
    known = orders.signals
    own_gear = GEAR_STATE in ship.model.all_states
    if own_gear or "delta" in known or "delta_order" not in known:
        return orders
    delta = ramp(known["delta_order"], ship.rudder_rate * orders.period)
    return replace(orders, signals={**known, "delta": delta})


def _sailed(ship: Vessel, manoeuvre: Manoeuvre) -> Passage:
    one = STEPS * ship.period
    return carry_out(ship, manoeuvre.told(), STRAIGHT * one, LENGTHS * one, manoeuvre.name)


def motions(ship: Vessel) -> tuple[str, ...]:
    """What is simulated and has a name of its own; a state that an effect adds has none."""
    return tuple(s for s in ship.model.all_states if s in SIGNALS)


def acts_under(effect: Effect, given: set[str]) -> bool:
    """Whether an effect moves a ship of which these signals are given."""
    unknown = ({*effect.signals} & AT_SEA) - given - {"psi"}
    return moves_her(effect) and not unknown


def _places(spread: LikelySpread, one: Shows) -> list[int]:
    return [len(spread.known) + c for c in one.columns]


def _apart(outputs: Iterable[str], other: Trial, base: Trial) -> Vector:
    """What another ship does differently at the same times; (N, n_outputs)."""
    n = min(other.samples, base.samples)
    columns = [np.zeros(base.samples) for _ in outputs]
    for column, name in zip(columns, outputs, strict=True):
        column[:n] = other.signals[name][:n] - base.signals[name][:n]
        column[n:] = column[n - 1]
    return np.column_stack(columns)


def _numbers(passage: Passage, reading: Reading) -> tuple[dict[str, float], str]:
    """What a passage comes to, and why there is no more."""
    if passage.departure is not None:
        return {}, f"the ship leaves her model: {passage.departure}"
    try:
        found = reading.read(passage, None)
    except DesignError as error:
        return {}, str(error)
    remark = "" if len(found) >= len(reading.names) else f"no {reading.names[len(found)]}"
    return dict(zip(reading.names, found, strict=False)), remark
