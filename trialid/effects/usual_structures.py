"""The usual structures of a manoeuvring model: how hull forces grow, the race, the speed lost."""

from collections.abc import Collection, Mapping, Sequence
from itertools import product
from typing import Final, Literal

import numpy as np

from trialid.trial import Trial

HULLS: Final[Mapping[str, Mapping[str, tuple[str, ...]]]] = {
    "linear": {},
    "modulus": {
        "v": ("sway_drag_vav", "sway_drag_var", "sway_drag_rar"),
        "r": ("yaw_drag_vav", "yaw_drag_var", "yaw_drag_rar"),
        "p": ("roll_drag_vav", "roll_drag_var", "roll_drag_rar"),
    },
    "cubic": {
        "v": ("sway_cubic_vvv", "sway_cubic_cross", "sway_cubic_rrr"),
        "r": ("yaw_cubic_vvv", "yaw_cubic_cross", "yaw_cubic_rrr"),
        "p": ("roll_cubic",),
    },
    "cross-flow": {"v": ("cross_flow_drag",), "r": ("cross_flow_drag",)},
}
"""What each adds beyond the linear hull, by the motion it acts on: the second-order modulus terms
of Blanke & Knudsen (1999), all third-order terms of Son & Nomoto (1982), one drag coefficient."""

RACE: Final = "rudder_slipstream"
LOST_SPEED: Final = "surge_loss"
IN_THE_RACE: Final = ("rudder_race", "rudder_race_shaft", "propeller_rudder")
"""Rudders that have the race in them; a pipeline with one keeps it in every structure."""

TELLING: Final = frozenset(
    {RACE, LOST_SPEED} | {n for hull in HULLS.values() for own in hull.values() for n in own}
)
"""Every effect that tells one usual structure from another."""

Speed = Literal["simulated", "recorded", "stated"]
"""Where the speed u of a record comes from."""


def speed_of(states: Collection[str], trials: Sequence[Trial]) -> Speed:
    """Where u comes from; it is recorded where it changes in any trial."""
    if "u" in states:
        return "simulated"
    recorded = any(np.ptp(t.signals["u"]) > 0.0 for t in trials if "u" in t.signals)
    return "recorded" if recorded else "stated"


def usual_structures(
    states: Collection[str], present: Collection[str], speed: Speed
) -> tuple[dict[str, tuple[str, ...]], dict[str, str]]:
    """The structures by name, each with its effects, and why others are left out.

    Parameters
    ----------
    states
        Motions that are simulated: what acts on others is left out of every list.
    present
        Effects of the pipeline.
    """
    if speed == "stated":
        further = {"": (), "surge": (LOST_SPEED,), "race, surge": (RACE, LOST_SPEED)}
        left_out = {"with race": "u is stated, and without surge no speed changes the race"}
    else:
        further = {"": (), "race": (RACE,)}
        left_out = {"with surge": f"u is {speed}, and with it what she loses in turns"}
    for rudder in (name for name in IN_THE_RACE if name in present):
        left_out["with race"] = f"{rudder} has it already"
        further = {more: own for more, own in further.items() if RACE not in own}
    found = dict[str, tuple[str, ...]]()
    for (hull, terms), (more, own) in product(HULLS.items(), further.items()):
        acting = dict.fromkeys(name for state in states for name in terms.get(state, ()))
        if (*acting, *own) not in found.values():
            found[f"{hull}, {more}" if more else hull] = (*acting, *own)
    return found, left_out
