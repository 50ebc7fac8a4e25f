"""What each parameter does to the standard measures: derivatives along the manoeuvres as sailed.

The helmsman answers the ship: where a parameter makes her reach the heading earlier, he reverses
earlier. So the derivative of the motion at a time is that with the orders given when they were,
which the simulation's own sensitivities are, and what the time of each order does, times what the
parameter does to that time.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final, Protocol

import numpy as np

from trialid.arrays import Vector
from trialid.design.helm import Passage, Vessel, speed_outputs, track, vessel
from trialid.design.imo.measures import execute_sample, reversal_samples
from trialid.design.rudders import steering_courses, steering_orders
from trialid.design.standard import (
    READINGS,
    Reading,
    acts_in_calm,
    in_calm,
    read_all,
    sail_all,
)
from trialid.errors import DesignError
from trialid.ship.effect import Effect
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial

LATER: Final = 8
"""Part of a sample that an order is given later, to see what that does."""
SMALL: Final = 1e-3
"""rad of heading, or share of the speed, that a parameter is moved by to read the measures anew."""


class Shows(Protocol):
    """A way in which an effect may be missing: by parameters near their null, or at one value."""

    @property
    def effect(self) -> Effect:
        """What may be missing."""

    @property
    def columns(self) -> tuple[int, ...]:
        """Its places among the columns of what may be missing."""

    @property
    def parameters(self) -> tuple[str, ...]:
        """What its columns are by; empty where a value was tried."""

    @property
    def tried(self) -> Mapping[str, float]:
        """The values tried."""


@dataclass(frozen=True)
class Slopes:
    """The measures of a ship by name, and their slopes by what is known and what may be missing.

    Attributes
    ----------
    values, remarks
        As `read_all` gives them.
    by
        (n, n_known + n_S), the measures that have values in their order, in their own units.
    """

    values: Mapping[str, float]
    remarks: Mapping[str, str]
    by: Vector


def measure_slopes(
    ship: Vessel, known: Sequence[str], missing: Sequence[Shows], width: int
) -> Slopes:
    """The measures of a ship with their slopes; zero by what does not act on her in calm water.

    Parameters
    ----------
    known
        Parameters that are fitted or held; those the ship has not, as of a sensor, move nothing.
    width
        How many columns `missing` has.

    Raises
    ------
    DesignError
        The ship is not one that can be steered.
    """
    base = in_calm(ship)
    acting = [m for m in missing if acts_in_calm(m.effect)]
    moved = with_columns(base, known, acting)
    passages = sail_all(base)
    values, remarks = read_all(passages)
    whole = np.zeros((len(values), len(known) + width))
    rows = {n: i for i, n in enumerate(values)}
    for reading in (r for r in READINGS if set(r.names) & set(values) and moved.places):
        slopes = reading_slopes(moved.ship, passages[reading.manoeuvre], reading)
        for name, row in slopes.items():
            whole[rows[name], moved.places] = row
    for one in (m for m in acting if m.tried):
        other, _ = read_all(sail_all(tried_ship(base, one)))
        apart = np.array([other.get(n, x) - x for n, x in values.items()])
        whole[:, [len(known) + c for c in one.columns]] = apart[:, None]
    return Slopes(values, remarks, whole)


@dataclass(frozen=True)
class WithColumns:
    """A ship that gives derivatives, and the place of each among known and missing columns."""

    ship: Vessel
    places: list[int]


def with_columns(
    base: Vessel, known: Sequence[str], acting: Sequence[Shows], more: Sequence[str] = ()
) -> WithColumns:
    """The ship with what may be missing, all of it absent, ready to give sensitivities.

    Parameters
    ----------
    known
        Parameters that are fitted or held; those the ship has not, as of a sensor, move nothing.
    acting
        What may be missing and would move her; what is tried at one value has no sensitivity.
    more
        Outputs beside the heading, the speed ahead and the sway speed.
    """
    linear = [m for m in acting if not m.tried]
    places = {n: i for i, n in enumerate(known) if n in base.model.parameters}
    for one in linear:
        places |= {n: len(known) + c for n, c in zip(one.parameters, one.columns, strict=True)}
    model = base.model
    for one in linear:
        model = model + one.effect
    model = model.with_values({n: x for m in linear for n, x in m.effect.nulls.items()})
    sway = [n for n in model.states if n == "v"]
    outputs = dict.fromkeys(["psi", *speed_outputs(model), *sway, *more])
    ship = replace(base, model=model, simulator=prepare(model, [*places], [*outputs]))
    return WithColumns(ship, [places[n] for n in ship.simulator.equations.free])


def tried_ship(base: Vessel, one: Shows) -> Vessel:
    """The ship with an effect at the value tried; the same where that takes nothing away."""
    model = (base.model + one.effect).with_values({**one.effect.nulls, **one.tried})
    return vessel(model, base.period, base.constants, base.rudder_rate)


def reading_slopes(ship: Vessel, passage: Passage, reading: Reading) -> dict[str, Vector]:
    """Slopes of what is read from a passage, by the columns of the ship; (n_columns,) each."""
    short = until_amidships(passage)
    motion = motion_slopes(ship, short)
    speed = ship.model.ship.particulars["U0"]
    scales = [1.0 if name == "psi" else speed for name in ship.simulator.outputs]
    sizes = np.max(np.abs(motion) / np.array(scales)[:, None], axis=(0, 1))
    steps = SMALL / np.where(sizes > 0.0, sizes, np.inf)
    rows = []
    for D, step in zip(np.moveaxis(motion, 2, 0), steps, strict=True):
        up, down = (_read(ship, short, side * step * D, reading) for side in (1.0, -1.0))
        rows.append((up - down) / (2.0 * step) if step else 0.0 * up)
    return dict(zip(reading.names, np.transpose(rows), strict=False))


def _read(ship: Vessel, passage: Passage, change: Vector, reading: Reading) -> Vector:
    """What is read where the motion is changed a little, seen from the course at the order."""
    trial = passage.trial
    signals = dict(trial.signals)
    for name, added in zip(ship.simulator.outputs, change.T, strict=True):
        signals[name] = signals[name] + added
    signals["psi"] = signals["psi"] - change[execute_sample(passage), 0]
    x, y = track(trial.t, signals, ship.model.ship.particulars["U0"])
    moved = Passage(replace(trial, signals=signals), x, y, None)
    return np.array(reading.read(moved, trial.signals["psi"]))


def until_amidships(passage: Passage) -> Passage:
    """A passage up to amidships, where it comes so far; what is after that is measured nowhere.

    Raises
    ------
    DesignError
        The ship left her model on the approach, before anything was ordered.
    """
    trial = passage.trial
    ordered = np.flatnonzero(trial.signals["delta_order"])
    if not len(ordered):
        raise DesignError(
            f"{trial.name}: the ship leaves her model on the approach, before anything is ordered: "
            f"{passage.departure}"
        )
    end = int(ordered[-1]) + 3
    signals = {n: x[:end] for n, x in trial.signals.items()}
    short = Trial(trial.name, trial.use, trial.period, signals, {})
    return Passage(short, passage.x[:end], passage.y[:end], None)


def motion_slopes(ship: Vessel, passage: Passage) -> Vector:
    """Derivatives of the motion at each time, the helmsman answering; (N, n_outputs, n_columns)."""
    trial = passage.trial
    response = respond(ship.simulator, trial, _values(ship), {})
    assert response.S is not None
    total = response.S[..., : len(ship.simulator.equations.free)].copy()
    rate, begin = trial.signals["r"], execute_sample(passage)
    for k in reversal_samples(trial.signals["delta_order"]):
        sooner = (total[k, 0] - total[begin, 0]) / rate[k]
        total[k:] -= _by_time(ship, trial, k, response.y)[k:, :, None] * sooner
    return total


def _by_time(ship: Vessel, trial: Trial, k: int, y: Vector) -> Vector:
    """What the time of the order at a sample does to the motion [1/s]; (N, n_outputs)."""
    order = trial.signals["delta_order"]
    part, fine = order.copy(), np.repeat(order, LATER)
    part[k] -= (order[k] - order[k - 1]) / LATER
    fine[k * LATER] = order[k - 1]
    signals = steering_courses(ship.model, fine, ship.rudder_rate, trial.period, LATER)
    signals |= dict.fromkeys(steering_orders(ship.model), part)
    moved = replace(trial, signals={**trial.signals, **signals})
    later = respond(ship.simulator, moved, _values(ship), {}, sensitivities=False)
    return (later.y - y) * (LATER / trial.period)


def _values(ship: Vessel) -> dict[str, float]:
    """What the columns stand at."""
    return {n: ship.model.value(n) for n in ship.simulator.equations.free}
