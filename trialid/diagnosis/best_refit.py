"""The effect that carries over best, and which of those as good has the name."""

from collections.abc import Sequence

from trialid.diagnosis.found_values import leaves_priors, of_the_ship
from trialid.diagnosis.search.carried import FAINT, RIVAL, as_near, believed_as_much
from trialid.diagnosis.search.refit import Refit
from trialid.identification.fit import Fit


def best_of(refits: Sequence[Refit], level: float, grown: bool = False) -> Refit | None:
    """The refit that leaves least on blocks left out, sensors, clocks and forces alike.

    One of which the parameters leave next to nothing gives way to any that is as good. In a model
    that has `grown` a sensor or a clock gives way to what is of the ship and as good: that the hull
    is another is then known, and a lag mends any hull a little. Of those within one standard error
    of the best what stands out against the noise comes first. Of a tanker's model on zig-zags a
    rudder that stalls stood out (p = 0.009) and left 1.13 times what her loss of speed does
    (p = 0.36) of blocks, 1.67 times of trials held out, 1.7 standard errors apart.
    """
    if not refits:
        return None
    least = min(refits, key=lambda r: r.cost)
    close = [least, *(r for r in refits if believed_as_much(least.carried, r.carried))]
    staying = [r for r in close if not _gives_way(r, grown)] or close
    best = min(staying, key=lambda r: r.cost)

    def shown(r: Refit) -> bool:
        return r.candidate.p_value < level and as_near(best.carried.after, r.carried.after)

    return min(staying, key=lambda r: (not shown(r), r.cost))


def choose_best(fit: Fit, refits: Sequence[Refit], level: float, grown: bool) -> Refit | None:
    """The best of those with which her numbers stay where they are known, if it is any rival.

    Of a ship with drag in sway and yaw a heel moment of the wrong sign, four deviations off what
    ships have, left 0.160 of the squared error, and the drag 0.183.
    """
    best = best_of(refits, level, grown)
    if best is None or not leaves_priors(fit, best.fit):
        return best
    staying = [r for r in refits if not leaves_priors(fit, r.fit)]
    rivals = [r for r in staying if r.carried.ratio < best.carried.ratio**RIVAL]
    return best_of(rivals, level, grown) or best


def _gives_way(refit: Refit, grown: bool) -> bool:
    """Whether an effect is not named where another is as good."""
    beside = grown and not of_the_ship(refit.candidate.effect)
    return beside or refit.carried.seen < FAINT
