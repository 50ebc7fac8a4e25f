"""Who steered when: the modes of an autopilot, in words for the report.

Outside of MANUAL the autopilot steers by what it measures, and a rudder that follows the motion
says less about the ship than one that is moved on purpose.
"""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

ROVER = {
    0: "MANUAL", 1: "ACRO", 3: "STEERING", 4: "HOLD", 5: "LOITER", 6: "FOLLOW", 7: "SIMPLE",
    8: "DOCK", 9: "CIRCLE", 10: "AUTO", 11: "RTL", 12: "SMART_RTL", 15: "GUIDED",
    16: "INITIALISING",
}  # fmt: skip
"""Modes of ArduPilot's Rover, which also steers boats (Rover/mode.h)."""
MOST = 8
"""Changes that are told one by one."""

Times = NDArray[np.int64]


def modes(t: Times, numbers: NDArray[np.int64], rover: bool) -> Iterator[str]:
    """A remark on the modes that were set at the times `t` [ns]; (N,) both."""
    names = [ROVER.get(n, f"mode {n}") if rover else f"mode {n}" for n in numbers.tolist()]
    told = _changes(t, names)
    if told:
        loop = any(name != "MANUAL" for name in names) and rover
        note = "; outside of MANUAL the autopilot steers by what it measures" if loop else ""
        yield f"{told}{note}"


def arming_remark(t: Times, armed: NDArray[np.bool_]) -> Iterator[str]:
    """A remark on when the autopilot was armed; states at the times `t` [ns]; (N,) both."""
    told = _changes(t, ["armed" if state else "disarmed" for state in armed.tolist()])
    if told:
        yield told


def _changes(t: Times, names: Sequence[str]) -> str:
    new = [i for i, name in enumerate(names) if i == 0 or name != names[i - 1]]
    told = [f"{names[i]} from {t[i] / 1e9:.1f} s" for i in new[:MOST]]
    more = f", and {len(new) - MOST} changes more" if len(new) > MOST else ""
    return ", ".join(told) + more
