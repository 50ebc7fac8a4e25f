"""Whether a fit can carry a verdict at all, and if not, the first reason and what to do.

A search that failed, a ship that never manoeuvred or a model that explains next to nothing still
leave a residual, and tests on it still name effects. None of those names means anything.
"""

from dataclasses import replace
from typing import Final

import numpy as np

from trialid.effects.actuators.push_kinds import PUSHES
from trialid.identification import file_of_ship
from trialid.identification.explained import closer_in_pieces, of_use, over_noise, unexplained_share
from trialid.identification.fit import Fit
from trialid.identification.inadequate import Inadequate
from trialid.identification.no_manoeuvre import no_manoeuvre
from trialid.identification.nuisance.at_the_end import at_the_end
from trialid.identification.roll.roll_range import LEAST
from trialid.identification.time_scales import longest_by_its_clock
from trialid.identification.trial_score import Score
from trialid.identification.weighing import NO_NOISE
from trialid.least_squares.gauss_newton import REASONS
from trialid.names import wording
from trialid.names.quantities import MASS_PARAMETERS
from trialid.ship.motion import masses_of

ABOVE_NOISE: Final = 2.0
"""Standard deviation of an output over its white noise above which it tells of a motion. Noise
alone has 1 within a few per cent; four times would refuse roll that still tells of damping."""

UNEXPLAINED: Final = 0.5
"""Share of an output's variance that a model may leave: with more, most of what moved is something
else, and the largest of it is not one effect beside a good model. Twice lets anything pass; half
turns away a plain model of a real ship in wind (54 % of the amplitude, 29 % of the variance)."""

NOTHING: Final = 0.9
"""Share of the variance from which on a search that failed found nothing better than a constant: 95
% of the amplitude. A course under an autopilot in waves leaves 99."""

LONGEST: Final = 1.0
"""I_zz over m L^2 beyond which she would be longer than she is: four times what a rod has with its
mass at both ends. Of 35 fits of strangers' boats in which it was sought one has 9e9, another
0.6, of a gyro 0.4 s late that has no fit by that, the others 0.3 at most: half says the same of
both, twice of the one."""

SOMETHING_ELSE: Final = (
    "check the ship's file, the signs and the units, and whether something else moved her"
)

SLOWEST_TIMES: Final = 4.0
"""Time scales of the slowest motion that one trial must hold: a lag has settled to 2 % by then, an
oscillation has swung twice. Half of it lets a lag be fitted that was seen to 14 %, twice turns
free-running models away that sailed 20 lengths."""


def why_no_fit(fit: Fit) -> Inadequate | None:
    """The first reason why nothing should be concluded from a fit, None where it is sound.

    What the record cannot tell comes before what the search did with it: a boat at the dock also
    fails to converge, but more iterations are no help there.
    """
    if not fit.model.states:  # sensors against each other: nothing manoeuvres
        return _no_number(fit) or _search_failed(fit)
    for place, check in enumerate(CHECKS, 1):
        if (found := check(fit)) is not None:
            others = (one(fit) for one in CHECKS[place:] if one not in LACKING)
            return replace(found, may_lack=check in LACKING and not any(others))
    return None


def _at_noise_level(fit: Fit) -> Inadequate | None:
    """No output moves more than its sensor's noise."""
    if any(ratio > ABOVE_NOISE for ratio in over_noise(fit, of_use(fit, "fit")).values()):
        return None
    return Inadequate(
        f"she never moves: {' and '.join(fit.problem.outputs)} within {ABOVE_NOISE:g} x the noise",
        "fit a record of a manoeuvre under way, or check the channels",
    )


def _too_short(fit: Fit) -> Inadequate | None:
    """No trial lasts long enough, by its own clock, to see the slowest motion settle."""
    found = longest_by_its_clock(fit)
    if found is None or found[0] >= SLOWEST_TIMES * found[1].seconds:
        return None
    lasts, slow = found
    return Inadequate(
        f"the record is too short: {lasts:.3g} s, where {slow.words} takes "
        f"{slow.seconds:.3g} s and must be seen {SLOWEST_TIMES:g} times over",
        f"record at least {np.ceil(SLOWEST_TIMES * slow.seconds):.0f} s in one go",
    )


def _no_number(fit: Fit) -> Inadequate | None:
    if np.isfinite(fit.theta).all() and np.isfinite(fit.eps_rmsn):
        return None
    return Inadequate(
        "the fit is no number", "give other starts in [model.values], or a shorter [align] period"
    )


def _search_failed(fit: Fit) -> Inadequate | None:
    if fit.converged:
        return None
    steps = wording.count_of(max(len(fit.iterations) - 1, 0), "step")
    bounds = f", {', '.join(fit.at_bounds)} at a bound" if fit.at_bounds else ""
    left = unexplained_share(fit, of_use(fit, "fit")).values()
    nothing = fit.model.states and NOTHING < min(left, default=0.0) < 1.0 / NOTHING
    found = "; it found nothing better than a constant" if nothing else ""
    return Inadequate(
        f"the search did not converge: {REASONS[fit.reason]} ({steps}, error "
        f"{fit.eps_rmsn:.1%}{bounds}){found}",
        SOMETHING_ELSE
        if nothing
        else "free fewer parameters, or start nearer the ship in [model.values] or in her file",
    )


def _sensor_at_bound(fit: Fit) -> Inadequate | None:
    """A bias, a delay or a rudder's zero ran to its bound: it stands for something else."""
    held = at_the_end(fit.problem.unknowns, fit.theta)
    if not held:
        return None
    units = {x.name: x.unit for x in fit.problem.unknowns}
    bounds = ", ".join(f"{n} = {wording.with_unit(x, units[n])}" for n, x in held.items())
    rolls = any(n.startswith("tau_phi") for n in held) and len(fit.problem.outputs) > 1
    swell = "; where a swell rolls her, leave phi out of outputs and states" if rolls else ""
    early = any(n.startswith("tau_") and x < 0.0 for n, x in held.items())
    where = (
        "first at the clock of what steers her, for no sensor is early, then at" if early else "at"
    )
    return Inadequate(
        f"what no sensor does had to be assumed: {bounds}, the end of what is possible",
        f"look {where} that signal's clock, sign and unit, and whether the model is one of this "
        f"ship; compare whole models by `trialid structures`{swell}",
    )


def no_stability(fit: Fit) -> Inadequate | None:
    """Her GM ran to nothing, which no ship has that stands upright."""
    roll = fit.problem.roll
    if roll is None or fit.theta[roll.GM] > LEAST * roll.length:
        return None
    return Inadequate(
        f"she does not right herself as fitted: GM = {fit.theta[roll.GM]:.2g} m",
        "her heel follows something else, sails, wind or a swell: leave phi and p out of states "
        "and outputs, or state GM and take it out of free",
    )


def _no_such_inertia(fit: Fit) -> Inadequate | None:
    """Her moment of inertia in yaw, where it was sought, is as of a ship longer than she is.

    Where no force on her is known, all moments grow together without end.
    """
    model, own = fit.model, (*MASS_PARAMETERS, *fit.model.parameters)
    mass = masses_of(model, {n: model.value(n) for n in own})
    found = mass["I_zz"] / mass["m"]
    if not (found > LONGEST and any(x.name == "I_zz" for x in fit.problem.unknowns)):
        return None
    return Inadequate(
        f"no ship has the inertia as fitted: I_zz = {found:.2g} m L^2, and 0.25 with all of her "
        "mass at her ends",
        "check which of what drives her stands where, sides and units, or hold I_zz by a prior",
    )


def _little_explained(fit: Fit) -> Inadequate | None:
    """No output that moves is explained by more than half."""
    scores = of_use(fit, "fit")
    left, seen = unexplained_share(fit, scores), over_noise(fit, scores)
    kept = {c: x for c, x in left.items() if seen[c] > ABOVE_NOISE}
    if min(kept.values(), default=0.0) <= UNEXPLAINED:
        return None
    return Inadequate(
        f"the model explains too little: {_listed(kept)} of what moves is left, where "
        "a constant would leave 100 %",
        f"{drives_unread(fit)}{SOMETHING_ELSE}",
    )


def drives_unread(fit: Fit) -> str:
    """What to add first where a drive is recorded that pushes nothing of the model; else empty."""
    fitted = [score.trial.signals for score in of_use(fit, "fit")]
    moving = {n for signals in fitted for n, x in signals.items() if np.ptp(x) > 0.0}
    read = {*fit.problem.simulator.equations.inputs}
    for one in fit.model.ship.actuators:
        told = {one.drive, f"{one.drive}_order"} & moving if one.drive else set()
        if told and not told & read:
            return (
                f"put what {one.name} does into the model first, `trialid add PIPELINE "
                f"{PUSHES[one.kind].effect}`, for it is recorded and nothing reads it; then "
            )
    return ""


def _another_ship(fit: Fit) -> Inadequate | None:
    """Her rudder, or most of her, is not as her file says, and none near the file does as well."""
    if (left := file_of_ship.left_by_file(fit)) is None:
        return None
    return Inadequate(
        f"the ship as fitted is not the one of her file: {file_of_ship.unlike_words(fit)}, "
        f"and none within half and twice the file's leave less than {left:.2g} times the error",
        "name her own file, check speed and units, begin with `trialid inspect --init --length`, "
        "or, where the file is hers, compare whole models by `trialid structures`",
    )


def _steered_backwards(fit: Fit) -> Inadequate | None:
    """The rudder as fitted turns her to the other side than in her file."""
    if not file_of_ship.steers_backwards(fit):
        return None
    return Inadequate(
        f"the rudder as fitted turns her the wrong way, by Ndelta = {fit.value('Ndelta'):.3g}",
        "check the sides of rudder and turn, or fit a zig-zag, which shows how she begins to turn",
    )


def _false_valley(fit: Fit) -> Inadequate | None:
    """Where more than noise is left, other values follow the record far better piece by piece."""
    if fit.eps_rmsn <= NO_NOISE or (found := closer_in_pieces(fit)) is None:
        return None
    pieces, closer = found
    return Inadequate(
        f"the search ended in a false valley: in {pieces} pieces, each with its own start, the "
        f"same effects follow the record {closer:.2g} times as closely with other values, and none "
        f"were found that follow it whole (error {fit.eps_rmsn:.1%})",
        "start nearer the ship in [model.values] or in her file, raise [identify] starts, fit "
        "shorter trials, or compare whole models by `trialid structures`",
    )


def _held_out_lost(fit: Fit) -> Inadequate | None:
    """The fitted ship leaves her model's domain in a trial that was held out."""
    for score in of_use(fit, "check"):
        if score.response.departure is not None:
            return Inadequate(
                f"held-out trial {score.trial.name!r} diverges: {score.response.departure}",
                "look at its record and at the parameters at bounds, or fit that trial too",
            )
    return None


def _held_out_unexplained(fit: Fit) -> Inadequate | None:
    """A held-out trial that moves is foretold worse than its own mean would."""
    for score in of_use(fit, "check"):
        if left := worse_than_none(fit, score):
            return Inadequate(
                f"held-out trial {score.trial.name!r} is foretold worse than by no model at all: "
                f"{_listed(left)} of what moves is left",
                "compare its signs, units and speed with those of the fitted trials; where they "
                "agree, fit that trial too, as she may move there as in no other, or compare whole "
                "models by `trialid structures`",
            )
    return None


def worse_than_none(fit: Fit, score: Score) -> dict[str, float]:
    """Shares of variance left of outputs that move, where most are foretold worse than by means.

    A boat that turned to the other side than her model left 74 % of her speed's, and 225 and 161 %
    of sway and turn.
    """
    left, seen = unexplained_share(fit, [score]), over_noise(fit, [score])
    kept = {c: x for c, x in left.items() if seen[c] > ABOVE_NOISE}
    worse = sum(x > 1.0 for x in kept.values())
    return kept if 2 * worse > len(kept) else {}


CHECKS: Final = (
    no_manoeuvre, _at_noise_level, _too_short, _no_number, _search_failed,
    _sensor_at_bound, _no_such_inertia, _little_explained, no_stability, _steered_backwards,
    _another_ship, _false_valley, _held_out_lost, _held_out_unexplained,
)  # fmt: skip

LACKING: Final = frozenset(
    (_sensor_at_bound, no_stability, _steered_backwards, _false_valley, _held_out_unexplained)
)
"""Those that a model without an effect of the ship fails, however well it was fitted."""


def _listed(shares: dict[str, float]) -> str:
    return " and ".join(f"{np.sqrt(x):.0%} of {c}" for c, x in shares.items())
