"""Whether the rudder is recorded late: all that it moves comes before it, by about the same.

No sensor is early. A hull that answers sooner than the model lets it may make the rate of turn so,
and hardly the roll, which the rudder itself sets off. Of an outsider's ship whose feedback lagged
by 2 and 3 s both came 1.1 to 1.9 s early, and the rest of that lag was called the lever of an
inclinometer.
"""

from typing import Final

import numpy as np

from trialid.errors import list_names
from trialid.identification.fit import Fit
from trialid.identification.remarks import in_all_trials
from trialid.ship.effect import Delayed, Effect, Rate, Steered

ROLL: Final = frozenset(("phi", "p"))
TURN: Final = frozenset(("r", "psi", "v"))
"""Of both one has to be early: what turns alone a hull makes so, rate and heading alike."""
ALIKE: Final = 1.4
"""Times as early as the least the most may be. Of 360 runs of outsiders' records with a roll both
are early in nine: 1.05 to 1.36 times in six whose rudder is late, 1.5 to 1.9 in three others, of a
gear with play and of a seaway. Half as far beyond 1 loses three of the six, twice as far takes two
of the three."""
RUDDER: Final = frozenset(("delta", "delta_order"))


def rudder_in_doubt(fit: Fit, named: Effect | None = None) -> str | None:
    """What speaks against the rudder's record, and how to settle it; None where nothing does.

    Nothing where what is `named` is the rudder's record itself, or its gear.
    """
    if named is not None and RUDDER & {*named.acts_on(Delayed, Steered, Rate)}:
        return None
    early = {c: -late for c, late in in_all_trials(fit).items() if late < 0.0}
    columns = {x.column for x in fit.problem.unknowns}
    sought = {c for c in fit.problem.outputs if f"tau_{c}" in columns}
    if not (early.keys() & ROLL and early.keys() & TURN) or early.keys() != sought:
        return None
    if max(early.values()) > ALIKE * min(early.values()):
        return None
    return (
        f"{list_names(list(early))} come {np.mean([*early.values()]):.2g} s before the rudder that "
        "moves them, in all trials, as no sensor does: the rudder is recorded late, by a feedback "
        "that lags or another clock; read its order as delta_order, or take `delay` out of "
        "nuisance, so that what the rudder's record lacks can be sought"
    )
