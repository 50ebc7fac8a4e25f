"""What speaks against an effect once it is fitted, and the likeliest that stands every check."""

from collections.abc import Sequence
from typing import Final, Protocol

import numpy as np

from trialid.diagnosis.best_refit import best_of, choose_best
from trialid.diagnosis.found_values import (
    SURE,
    as_slow_as_the_ship,
    at_a_sensors_end,
    by_heading,
    gives_way,
    her_own,
    is_not_there,
    late_sensor,
    leaves_priors,
    mostly_at_ends,
    no_such_mass,
    no_wind,
    of_a_sensor,
    of_the_ship,
    sweeps_away,
    turns_round,
)
from trialid.diagnosis.plain_damping import is_plain_damping
from trialid.diagnosis.records.course_keeping import by_the_rudder, gained_on_course
from trialid.diagnosis.records.rudder_jumps import jump_in
from trialid.diagnosis.search.carried import (
    FALL,
    SHAPE,
    as_good,
    does_as_well,
    is_far,
)
from trialid.diagnosis.search.carry_over import levels
from trialid.diagnosis.search.falls import (
    Refitted,
    fall,
    fall_of_all,
    fall_of_check,
    own_fall,
    worse_held_out,
)
from trialid.diagnosis.search.refit import Progress, Refit, refit
from trialid.diagnosis.search.score import Candidate
from trialid.identification.fit import Fit
from trialid.identification.roll.own_roll import ROLLING
from trialid.ship.effect import Effect

HELD_OUT: Final = "the held-out error rises"
NOT_ARRIVED: Final = "the search does not arrive"
ELSEWHERE: Final = "it takes what is surely known of her elsewhere"
SLIGHT: Final = "it corrects the shapes of others"
AS_SLOW: Final = "a sensor as slow as that looks like the ship's own memory"
AS_A_GEAR: Final = "the recorded rudder jumps as an order does, and a gear is as late"
ON_COURSE: Final = (
    "most of that is gained while the rudder keeps her on her course: there it answers what the "
    "model does not know, and small angles look as if they did less; a zig-zag tells"
)
BESIDE: Final = "something else moves what the model leaves most of, and this may be what that does"
SWELL: Final = (
    "her roll as it was fitted goes on as a swell does, and dies down as no ship's; this may be "
    "what moves that"
)
"""Objections in their words."""

LEFT: Final = 0.25
"""Share of an output's mean square left from which on something else moves it. Of ships that roll
in a swell of their own period 0.29 to 0.35 of the roll is left, and three of eleven had an effect
of the yaw named that the ship did not have. Half of it is left of a real ship's sway in wind (0.19,
of which the wind takes half); with twice the three have their names."""

TOUCHED: Final = 0.05
"""Part of that which an effect must take to have a share in it: those three took 0.003 at most, a
steady wind 0.93. Half and twice change nothing there."""

SURER: Final = 12.0
"""Twice the log odds at which one of two is surer, e^6: as in the trial to sail next. Five drags of
a boat, which her log stood in for, are surer than that by 30 to 73: half and twice say the same."""

MOST: Final = 0.5
"""Share of the squared error that goes with an effect from which on it has a name although no test
against the noise shows it: where most that a model leaves is of the effect, the noise looks as
smooth as that, but it is no more than what is left with it. Of two sets of a cargo ship's trials by
her heading alone 0.98 and 0.99 went (p = 1), of a boat with a weak thruster 0.95 although its slope
shows nothing: at half of it they are named too, at twice none is."""


def refit_best(
    fit: Fit,
    candidates: Sequence[Candidate],
    most: int,
    level: float,
    progress: Progress,
) -> list[Refit]:
    """The first few candidates fitted; as many of other families where none stands every check.

    Twins stand side by side in the ranking, and what speaks against one speaks against all.
    """
    done = refit(fit, candidates[:most], progress)
    if likeliest_refit(fit, done, level) is None:
        known = {n for c in candidates[:most] for n in (c.effect.name, *c.family)}
        others = [c for c in candidates[most:] if c.effect.name not in known]
        done += refit(fit, others[:most], progress)
    return done


def likeliest_refit(
    fit: Fit, refits: Sequence[Refit], level: float, grown: bool = False
) -> Refit | None:
    """Of the refits that stand every check the one whose fall carries over best."""
    able = [
        r
        for r in refits
        if not objection(fit, r, level, grown)
        and not _looks_like_the_ship(fit, r, refits, level, grown)
        and not is_plain_damping(r, [o for o in refits if o.fit.converged], level)
    ]
    best = choose_best(fit, able, level, grown)
    if best is None or grown:  # what is added later is held against these trials step by step
        return best
    ahead = [r for r in able if _foretells_more(fit, r, best)]
    return best_of(ahead, level, grown) or best


def _foretells_more(fit: Fit, refit: Refit, best: Refit) -> bool:
    """Whether an effect of the ship as good on blocks takes far more off, held-out trials too."""
    return (
        fit.eps_check is not None
        and of_the_ship(refit.candidate.effect)
        and as_good(best.carried.after, refit.carried.after)
        and (leaves_priors(fit, best.fit) or not leaves_priors(fit, refit.fit))
        and is_far(fall_of_all(fit, refit), fall_of_all(fit, best))
    )


def _looks_like_the_ship(
    fit: Fit, refit: Refit, refits: Sequence[Refit], level: float, grown: bool
) -> bool:
    """Whether an effect of the ship does as much as a sensor that looks like one.

    Late ones do, of a hull that remembers, and in a model that has grown, whose hull is another,
    all may. By the blocks: whatever held-out trials say of that effect, the record does not tell
    them apart. Of a model of 3 m in wind a gyro was named as 3.5 to 5 s late where nobody had told
    of the wind, and her sway as measured 1 m aft where it was. In a model that has grown whatever
    would be said to do as well does, also where chance would: of a simulated ship the rudder's
    clock drifted for 5 %, where a term of sway takes 4 and does not stand out. So in any model may
    wind or current that nobody recorded: they know the heading, which swings with all that she
    does. Of 30 ships simulated in calm and logged by heading and speed four had one named.
    """
    doubted = gives_way(refit.candidate.effect, grown)
    ship = [r for r in refits if her_own(r.candidate.effect) and r.fit.converged]
    ship = [r for r in ship if not _told_by_held_out(fit, refit, r)]
    if doubted and any(
        r.candidate.allowed and does_as_well(refit.carried, r.carried) for r in ship
    ):
        return True
    sensor = not of_the_ship(refit.candidate.effect)
    slow = (grown and sensor) or as_slow_as_the_ship(*_found(refit))
    against = [(objection(fit, r, level), r) for r in ship]
    return any(
        (not why and _shown_more(refit, r))
        or (why in ("", HELD_OUT) and slow and as_good(refit.carried.after, r.carried.after))
        for why, r in against
    )


def _shown_more(refit: Refit, other: Refit) -> bool:
    """Whether a twin of a sensor's effect, of the ship, stands out more against the noise.

    Whatever blocks say: where two measures contradict each other about twins a record does not tell
    them apart. Of a stranger's boat without drag by her speed in her model her log was named as
    0.16 m/s off in 14 of 20 voyages (cosine 0.98); in five of these the drag stands out more.
    """
    mine, its = refit.candidate, other.candidate
    alike = its.effect.name in mine.family and of_a_sensor(mine.effect)
    return alike and its.score > mine.score + SURER


def _told_by_held_out(fit: Fit, refit: Refit, other: Refit) -> bool:
    """Whether trials held out tell what is by the heading from what they deny, by far.

    Of a boat in 13 m/s of wind that nobody logged blocks did not tell the wind from her heel with
    drift; of trials held out the wind takes 0.60 of the squared error, that makes them worse.
    """
    check = fall_of_check(fit, refit)
    denied = worse_held_out(fit, other.fit)
    return by_heading(refit.candidate.effect) and denied and is_far(check, 0.0)


SEEN: Final = 0.002
"""Error that must go, as a share of what moved: nobody notices less, and a rudder that is logged
every 2 s leaves as much. Of 12 such records of a ship of whom nothing was missing two had a name,
0.0012 and 0.0017 for it; with half of it they have."""

ENDS: Final = (at_a_sensors_end, mostly_at_ends)
HARDLY_FALLS: Final = "the error hardly falls"
NO_SUCH_VALUE: Final = (turns_round, is_not_there, *ENDS, sweeps_away, no_wind, no_such_mass)
"""What a value is that no ship, no sensor and no trial has."""


class Rolled(Refitted, Protocol):
    """What was fitted, and whether its roll goes on."""

    @property
    def rolls_on(self) -> bool:
        """As a swell does."""


def objection(fit: Fit, refit: Refit, level: float, grown: bool = False) -> str:
    """What speaks against an effect once it is fitted, empty where nothing does."""
    shown = refit.candidate.shown(level) or _takes_most(fit, refit)
    if not shown or any(no_such(*_found(refit)) for no_such in NO_SUCH_VALUE):
        return "no ship, sensor or trial has such a value" if shown else "chance would do it"
    if not (refit.fit.converged and np.isfinite(refit.fit.eps_rmsn)):
        return NOT_ARRIVED
    if worse_held_out(fit, refit.fit):
        return HELD_OUT
    if not falls(fit, refit):
        return HARDLY_FALLS
    if grown and not refit.carried.worth >= SHAPE:
        return SLIGHT
    return _something_else(fit, refit, grown)


def outputs_beside(fit: Fit, refit: Refitted) -> tuple[str, ...]:
    """Outputs that the model leaves much of, and of which the effect takes nothing."""
    before, after = ({n: e**2 for n, e in f.eps_by_output.items()} for f in (fit, refit.fit))
    much = (name for name, left in before.items() if left > LEFT)
    return tuple(name for name in much if after[name] > (1.0 - TOUCHED) * before[name])


def follows_a_swell(fit: Fit, refit: Rolled) -> bool:
    """Whether most that it takes is of a roll that as it was fitted is a swell's, and no ship's.

    Each output by its own error: of what shakes all the time little is much of the whole.

    Of seven records of a linear ship that rolls in a swell of her own period two had an effect of
    the roll named, in fits that damp her by 0.001 of what is critical.
    """
    before, after = (f.eps_by_output for f in (fit, refit.fit))
    rolls = [n in ROLLING for n in before]
    problem = refit.fit.problem
    if not any(rolls) or problem.roll is None:
        return False
    counts = levels(fit) * problem.weights**2
    taken = counts * [before[n] ** 2 - after[n] ** 2 for n in before]
    return bool(2.0 * (taken @ rolls) > taken.sum() > 0.0) and refit.rolls_on


def _takes_most(fit: Fit, refit: Refit) -> bool:
    """Whether once it is fitted most goes with it, in all blocks, whatever its slope had shown."""
    return refit.candidate.allowed and refit.carried.large and fall(fit, refit) > MOST


def _found(refit: Refit) -> tuple[Effect, Fit]:
    return refit.candidate.effect, refit.fit


def _something_else(fit: Fit, refit: Refit, grown: bool) -> str:
    """What may do what an effect does: what moves the rest, a swell, an autopilot, what is late."""
    if leaves_priors(fit, refit.fit, SURE):
        return ELSEWHERE
    if outputs_beside(fit, refit):
        return BESIDE
    if follows_a_swell(fit, refit):
        return SWELL
    if by_the_rudder(refit.candidate.effect) and gained_on_course(fit, refit.fit):
        return ON_COURSE
    if late_sensor(refit.candidate.effect) and jump_in(fit) is not None:
        return AS_A_GEAR
    return AS_SLOW if grown and as_slow_as_the_ship(*_found(refit)) else ""


def falls(fit: Fit, refit: Refit) -> bool:
    """Whether the error falls by what is worth a name, where it was fitted and where not."""
    most = max(fall(fit, refit), own_fall(fit, refit))
    gone = fit.eps_rmsn * float(np.sqrt(max(most, 0.0)))
    return refit.carried.falls and 1.0 - most < FALL and gone >= SEEN


def standing_but(why: str, fit: Fit, refits: Sequence[Refit], level: float) -> Refit | None:
    """The best effect that stands every check but this one, in a model that has grown."""
    able = [r for r in refits if objection(fit, r, level, True) == why and falls(fit, r)]
    return best_of(able, level)


def more_on_course(
    fit: Fit, refits: Sequence[Refit], level: float, than: Refitted | None
) -> Refit | None:
    """What looks like an effect of the rudder, as it keeps her on course, and does more than that.

    Whatever else is named then stands in for it.
    """
    answer = standing_but(ON_COURSE, fit, refits, level)
    less = than is None or (answer is not None and fall(fit, answer) > fall(fit, than))
    return answer if less else None
