"""What to read beside the parameters of a fit, sound or not."""

import math
from collections.abc import Callable
from typing import Final

import numpy as np

from trialid.accuracy.parameter_table import Accuracy
from trialid.effects.actuators.astern_gains import USUAL, drives_astern, held_astern
from trialid.identification.approach import approach_speed
from trialid.identification.check.own_sensor import own_sensors
from trialid.identification.fit import Fit
from trialid.identification.nuisance.priors import time_per_length
from trialid.identification.roll.own_roll import damped_by, is_a_ships, is_rolled_by_others
from trialid.identification.roll.told_gm import late_roll
from trialid.names.wording import with_unit
from trialid.ship.effect import Force

OFF_AMIDSHIPS: Final = np.deg2rad(0.5)
"""[rad] Zero of a rudder that one-sided overshoots come of: a tenth of a 5 deg helm; and a list
that is seen, where sensors are mounted to that."""

OFF_RATE: Final = np.deg2rad(0.05)
"""[rad/s] Zero of a rate of turn that a course shows: 3 deg in a minute of what is predicted."""

STANDS_OFF: Final = {
    "b_phi": (
        OFF_AMIDSHIPS,
        "the heel's zero is {} deg in all trials, a list or how the sensor is mounted: what is "
        "predicted of her has her upright; where she does list, `trialid add` static_list",
    ),
    "delta_0": (
        OFF_AMIDSHIPS,
        "the rudder's zero is {} deg in all trials, a screw's side push, wind from one side, what "
        "a list does or a feedback's error: what is predicted of her has it there, by the recorded "
        "rudder, and is likely from where it would be without",
    ),
    "b_r": (
        OFF_RATE,
        "the rate of turn reads {} deg/s too much in all trials, a gyro's zero: what is predicted "
        "of her is without it",
    ),
}
"""Least [rad, rad/s] and what to say of a number of each trial that is the same in all of them."""

LATE: Final = 0.1
"""Share of the time in which she goes her length from which on a delay of all trials is said. Boats
of 8 m whose rudder acts 0.7 and 1 s after its record have 0.47 and 0.9, five others of their kind
0.1 at most, or another in each trial; half and twice say the same of all seven."""

EARLY: Final = 0.03
"""The same share for an output that is early, which no sensor is. Of 17 ships of an outsider's with
a gyro that far ahead and more, 0.2 at most, the first overshoot 20/20 was foretold 14 % too large
in the mean, 27 % at most. At half of it ten more are told, eight of them 4 to 8 % too large; at
twice eight are."""

APART: Final = 3.0
"""Times the scatter over trials from which on a mean is of all of them; standard errors from which
on a gain is another."""

AHEAD: Final = "k_ahead"
OTHER_SPEED: Final = 1.4
"""Times the U0 of her file, either way, from which on her speed in all trials is asked about: a
speed in another unit is 1.85 times off at least. Half as far beyond 1 says so of a ship that is a
sixth slower than in service, at twice as far knots that are called km/h are hardly told."""

OTHER_MASS: Final = 2.0
"""Factor on a thrust in newtons from which on her file's mass is doubted: a hull's part in it, and
the water that she carries, are some tenths. Half of it is no factor; by twice of it two boats
whose masses were guessed five and seven times too large are still told, at 4.1 and 6.7."""

DAMPS: Final = {"Yv": "drifts", "Nr": "turns"}
"""What holds a hull back, below zero for all of them, and when."""


def remarks(fit: Fit) -> tuple[str, ...]:
    """What to read beside the parameters of a fit, sound or not; a line each.

    Priors of the ship's own parameters stand in the table, and what contradicts them beside it.
    """
    own = {x.name for x in fit.problem.unknowns if x.kind == "physical" and x.prior}
    units = {x.name: x.unit for x in fit.problem.unknowns}
    off = _off_in_all(fit)
    of_all = {x.name for x in fit.problem.unknowns if x.column in off and x.trial is not None}

    def said(name: str, value: float) -> str:
        return with_unit(value, units[name])

    bounds = [
        f"{n} ended at its bound {said(n, x)}: that is the bound's value, not the record's"
        for n, x in fit.at_bounds.items()
    ]
    against = [
        f"{n} = {said(n, fit.value(n))} is {abs(z):.1f} deviations "
        f"{'above' if z > 0.0 else 'below'} what is likely"
        for n, z in fit.contradicted.items()
        if n not in own | of_all and not _begins_off(fit, n)
    ]
    weak = ["the search was slow to the end: some parameters can hardly be told apart"]
    return (
        *own_sensors(fit),
        *_untold_GM(fit),
        *bounds,
        *against,
        *_other_signs(fit, said),
        *(STANDS_OFF[name][1].format(f"{np.rad2deg(by):.2g}") for name, by in off.items()),
        *_another_in_each(fit),
        *_late(fit),
        *_astern(fit),
        *_held_astern(fit),
        *_other_speed(fit),
        *(weak if fit.weakly_identified else []),
    )


def _other_signs(fit: Fit, said: Callable[[str, float], str]) -> list[str]:
    """Numbers of a sign that no ship has.

    Ndelta where nothing else in the model is of the rudder: that with which `--auto` ended for an
    outsider's ship in wind was an eighth of the true one, and of the other sign.
    """
    known = {x.name for x in fit.problem.unknowns}
    driven = [
        f"{n} = {said(n, fit.value(n))} would drive her on when she {when}: no hull does, and "
        "something that is missing may stand in it"
        for n, when in DAMPS.items()
        if n in known and fit.value(n) > 0.0
    ]
    value = fit.value("Ndelta") if "Ndelta" in known else 0.0
    pushes = {e.name for e in fit.model.effects if Force in e.forms and "delta" in e.signals}
    if value >= 0.0 or pushes - {"linear_rudder", "surge_rudder"}:
        return driven
    return [
        *driven,
        f"Ndelta = {said('Ndelta', value)} would turn her to the other side than her rudder is put "
        "to: no rudder does, and something that is missing, or that was added, may stand in it",
    ]


def _begins_off(fit: Fit, name: str) -> bool:
    """Whether a trial begins elsewhere than recorded because its sensor's zero is off.

    Of ships upright whose sensors stood at 2 deg it was said that 0.003 deg is 6.3 deviations off.
    """
    column, _, where = name.partition("(0) ")
    return f"b_{column} {where}" in fit.estimates


def _off_in_all(fit: Fit) -> dict[str, float]:
    """What stands off by the same in all trials: a rudder's zero, in predictions too; a heel's."""
    found = {column: _in_all(fit, column, least) for column, (least, _) in STANDS_OFF.items()}
    return {column: off for column, off in found.items() if off is not None}


def zero_between_trials(fit: Fit) -> float:
    """By how much a rudder's zero changes from trial to trial [rad]; 0 where that is little."""
    found = fit.of_all_trials.get("delta_0")
    between = 0.0 if found is None else math.sqrt(found.variance)
    return between if between >= OFF_AMIDSHIPS else 0.0


def _another_in_each(fit: Fit) -> list[str]:
    """That a rudder's zero changes from trial to trial by more than each is uncertain by."""
    if not (between := zero_between_trials(fit)):
        return []
    return [
        f"the rudder's zero is another in each trial, by {np.rad2deg(between):.2g} deg (standard "
        "deviation): a gear has one; wind or current from another side may stand in it, or "
        "whatever else the model lacks"
    ]


def _astern(fit: Fit) -> list[str]:
    """Trials whose recorded speed is below zero for more than half of the time."""
    found = [t.name for t in fit.trials if np.median(t.signals.get("u", 0.0)) < 0.0]
    said = f"u is below zero in {', '.join(found)}: she goes astern there, or its sign is wrong"
    return [said] if found else []


def untold_astern(fit: Fit) -> dict[str, str]:
    """Gains of thrust astern that are held and no fitted trial shows, each with that ahead."""
    fitted = (t.signals for t in fit.trials if t.use == "fit")
    astern = drives_astern(fit.model.ship, fitted)
    return held_astern(fit.model, {x.name for x in fit.problem.unknowns}, astern)


def _held_astern(fit: Fit) -> list[str]:
    """That a gain astern is held at what no screw has beside that ahead."""
    model = fit.model
    off = {
        n: (ahead, model.value(n) / model.value(ahead))
        for n, ahead in untold_astern(fit).items()
        if model.value(ahead) > 0.0
    }
    return [
        f"no trial goes astern: {n} stays as it is stated, {times:.2g} times the {ahead} that was "
        "found, where screws have 0.6 to 1; what she does astern is not known: sail one that goes "
        "astern, and free it"
        for n, (ahead, times) in off.items()
        if not USUAL[0] < times < USUAL[1]
    ]


def _other_speed(fit: Fit) -> list[str]:
    """That she is far from the speed of her file in all trials, on her approach."""
    stated = fit.model.ship.particulars["U0"]
    speeds = [speed for t in fit.trials if (speed := approach_speed(t)) is not None]
    if not speeds or min(stated, *speeds) <= 0.0:  # astern is told for itself
        return []
    shares = np.array(speeds) / stated
    if not (shares.min() > OTHER_SPEED or shares.max() < 1.0 / OTHER_SPEED):
        return []
    return [
        f"she sails at {np.median(speeds):.3g} m/s, {np.median(shares):.3g} times the U0 of her "
        "file, in all trials: knots called m/s are 1.94 times, km/h 3.6 times too many"
    ]


def another_mass(fit: Fit, accuracy: Accuracy) -> tuple[str, ...]:
    """That a thrust logged in newtons would have to be another for a mass as in the file.

    Nothing where noise alone may have made it so.
    """
    logged = any(one.command == "thrust" for one in fit.model.ship.actuators)
    gains = [p for p in accuracy.parameters if p.name == AHEAD and logged]
    if not gains or not gains[0].standard_error < abs(gains[0].value - 1.0) / APART:
        return ()
    gain = gains[0].value
    if 1.0 / OTHER_MASS < gain < OTHER_MASS:
        return ()
    known = fit.model.ship.particulars
    mass = known["rho"] * known["nabla"]
    return (
        f"each newton of thrust that is logged would push with {gain:.2g}: either it is no thrust, "
        f"or her mass is nearer {mass / gain:.2g} kg than the {mass:.2g} of her file, and every "
        "number in kg with it; state her displacement",
    )


def _late(fit: Fit) -> list[str]:
    """What is late or early by the same in all trials: predictions and gains know of no delay."""
    return [
        f"{c} is taken as {off:.2g} s late in all trials, by its sensor or as the rudder acts "
        "after its record: what is predicted of her, and gains of an autopilot, are without it"
        if off > 0.0
        else f"{c} is taken as {-off:.2g} s early in all trials, which no sensor is: the rudder "
        "acts before its record, or she answers sooner than the model lets her; what is predicted "
        "of her is without it, so that she turns later there"
        for c, off in in_all_trials(fit).items()
    ]


def in_all_trials(fit: Fit) -> dict[str, float]:
    """How late outputs are [s], less than nothing for early; those that are so in all trials."""
    length = time_per_length(fit.model, fit.problem.trials)
    found = {c: _in_all(fit, f"tau_{c}", EARLY * length) for c in fit.problem.outputs}
    told = {c: off for c, off in found.items() if off is not None}
    return {c: off for c, off in told.items() if off < 0.0 or off > LATE * length}


def _in_all(fit: Fit, column: str, least: float) -> float | None:
    """Mean over the trials of what is far off in all of them, None where it is not."""
    unknowns = zip(fit.problem.unknowns, fit.theta, strict=True)
    each = np.array([a for x, a in unknowns if x.column == column])
    if len(each) < 2 or abs(each.mean()) < max(least, APART * each.std(ddof=1)):
        return None
    return float(each.mean())


def _untold_GM(fit: Fit) -> list[str]:
    """That the record does not choose among metacentric heights, where it does not."""
    if not fit.rivals or fit.problem.roll is None:
        return []
    if not is_a_ships(fit.problem, fit.theta):
        ratio = abs(damped_by(fit.problem, fit.theta))
        return [
            f"the record does not tell GM: her roll is damped by {ratio:.2g} of what is critical, "
            f"as no ship's is, so that {fit.value('GM'):.3g} m may be of a swell or of nothing"
        ]
    listed = [f"{values['GM']:.3g}" for values in fit.rivals]
    rivals = (
        " or ".join(listed) if len(listed) < 4 else f"at least all from {listed[0]} to {listed[-1]}"
    )
    late = late_roll(fit.problem, fit.theta)
    place = max(late, key=lambda place: abs(late[place]), default=None)
    if place is not None:
        return [
            f"the record does not tell GM: {rivals} m, as its clocks are; "
            f"{fit.problem.unknowns[place].name} = {late[place]:.3g} s is no sensor's"
        ]
    if is_rolled_by_others(fit.problem, fit.theta):
        period = 2.0 * np.pi / fit.problem.roll.frequency(fit.theta)
        return [
            f"the record does not tell GM: most of her roll in about {period:.2g} s is of nothing "
            f"in the model, as a swell's, so that {fit.value('GM'):.3g} m may be the swell's"
        ]
    return [f"the record does not tell GM: {rivals} m fit as well or hardly worse"]
