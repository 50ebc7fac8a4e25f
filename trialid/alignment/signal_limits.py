"""What a number of each quantity can be at all, in SI: beyond it no ship was measured."""

from dataclasses import dataclass

import numpy as np

DEG = float(np.deg2rad(1.0))


@dataclass(frozen=True)
class Limit:
    """Values outside `low` to `high` [SI] are no measurement, and why."""

    low: float
    high: float
    reason: str


def _both(high: float, reason: str) -> Limit:
    return Limit(-high, high, reason)


LIMITS = {
    "u": _both(50.0, "the fastest sailing craft reach 34 m/s, patrol craft 30 m/s"),
    "v": _both(25.0, "no craft slides sideways at half its highest speed"),
    "U": Limit(0.0, 50.0, "as the surge speed, and never negative"),
    "p": _both(360 * DEG, "a 1 m model rolls 20 deg in 0.8 s at up to 160 deg/s"),
    "r": _both(180 * DEG, "ships turn at 3 deg/s, small craft at 60, a model on the spot at 90"),
    "phi": _both(90 * DEG, "beyond it the boat has capsized"),
    "psi": _both(np.inf, "checked as an angle: 655.35 deg means not available"),
    "delta": _both(90 * DEG, "beyond it the rudder points forward; gears stop at 35 to 70 deg"),
    "delta_order": _both(90 * DEG, "as the rudder"),
    "n": _both(5000.0, "model propellers reach 30000 rpm, which is 3100 rad/s"),
    "n_p": _both(5000.0, "as the shaft speed"),
    "n_s": _both(5000.0, "as the shaft speed"),
    "V_aw": Limit(0.0, 110.0, "the strongest gust on record was 113 m/s; none was on trial in it"),
    "gamma_aw": _both(360.5 * DEG, "a direction is within one turn"),
    "h": Limit(0.0, 11_100.0, "the sea is 10 935 m deep at most"),
    "alpha_w": _both(90 * DEG, "a wave breaks long before it stands upright"),
}  # fmt: skip
"""Wide on purpose: what is outside is masked, so nothing real may be."""
