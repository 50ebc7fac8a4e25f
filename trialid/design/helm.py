"""What a helmsman can be told, and how his orders are carried out on a simulated ship.

A manoeuvre is a generator of instructions: hold an angle until something has happened, or follow a
list of orders. It is sent what the ship has done so far, so that it may answer it: a zig-zag
reverses on the heading, Bech's reversed spiral steers to a rate of turn.
"""

import functools
import math
from collections.abc import Callable, Generator, Mapping
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.arrays import Mask
from trialid.design.drive_commands import Drive
from trialid.design.rudders import amidships, ramp, steering_courses
from trialid.errors import DesignError
from trialid.names.quantities import POSITION
from trialid.ship.actuators import Actuator
from trialid.ship.model import ShipModel, without_sensors
from trialid.simulation.integrate import Departure, Simulator, prepare, respond
from trialid.trial import Trial

Vector = NDArray[np.float64]

Motion = Mapping[str, Vector]
"""Signals of a stretch of the trial by name, all of one length: `t`, `psi`, `r`, `phi`, `delta`."""

OVER_GROUND: Final = ("sog", "cog")
LOOK_AHEAD: Final = 100.0
"""s that are simulated at first to see whether a condition comes to hold."""


@dataclass(frozen=True)
class Hold:
    """Hold the order [rad] until a condition holds, and at most so long [s].

    `until` takes the motion while it is held and gives True where the condition holds; (n,).
    Held for no time, it only asks for a look at the ship.
    """

    order: float
    at_most: float
    until: Callable[[Motion], Mask] | None = None


@dataclass(frozen=True)
class Follow:
    """Follow orders [rad], one a sample of the trial's clock; (n,)."""

    orders: Vector


Look = Callable[[], Motion]
"""What the ship has done from the start of the trial up to now."""

Instructions = Generator[Hold | Follow | Drive, Look, None]
"""Yields what to do; is sent a look at the ship when it is done."""


@dataclass(frozen=True)
class Vessel:
    """A ship ready to be sailed: her model, what stays constant, and her clock.

    Attributes
    ----------
    model
        States with the heading among them.
    period
        Time between samples [s].
    constants
        Signals that do not change: shaft speed, wind; SI by quantity.
    rudder_rate
        What the steering gear can do [rad/s], where the model has no gear of its own.
    """

    model: ShipModel
    simulator: Simulator
    period: float
    constants: Mapping[str, float]
    rudder_rate: float


@dataclass(frozen=True)
class Passage:
    """A manoeuvre carried out.

    Attributes
    ----------
    trial
        Orders, rudder, and every simulated state as signals, valid everywhere.
    x, y
        Track from where the trial began, ahead and to starboard of the approach course [m]; (N,).
    departure
        Where the ship left the domain of her model; the trial ends before it. None: nowhere.
    driven
        Actuators that were commanded, where it was not the rudder.
    """

    trial: Trial
    x: Vector
    y: Vector
    departure: Departure | None
    driven: tuple[Actuator, ...] = ()


def vessel(
    model: ShipModel, period: float, constants: Mapping[str, float], rudder_rate: float
) -> Vessel:
    """Make a ship ready, her sensors left out; the heading is added to what is simulated."""
    if "r" not in model.states:
        raise DesignError(
            "a manoeuvre needs a ship that turns: put r among the states of the model"
        )
    moving = tuple(s for s in model.states if s not in POSITION)  # the track follows from them
    states = moving if "psi" in moving else (*moving, "psi")
    sailed = replace(without_sensors(model), states=states)
    simulator = prepare(sailed, (), speed_outputs(sailed))
    return Vessel(sailed, simulator, period, dict(constants), rudder_rate)


def speed_outputs(model: ShipModel) -> tuple[str, ...]:
    """What tells the speed ahead as it acts: a speed that is given may be lost in turns."""
    return ("u",) if "u" in model.states else ("U",)


def carry_out(
    vessel: Vessel, instructions: Instructions, approach: float, duration: float, name: str = "test"
) -> Passage:
    """Sail the manoeuvre: rudder amidships for `approach` [s], then as told, `duration` [s] in all.

    What is ordered after the last instruction is amidships. The loop is closed by simulating from
    the start what is ordered so far: a simulation is quicker than keeping its place.
    """
    samples = round(duration / vessel.period) + 1
    orders = np.zeros(samples)
    at = min(round(approach / vessel.period), samples)
    told = next(instructions, None)
    if isinstance(told, Drive):
        return _driven(vessel, told, at, samples, name)
    while told is not None and at < samples:
        assert not isinstance(told, Drive)  # a test commands either the rudder or the drives
        at = _obeyed(vessel, orders, at, told)
        look = functools.partial(sail, vessel, orders[: at + 1].copy())
        try:
            told = instructions.send(look)
        except StopIteration:
            break
    return _passage(vessel, _sail(vessel, orders), name)


def _driven(vessel: Vessel, told: Drive, at: int, samples: int, name: str) -> Passage:
    """Sail with drives commanded by the clock; what is commanded last is held."""
    known = {one.name: one for one in vessel.model.ship.actuators}
    given = amidships(vessel.model, samples)
    for drive, order in told.courses(at, samples).items():
        given[f"{drive}_order"] = order
        if drive not in vessel.model.all_states:
            given[drive] = _following(order, known[drive].rate * vessel.period)
    return _passage(vessel, _run(vessel, given), name, tuple(known[n] for n in told.commands))


def _following(order: Vector, step: float) -> Vector:
    """What a drive does of its order; all of it where nobody says how fast it follows."""
    return ramp(order, step) if math.isfinite(step) else order


def _obeyed(vessel: Vessel, orders: Vector, at: int, told: Hold | Follow) -> int:
    """Write one instruction into the orders from sample `at`; the sample it ends at."""
    if isinstance(told, Follow):
        part = told.orders[: len(orders) - at]
        orders[at : at + len(part)] = part
        return at + len(part)
    wait = math.ceil(told.at_most / vessel.period - 1e-9)
    end = min(at + wait, len(orders))
    orders[at:end] = told.order
    if told.until is None:
        return end
    stop = _until(vessel, orders[:end], at, told.until)
    orders[stop:end] = 0.0
    return stop


def _until(vessel: Vessel, orders: Vector, at: int, until: Callable[[Motion], Mask]) -> int:
    """The sample after `at` at which a condition first holds, or the end of the orders.

    Looks ahead by little and then further: what is awaited mostly comes soon.
    """
    reach = round(LOOK_AHEAD / vessel.period)
    while True:
        end = min(at + reach, len(orders))
        motion = sail(vessel, orders[:end])
        since = {name: values[at:] for name, values in motion.items()}
        happened = np.flatnonzero(until(since)[1:])  # the order acts from the next sample
        if len(happened) or end == len(orders):
            return at + 1 + int(happened[0]) if len(happened) else end
        reach *= 2


def sail(vessel: Vessel, orders: Vector) -> dict[str, Vector]:
    """Every signal under these orders; (n,) each, NaN after a departure."""
    return _sail(vessel, orders)[0]


def _sail(vessel: Vessel, orders: Vector) -> tuple[dict[str, Vector], Departure | None]:
    return _run(vessel, steering_courses(vessel.model, orders, vessel.rudder_rate, vessel.period))


def _run(vessel: Vessel, given: Mapping[str, Vector]) -> tuple[dict[str, Vector], Departure | None]:
    """Every signal of the ship under given ones, what stays constant beside them."""
    model = vessel.model
    count = len(next(iter(given.values())))
    still = {c: np.full(count, value) for c, value in vessel.constants.items() if c not in given}
    blank = Trial("sailed", "fit", vessel.period, {**given, **still}, {})
    response = respond(vessel.simulator, blank, {}, {}, sensitivities=False)
    states = dict(zip(model.all_states, response.states.T, strict=True))
    speed = {} if "u" in states else {"U": response.y[:, 0]}
    return {"t": blank.t, **given, **still, **states, **speed}, response.departure


def _passage(
    vessel: Vessel,
    sailed: tuple[dict[str, Vector], Departure | None],
    name: str,
    driven: tuple[Actuator, ...] = (),
) -> Passage:
    signals, departure = sailed
    if departure is not None:
        kept = max(round(departure.t / vessel.period), 2)
        signals = {c: values[:kept] for c, values in signals.items()}
    t = signals.pop("t")
    x, y = track(t, signals, vessel.model.ship.particulars["U0"])
    arrays = {c: np.array(values) for c, values in signals.items()}
    arrays |= {"x": x, "y": y, **_over_ground(t, x, y)}
    valid = {c: np.ones(len(t), dtype=bool) for c in arrays}
    return Passage(Trial(name, "fit", vessel.period, arrays, valid), x, y, departure, driven)


def track(t: Vector, motion: Motion, speed: float) -> tuple[Vector, Vector]:
    """Where the ship is, ahead and to starboard of where she began [m]; (N,) each.

    `speed` [m/s] is used where neither surge nor the speed U through the water is known.
    """
    u = motion["u"] if "u" in motion else np.full(len(t), speed)
    v = motion["v"] if "v" in motion else np.zeros(len(t))
    if "U" in motion:
        u = np.sqrt(np.maximum(motion["U"] ** 2 - v**2, 0.0))
    psi = motion["psi"]
    ahead = u * np.cos(psi) - v * np.sin(psi)
    abeam = u * np.sin(psi) + v * np.cos(psi)
    return _integral(t, ahead), _integral(t, abeam)


def _over_ground(t: Vector, x: Vector, y: Vector) -> dict[str, Vector]:
    """The track's speed [m/s] and course [rad], as receivers tell them; no current is known."""
    north, east = np.gradient(x, t), np.gradient(y, t)
    told = np.hypot(north, east), np.unwrap(np.arctan2(east, north))
    return dict(zip(OVER_GROUND, told, strict=True))


def _integral(t: Vector, rate: Vector) -> Vector:
    steps = np.diff(t) * (rate[1:] + rate[:-1]) / 2
    return np.concatenate([[0.0], np.cumsum(steps)])
