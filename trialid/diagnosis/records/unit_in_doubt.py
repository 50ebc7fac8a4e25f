"""Whether she turns for her rudder as ships do: what does not, is in another unit than it says.

A ship of any size turns by r L / U of about as much as her rudder stands over in radians. Where no
heading lies beside the rate of turn, a rate in deg/s that is called deg/min fits a ship that hardly
answers her rudder, a speed in knots that is called m/s one that turns half as well.
"""

from collections.abc import Sequence
from typing import Final

import numpy as np

from trialid.identification.fit import Fit
from trialid.names.wording import number
from trialid.simulation.integrate import record_for
from trialid.trial import Trial

LITTLE: Final = 0.15
MUCH: Final = 15.0
"""r L / U over the rudder's angle, where 99 of 100 samples are below, that no ship has. Of 450
trials of drawn ships it is 0.49 to 4.6, of a tanker's and another model 0.74 to 1.6, of outsiders'
ships, boats and a vehicle under water 0.44 to 2.7. Rates 60 times too small have 0.01 to 0.02, 60
times too large and rudders in radians 50 to 70. At half and at twice of either the same are told.
"""

UNITS: Final = {("knots", "m/s"): 1.944, ("km/h", "m/s"): 3.6, ("km/h", "knots"): 1.852}
"""What a speed is too large by that is in the one unit and called the other."""

ABOUT: Final = 0.05
"""Share by which a speed may be off such a factor of that in the others: ships slow down in turns.
Half of it says the same of an outsider's four trials, of 1.92 to 1.95; at twice 1.852 is 1.944."""

APPROACH: Final = 0.95
"""Share of a trial in which she is slower than on her approach."""

NO_FASTER: Final = 0.7
"""Share of the factor, as logarithms, by which she must turn less for her rudder than in the trial
of the nearest angle: all of it where the speed is wrong, none where it is not. An outsider's four
have 0.84 to 1.1; of one ship's next zig-zag she turns 1.33 times less, 0.43 of knots. Half of it
would take that for them, twice tells none."""


def unit_in_doubt(fit: Fit) -> str | None:
    """What her turns deny of the units, and in which trials; None where they deny nothing."""
    turns = _turns(fit)
    if not turns:
        return None
    off = [name for name, (turn, rudder) in turns.items() if not LITTLE <= turn / rudder <= MUCH]
    return _outside(turns, off) if off else _unlike_others(fit, turns)


def _turns(fit: Fit) -> dict[str, tuple[float, float]]:
    """Each trial's r L / U and its rudder [rad]; none of her who has other means to turn.

    By her speed on the approach: one that begins or ends at rest turns by any share of it there.
    """
    ship = fit.problem.simulator.model.ship
    if ship.actuators or "delta" not in fit.problem.simulator.equations.inputs:
        return {}
    found = dict[str, tuple[float, float]]()
    for trial in fit.trials:
        rudder = record_for(trial, "delta")
        if rudder is None or "r" not in trial.signals:
            continue
        over, rate = (float(np.quantile(np.abs(trial.signals[n]), 0.99)) for n in (rudder, "r"))
        speed = _speed(trial) or ship.particulars["U0"]
        if over > 0.0 and speed > 0.0:
            found[trial.name] = rate * ship.particulars["L"] / speed, over
    return found


def _speed(trial: Trial) -> float:
    """Her speed on the approach [m/s]; 0 where it is not recorded."""
    return float(np.quantile(np.abs(trial.signals["u"]), APPROACH)) if "u" in trial.signals else 0.0


def _outside(turns: dict[str, tuple[float, float]], off: Sequence[str]) -> str:
    """That no ship turns so, with what may be called what."""
    turn, over = turns[off[0]]
    where = "" if len(off) == len(turns) else f" in {', '.join(off)}"
    rudder = number(float(np.rad2deg(over)), 2)
    begins = f"she turns{where} by r L/U = {number(turn, 2)} for {rudder} deg of rudder"
    if turn < over:
        return (
            f"{begins}, in a circle of {2.0 / max(turn, 1e-3):.0f} lengths, where ships have 2 to "
            "20: a rate of turn in deg/s that is called deg/min is 60 times too small; check the "
            "unit of r, of the speed, and her length"
        )
    return (
        f"{begins}, as no ship does: a rate of turn in deg/min that is called deg/s is 60 times "
        "too large, a rudder in rad that is called deg 57 times too small; check the units of r, "
        "the rudder and the speed, and her length"
    )


def _unlike_others(fit: Fit, turns: dict[str, tuple[float, float]]) -> str | None:
    """That one trial's speed is another by a unit's factor, and she turns as at the others'."""
    speeds = {t.name: _speed(t) for t in fit.trials if t.name in turns}
    if len(speeds) < 3 or not all(speeds.values()):
        return None
    for name, speed in speeds.items():
        faster = speed / float(np.median([speeds[n] for n in speeds if n != name]))
        called = min(UNITS, key=lambda c: _off(faster, UNITS[c]))
        if _off(faster, UNITS[called]) < ABOUT and _less(turns, name, faster) > NO_FASTER:
            one, other = called if faster > 1.0 else called[::-1]
            return (
                f"the speed in {name} is {number(faster, 3)} times that in the others, and she "
                f"turns no faster for it: it is as of {one} that are called {other}"
            )
    return None


def _less(turns: dict[str, tuple[float, float]], name: str, faster: float) -> float:
    """By which power of the factor she turns less for her rudder than at the nearest angle."""
    turn, over = turns[name]
    near = min((n for n in turns if n != name), key=lambda n: abs(turns[n][1] - over))
    return float(np.log(turns[near][0] / turns[near][1] * over / turn) / np.log(faster))


def _off(factor: float, by: float) -> float:
    """Share by which a factor, either way, is off one."""
    return abs(max(factor, 1.0 / factor) / by - 1.0)
