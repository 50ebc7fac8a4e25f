"""Several channels of one quantity made one signal: their mean, where all of them are known.

A mean over fewer sensors where one is silent would step by what lies between them; it is not
bridged. Channels that move against one another are refused, for their mean is neither of them.
"""

from collections.abc import Iterator, Sequence

import numpy as np

from trialid.alignment.agreement import relation
from trialid.alignment.agreement.duplicate_channels import disagreements
from trialid.alignment.agreement.signs import CONTRADICTION
from trialid.alignment.clocks import Series
from trialid.alignment.sources import SignalSource
from trialid.arrays import Mask, Vector
from trialid.errors import AlignmentError
from trialid.names.quantities import POSITIONS, Quantity

Sampled = tuple[Vector, Mask]
"""Values on the clock of the trial, (n,), and which of them are known."""


def check_once(sources: Sequence[SignalSource], where: str) -> None:
    """AlignmentError for a quantity of several sources that are not said to be combined."""
    for name in dict.fromkeys(source.quantity for source in sources):
        same = [source for source in sources if source.quantity == name]
        if len(same) > 1 and not all(source.combine for source in same):
            raise AlignmentError(
                f"{where}: signal {name!r} is given twice; keep one channel for it, or take the "
                'mean of several by channels = [...] and combine = "mean"'
            )
        if len(same) > 1 and name in POSITIONS:
            raise AlignmentError(
                f"{where}: signal {name!r} is given twice; two antennas stand in two places, take "
                "one of them"
            )


def mean(parts: Sequence[Sampled], quantity: Quantity) -> Sampled:
    """The mean of all parts where all are valid; of one part, that part itself."""
    if len(parts) == 1:
        return parts[0]
    valid = np.logical_and.reduce([known for _, known in parts])
    values = [_near(values, parts[0][0], valid, quantity) for values, _ in parts]
    return np.mean(values, axis=0), valid


def _near(values: Vector, first: Vector, valid: Mask, quantity: Quantity) -> Vector:
    """An angle turned by whole turns to where the first one is; all else as it is."""
    if not quantity.angle or not valid.any():
        return values
    turns = np.round(np.median(values[valid] - first[valid]) / (2 * np.pi))
    return values - 2 * np.pi * float(turns)


def check_sides(
    parts: Sequence[Sampled], sources: Sequence[SignalSource], period: float, where: str
) -> None:
    """AlignmentError where a part moves against the first of its quantity."""
    for (values, known), source in zip(parts[1:], sources[1:], strict=True):
        found = relation.of_values(parts[0][0], values, parts[0][1] & known, period)
        if found is not None and found.at_once < CONTRADICTION:
            raise AlignmentError(
                f"{where}: {sources[0].channel!r} and {source.channel!r} move against one another "
                f"(correlation {found.at_once:.2f}); their mean is no signal. Log both to one "
                "side, or take one of them"
            )


def remarks(series: Sequence[Series], sources: Sequence[SignalSource]) -> Iterator[str]:
    """What each combined quantity is made of, and how its channels differ."""
    for name in dict.fromkeys(source.quantity for source in sources if source.combine):
        at = [i for i, source in enumerate(sources) if source.quantity == name]
        channels = {sources[i].channel: series[i] for i in at}
        words = [found.sentence for found in disagreements(channels)]
        yield f"{name} is the mean of {', '.join(channels)}" + "".join(
            f"; {word}" for word in words
        )
