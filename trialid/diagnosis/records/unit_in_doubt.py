"""Whether she turns for her rudder as ships do: what does not, is in another unit than it says.

A ship of any size turns by r L / U of about as much as her rudder stands over in radians. Where no
heading lies beside the rate of turn, a rate in deg/s that is called deg/min fits a ship that hardly
answers her rudder, a speed in knots that is called m/s one that turns half as well.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import permutations
from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.diagnosis.records.heel_side import TURNS
from trialid.identification.approach import approach_speed
from trialid.identification.fit import Fit
from trialid.identification.no_manoeuvre import RUDDER_RANGE
from trialid.names import units
from trialid.names.wording import number
from trialid.simulation.integrate import record_for
from trialid.trial import Trial

LITTLE: Final = 0.15
MUCH: Final = 15.0
"""r L / U over the rudder's angle that no ship has, each averaged over the time of her length. Of
364 trials of drawn ships, 14 of two models and 558 of outsiders' ships, boats and a vehicle under
water it is 0.52 to 4.4. Rates 60 times too small have 0.01 to 0.02, 60 times too large and rudders
in radians 49 to 68. At half and at twice of either the same are told."""

ANSWERS: Final = 0.5
"""Correlation of her rudder with her rate of turn, or with how that changes, from which on she
answers it: of trials that are in another unit 0.71 and more, of a rudder that makes noise 0.15 at
most. Half of it tells the same of all of them, twice none."""

SPEEDS: Final = ("kn", "km/h", "m/s")

ABOUT: Final = 0.05
"""Share by which a speed may be off the factor of two units to that in the others. Half of it says
the same of an outsider's four trials, of 1.92 to 1.95; at twice 1.852 is 1.944."""

NO_FASTER: Final = 0.7
"""Share of the factor, as logarithms, by which she must turn less for her rudder than in the trial
of the nearest angle: all of it where the speed is wrong, none where it is not. An outsider's four
have 0.84 to 1.1; of one ship's next zig-zag she turns 1.33 times less, 0.43 of knots. Half of it
would take that for them, twice tells none."""


@dataclass(frozen=True)
class Answer:
    """How she answers her rudder in one trial.

    Attributes
    ----------
    turn, rudder
        r L / U and the angle of the rudder [rad], where 99 of 100 samples are below.
    turned
        By how much her heading changes in all [rad].
    speed
        On her approach [m/s]; None where it is not logged.
    """

    turn: float
    rudder: float
    turned: float
    speed: float | None

    @property
    def gain(self) -> float:
        """How far she turns for her rudder, by radians and lengths."""
        return self.turn / self.rudder

    @property
    def is_no_ships(self) -> bool:
        """Whether no ship turns so: hardly for a rudder over, or round for one amidships."""
        hardly = self.gain < LITTLE and self.rudder >= RUDDER_RANGE
        return hardly or (self.gain > MUCH and self.turned >= TURNS)


def unit_in_doubt(fit: Fit) -> str | None:
    """What her turns deny of the units, and in which trials; None where they deny nothing."""
    answers = _answers(fit)
    off = [name for name, answer in answers.items() if answer.is_no_ships]
    return _outside(answers, off) if off else _unlike_others(answers)


def _answers(fit: Fit) -> dict[str, Answer]:
    """Of trials in which she answers her rudder; none of her who has other means to turn."""
    ship = fit.problem.simulator.model.ship
    if ship.actuators or "delta" not in fit.problem.simulator.equations.inputs:
        return {}
    L, stated = ship.particulars["L"], ship.particulars["U0"]
    found = ((t.name, _answer(t, L, stated)) for t in fit.trials)
    return {name: answer for name, answer in found if answer is not None}


def _answer(trial: Trial, L: float, stated: float) -> Answer | None:
    """How she answers in one trial, by its own speed or the stated one; None where she does not."""
    name, logged = record_for(trial, "delta"), approach_speed(trial)
    speed = stated if logged is None else logged
    if name is None or "r" not in trial.signals or speed <= 0.0:
        return None
    length = int(np.clip(round(L / speed / trial.period), 1, trial.samples // 4 or 1))
    rudder, r = (_averaged(trial.signals[n], length) for n in (name, "r"))
    if max(_likeness(rudder, r), _likeness(rudder[1:], np.diff(r))) < ANSWERS:
        return None
    over, rate = (float(np.quantile(np.abs(x), 0.99)) for x in (rudder, r))
    turned = float(np.ptp(np.cumsum(r))) * trial.period
    return Answer(rate * L / speed, over, turned, logged)


def _averaged(x: Vector, samples: int) -> Vector:
    """Without what waves do to it, and what only answers waves."""
    return np.asarray(np.convolve(x, np.ones(samples) / samples, "valid"))


def _likeness(one: Vector, other: Vector) -> float:
    """Correlation of two signals, whichever way; 0 where one stands still."""
    moves = len(one) > 1 and min(np.ptp(one), np.ptp(other)) > 0.0
    return abs(float(np.corrcoef(one, other)[0, 1])) if moves else 0.0


def _outside(answers: Mapping[str, Answer], off: Sequence[str]) -> str:
    """That no ship turns so, with what may be called what."""
    first = answers[off[0]]
    where = "" if len(off) == len(answers) else f" in {', '.join(off)}"
    rudder = number(float(np.rad2deg(first.rudder)), 2)
    begins = f"she turns{where} by r L/U = {number(first.turn, 2)} for {rudder} deg of rudder"
    if first.gain < LITTLE:
        return (
            f"{begins}, in a circle of {2.0 / max(first.turn, 1e-3):.0f} lengths, where ships have "
            "2 to 20: a rate of turn in deg/s that is called deg/min is 60 times too small; check "
            "the unit of r, of the speed, and her length"
        )
    return (
        f"{begins}, as no ship does: a rate of turn in deg/min that is called deg/s is 60 times "
        "too large, a rudder in rad that is called deg 57 times too small; check the units of r, "
        "the rudder and the speed, and her length"
    )


def _unlike_others(answers: Mapping[str, Answer]) -> str | None:
    """That one trial's speed is another by a unit's factor, and she turns as at the others'."""
    speeds = {name: answer.speed for name, answer in answers.items() if answer.speed}
    if len(speeds) < max(3, len(answers)):
        return None
    factors = {(one, called): too_large(one, called) for one, called in permutations(SPEEDS, 2)}
    for name, speed in speeds.items():
        faster = speed / float(np.median([x for n, x in speeds.items() if n != name]))
        one, called = min(factors, key=lambda pair: abs(faster / factors[pair] - 1.0))
        about = abs(faster / factors[one, called] - 1.0) < ABOUT
        if about and _turns_less(answers, name, faster) > NO_FASTER:
            return (
                f"the speed in {name} is {number(faster, 3)} times that in the others, and she "
                f"turns no faster for it: it is as one in {one} that is called {called}"
            )
    return None


def too_large(one: str, called: str) -> float:
    """How many times too large a speed in one unit is that is called another."""
    return units.factor(called, "m/s") / units.factor(one, "m/s")


def _turns_less(answers: Mapping[str, Answer], name: str, faster: float) -> float:
    """By which power of the factor she turns less for her rudder than at the nearest angle."""
    own = answers[name]
    others = (answer for other, answer in answers.items() if other != name)
    near = min(others, key=lambda answer: abs(answer.rudder - own.rudder))
    return float(np.log(near.gain / own.gain) / np.log(faster))
