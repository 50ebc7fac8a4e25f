"""What the channels of a log say of one another: contradictions, with the line that mends them.

Judged on the sketches, so that a log of any length is judged at once; alignment judges again, on
every sample.
"""

from trialid.alignment.agreement import checks, duplicate_channels
from trialid.alignment.agreement.channel_finding import Finding
from trialid.alignment.clocks import Series
from trialid.inspection.inspected import ChannelInspection, Inspection
from trialid.inspection.usual_units import to_si
from trialid.names.quantities import SIGNALS

COMPARED = ("delta", "delta_order", "r", "p", "phi", "psi", "u")
"""Quantities a fit is made of; of two depths or winds neither is a question."""

MOST_SOURCES = 4
"""Sources of one quantity that are compared, the likeliest ones."""


def findings(survey: Inspection) -> tuple[Finding, ...]:
    """What contradicts what: the likeliest channels among one another, then twins."""
    live = {name: _live(survey, name) for name in COMPARED}
    best = {name: next(iter(found.values())) for name, found in live.items() if found}
    by_key = {one.key: one for one in survey.channels.values()}
    stated = {name: by_key[next(iter(found))] for name, found in live.items() if found}
    said = {name: one.unit for name, one in stated.items() if one.unit is not None}
    among = checks.of_series(best, said)
    return (
        *among,
        *(one for found in live.values() for one in duplicate_channels.disagreements(found)),
    )


def _live(survey: Inspection, quantity: str) -> dict[str, Series]:
    """Series of the likeliest sources, by channel."""
    moving = [one for one in survey.sources(quantity) if not one.constant]
    series = {one.key: _series(one) for one in moving[:MOST_SOURCES]}
    return {key: one for key, one in series.items() if one is not None}


def _series(channel: ChannelInspection) -> Series | None:
    """The sketch in SI and in our positive direction; None where no unit is known."""
    unit = channel.stated_unit
    if unit is None or channel.guess is None:
        return None
    quantity = SIGNALS[channel.guess.quantity]
    factor = to_si(unit, quantity.unit)
    if factor is None:
        return None
    side = -1.0 if channel.guess.positive == "port" and quantity.mirror < 0 else 1.0
    y = side * factor * channel.sketch.y
    return Series(quantity, channel.sketch.t, y, channel.clock.words)
