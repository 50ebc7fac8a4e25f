"""A roll that hardly moves: left to the user, for it tells less of her than it takes away."""

import dataclasses
from collections.abc import Sequence
from typing import Final

import numpy as np

from trialid.inspection.usual_units import to_si
from trialid.workflow.first_pipeline.chosen import Chosen, Signal

ROLLS: Final = np.deg2rad(1.0)
"""[rad] From the 5th to the 95th percentile, in the trial where she rolls most. Less is as much as
an inclinometer drifts and the sea moves her, counts as much as the yaw, and hides what is missing
there: of a tanker in a basin that rolls by 0.9 deg, held-out yaw rates ended at 57 % with roll and
16 % without. Of 8 ships simulated by the MMG method that roll by 0.7 to 1.0 deg they ended lower
without it in six, in two higher by 0.5 and 2 points. Half keeps the roll of all nine. With twice,
five more lose theirs, one of which ended higher by 12 points, and a coaster whose GM her roll of
1.5 deg tells to a third."""

MOST: Final = (0.05, 0.95)


def without_small_roll(trials: Sequence[Chosen]) -> list[Chosen]:
    """The trials with roll beside, with why, where she hardly rolls in any of them."""
    rolls = [one for trial in trials for one in trial.signals if one.quantity == "phi"]
    spreads = [_spread(one) for one in rolls]
    known = [x for x in spreads if x is not None]
    if not known or len(known) < len(trials) or max(known) >= ROLLS:
        return list(trials)
    why = (
        f"she rolls by {np.rad2deg(max(known)):.2g} deg at most, as an inclinometer drifts and a "
        "sea moves her too: begin without"
    )
    return [_beside(trial, why) for trial in trials]


def _beside(trial: Chosen, why: str) -> Chosen:
    signals = tuple(one for one in trial.signals if one.quantity != "phi")
    beside = tuple((one, why) for one in trial.signals if one.quantity == "phi")
    return dataclasses.replace(trial, signals=signals, beside=(*beside, *trial.beside))


def _spread(roll: Signal) -> float | None:
    """[rad] How far it goes most of the time; None where its unit is not known."""
    size = 1.0 if roll.source.angle else to_si(roll.unit or "", "rad")
    y = roll.source.sketch.y
    if size is None or not len(y):
        return None
    low, high = np.quantile(y, MOST)
    return float(high - low) * size
