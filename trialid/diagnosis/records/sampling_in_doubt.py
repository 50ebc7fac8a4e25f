"""Whether her logs say more than the samples taken of them: half a second is long for a boat.

Within a sample orders and motions are averaged, and between two of them taken for straight. What is
lost of a boat that turns within a sample looks like a sensor behind a low-pass.
"""

from typing import Final

from trialid.diagnosis.records.rudder_jumps import own_time
from trialid.identification.fit import Fit

LONG: Final = 0.25
"""Share of the time in which she goes her length that a sample may take. Of eight sets of an
outsider's boat of 2 m, in whom nothing was missing, seven had a name at 0.29 to 0.36 of it, mostly
`lag_u`, and none at 0.12 to 0.14. At half of it some of those are doubted too, at twice none of
either; of 640 sets of other ships none is at half of it."""

FINER: Final = 0.5
"""Share of a sample that her logs take: of what they do not hold, nobody can make more. Those of
that boat take 0.2, so that half of it tells the same; at twice logs that hold no more are asked."""


def sampling_in_doubt(fit: Fit) -> str | None:
    """That samples are too far apart for her, and how near together they can be; else None."""
    own = own_time(fit)
    coarse = [t for t in fit.trials if t.period > LONG * own and _finer(t.logged_every, t.period)]
    if not coarse:
        return None
    logged = max(t.logged_every for t in coarse)
    return (
        f"the samples are {coarse[0].period:g} s apart, where she goes her own length in {own:.2g} "
        f"s and her logs have one in {logged:.2g} s: what she does within a sample is taken for "
        f"something else; write period = {logged:.2g} under [align]"
    )


def _finer(logged: float, period: float) -> bool:
    """Whether logs say more; they say nothing of themselves where trials come from elsewhere."""
    return 0.0 < logged <= FINER * period
