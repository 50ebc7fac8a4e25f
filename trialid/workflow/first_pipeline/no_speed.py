"""What to say where no log tells how fast she goes."""

from collections.abc import Sequence
from typing import Final

from trialid.inspection import Inspection
from trialid.inspection.inspected import ChannelInspection
from trialid.inspection.usual_units import to_si
from trialid.ship.estimate.particulars_given import KNOT

NO_SPEED: Final = "no log tells the speed in a stated unit; add --speed KNOTS, the approach speed"


def no_speed(surveys: Sequence[Inspection]) -> str:
    """That no log tells the speed; or that one holds a single value, and how to take it."""
    for survey in surveys:
        for one in survey.sources("u"):
            if one.constant and (held := _held(one)) > 0.0:
                unit = one.stated_unit
                return (
                    f"{one.name!r} is {float(one.sketch.y[0]):g} {unit} throughout, as no log "
                    "under way is; if that is the approach speed, add "
                    f"--speed {held / KNOT:.4g} (knots)"
                )
    return NO_SPEED


def _held(one: ChannelInspection) -> float:
    """The one value of a channel [m/s], 0 where its unit is not stated."""
    size = to_si(one.stated_unit or "", "m/s")
    y = one.sketch.y
    return float(y[0]) * size if size is not None and len(y) else 0.0
