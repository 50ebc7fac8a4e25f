"""The standard manoeuvres of MSC.137(76), predicted from a model, with how sure that is.

The resolution asks for them at 90 % of the speed at 85 % of the engine's power, at full load and in
deep calm water: a model fitted at another speed predicts them at that one.
"""

import contextlib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from trialid.design import manoeuvres, measures
from trialid.design.helm import Instructions, Passage, Vessel, carry_out
from trialid.design.measures import Criterion
from trialid.errors import DesignError

TEN: Final = float(np.deg2rad(10.0))
TWENTY: Final = float(np.deg2rad(20.0))
HARD: Final = float(np.deg2rad(35.0))
BEFORE: Final = 20.0
"""s of straight course before the order."""
LENGTHS: Final = 90.0
"""Ship lengths a manoeuvre is given; a turn of 540 deg takes about 15."""


@dataclass(frozen=True)
class Measure:
    """One standard measure.

    Attributes
    ----------
    value
        In the criterion's unit; None where the manoeuvre did not come so far.
    interval
        95 %, None where nothing says how sure the model is.
    """

    criterion: Criterion
    value: float | None
    interval: tuple[float, float] | None

    @property
    def kept(self) -> bool | None:
        """Whether the criterion is kept, whatever of its interval; None where that is open."""
        if self.value is None:
            return None
        low, high = self.interval or (self.value, self.value)
        if high <= self.criterion.largest:
            return True
        return False if low > self.criterion.largest else None


def predict(vessels: Sequence[Vessel], model_error: float = 0.0) -> tuple[Measure, ...]:
    """The standard measures of the first vessel; the others are what she might be as well.

    `model_error` is what the model's own error adds, as a share of each measure.
    """
    first = vessels[0]
    found = [_values(vessel) for vessel in vessels]
    particulars = first.model.ship.particulars
    made = []
    for criterion in measures.criteria(particulars["L"], particulars["U0"]):
        value = found[0].get(criterion.name)
        others = [f[criterion.name] for f in found[1:] if criterion.name in f]
        spread = float(np.std(others, ddof=1)) if len(others) > 2 else None
        interval = None
        if value is not None and spread is not None:
            wide = 1.96 * float(np.hypot(spread, model_error * value))
            interval = (value - wide, value + wide)
        made.append(Measure(criterion, value, interval))
    return tuple(made)


def _values(vessel: Vessel) -> dict[str, float]:
    """Every measure the ship's model comes to, in the units of the criteria."""
    degrees = float(np.rad2deg(1.0))
    found: dict[str, float] = {}
    circle = _sailed(vessel, manoeuvres.turning_circle(HARD))
    if circle is not None:
        with contextlib.suppress(DesignError):  # she does not turn so far in the time
            found |= measures.turning(circle)
    ten, twenty = (_sailed(vessel, manoeuvres.zigzag(a, a, 4)) for a in (TEN, TWENTY))
    if ten is not None:
        over = measures.overshoots(ten)
        names = ("first overshoot 10/10", "second overshoot 10/10")
        found |= {n: x * degrees for n, x in zip(names, over, strict=False)}
        found["initial turning"] = measures.initial_turning(ten, TEN)
    if twenty is not None:
        over = measures.overshoots(twenty)
        found |= {n: x * degrees for n, x in zip(["first overshoot 20/20"], over, strict=False)}
    return found


def _sailed(vessel: Vessel, instructions: Instructions) -> Passage | None:
    """A manoeuvre carried out; None where the ship leaves her model."""
    particulars = vessel.model.ship.particulars
    duration = LENGTHS * particulars["L"] / particulars["U0"]
    passage = carry_out(vessel, instructions, BEFORE, duration)
    return None if passage.departure is not None else passage
