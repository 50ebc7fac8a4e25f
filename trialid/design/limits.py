"""What crew, ship and water allow, and which of it a test would break."""

import itertools
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from trialid.arrays import Vector
from trialid.design.helm import Passage
from trialid.names import units
from trialid.ship.actuators import SHOWN, Actuator


@dataclass(frozen=True)
class Limits:
    """What a test may ask for; None where nothing limits it. SI.

    Attributes
    ----------
    rudder, rudder_rate
        Largest order [rad], and the fastest the gear may be asked to run [rad/s]: how fast the
        rudder runs, or would have to, to reach every order before the next one.
    heel
        Largest roll angle [rad].
    speed_loss
        Largest share of the approach speed that may be lost.
    room
        Sea room ahead of where the test begins, to each side and astern [m].
    duration
        [s], approach included.
    rudders
        Rudders of a ship with several, each with a limit of its own.
    """

    rudder: float | None = None
    rudder_rate: float | None = None
    heel: float | None = None
    speed_loss: float | None = None
    room: tuple[float, float, float] | None = None
    duration: float | None = None
    rudders: tuple[Actuator, ...] = ()


@dataclass(frozen=True)
class Excess:
    """A limit that a test breaks: what is found, what is allowed, and when [s] it is reached."""

    limit: str
    found: float
    allowed: float
    t: float
    sentence: str

    @property
    def share(self) -> float:
        """How far beyond: 0.1 is ten per cent too much."""
        return self.found / self.allowed - 1.0 if self.allowed > 0.0 else float("inf")


def excesses(passage: Passage, limits: Limits, speed: float) -> tuple[Excess, ...]:
    """Every limit the passage breaks, the worst first.

    Parameters
    ----------
    speed
        Approach speed [m/s].
    """
    return tuple(sorted(_found(passage, limits, speed), key=lambda e: -e.share))


def _found(passage: Passage, limits: Limits, speed: float) -> Iterator[Excess]:
    signals, t = passage.trial.signals, passage.trial.t
    degrees = np.rad2deg(1.0)
    if passage.departure is not None:
        yield Excess("model", np.inf, 1.0, passage.departure.t, str(passage.departure))
    if not passage.driven:
        yield from _of_rudder(passage, limits)
    for one in passage.driven or limits.rudders:
        order, shown = np.abs(signals[f"{one.name}_order"]), SHOWN[one.unit]
        words = f"{'' if shown == '1' else shown + ' '}of {one.name} are ordered"
        size = units.factor(one.unit, shown)
        yield from _over(one.name, order, t, one.limit, size, words.strip())
    if "phi" in signals:
        roll = np.abs(signals["phi"])
        yield from _over("heel", roll, t, limits.heel, degrees, "deg of heel are reached")
    if "u" in signals:
        lost = 1.0 - signals["u"] / speed
        yield from _over("speed loss", lost, t, limits.speed_loss, 100.0, "% of speed are lost")
    if limits.room is not None:
        ahead, side, astern = limits.room
        x, y = passage.x, passage.y
        yield from _over("room ahead", x, t, ahead, 1.0, "m are run ahead")
        yield from _over("room to the side", np.abs(y), t, side, 1.0, "m are run to the side")
        yield from _over("room astern", -x, t, astern, 1.0, "m are run back")
    if limits.duration is not None and t[-1] > limits.duration + passage.trial.period:
        words = f"it takes {t[-1]:.0f} s, {limits.duration:.0f} s are allowed"
        yield Excess("duration", float(t[-1]), limits.duration, limits.duration, words)


def _of_rudder(passage: Passage, limits: Limits) -> Iterator[Excess]:
    signals, t = passage.trial.signals, passage.trial.t
    degrees = np.rad2deg(1.0)
    order = np.abs(signals["delta_order"])
    yield from _over("rudder", order, t, limits.rudder, degrees, "deg of rudder are ordered")
    rate = np.maximum(needed_rates(signals["delta_order"], passage.trial.period), _runs(passage))
    yield from _over(
        "rudder rate", rate, t, limits.rudder_rate, degrees, "deg/s of rudder are asked for"
    )


def needed_rates(orders: Vector, period: float) -> Vector:
    """How fast a rudder must run to reach each order before the next one [rad/s]; (N,).

    The last order has all the time there is. At every sample the rate of the order it belongs to.

    >>> needed_rates(np.array([0.0, 4.0, 4.0, -4.0, -4.0]), 0.5).tolist()
    [0.0, 4.0, 4.0, 0.0, 0.0]
    """
    rates = np.zeros(len(orders))
    edges = np.flatnonzero(np.diff(orders)) + 1
    for begin, end in itertools.pairwise(edges.tolist()):
        rates[begin:end] = abs(orders[begin] - orders[begin - 1]) / ((end - begin) * period)
    return rates


def _runs(passage: Passage) -> Vector:
    """How fast the rudder runs [rad/s]; (N,)."""
    delta = passage.trial.signals["delta"]
    return np.abs(np.diff(delta, prepend=delta[0])) / passage.trial.period


def _over(
    name: str, values: Vector, t: Vector, allowed: float | None, shown: float, words: str
) -> Iterator[Excess]:
    if allowed is None:
        return
    beyond = np.flatnonzero(values > allowed * (1.0 + 1e-9))
    if len(beyond):
        found, at = float(values.max()), float(t[beyond[0]])
        sentence = (
            f"{found * shown:.3g} {words}, {allowed * shown:.3g} are allowed; "
            f"passed {at:.0f} s after the start"
        )
        yield Excess(name, found, allowed, at, sentence)
