"""Stops in a record: the shaft astern while the ship has way, until she has none."""

from collections.abc import Iterator
from typing import Final

import numpy as np

from trialid.arrays import Mask, Vector
from trialid.design.imo.excursions import ALIKE, SteeredRecord
from trialid.design.imo.recognition import Recognised
from trialid.trial import Trial

WAY: Final = 0.1
"""Share of the approach speed at which a ship is stopped."""


def find_stops(record: SteeredRecord, steered: Mask) -> Iterator[Recognised]:
    """The shaft astern while the ship has way; `steered` are samples of other manoeuvres, (N,)."""
    n, u = record.trial.signals.get("n"), way(record.trial)
    if n is None or u is None or float(np.quantile(n, 0.9)) <= 0.0:
        return
    least = 0.5 * float(np.quantile(u, 0.9))
    begun = np.flatnonzero((n[1:] < 0.0) & (n[:-1] >= 0.0)) + 1
    ahead = np.append(np.flatnonzero(n >= 0.0), len(n))
    for k, again in zip(begun.tolist(), ahead[np.searchsorted(ahead, begun)].tolist(), strict=True):
        approach = float(np.mean(u[max(k - record.clock, 0) : k]))
        if approach <= least or steered[k]:
            continue
        stopped = np.flatnonzero(u[k:again] <= WAY * approach)
        execute = _left_ahead(n, k)
        yield Recognised(
            kind="stop",
            execute=execute,
            end=k + int(stopped[0]) if len(stopped) else again,
            rudder=0.0,
            course=float(np.mean(record.psi[max(execute - record.clock, 0) : execute + 1])),
            remark="" if len(stopped) else "broken off before she stopped",
        )


def way(trial: Trial) -> Vector | None:
    """The speed as logged, or over the ground [m/s]; None where neither is known; (N,)."""
    return trial.signals.get("u", _over_ground(trial))


def _left_ahead(n: Vector, k: int) -> int:
    """The sample at which the shaft left its revolutions ahead."""
    usual = float(np.median(n[max(k - 400, 0) : k]))
    while k > 0 and n[k - 1] < (1.0 - ALIKE / 3.0) * usual:
        k -= 1
    return k


def _over_ground(trial: Trial) -> Vector | None:
    """Speed over the ground [m/s]; None where no position is recorded."""
    if "sog" in trial.signals:
        return trial.signals["sog"]
    if not {"x", "y"} <= {*trial.signals}:
        return None
    return np.hypot(*(np.gradient(trial.signals[c], trial.period) for c in ("x", "y")))
