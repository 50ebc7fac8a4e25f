"""By how much a speed log reads too high, as the positions of a turning ship show it."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.inspection.inspected import ChannelInspection
from trialid.inspection.positions import positions, way_beside
from trialid.inspection.sketch import Sketch

WAYS: Final = 60
"""Parts of a log whose ways are compared: a second or more of any manoeuvre, so that noise of a
position is little of it. Half and twice move the factor by less than its scatter."""
TURNED: Final = np.pi
"""[rad] Between headings as far apart as this a current shows as one. Of 136 logs of outsiders 34
with a right speed turn so far, and have 0.989 to 1.003 of it; 100 zig-zags, which turn by 28 to 80
deg, have 0.73 to 0.93, for the speed that turns cost is taken for a current there. At half of it
one is added that has 0.83 for 0.89, at twice of it five are left."""


@dataclass(frozen=True)
class LogFactor:
    """What a speed is to be multiplied by, one standard deviation of it, and the turn [rad]."""

    value: float
    sigma: float
    turned: float


def log_factor(
    channels: Iterable[ChannelInspection], speed: Sketch, heading: Sketch
) -> LogFactor | None:
    """The factor from a speed [m/s] and a heading [rad] to the ways between positions.

    With it a steady current and a sway that goes with the turn, or an antenna's place, are fitted.
    None where there are no positions, or she does not turn far enough to part them.
    """
    way = way_beside(positions(channels), speed, heading)
    if way is None:
        return None
    (period, north, east), (u, psi) = way
    psi = np.unwrap(psi)
    turned = float(np.ptp(psi))
    if turned < TURNED:
        return None
    over = max(1, len(u) // WAYS)
    ways = np.concatenate([_over(north, over), _over(east, over)])
    parts = np.vstack([*_parts(period, u, psi, over)])
    there = np.isfinite(ways) & np.isfinite(parts).all(axis=1)
    if there.sum() < WAYS:
        return None
    ways, parts = ways[there], parts[there]
    x = np.linalg.lstsq(parts, ways, rcond=None)[0]
    square = float(np.mean((ways - parts @ x) ** 2))
    # ways that overlap share their errors: one in each stretch, of either axis, tells something new
    spread = np.linalg.pinv(parts.T @ parts)[0, 0] * square * over
    return LogFactor(float(np.hypot(x[0], x[1])), float(np.sqrt(spread)), turned)


def _parts(period: float, u: Vector, psi: Vector, over: int) -> tuple[Vector, Vector]:
    """What makes the ways to the north and to the east, a column each, six in all.

    The speed along her heading and across it, where that is off; a current to the north and to the
    east; what stands ahead of her and to starboard, or turns so.
    """
    c: Vector = np.cos(psi)
    s: Vector = np.sin(psi)
    time: Vector = np.arange(len(u), dtype=float) * period
    none = np.zeros(len(u))
    ahead = [period * np.cumsum(u * one) for one in (c, s)]
    to_north = (ahead[0], -ahead[1], time, none, c, -s)
    to_east = (ahead[1], ahead[0], none, time, s, c)
    return _columns(to_north, over), _columns(to_east, over)


def _columns(parts: Sequence[Vector], over: int) -> Vector:
    return np.column_stack([_over(one, over) for one in parts])


def _over(y: Vector, over: int) -> Vector:
    return np.asarray(y[over:] - y[:-over])
