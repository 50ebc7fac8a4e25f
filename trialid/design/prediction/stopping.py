"""The engine stopped: how far the ship runs on, where the model simulates her speed.

A crash stop, the shaft astern, is not predicted: the propellers of the catalogue are those of a
shaft that turns ahead, and trials that hold one astern are rare.
"""

import functools
from collections.abc import Mapping
from dataclasses import replace
from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.design.helm import Vessel
from trialid.design.prediction.likely_spread import LikelySpread
from trialid.design.prediction.predicted_motion import sail_orders
from trialid.design.prediction.ranged_motion import PredictedMotion
from trialid.design.standard import LENGTHS, STEPS, STRAIGHT, in_calm
from trialid.errors import DesignError
from trialid.trial import Trial

SHAFTS: Final = ("n", "n_p", "n_s")
"""Inputs that are zero where the engine is stopped."""


def sail_stop(
    ship: Vessel, share: float, spread: LikelySpread, band: Mapping[str, float]
) -> PredictedMotion:
    """The engine stopped on a straight course in calm deep water, until the speed has fallen.

    Parameters
    ----------
    share
        Of the approach speed, that is left at the end.

    Raises
    ------
    DesignError
        The model does not simulate the speed, or nothing in it is a shaft.
    """
    base = in_calm(ship)
    shafts, start = _shafts(base), round(STRAIGHT * STEPS)
    samples = round(LENGTHS * STEPS) + 1
    signals = {n: np.full(samples, x) for n, x in base.constants.items() if n != "u"}
    signals |= {n: np.zeros(samples) for n in ("delta", "delta_order")}
    for name in shafts:
        signals[name][start:] = 0.0
    orders = Trial("stop", "check", base.period, signals, {})
    read = functools.partial(_numbers, start, share)
    made = sail_orders(base, orders, spread, band, read=read)
    return _until_slow(made, share, start)


def _shafts(ship: Vessel) -> tuple[str, ...]:
    """Inputs that push the ship.

    Raises
    ------
    DesignError
        There are none, or they would change nothing.
    """
    if "u" not in ship.model.states:
        raise DesignError(
            "stop: this model is given its speed and does not simulate it; put u "
            "among its states, with effects such as propeller_thrust and surge_resistance"
        )
    shafts = tuple(n for n in SHAFTS if n in ship.simulator.equations.inputs)
    if not shafts:
        raise DesignError(
            "stop: no effect of this model reads a shaft's speed "
            f"({', '.join(SHAFTS)}), so there is nothing to stop; add propeller_thrust"
        )
    return shafts


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
    part = (u[end - 1] - wanted) / (u[end - 1] - u[end])
    at = end - 1 + part

    def since(values: Vector) -> float:
        return float(np.interp(at, np.arange(len(values)), values) - values[start])

    return {
        "time to that speed [s]": since(t),
        "head reach [m]": since(now["x"]),
        "lateral deviation [m]": since(now["y"]),
    }


def _until_slow(made: PredictedMotion, share: float, start: int) -> PredictedMotion:
    """Everything up to where the speed has fallen so far, or a remark that it does not."""
    u = made.motion["u"]
    if not made.numbers:
        return replace(made, remark=f"the speed falls to {u[-1] / u[start]:.0%} of itself only")
    end = start + int(np.flatnonzero(u[start:] <= share * u[start])[0]) + 1
    return replace(
        made,
        t=made.t[:end],
        given={n: x[:end] for n, x in made.given.items()},
        motion={n: x[:end] for n, x in made.motion.items()},
        ranges={n: (a[:end], b[:end]) for n, (a, b) in made.ranges.items()},
    )
