"""A manoeuvre simulated once from begin to end: for thousands of ships that differ in numbers.

`helm.carry_out` simulates from the start whenever the helmsman looks; here the ship keeps her
place, so that every sample is simulated about once. The same orders at the same samples come out.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.design.helm import Hold, Instructions, Passage, Vessel, track
from trialid.design.rudders import amidships, steering_gears, steering_orders
from trialid.errors import DesignError
from trialid.simulation.integrate import arguments, departure
from trialid.simulation.readout import sensor_outputs
from trialid.trial import Trial

REACH: Final = 400
"""Samples that are simulated from one look of the helmsman at the ship to the next."""
AFTER: Final = 3
"""Samples after the last order that a reading may need."""


@dataclass(kw_only=True)
class _Voyage:
    """A manoeuvre in the making, its states (N, n_x) known up to the sample `known`."""

    ship: Vessel
    theta: Vector
    limit: Vector
    u: Vector
    X: Vector
    orders: Vector
    rudders: dict[str, Vector]
    known: int = 0
    left: int = 0

    def simulate(self, end: int) -> None:
        """Go on to the sample before `end`."""
        inputs = self.ship.simulator.equations.inputs
        here = slice(self.known, end)
        told = dict.fromkeys(steering_orders(self.ship.model), self.orders)
        for name, values in (told | self.rudders).items():
            if name in inputs:
                self.u[here, inputs.index(name)] = values[here]
        run = self.ship.simulator.engine
        x, u = self.X[self.known], self.u[here]
        self.X[here], left = run.simulate(self.theta, x, u, self.limit, self.ship.period, 1)
        self.left = self.known + left if left else 0
        self.known = end - 1

    def steer(self, at: int, end: int, order: float) -> None:
        """Give an order at a sample; the rudder is under way from the next one on."""
        self.orders[at:end] = order
        for name, rate in steering_gears(self.ship.model, self.ship.rudder_rate).items():
            angle = self.rudders[name]
            step, far = rate * self.ship.period, order - angle[at]
            moved = np.minimum(step * np.arange(end + 1 - at), abs(far))
            angle[at : end + 1] = angle[at] + math.copysign(1.0, far) * moved

    def look(self, begin: int, end: int) -> dict[str, Vector]:
        """Every motion between two samples."""
        states = self.ship.simulator.equations.states
        found = dict(zip(states, self.X[begin:end].T, strict=True))
        found |= {n: angle[begin:end] for n, angle in self.rudders.items()}
        return {**found, "t": np.asarray(np.arange(begin, end) * self.ship.period)}


def sail_each(
    ship: Vessel,
    thetas: Vector,
    told: Callable[[], Instructions],
    approach: float,
    duration: float,
) -> Iterator[Passage]:
    """A manoeuvre of holds as `helm.carry_out` has it, up to a little after its last order.

    Parameters
    ----------
    thetas
        Values of the parameters of the ship's equations, a row a ship; (n, n_p). A passage is to
        be read before the next one is asked for.

    Raises
    ------
    DesignError
        The model delays an input: a record would have to be shifted as a whole.
    ValueError
        Other parameters than those of the equations.
    """
    if ship.model.late_inputs:
        raise DesignError(
            f"{', '.join(ship.model.late_inputs)} acts late in this model, which needs a whole "
            "record at once; simulate it once, or draw from a model without that delay"
        )
    names = ship.simulator.equations.parameters
    if np.shape(thetas)[1:] != (len(names),):
        raise ValueError(f"thetas: a row a ship of {', '.join(names)}, got {np.shape(thetas)}")
    voyage = _start(ship, round(duration / ship.period) + 1)
    for theta in np.ascontiguousarray(thetas, dtype=np.float64):
        voyage.theta, voyage.known, voyage.left = theta, 0, 0
        yield _sailed(voyage, told(), approach)


def _sailed(voyage: _Voyage, told: Instructions, approach: float) -> Passage:
    samples = len(voyage.orders)
    at = min(round(approach / voyage.ship.period), samples - 1)
    voyage.steer(0, at + 1, 0.0)
    voyage.simulate(at + 1)
    instruction = next(told, None)
    while instruction is not None and at < samples and not voyage.left:
        assert isinstance(instruction, Hold)
        at = _held(voyage, at, instruction)
        try:
            instruction = told.send(lambda: voyage.look(0, voyage.known + 1))
        except StopIteration:
            break
    end = voyage.left or min(at + AFTER, samples)
    if not voyage.left and at < samples:
        _back(voyage, at)
        voyage.steer(at, end, 0.0)
        voyage.simulate(end)
    return _passage(voyage, end)


def _start(ship: Vessel, samples: int) -> _Voyage:
    """The ship on her straight course, amidships."""
    given = {n: np.full(samples, x) for n, x in ship.constants.items()}
    given |= amidships(ship.model, samples)
    free = {n: ship.model.value(n) for n in ship.simulator.equations.free}
    blank = Trial("sailed", "fit", ship.period, given, {})
    theta, x0, u, limit = arguments(ship.simulator, blank, free, {})
    X = np.empty((samples, len(x0)))
    X[0] = x0
    orders, gears = np.zeros(samples), steering_gears(ship.model, ship.rudder_rate)
    rudders = {n: np.zeros(samples + 1) for n in gears}
    return _Voyage(
        ship=ship, theta=theta, limit=limit, u=np.array(u), X=X, orders=orders, rudders=rudders
    )


def _held(voyage: _Voyage, at: int, told: Hold) -> int:
    """The sample after `at` at which a hold ends."""
    wait = math.ceil(told.at_most / voyage.ship.period - 1e-9)
    end = stop = min(at + wait, len(voyage.orders))
    if at < end:
        _back(voyage, at)
    begin = at
    while begin < end and not voyage.left:
        stop = min(begin + REACH, end) if told.until is not None else end
        voyage.steer(at, stop, told.order)
        voyage.simulate(stop)
        if told.until is not None:
            happened = np.flatnonzero(told.until(voyage.look(at, stop))[1:])
            if len(happened):
                voyage.left = 0  # what comes of an order that was no longer given
                return at + 1 + int(happened[0])
        begin = stop
    return end


def _back(voyage: _Voyage, at: int) -> None:
    """To the last sample that an order given at this one leaves as it is."""
    ship = voyage.ship
    gear = not {*ship.simulator.equations.inputs}.isdisjoint(steering_orders(ship.model))
    voyage.known = max(at - 1, 0) if gear else at


def _passage(voyage: _Voyage, end: int) -> Passage:
    ship, simulator = voyage.ship, voyage.ship.simulator
    signals = voyage.look(0, end)
    t = signals.pop("t")
    X, u = voyage.X[:end], voyage.u[:end]
    y, _ = sensor_outputs(simulator, ship.period, X, None, u, voyage.theta)
    if "u" not in signals:
        signals["U"] = y[:, 0]
    signals["delta_order"] = voyage.orders[:end]
    x, y = track(t, signals, ship.model.ship.particulars["U0"])
    gone = departure(simulator, voyage.X, voyage.left, ship.period, voyage.limit)
    return Passage(Trial("sailed", "fit", ship.period, signals, {}), x, y, gone)
