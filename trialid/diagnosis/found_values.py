"""What the values that a fit found for an effect say of it: a sensor's end, a lag like a hull's."""

from collections import Counter
from typing import Final

import numpy as np

from trialid.diagnosis.records.rudder_jumps import own_time
from trialid.identification.fit import Fit
from trialid.identification.weighing import CONTRADICTS, deviations
from trialid.names.quantities import MASS_PARAMETERS, PARTICULARS, RUDDERS
from trialid.ship.effect import Delayed, Effect, Force, Lagged, Mass, Measured, Rate
from trialid.ship.model import ADDED, STATES
from trialid.ship.motion import masses_of

SLOW: Final = 0.1
"""Share of L/U from which on a sensor's lag or delay may be what the hull remembers, in a model
whose hull is known to be another: what a hull remembers takes 0.2 to 0.6 L/U and more. Where this
was found, on two models in basins, lags of 0.3 to 0.8 L/U were named for gyros that have none, and
a delay of -0.18; half of it doubts a lag of 1 s of a ship of 140 m at 14 knots, twice lets that
delay pass."""


HURRICANE: Final = 32.7
"""m/s: Beaufort 12, World Meteorological Organization, Manual on codes; none is sailed in."""

SURE: Final = 0.2
"""Share of its value to less than which a number is known that no effect may take elsewhere: what
formulas tell best, added masses and a radius of gyration, is known to as much. Of a ship whose GM
was stated to 10 %, at 0.55 m, and who has drag in sway and yaw, a heel moment was named that takes
it to 0.10 m. Half of it says the same of her; at twice a boat whose screw turns on loses that name,
for a rate's damping known to 35 %."""

WINDAGE: Final = 2.5e-4
"""rho_air C_Y A / rho L^2 of a ship with a side of a fifth of her length squared. At half of it the
same two are told that it alone tells, 43 and 38 m/s on a ferry, at twice none of them; what a model
on a pond finds is 0.004, where it may be 1.7."""


def of_the_ship(effect: Effect) -> bool:
    """Whether it moves the ship or her rudder; else it belongs to a sensor or a clock."""
    return bool({Force, Rate, Mass} & {*effect.forms})


def of_a_sensor(effect: Effect) -> bool:
    """Whether it belongs to what measures her motion, and to no gear."""
    return bool({Measured, Delayed, Lagged} & {*effect.forms}) and not by_heading(effect)


def is_force(effect: Effect) -> bool:
    """Whether it is a force or a mass of hull, rudder or screw; no gear, sensor or clock is."""
    return bool({Force, Mass} & {*effect.forms})


def by_heading(effect: Effect) -> bool:
    """Whether it is of surroundings unrecorded, or a compass: no force of her own knows the north.

    One that takes a record of its own beside the heading, as of a wind that was measured, is not.
    """
    return "psi" in effect.signals and {*effect.signals} <= {*STATES, *PARTICULARS}


def comes_from_outside(effect: Effect) -> bool:
    """Whether it is of wind or current that nobody recorded; a compass is a sensor of hers."""
    return by_heading(effect) and "psi" not in effect.acts_on(Measured)


def her_own(effect: Effect) -> bool:
    """Whether it is of the ship, and not of wind or current that nobody recorded."""
    return of_the_ship(effect) and not by_heading(effect)


def gives_way(effect: Effect, grown: bool) -> bool:
    """Whether its name gives way to whatever of the ship does as much.

    A sensor's in a model that has `grown`, and in any model that of surroundings unrecorded.
    """
    return by_heading(effect) or (grown and not of_the_ship(effect))


def turns_round(effect: Effect, fit: Fit) -> bool:
    """Whether a coefficient that the model held leaves the range in which it may be named."""
    return effect.held is not None and not all(
        p.low <= fit.estimates[n] <= p.high for n, p in effect.parameters.items()
    )


def is_not_there(effect: Effect, fit: Fit) -> bool:
    """Whether what makes it ran to where there is none of it: the rest of it stands for another.

    Of a ship whose order was recorded for her rudder a play of nothing had a name, followed in 3 s,
    which is the lag of her gear.
    """
    own = [n for n, p in effect.parameters.items() if p.null == 0.0]
    return 0 < len(own) < len(effect.parameters) and all(fit.at_bounds.get(n) == 0.0 for n in own)


def at_a_sensors_end(effect: Effect, fit: Fit) -> bool:
    """Whether a sensor's or a clock's number ran to the end of what is possible.

    It then stands for something else. Of real zig-zags of a twin-screw model that were logged by
    one clock a clock of the heading that drifts by 0.5 % had a name.
    """
    return not of_the_ship(effect) and bool({*effect.parameters} & {*fit.at_bounds})


def mostly_at_ends(effect: Effect, fit: Fit) -> bool:
    """Whether most of what it adds ran to the ends of what may be sought: nothing it does fits.

    Of a boat whose battery ran down two of three coefficients of a surge in turns did. A single one
    may be as large.
    """
    added = {n for n, p in effect.parameters.items() if p.null == 0.0}
    ended = len(added & {*fit.at_bounds})
    return ended > 1 and 2 * ended > len(added)


def sweeps_away(effect: Effect, fit: Fit) -> bool:
    """Whether it is a current that nobody recorded, faster than she goes: no trial is sailed in it.

    Of a boat that goes 0.6 m/s one of 1.2 m/s was said to do as well as what was named.
    """
    flow = [fit.estimates[n] for n, p in effect.parameters.items() if p.unit == "m/s"]
    if not flow or not by_heading(effect):
        return False
    return float(np.hypot.reduce(flow)) * own_time(fit) > fit.model.ship.particulars["L"]


def no_wind(effect: Effect, fit: Fit) -> bool:
    """Whether it is a wind that nobody recorded, of a hurricane, or one that grips nowhere on her.

    By what is there, north and east, as over 1/2 rho L^2 U0^2; its lever is at the end of what may
    be sought. Of ships under an unsteady moment, of ice, whose heading it turns, such a wind was
    named in seven of 22: 9 MN on one of 100 m, at 0.3 L, or 43 and 38 m/s on a ferry.
    """
    if not {"F_N", "F_E", "x_wind"} <= {*effect.parameters}:
        return False
    found, speed = fit.estimates, fit.model.ship.particulars["U0"]
    most = WINDAGE * (HURRICANE / speed) ** 2
    return float(np.hypot(found["F_N"], found["F_E"])) > most or "x_wind" in fit.at_bounds


def no_such_mass(effect: Effect, fit: Fit) -> bool:
    """Whether with it she has a mass that no ship has, or one at the end of what may be sought.

    Water that pushes; more weight than a box of her length, beam and draught displaces; a radius of
    gyration beyond half her length. Of three strangers' ships such a mass stood in for a hull of
    another shape: an added mass in sway of the other sign, a block coefficient of 1.10.
    """
    if Mass not in effect.forms:
        return False
    model, size = fit.model, fit.model.ship.particulars
    mass = masses_of(model, {n: model.value(n) for n in (*MASS_PARAMETERS, *model.parameters)})
    box = 2.0 * size["B"] * size["T"] / size["L"] ** 2 if {"B", "T"} <= size.keys() else np.inf
    return (
        bool({*effect.parameters} & {*fit.at_bounds})
        or any(mass[n] > 0.0 for n in ADDED)
        or not 0.0 < mass["m"] <= box
        or not 0.0 < mass["I_zz"] <= 0.25 * mass["m"]
        or not mass["I_xx"] > 0.0
    )


def leaves_priors(before: Fit, after: Fit, within: float = np.inf) -> bool:
    """Whether an effect takes numbers of hers three deviations further off what is known of them.

    Its own count from nothing. Only numbers are looked at that are known to less than this share.
    """
    old, new = (_off_known(f, within) for f in (before, after))
    return any(abs(z) > abs(old.get(n, 0.0)) + CONTRADICTS for n, z in new.items())


def _off_known(fit: Fit, within: float) -> dict[str, float]:
    """Standard deviations by which numbers of hers lie off what is known of them."""
    off = deviations(fit.problem, fit.theta)
    known = [(x, x.prior, off[i]) for i, x in enumerate(fit.problem.unknowns) if x.prior]
    hers = ((x.name, z, prior) for x, prior, z in known if x.kind == "physical")
    return {name: z for name, z, (mean, by) in hers if within == np.inf or by < within * abs(mean)}


def as_slow_as_the_ship(effect: Effect, fit: Fit) -> bool:
    """Whether it is a sensor or a clock that is late by a share of the ship's own time."""
    late = [abs(fit.model.value(n)) for n, p in effect.parameters.items() if p.unit == "s"]
    if not late or of_the_ship(effect):
        return False
    in_turn = max(Counter(effect.acts_on(Delayed, Lagged)).values())  # two low-passes add up
    return in_turn * max(late) > SLOW * own_time(fit)


def late_sensor(effect: Effect) -> bool:
    """Whether it makes the record of a motion late, and not that of the rudder."""
    late = any(p.unit == "s" for p in effect.parameters.values())
    return late and not of_the_ship(effect) and not RUDDERS & {*effect.acts_on(Delayed)}
