"""The engine stopped, or ordered astern: how far the ship runs on, where her speed is simulated."""

import functools
from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import Final

import numpy as np

from trialid.accuracy.ranges import ANYWHERE, FROM_ZERO, cut_to_ends
from trialid.arrays import Vector
from trialid.design.helm import Vessel
from trialid.design.prediction.engine_orders import astern_orders, engine_of
from trialid.design.prediction.likely_spread import LikelySpread
from trialid.design.prediction.predicted_motion import sail_orders
from trialid.design.prediction.ranged_motion import PredictedMotion
from trialid.design.prediction.unseen_astern import (
    REMARK,
    all_of,
    gains_astern,
    screws_astern,
)
from trialid.design.rudders import amidships
from trialid.design.standard import LENGTHS, STEPS, STRAIGHT, in_calm
from trialid.trial import Trial


def sail_stop(
    ship: Vessel,
    share: float,
    spread: LikelySpread,
    band: Mapping[str, float],
    *,
    astern: bool = False,
    untold: Mapping[str, str] = MappingProxyType({}),
) -> PredictedMotion:
    """The engine stopped on a straight course in calm deep water, until the speed has fallen.

    Parameters
    ----------
    share
        Of the approach speed, that is left at the end.
    astern
        Ordered as fast astern as ahead on the approach, instead: a crash stop.
    untold
        Gains astern that no trial and nobody has told, each with that ahead.

    Raises
    ------
    DesignError
        The model does not simulate the speed, nothing drives her, or nothing known drives astern.
    """
    base, start = in_calm(ship), round(STRAIGHT * STEPS)
    given = _orders(base, start, astern)
    read = functools.partial(_numbers, start, share)
    gains, screws = (gains_astern(base, untold), screws_astern(base)) if astern else ((), ())
    made = [sail_orders(one, given, spread, band, read=read) for one in gains or screws or (base,)]
    if gains:
        return _until_slow(all_of(made), share, start)
    return _until_slow(all_of(made, ASIDE, REMARK) if screws else made[0], share, start)


def _orders(base: Vessel, start: int, astern: bool) -> Trial:
    """Straight ahead, then from a sample on the engine stopped, or as fast astern."""
    engine, samples = engine_of(base), round(LENGTHS * STEPS) + 1
    signals = {n: np.full(samples, x) for n, x in base.constants.items() if n != "u"}
    signals |= amidships(base.model, samples)
    orders = astern_orders(base, engine) if astern else dict.fromkeys(engine.approach, 0.0)
    for name, order in orders.items():
        ahead = engine.approach[name]
        signals[engine.feedback[name]] = np.full(samples, ahead)
        signals[name] = np.where(np.arange(samples) < start, ahead, order)
    return Trial("stop", "check", base.period, signals, {})


FORWARD: Final = ("time to that speed [s]", "head reach [m]", "track reach [m]")
ASIDE: Final = "lateral deviation [m]"
"""What is told of a stop; nothing of the first three is below zero, whatever slopes say."""


def _numbers(start: int, share: float, t: Vector, now: Mapping[str, Vector]) -> dict[str, float]:
    """Time and track from the order until the speed has fallen so far; nothing where it never does.

    Between two samples everything goes straight.
    """
    u = now["u"]
    wanted = share * u[start]
    slow = np.flatnonzero(u[start:] <= wanted)
    if not len(slow):
        return {}
    end = start + int(slow[0])
    steps = np.hypot(np.diff(now["x"]), np.diff(now["y"]))
    way = np.concatenate([[0.0], np.cumsum(steps)])
    part = (u[end - 1] - wanted) / (u[end - 1] - u[end])
    at = end - 1 + part

    def since(values: Vector) -> float:
        return float(np.interp(at, np.arange(len(values)), values) - values[start])

    values = (t, now["x"], way, now["y"])
    return {name: since(x) for name, x in zip((*FORWARD, ASIDE), values, strict=True)}


def _until_slow(made: PredictedMotion, share: float, start: int) -> PredictedMotion:
    """Everything up to where the speed has fallen so far, or a remark that it does not."""
    u = made.motion["u"]
    if not made.numbers:
        return replace(made, remark=f"the speed falls to {u[-1] / u[start]:.0%} of itself only")
    end = start + int(np.flatnonzero(u[start:] <= share * u[start])[0]) + 1
    numbers = {
        n: (x, cut_to_ends(r, FROM_ZERO if n in FORWARD else ANYWHERE))
        for n, (x, r) in made.numbers.items()
    }
    return replace(
        made,
        t=made.t[:end],
        numbers=numbers,
        given={n: x[:end] for n, x in made.given.items()},
        motion={n: x[:end] for n, x in made.motion.items()},
        ranges={n: (a[:end], b[:end]) for n, (a, b) in made.ranges.items()},
    )
