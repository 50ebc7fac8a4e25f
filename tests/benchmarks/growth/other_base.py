"""A base of another structure than the truth: the second-order model on the cubic S-175.

The true ship is `tests/cubic_truth.py`'s: hull cubic in sway, yaw and heel, rudder in the race of
the propeller. The fitted model has second-order terms, most of them held at another ship's values.
"""

import sys
from pathlib import Path
from typing import Final

ROOT: Final = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "tests"), str(ROOT / "tests" / "benchmarks")]
import cubic_truth  # noqa: E402
from hidden_scenarios import SCENARIOS, TWINS  # noqa: E402
from hidden_truth import SHIP  # noqa: E402

from trialid.effects import CATALOGUE  # noqa: E402
from trialid.ship.model import ShipModel  # noqa: E402

TRUTH: Final = cubic_truth.ship()
TERMS: Final = (
    "linear_hull linear_rudder linear_roll centripetal_added_mass heel_roll heel_sway heel_yaw "
    "roll_rate_yaw sway_drag_vav sway_drag_var yaw_drag_vav yaw_drag_var yaw_drag_rar "
    "roll_drag_vav roll_drag_var"
)
BASE: Final = ShipModel(
    SHIP, ("v", "p", "r", "phi"), tuple(CATALOGUE[name] for name in TERMS.split())
)
"""The model of `tests/cubic_truth.toml`."""

FREE: Final = ("Yv", "Nv", "Nr", "Ndelta", "Kv", "Kr", "Kdelta", "Kp", "GM", "Yvav", "Nrar")

RACE: Final = {"rudder_slipstream", "rudder_race", "propeller_rudder", "rudder_race_shaft"}
"""What stands for the rudder of the truth, which lies in the propeller's race."""

FLOW: Final = {"sway_froude", "yaw_froude_v", "yaw_froude_r"}
"""What stands for the side flow of drift and turning at that rudder: the race keeps its speed as
the ship slows down, so that its part of the moment of drift changes with hers. Of what linear and
cubic terms and a slipstream leave of the true rudder's moment in these manoeuvres, v (F - F0) takes
31 % of the square off. Counted as her own after nine records (4100 to 4108) had been looked at."""

BENT: Final = {"rudder_cubic", "rudder_in_drift"}
"""What stands for the lift of that rudder as the angle of flow grows, and the drift that makes it:
of what a model of second order with a slipstream leaves of its moment, delta^3 takes 44 % and
v^2 delta 27 % of the square, where v delta^2 takes 2 % and delta phi^2 1 % (`share_of_rudder` of
`tests/cubic_truth.py`). Counted as her own after records 5400 to 5432 had been looked at; before,
they were wrong unless they were hidden."""

OWN: Final = frozenset(
    {e.name for e in TRUTH.effects}
    | RACE
    | FLOW
    | {n for t in TWINS if t & {e.name for e in TRUTH.effects} for n in t}
)
"""The truth's own structure, and names that no manoeuvre of a rudder separates from it."""

RIGHT: Final = OWN | BENT
"""What is right where nobody hid it; what is drawn does not change by what was seen."""

DRAWN: Final = tuple(
    s
    for s in SCENARIOS.values()
    if s.group in ("physics", "sensor")
    and not s.right & OWN
    and not {*s.values} & {*TRUTH.parameters, *BASE.parameters}
    and s.name != "surge_rudder"
    and not {p for e in s.effects for p in e.parameters} & {*TRUTH.parameters}
)
"""What can be hidden in her: neither she nor the base has it, and it acts not on speed alone."""
