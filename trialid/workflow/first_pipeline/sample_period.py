"""Time between the samples of a pipeline: what the slowest signal has, and what the ship needs."""

from collections.abc import Iterator, Sequence
from typing import Final

from trialid.errors import printable
from trialid.inspection.inspected import ChannelInspection
from trialid.workflow.first_pipeline.chosen import Chosen
from trialid.workflow.first_pipeline.roll_decay import is_of_decays, roll_period

NO_PACE: Final = frozenset(("u", "cog"))
"""What changes so slowly that its sensor sets no pace; nor does a heading beside its rate."""
PERIODS: Final = (0.01, 0.02, 0.05, 0.1, 0.2, 0.25, 0.5, 1.0, 2.0, 5.0, 10.0)
STEPS_A_LENGTH: Final = 40
"""Samples while the ship moves by her own length: she does little in a fortieth of that."""
STEPS_A_ROLL: Final = 40
"""Samples while she rolls to both sides, where that is all she does: 9 deg of a swing each. Half of
it is 18, of which a low-pass takes a hundredth off; twice of it tells no more."""


def align_lines(trials: Sequence[Chosen], length: float, speed: float) -> Iterator[str]:
    """Lines of `[align]`, for a ship of this length [m] and speed [m/s]."""
    chosen = period(trials, length, speed)
    slowest = min(_paces(trials), key=lambda c: c.rate)
    yield "[align]"
    own = f"her own length takes the ship {length / max(speed, 1e-3):.3g} s"
    if is_of_decays(trials):
        own = f"she rolls in {roll_period(trials):.3g} s"
    yield (
        f"period = {chosen:g}  # s; the slowest signal, {printable(slowest.key)}, has "
        f"{slowest.rate:.3g} Hz; {own}"
    )


def period(trials: Sequence[Chosen], length: float, speed: float) -> float:
    """Time between samples [s]: as the slowest signal has it, but no longer than the ship allows.

    Nor shorter than she needs: a simulation at 100 Hz tells no more of a ship, and takes longer.
    """
    slow = 1.0 / min(one.rate for one in _paces(trials))
    quick = min(0.5, length / max(speed, 0.1) / STEPS_A_LENGTH)
    if is_of_decays(trials):
        quick = roll_period(trials) / STEPS_A_ROLL
    return max((p for p in PERIODS if p <= max(slow, quick) * 1.05), default=PERIODS[0])


def _paces(trials: Sequence[Chosen]) -> Iterator[ChannelInspection]:
    """Channels that have to be followed from sample to sample."""
    for trial in trials:
        rated = any(one.quantity == "r" for one in trial.signals)
        slow = NO_PACE | {"psi"} if rated else NO_PACE
        yield from (one.source for one in trial.signals if one.quantity not in slow)
