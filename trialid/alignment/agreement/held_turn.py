"""To which side a ship turns all round with her rudder held over.

A turning circle is one step of the rudder, which correlates with nothing. Where the record begins
in the turn there is no first answer either, but no ship goes round against a rudder that is well
over: what an unstable one turns against is a few degrees.
"""

from typing import Final

import numpy as np

from trialid.alignment.agreement.turning import Turning
from trialid.arrays import Mask, Vector

OVER: Final = float(np.deg2rad(10.0))
"""[rad] A rudder that is well over. Of 158 trials of strangers' ships and boats whose sides are
right 12 are such turns and tell theirs, all rightly; with half of it the same, with twice 3."""

ROUND: Final = 2.0 * np.pi
"""[rad] What she must have turned by then: with half of it 14 tell their side, rightly too, with
twice 7, and a boat whose side was stated wrong, sailed 1.3 of it, is missed."""

ONE_WAY: Final = 0.9
"""Share by which what is one way outweighs what is not; 1 where all of it is. With half of it, and
with 0.99, the same 12."""


def held_turn(rudder: Vector, rate: Vector, both: Mask, period: float) -> Turning:
    """How she answers a rudder that is held; sign 0.0 where no turn shows it.

    Parameters
    ----------
    rudder, rate
        [rad] and [rad/s] on one clock of this period [s]; (N,).
    both
        Where both were measured; (N,).
    """
    over = both & (np.abs(rudder) > OVER)
    if abs(float(rate[over].sum())) * period < ROUND:
        return Turning(0.0, 0.0, "")
    laid, turned = (float(y[over].sum() / np.abs(y[over]).sum()) for y in (rudder, rate))
    if min(abs(laid), abs(turned)) < ONE_WAY:
        return Turning(0.0, 0.0, "")
    return Turning(float(np.sign(laid * turned)), laid * turned, "r, in a turn that it holds")
