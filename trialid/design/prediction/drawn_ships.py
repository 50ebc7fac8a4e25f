"""Ships as the record leaves them open, drawn and sailed one by one by the compiled kernel.

A draw supposes what a likely range averages over: noise, what was held fixed and may be off, and an
effect of the catalogue that may be missing, as often as each stands. The parameters move as they
would have stood in for it, and the effect is there when the ship is sailed; one that is only known
at a value tried is there in proportion.
"""

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.arrays import Vector
from trialid.design.helm import Passage, Vessel, speed_outputs
from trialid.design.imo.measure_slopes import Shows, tried_ship
from trialid.design.prediction.keeping_place import sail_each
from trialid.design.prediction.likely_spread import LikelySpread
from trialid.design.prediction.predicted_motion import Manoeuvre, acts_under
from trialid.design.standard import LENGTHS, STEPS, STRAIGHT, acts_in_calm, in_calm
from trialid.errors import DesignError
from trialid.ship.effect import Effect
from trialid.ship.model import ShipModel
from trialid.simulation.integrate import arguments, prepare
from trialid.simulation.readout import sensor_outputs
from trialid.trial import Trial

SPARE: Final = 4
"""Times as many are drawn as are wanted, so that there are others for those that cannot be."""
SOLID: Final = frozenset({"m", "I_xx", "I_zz"})

Values = Mapping[str, Vector]
"""A number of each draw by its name; (n,) each."""


@dataclass(frozen=True)
class DrawnShips:
    """Ships drawn: what each has for numbers.

    Attributes
    ----------
    known
        Parameters that are fitted or held, and what turns cost of the speed; (n,) each.
    rivals
        Place among what may be missing of what is missing, -1 for nothing; (n,).
    sizes
        Sizes of what is missing, by its columns; (n, n_S).
    """

    known: Values
    rivals: NDArray[np.int64]
    sizes: Vector


def draw_ships(ship: Vessel, spread: LikelySpread, number: int, seed: int) -> DrawnShips:
    """Ships as the record leaves them open; the same seed gives the same ones.

    Moves are of first order: far out they make ships that cannot be, with a mass below zero or a
    thrust of nothing that the record rules out. Others are taken in their place.
    """
    rng, many = np.random.default_rng(seed), SPARE * number
    drawn = spread.standing.draw(many, rng)
    root = np.linalg.cholesky(spread.covariance + np.diag(_least(spread.covariance)))
    noise = rng.standard_normal((many, len(root))) @ root.T
    noise[:, : len(spread.fitted)] += drawn.moves
    off = np.concatenate([noise, drawn.columns[:, : len(spread.held)]], axis=1)
    known, possible = dict[str, Vector](), np.ones(many, dtype=bool)
    for name, by in zip(spread.known, off.T, strict=True):
        if name in ship.model.parameters:
            value, (low, high) = ship.model.value(name), _range(ship.model, name)
            known[name] = np.clip(value + by, low, high)
            if low < value < high:  # what ended at a bound is at it in every other ship
                possible &= (low < value + by) & (value + by < high)
    rows = np.argsort(~possible, kind="stable")[:number]
    known = {n: x[rows] for n, x in known.items()}
    return DrawnShips(known, drawn.rivals[rows], drawn.columns[rows, len(spread.held) :])


def _range(model: ShipModel, name: str) -> tuple[float, float]:
    """What a parameter can be."""
    low, high = model.parameters[name].low, model.parameters[name].high
    return (max(low, 0.0) if name in SOLID else low), high


def _least(covariance: Vector) -> Vector:
    """What keeps a covariance definite where something is known without error."""
    own = np.diag(covariance)
    return np.maximum(1e-12 * own, 1e-300)


def sail_draws(
    ship: Vessel, manoeuvre: Manoeuvre, spread: LikelySpread, ships: DrawnShips
) -> Values:
    """The numbers of a manoeuvre by name, of every ship drawn; NaN where one has none.

    Raises
    ------
    DesignError
        The model delays an input, or cannot be steered.
    """
    base = in_calm(ship)
    names = manoeuvre.reading.names
    found = np.full((len(ships.rivals), len(names)), np.nan)
    for one in groups_of_ships(base, spread, ships, acts_in_calm):
        passages = _passages(one.ship, one.thetas, manoeuvre)
        for row, passage in zip(one.rows, passages, strict=True):
            numbers = _numbers(manoeuvre, passage)
            found[row, : len(numbers)] = numbers
        if one.tried is not None:
            found[one.rows] += one.share[:, None] * _apart(base, one.tried, manoeuvre)
    return dict(zip(names, found.T, strict=True))


def simulate_draws(
    ship: Vessel,
    orders: Trial,
    spread: LikelySpread,
    ships: DrawnShips,
    outputs: Sequence[str],
) -> dict[str, Vector]:
    """Motions under orders of every ship drawn, NaN behind a departure; (n, N) each."""
    given = {*orders.signals}
    found = np.full((len(ships.rivals), orders.samples, len(outputs)), np.nan)
    for one in groups_of_ships(ship, spread, ships, lambda e: acts_under(e, given), outputs):
        for row, theta in zip(one.rows, one.thetas, strict=True):
            found[row] = _under(one.ship, orders, theta)
        if one.tried is not None:
            plain = _group(ship, None, outputs)
            other = _group(tried_ship(ship, one.tried), None, outputs)
            apart = _under(other, orders, _theta(other)) - _under(plain, orders, _theta(plain))
            found[one.rows] += one.share[:, None, None] * apart
    return dict(zip(outputs, np.moveaxis(found, 2, 0), strict=True))


@dataclass(frozen=True)
class Group:
    """Ships of which the same is missing: one structure, a row of parameters each."""

    ship: Vessel
    rows: NDArray[np.int64]
    thetas: Vector
    tried: Shows | None
    share: Vector


def groups_of_ships(
    base: Vessel,
    spread: LikelySpread,
    ships: DrawnShips,
    acts: Callable[[Effect], bool],
    outputs: Sequence[str] = (),
) -> Iterator[Group]:
    """Ships drawn, those together of which the same is missing."""
    for place in np.unique(ships.rivals).tolist():
        rows = np.flatnonzero(ships.rivals == place).astype(np.int64)
        missing = spread.missing[place] if place >= 0 else None
        if missing is not None and not acts(missing.effect):
            missing = None
        tried = missing if missing is not None and missing.tried else None
        ship = _group(base, missing if tried is None else None, outputs, ships.known)
        values = {n: x[rows] for n, x in ships.known.items()}
        share = np.zeros(len(rows))
        if missing is not None:
            sizes = ships.sizes[np.ix_(rows, np.array(missing.columns))]
            share = sizes[:, 0]
            for name, size in zip(missing.parameters, sizes.T, strict=tried is None):
                values[name] = missing.effect.nulls[name] + size
        parameters = ship.simulator.equations.parameters
        thetas = np.tile(_theta(ship), (len(rows), 1))
        for column, name in enumerate(parameters):
            if name in values:
                thetas[:, column] = values[name]
        yield Group(ship, rows, thetas, tried, share)


def _group(
    base: Vessel, missing: Shows | None, outputs: Sequence[str], drawn: Collection[str] = ()
) -> Vessel:
    """The ship with what is missing; what is drawn stays a symbol, were it zero by itself."""
    model = base.model
    if missing is not None:
        model = (model + missing.effect).with_values(missing.effect.nulls)
    free = [*drawn, *(missing.parameters if missing is not None else ())]
    asked = tuple(outputs) or speed_outputs(model)
    return replace(base, model=model, simulator=prepare(model, free, asked))


def _theta(ship: Vessel) -> Vector:
    return np.array([ship.model.value(n) for n in ship.simulator.equations.parameters])


def _passages(ship: Vessel, thetas: Vector, manoeuvre: Manoeuvre) -> Iterator[Passage]:
    one = STEPS * ship.period
    return sail_each(ship, thetas, manoeuvre.told, STRAIGHT * one, LENGTHS * one)


def _numbers(manoeuvre: Manoeuvre, passage: Passage) -> list[float]:
    if passage.departure is not None:
        return []
    try:
        return manoeuvre.reading.read(passage, None)[: len(manoeuvre.reading.names)]
    except DesignError:
        return []


def _apart(base: Vessel, tried: Shows, manoeuvre: Manoeuvre) -> Vector:
    """What an effect at its value tried does to the numbers; zero to those it takes away."""
    found = []
    for ship in (_group(tried_ship(base, tried), None, ()), _group(base, None, ())):
        [passage] = _passages(ship, _theta(ship)[None], manoeuvre)
        found.append(_numbers(manoeuvre, passage))
    apart = np.zeros(len(manoeuvre.reading.names))
    both = min(map(len, found))
    apart[:both] = np.subtract(found[0][:both], found[1][:both])
    return apart


def _under(ship: Vessel, orders: Trial, theta: Vector) -> Vector:
    """Outputs under orders written down; (N, n_y)."""
    simulator = ship.simulator
    values = dict(zip(simulator.equations.parameters, theta.tolist(), strict=True))
    theta, x0, u, limit = arguments(simulator, orders, values, {})
    X, _ = simulator.engine.simulate(theta, x0, u, limit, orders.period, simulator.substeps)
    y, _ = sensor_outputs(simulator, orders.period, X, None, u, theta)
    return y
