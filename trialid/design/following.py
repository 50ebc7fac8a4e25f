"""After a fit: the trial that tells rivals apart, and what the fitted ship does in standard ones.

A fitted model becomes a vessel by what its trials held: inputs that stayed about constant are kept
at their medians, and the rudder is steered as fast as it was seen to move.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from trialid.accuracy.likely import WIDE, Standing
from trialid.arrays import Vector
from trialid.design.helm import Vessel, vessel
from trialid.design.imo.measure_slopes import Shows, measure_slopes
from trialid.design.imo.speed_loss import speed_loss, with_speed_loss
from trialid.design.kinds import Test
from trialid.design.limits import Limits, excesses
from trialid.design.prediction.engine_orders import at_her_speed
from trialid.design.prediction.likely_spread import LikelySpread, likely_spread
from trialid.design.prediction.rudders_zero import with_rudders_zero
from trialid.design.rating import Goal, Noise, goal
from trialid.design.rudder_rate import gear_rate
from trialid.design.rudders import steered_signals, steering_angles
from trialid.design.search import natural_roll, sail_all
from trialid.design.separation import Likeness, Separation, likeness_of, rivals
from trialid.design.standard import Measure, in_calm, measures_of
from trialid.design.triangles import Triangles, triangles, triangles_beside
from trialid.errors import DesignError, TrialidError
from trialid.identification.approach import approach_speed
from trialid.identification.fit import Fit
from trialid.identification.output_error import compared_mask
from trialid.identification.problem import norms
from trialid.ship.effect import Effect
from trialid.ship.model import STATES, ShipModel
from trialid.simulation.integrate import inputs
from trialid.trial import Trial

APART: Final = 0.05
"""Share by which approach speeds differ that are two."""
WORTH_SAILING: Final = 0.9
"""A test that leaves more than this share of a width is not proposed for it."""

_D: Final = float(np.deg2rad(1.0))
FEASIBLE: Final[Mapping[str, tuple[str, Mapping[str, float]]]] = {
    "zig-zag 5/5": ("zigzag", {"angle": 5 * _D, "heading": 5 * _D}),
    "zig-zag 10/10": ("zigzag", {"angle": 10 * _D, "heading": 10 * _D}),
    "zig-zag 20/20": ("zigzag", {"angle": 20 * _D, "heading": 20 * _D}),
    "zig-zag 20/40": ("zigzag", {"angle": 20 * _D, "heading": 40 * _D}),
    "zig-zag 35/20": ("zigzag", {"angle": 35 * _D, "heading": 20 * _D}),
    "turning circle at 15 deg": ("turning_circle", {"angle": 15 * _D, "turn": 720 * _D}),
    "turning circle at 35 deg": ("turning_circle", {"angle": 35 * _D, "turn": 720 * _D}),
    "pull-out from 20 deg": ("pull_out", {"angle": 20 * _D, "turn": 120 * _D}),
    "rolling by 10 deg of rudder": ("roll", {"angle": 10 * _D}),
}
"""Tests any crew can run, tried for a proposal."""


def vessel_of(fit: Fit, model: ShipModel | None = None) -> Vessel:
    """The fitted ship as she was in the first of her trials, at revolutions that hold her speed.

    Raises
    ------
    DesignError
        The model does not turn, or is not steered by a rudder.
    """
    sailed = model or fit.model
    if steered_signals(sailed).isdisjoint(sailed.recorded):
        raise DesignError("she has no rudder to steer by; `stop` and orders of your own need none")
    trials = fit.problem.trials
    rate = gear_rate(trials, steering_angles(sailed))
    ship = vessel(sailed, trials[0].period, steady_inputs(fit), rate)
    return at_her_speed(ship, in_calm(ship))


def steady_inputs(fit: Fit) -> dict[str, float]:
    """What stays as it was in the first trial, the rudder apart: medians of its signals [SI]."""
    trial = fit.problem.trials[0]
    eq = fit.problem.simulator.equations
    u = inputs(fit.problem.simulator, trial, fit.problem.simulator.fixed | fit.estimates)
    steady = {n: float(np.median(c)) for n, c in zip(eq.inputs, u.T, strict=True)}
    logged = {n: float(np.median(x)) for n, x in trial.signals.items() if n not in STATES}
    moved = steered_signals(fit.model) | {"t"}
    constants = {n: x for n, x in (logged | steady).items() if n not in moved}
    return constants | {"u": fit.model.ship.particulars["U0"]}  # not what a turn leaves of it


def next_trial(
    fit: Fit, effects: tuple[Effect, Effect], noise: Mapping[str, float]
) -> Separation | None:
    """The feasible standard test that best tells two effects apart beside the trials there are.

    None where the model cannot be sailed. `noise` is the standard deviation of each output [SI].
    """
    try:
        return _proposed(fit, effects, noise)
    except TrialidError:
        return None


def _proposed(
    fit: Fit, effects: tuple[Effect, Effect], noise: Mapping[str, float]
) -> Separation | None:
    sensors = {c: Noise(s) for c, s in noise.items()}
    ready = vessel_of(fit)
    pair = rivals(
        model=fit.model,
        settings=fit.settings,
        noise=sensors,
        effects=effects,
        vessel=ready,
        roll_frequency=_roll_frequency(fit, ready),
        speed=fit.model.ship.particulars["U0"],
    )
    so_far = triangles(pair.goal, fit.problem.trials)
    rated: list[tuple[Test, Likeness]] = [
        (test, likeness_of(pair, triangles_beside(pair.goal, so_far, trial)))
        for test, trial in _feasible(fit, ready)
    ]
    if not rated:
        return None
    test, after = max(rated, key=lambda r: min(r[1].odds))
    return Separation(pair.names, (test,), likeness_of(pair, so_far), after, len(rated))


def _roll_frequency(fit: Fit, ready: Vessel) -> float:
    rolls = {"p", "phi"} <= {*fit.model.states}
    return natural_roll(ready) if rolls else 2.0 * np.pi / 15.0


def _feasible(fit: Fit, ready: Vessel) -> Iterator[tuple[Test, Trial]]:
    """Standard tests as long as the longest trial, sailed; those she should not sail left out."""
    duration = max(t.duration for t in fit.problem.trials)
    roll, speed = _roll_frequency(fit, ready), fit.model.ship.particulars["U0"]
    for name, (kind, values) in FEASIBLE.items():
        test = Test(kind, values, duration, 0.1 * duration, name=name)
        [passage] = sail_all([test], ready, roll)
        if not excesses(passage, Limits(heel=0.6), speed):
            yield test, passage.trial


@dataclass(frozen=True)
class Narrowing:
    """The standard test that leaves a parameter least open if an effect may be missing.

    `share` is what the effect and noise leave open with the test, as a share of that without; what
    is held fixed has no part in it.
    """

    parameter: str
    effect: str
    test: str
    share: float

    @property
    def sentence(self) -> str:
        """What was found, in words."""
        if self.share > WORTH_SAILING:
            return f"No standard test would narrow that by more than {1.0 - WORTH_SAILING:.0%}."
        test = self.test[:1].upper() + self.test[1:]
        return f"{test} would narrow that most, to about {self.share:.0%} of its width."


def narrowing_trial(
    fit: Fit, parameter: str, effect: Effect, noise: Mapping[str, float]
) -> Narrowing | None:
    """The feasible standard test after which an effect leaves a parameter least open.

    None where the effect has nothing that is linear at its null, or nothing can be sailed. `noise`
    is the standard deviation of each output [SI].
    """
    added = tuple(n for n, p in effect.parameters.items() if p.null == 0.0)
    if effect.scanned or not added or parameter not in fit.settings.free:
        return None
    wider = replace(fit.settings, free=(*fit.settings.free, *added))
    sensors = {c: Noise(s) for c, s in noise.items()}
    try:
        asked = goal((fit.model + effect).with_values(effect.nulls), wider, sensors)
        before = triangles(asked, fit.problem.trials)
        so_far = _openness(asked, before, parameter, added)
        found = [
            (_openness(asked, triangles_beside(asked, before, trial), parameter, added), test.name)
            for test, trial in _feasible(fit, vessel_of(fit))
        ]
    except TrialidError:
        return None
    least = min(found, default=None)
    if least is None or not so_far > 0.0:
        return None
    return Narrowing(parameter, effect.name, least[1], least[0] / so_far)


def _openness(asked: Goal, found: Triangles, parameter: str, added: Sequence[str]) -> float:
    """Standard deviation of a parameter in its sizes, the effect known to twice its typical one.

    By the formula of a fit, which weighs outputs by what they move in all its trials and takes
    what is left of them together.
    """
    outputs = asked.settings.outputs
    compared = [compared_mask(t, asked.simulator) for t in found.trials]
    length = asked.simulator.model.ship.particulars["L"]
    sizes = norms(found.trials, compared, outputs, asked.settings.norm, length)
    shares = [asked.noise[c].sigma / size for c, size in zip(outputs, sizes, strict=True)]
    eps = float(np.sqrt(np.mean(np.square(shares))))
    alike = {c: Noise(eps * float(size)) for c, size in zip(outputs, sizes, strict=True)}
    known = np.diag([1.0 / WIDE if n in added else 0.0 for n in found.names])
    inverse = np.linalg.pinv(np.concatenate([found.rows(alike), known]))
    return float(np.linalg.norm(inverse[found.names.index(parameter)]))


def standard_measures(
    fit: Fit, covariance: Vector, standing: Standing, held: Sequence[str], missing: Sequence[Shows]
) -> tuple[Measure, ...]:
    """IMO's measures of the fitted ship, with where each is likely to lie.

    What the record leaves open of the parameters, of what was held fixed and of what may be missing
    is followed through the manoeuvre to each measure. So a missing effect counts twice: it moved
    the parameters, and it is not there in the prediction.

    Parameters
    ----------
    covariance
        Of the unknowns by noise; (n_theta, n_theta).
    standing, held, missing
        What may be off: how models of what is missing stand, and what their columns are.

    Raises
    ------
    DesignError
        The model does not turn, or is not steered by a rudder.
    """
    return measures_within(fit, likely_spread(fit, covariance, standing, held, missing))


def measures_within(fit: Fit, spread: LikelySpread) -> tuple[Measure, ...]:
    """IMO's measures of the fitted ship; DesignError as `standard_measures`."""
    slopes = measure_slopes(sailed_ship(fit), spread.known, spread.missing, spread.width)
    ranges = spread.ranges([*slopes.values.values()], slopes.by)
    known = dict(zip(slopes.values, ranges, strict=True))
    return measures_of(fit.model.ship, slopes.values, slopes.remarks, known)


def sailed_ship(fit: Fit) -> Vessel:
    """The fitted ship as she is predicted: losing speed and steered as in her trials.

    DesignError as `vessel_of`.
    """
    loss, ship = speed_loss(fit), vessel_of(fit, with_rudders_zero(fit))
    return ship if loss is None else with_speed_loss(ship, loss.values)


def approach_speeds(fit: Fit) -> tuple[float, ...]:
    """The approach speed of the ship's file, then those of the fitted trials that differ [m/s]."""
    found = [fit.model.ship.particulars["U0"]]
    for trial in (t for t in fit.trials if t.use == "fit"):
        speed = approach_speed(trial) or 0.0
        if speed > 0.0 and all(abs(speed - x) > APART * x for x in found):
            found.append(speed)
    return tuple(found)


def by_name(catalogue: Mapping[str, Effect], names: Sequence[str]) -> tuple[Effect, Effect] | None:
    """The first two of these effects that are known; None where there are not two."""
    known = [catalogue[n] for n in names if n in catalogue]
    return (known[0], known[1]) if len(known) >= 2 else None
