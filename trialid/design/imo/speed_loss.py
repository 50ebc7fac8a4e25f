"""The speed that turning costs, from the logs of a fit that reads its speed from them.

A model that is given the speed knows none in a manoeuvre that nobody has sailed. How the logged
speed fell says how it would: by squares of the rate of turn and of the rudder, behind a lag, fitted
to the logs along the rates of turn that the model had there.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np

from trialid.alignment.frames import SHAFTS
from trialid.arrays import Mask, Vector
from trialid.design.helm import Vessel, vessel
from trialid.identification.approach import APPROACH
from trialid.identification.fit import Fit
from trialid.identification.trial_score import Score
from trialid.least_squares.gauss_newton import minimise
from trialid.maths import Number, clip
from trialid.ship.effect import Parameter, Rate, Steered, effect
from trialid.ship.model import ShipModel
from trialid.simulation.integrate import Simulator, prepare, record_for, respond
from trialid.trial import Trial

WAY: Final = 0.05
"""Share of the approach speed from which on turns cost speed in full: of a ship of 8 m/s, of whom
an autopilot's logs in gusts said ten times what is typical, 24 m/s astern came out without it. At
half and at twice of it the speed of the S-175 in her circle is the same, and none goes astern."""


@effect(
    source="Son & Nomoto (1982): 10 % of speed lost at 5 deg of rudder, 55 % at 35 deg",
    states={"u_off": None},
)
def logged_loss(
    u: Number,
    r: Number,
    delta: Number,
    u_off: Number,
    L: Number,
    U0: Number,
    *,
    lost_in_turns: Any = Parameter(5.0, low=0.0, high=50.0),
    lost_by_rudder: Any = Parameter(0.5, low=0.0, high=5.0),
    lost_after: Any = Parameter(5.0, low=0.5, high=100.0, null=None),
) -> tuple[Steered, Rate]:
    """Speed loss: u = u - u_off,  d(u_off)/dt = (a (r L)^2 + b (delta u)^2 - u u_off) / (c L).

    What drives it ends with her way: a turn stops no ship, and drives none astern.
    a is lost_in_turns, b lost_by_rudder, c lost_after, in ship lengths. Without b the speed begins
    to fall too late: both overshoots of a 20/20 of the S-175 then come out 1 % too large, with it
    0.2 % and 0.1 %.
    """
    lost = lost_in_turns * (r * L) ** 2 + lost_by_rudder * (delta * u) ** 2
    fall = lost * clip((u - u_off) / (WAY * U0), 1.0) - u * u_off
    return Steered(u=-u_off), Rate(u_off=fall / (lost_after * L))


NAMES: Final = tuple(logged_loss.parameters)
TYPICAL: Final = np.array([p.start for p in logged_loss.parameters.values()])
BEGIN: Final = np.array([0.1, 0.1, 1.0]) * TYPICAL
"""Where the search begins. A boat that turns in two lengths would lose all her speed by what is
typical of ships, and at standstill no slope leads back: of one of 2 m twice the loss was read that
she had. From half and twice of it she ends at the same."""
NOTHING: Final = np.array([0.0, 0.0, TYPICAL[-1]])
ONE_SETTING: Final = 0.3
"""Share of itself that a shaft's speed may change by in a trial that tells what turns cost: a
governor lets it fall by a tenth in a hard turn. Of an outsider's ship a trial whose shaft went from
half to full before a circle and one whose shaft was slowed down on a straight course hid all that
turns cost: 6 % was foretold, where she loses 33 %. Half of it leaves out the same, twice lets one
pass."""
LAW: Final = 0.15
"""Standard deviation of each number as a share of it: a ship loses speed by a law of her own, and a
hard turn costs another share than those that were logged."""
TINY: Final = 1e-12
"""(m/s)^2 that are always left of the logs."""
LEAST: Final = 0.01
"""Share of what is typical below which nothing is lost."""


@dataclass(frozen=True)
class SpeedLoss:
    """Values of `logged_loss` by name, and their covariance; (3, 3).

    Where no log tells, or only as much as no ship loses, nothing is lost, and that is uncertain by
    what is typical.
    """

    values: Mapping[str, float]
    covariance: Vector


def speed_loss(fit: Fit) -> SpeedLoss | None:
    """What turns cost of the speed by the fitted trials' logs; None where it is simulated.

    What the law leaves of a log is no noise: each trial counts as one value of it.
    """
    simulated = {*fit.problem.simulator.model.all_states}
    if {"u", "u_lost"} & simulated or "r" not in simulated:
        return None
    logged = [s for s in fit.scores if s.trial.use == "fit" and _logged(s.trial)]
    if not logged:
        return SpeedLoss(_named(NOTHING), np.diag(TYPICAL**2))
    simulator = prepare(ShipModel(fit.model.ship, ("psi",), (logged_loss,)), NAMES, ("U",))
    records = [_record(fit, s) for s in logged]

    def at(values: Vector) -> tuple[Vector, Vector]:
        found = [_left(simulator, values, *record) for record in records]
        return np.concatenate([e for e, _ in found]), np.concatenate([psi for _, psi in found])

    ranges = logged_loss.parameters.values()
    low, high = np.array([p.low for p in ranges]), np.array([p.high for p in ranges])
    found = minimise(at, BEGIN, TYPICAL, low, high)
    lost = loses_speed(_named(found.theta)) and not np.any(found.theta[:2] >= high[:2])
    best, e, psi = (
        (found.theta, found.residual, found.jacobian) if lost else (NOTHING, *at(NOTHING))
    )
    known = psi.T @ psi * len(records) / max(float(e @ e), TINY) + np.diag(TYPICAL**-2)
    return SpeedLoss(_named(best), np.asarray(np.linalg.inv(known) + np.diag((LAW * best) ** 2)))


def _named(values: Sequence[float] | Vector) -> dict[str, float]:
    return dict(zip(NAMES, map(float, values), strict=True))


def loses_speed(values: Mapping[str, float]) -> bool:
    """Whether any speed is lost that is worth a word."""
    return any(values.get(n, 0.0) > LEAST * x for n, x in zip(NAMES[:2], TYPICAL, strict=False))


def with_speed_loss(ship: Vessel, values: Mapping[str, float]) -> Vessel:
    """The ship losing speed in turns; as she is where her model says how, or nothing does."""
    if not values or {"u", "u_lost", "u_off"} & {*ship.model.all_states}:
        return ship
    model = (ship.model + logged_loss).with_values(values)
    return vessel(model, ship.period, ship.constants, ship.rudder_rate)


def with_logged_speed(trial: Trial, approach: float) -> Trial:
    """What was sailed with `logged_loss` from an approach speed [m/s], with the speed as logged."""
    if "u_off" not in trial.signals:
        return trial
    u = trial.signals.get("u", approach) - trial.signals["u_off"]
    return replace(trial, signals={**trial.signals, "u": u})


def _logged(trial: Trial) -> bool:
    """Whether the speed was logged, and the rudder: a stated one is one number all along.

    And whether no shaft that was logged was set anew: turns alone cost speed then.
    """
    if "u" not in trial.signals or record_for(trial, "delta") is None:
        return False
    if any(_is_set_anew(trial, n) for n in SHAFTS & {*trial.signals}):
        return False
    speeds = trial.signals["u"][_valid(trial)]
    return len(speeds) > 0 and float(np.ptp(speeds)) > 0.0


def _is_set_anew(trial: Trial, name: str) -> bool:
    """Whether a shaft's speed, where it was logged, changes by more than a governor lets it."""
    shaft = np.abs(trial.signals[name][trial.valid[name] & np.isfinite(trial.signals[name])])
    if not len(shaft):
        return False
    low, high = np.quantile(shaft, (0.02, 0.98))  # whatever a few samples say
    return bool(high - low > ONE_SETTING * high)


def _valid(trial: Trial) -> Mask:
    """Where a speed was logged."""
    return trial.valid["u"] & np.isfinite(trial.signals["u"])


def _record(fit: Fit, score: Score) -> tuple[Trial, Vector, Mask]:
    """A trial of the approach speed alone along the fit's rates of turn; the log, where valid."""
    trial, states = score.trial, fit.problem.simulator.model.all_states
    rate = score.response.states[:, states.index("r")]
    valid = _valid(trial) & np.isfinite(rate)
    speed = np.full(trial.samples, np.quantile(trial.signals["u"][valid], APPROACH))
    rudder = trial.signals[record_for(trial, "delta") or "delta"]
    given = {"r": rate, "u": speed, "delta": rudder}
    return Trial(trial.name, "fit", trial.period, given, {}), trial.signals["u"], valid


def _left(
    simulator: Simulator, values: Vector, blank: Trial, logged: Vector, valid: Mask
) -> tuple[Vector, Vector]:
    """The logged speed less the simulated one and their mean, and the latter's derivatives."""
    response = respond(simulator, blank, _named(values), {})
    assert response.S is not None
    places = [simulator.columns.index(n) for n in NAMES]
    e = (logged - response.y[:, 0])[valid]
    slopes = response.S[valid, 0][:, places]
    return e - e.mean(), slopes - slopes.mean(axis=0)
