"""The unit of a drive: as the log states it, as its name says, or as its numbers leave it."""

from typing import Final

from trialid.inspection.inspected import ChannelInspection
from trialid.inspection.name_words import words
from trialid.inspection.own_scale import at_rest
from trialid.workflow.first_pipeline.chosen import BY_NAME, OPEN, UNSAID, Reason

SHARE: Final = 1.05
"""No share of full is larger; a stated thrust of a boat that moves is."""
FULL: Final = 100.0
"""Nor is a percentage; thrusts in newton of a small boat may be smaller, so that none is taken for
one up to here: the thrust of a share goes with its square."""


def unit_of_drive(source: ChannelInspection) -> tuple[str, Reason]:
    """The unit to write, and why."""
    if source.unit is not None:
        return source.unit, UNSAID
    if source.unit_in_name is not None:
        return source.unit_in_name, BY_NAME
    turns = [word for word in words(source.name) if word in ("rpm", "rps")]
    return (turns[0], BY_NAME) if turns else _unit_by_size(source)


def _unit_by_size(source: ChannelInspection) -> tuple[str, Reason]:
    largest = max(abs(source.low), abs(source.high))
    if largest <= SHARE:
        words_for = f"no unit is stated, up to {largest:.3g} can only be a share of full"
        return "1", Reason(words_for, "size")
    if "thrust" in words(source.name) and largest > FULL:
        return "N", Reason(
            f"CAREFUL: a thrust by its name, and no unit is stated: up to {largest:.3g} is read "
            "as newton, and the gain is of whatever it is"
        )
    if at_rest(source):
        return OPEN, Reason(
            f"FILL IN its unit: {source.low:.4g} to {source.high:.4g} look like pulse widths "
            "[us], about 1500 at rest; `trialid guide actuators` has the line that makes a share "
            "of full of them",
            "asked",
        )
    return OPEN, Reason(
        f"FILL IN its unit: nothing tells what up to {largest:.3g} is; where it is no thrust, "
        "its command in the ship file too",
        "asked",
    )
