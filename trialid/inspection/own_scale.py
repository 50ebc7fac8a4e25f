"""A rudder or a drive on a scale of its own: pulses of a servo, counts, a share of full."""

from typing import Final

import numpy as np

from trialid.alignment.signal_limits import LIMITS
from trialid.inspection.inspected import ChannelInspection
from trialid.inspection.relations import turning_beside

PULSES: Final = (800.0, 2200.0)
"""[us] Between which pulses of servos and speed controllers lie: 1000 to 2000, some 900 to 2100.
Only words depend on it, and whether she goes astern: the unit is asked for either way."""
REST: Final = 1500.0
"""[us] The pulse at which speed controllers that go both ways stand still, and servos amidships."""
SELDOM: Final = 0.02
"""Share of a record that noise may take a rudder beyond amidships, to either side."""
SPIKES: Final = 2
"""Values beyond which a rudder that goes as far to its other side as it stands on this is no wild
sample. Of a voyage on one course, 1.5 deg to one side, `-20 to 20 are of one side alone` was said;
at half and at twice the same is said of it, and of a servo's 30 to 50."""
BOTH: Final = 0.1
"""Share of a record in which she turns to either side at least, ..."""
AS_FAST: Final = 0.5
"""... and how fast to the slower one, as a share of the other: a gyro that reads too much does not
make it, nor the swing back out of a turn."""
STIRS: Final = 0.2
"""How far a rudder moves that turned her so, as a share of where it stands: at a berth the boat and
what stirs her rudder are noise. Of 1 096 rudders logged with a rate of turn or a heading the three
tell a boat's servo alone, and at half and at twice of each the same, this down to 0.05; but that
she turned as fast to both sides, which is `AS_FAST` twice, is true of none."""


def at_rest(drive: ChannelInspection) -> float:
    """What a drive shows where it does nothing: that of pulses of servos, else 0."""
    return REST if are_pulses(drive) else 0.0


def why_no_angle(rudder: ChannelInspection, turning: ChannelInspection) -> str:
    """Why a rudder's numbers are no angle from amidships, in words; empty where they may be.

    `turning` is a rate of turn or a heading of the same log.
    """
    if are_pulses(rudder):
        return f"look like pulse widths [us], about {REST:.0f} amidships"
    most = np.rad2deg(LIMITS["delta"].high)
    if max(abs(rudder.low), abs(rudder.high)) > most:
        return f"are no degrees, which end at {most:.0f}, and no share of full"
    if _keeps_to_a_side(rudder, turning):
        return "are of one side alone, though she turns to both: amidships it shows another than 0"
    return ""


def are_pulses(one: ChannelInspection) -> bool:
    """Whether its numbers lie where pulse widths of servos do."""
    return PULSES[0] < one.low and one.high < PULSES[1]


def _keeps_to_a_side(rudder: ChannelInspection, turning: ChannelInspection) -> bool:
    """Whether she turns both ways while her rudder as logged keeps to one."""
    y = np.sort(rudder.sketch.y)
    one, other = np.quantile(y, (SELDOM, 1 - SELDOM))
    middle, within = abs(one + other) / 2, y[SPIKES:-SPIKES]
    if len(within) and min(-within[0], within[-1]) > middle:
        return False  # seldom, as on a voyage, but she steers to the other side
    stirs = one * other > 0.0 and other - one > STIRS * middle
    r = turning_beside(rudder, turning) if stirs else None
    if r is None or not len(r):
        return False
    low, high = np.quantile(r, (BOTH, 1 - BOTH))
    return bool(min(-low, high) > AS_FAST * max(-low, high))
