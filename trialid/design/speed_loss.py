"""The speed that turning costs, from the logs of a fit that reads its speed from them.

A model that is given the speed knows none in a manoeuvre that nobody has sailed. How the logged
speed fell says how it would: by squares of the rate of turn and of the rudder, behind a lag, fitted
to the logs along the rates of turn that the model had there.
"""

from collections.abc import Mapping
from typing import Any, Final

import numpy as np
from scipy.optimize import least_squares

from trialid.arrays import Mask, Vector
from trialid.design.helm import Vessel, vessel
from trialid.identification.fit import Fit, Score
from trialid.maths import Number
from trialid.ship.effect import Parameter, Rate, Steered, effect
from trialid.ship.model import ShipModel
from trialid.simulation.integrate import Simulator, prepare, record_for, respond
from trialid.trial import Trial


@effect(
    source="Son & Nomoto (1982): 10 % of speed lost at 5 deg of rudder, 55 % at 35 deg",
    states={"u_lost": None},
)
def logged_loss(
    u: Number,
    r: Number,
    delta: Number,
    u_lost: Number,
    L: Number,
    *,
    lost_in_turns: Any = Parameter(5.0, low=0.0, high=50.0),
    lost_by_rudder: Any = Parameter(0.5, low=0.0, high=5.0),
    lost_after: Any = Parameter(5.0, low=0.5, high=100.0, null=None),
) -> tuple[Steered, Rate]:
    """Speed loss: u = u - u_lost,  d(u_lost)/dt = (a (r L)^2 + b (delta u)^2 - u u_lost) / (c L).

    a is lost_in_turns, b lost_by_rudder, c lost_after, in ship lengths. Without b the speed begins
    to fall too late: both overshoots of a 20/20 of the S-175 then come out 1 % too large, with it
    0.2 % and 0.1 %.
    """
    fall = lost_in_turns * (r * L) ** 2 + lost_by_rudder * (delta * u) ** 2 - u * u_lost
    return Steered(u=-u_lost), Rate(u_lost=fall / (lost_after * L))


NAMES: Final = tuple(logged_loss.parameters)
LAW: Final = 0.15
"""Standard deviation of each number as a share of it: a ship loses speed by a law of her own, and a
hard turn costs another share than those that were logged. By noise they are far better known."""
APPROACH: Final = 0.95
"""Quantile of the logged speeds that is the approach: noise is beyond it, turns are below."""


def speed_loss(fit: Fit) -> dict[str, float]:
    """Values of `logged_loss`; empty where speed is simulated, not logged, or not lost in turns."""
    simulated = {*fit.problem.simulator.model.all_states}
    if {"u", "u_lost"} & simulated or "r" not in simulated:
        return {}
    logged = [s for s in fit.scores if s.trial.use == "fit" and _logged(s.trial)]
    if not logged:
        return {}
    simulator = prepare(ShipModel(fit.model.ship, ("psi",), (logged_loss,)), NAMES, ("U",))
    records = [_record(fit, s) for s in logged]

    def left(values: Vector) -> Vector:
        return np.concatenate([_left(simulator, values, *record)[0] for record in records])

    def slopes(values: Vector) -> Vector:
        return np.concatenate([_left(simulator, values, *record)[1] for record in records])

    ranges = [logged_loss.parameters[n] for n in NAMES]
    start = np.array([p.start for p in ranges])
    bounds = ([p.low for p in ranges], [p.high for p in ranges])
    found = least_squares(left, start, slopes, bounds=bounds, x_scale=start)
    return dict(zip(NAMES, map(float, found.x), strict=True))


def with_speed_loss(ship: Vessel, values: Mapping[str, float]) -> Vessel:
    """The ship losing speed in turns; as she is where her model says how, or nothing does."""
    if not values or {"u", "u_lost"} & {*ship.model.all_states}:
        return ship
    model = (ship.model + logged_loss).with_values(values)
    return vessel(model, ship.period, ship.constants, ship.rudder_rate)


def _logged(trial: Trial) -> bool:
    """Whether the speed was logged, and the rudder: a stated one is one number all along."""
    if "u" not in trial.signals or record_for(trial, "delta") is None:
        return False
    return float(np.ptp(trial.signals["u"])) > 0.0


def _record(fit: Fit, score: Score) -> tuple[Trial, Vector, Mask]:
    """A trial of the approach speed alone along the fit's rates of turn; the log, where valid."""
    trial, states = score.trial, fit.problem.simulator.model.all_states
    rate = score.response.states[:, states.index("r")]
    valid = trial.valid["u"] & np.isfinite(rate)
    speed = np.full(trial.samples, np.quantile(trial.signals["u"][valid], APPROACH))
    rudder = trial.signals[record_for(trial, "delta") or "delta"]
    given = {"r": rate, "u": speed, "delta": rudder}
    return Trial(trial.name, "fit", trial.period, given, {}), trial.signals["u"], valid


def _left(
    simulator: Simulator, values: Vector, blank: Trial, logged: Vector, valid: Mask
) -> tuple[Vector, Vector]:
    """What the loss leaves of the logged speed less its mean, and the derivatives of that."""
    named = dict(zip(NAMES, values, strict=True))
    response = respond(simulator, blank, named, {})
    assert response.S is not None
    places = [simulator.columns.index(n) for n in NAMES]
    e = (response.y[:, 0] - logged)[valid]
    slopes = response.S[valid, 0][:, places]
    return e - e.mean(), slopes - slopes.mean(axis=0)
