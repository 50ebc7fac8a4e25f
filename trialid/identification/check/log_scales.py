"""How far every log's scale may be off: ranges count with it, whatever is missing.

A rudder's feedback that reads 5 % too much in all trials alike leaves the same error, and a rudder
that does 5 % less: no residual shows it.
"""

from dataclasses import replace
from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.identification.fit import Fit
from trialid.identification.output_error import Problem, residual_of_trial, stretches
from trialid.names.quantities import OVER_GROUND, SIGNALS, SLOPES
from trialid.simulation.integrate import Departure, record_for

OFF: Final = 0.025
"""Standard deviation of a log's scale: half of the 5 % that a rate-of-turn indicator may be off by
(IMO resolution A.526(13)). Rudder feedbacks are 1 to 2 deg off at 35 deg, which is as much; of
revolutions and winds nobody says, and it is taken to be the same. Of 20 ships whose logs scatter by
that (seeds 51000 to 51019) ranges hold 96.7 % of the truths; with half of it 95.6, with twice 98.3
in ranges wider by a third."""

BETTER: Final = 0.01
"""The same of a speed log, by the 2 % of resolution A.824(19), and of a rate of turn beside a
heading, whose circle closes: those of sound gyros lie within 2 % of its slope."""

SPEEDS: Final = ("u", "v")

STEP: Final = 0.01
"""Of a scale, by which its slope is found."""


def log_scales(fit: Fit) -> tuple[Vector, Vector]:
    """Normed rows per unit of the scale of each log, and how uncertain it is; (M, n), (n,).

    Of an output by what the model says, for its noise is none of its scale. Of orders nothing: they
    are what was asked for. In the order of `scaled_logs`.
    """
    problem, names = fit.problem, scaled_logs(fit.problem)
    columns = np.zeros((len(fit.residual), len(names)))
    for column, name in zip(columns.T, names, strict=True):
        for place in range(len(problem.trials)):
            column[rows_of(problem, place)] = slope_of_scale(fit, place, name)
        for part in (p for p in stretches(problem) if problem.outputs[p.output] == name):
            column[part.rows] -= fit.residual[part.rows]
    return columns, np.array([BETTER if _is_better_known(problem, n) else OFF for n in names])


def scaled_logs(problem: Problem) -> list[str]:
    """Logs of any fitted trial whose scale may be off, but for orders."""
    places = range(len(problem.trials))
    ordered = {a.name for a in problem.simulator.model.ship.actuators if a.command == "share"}
    read = dict.fromkeys(n for i in places for n in with_a_scale(problem, i))
    return [n for n in read if n not in ordered and not n.endswith("_order")]


def _is_better_known(problem: Problem, name: str) -> bool:
    angle = SLOPES.get(name)
    closes = angle is not None and SIGNALS[angle].angle
    return name in SPEEDS or (closes and all(angle in t.signals for t in problem.trials))


def with_a_scale(problem: Problem, place: int) -> tuple[str, ...]:
    """Logs that are read of a fitted trial, but of directions and of what is told over ground."""
    read = (*problem.simulator.equations.inputs, *problem.outputs)
    round_about = {a.angle for a in problem.simulator.model.ship.actuators if a.kind == "azimuth"}
    records = (record_for(problem.trials[place], n) for n in read)
    return tuple(
        name
        for name in dict.fromkeys(n for n in records if n)
        if name not in {*OVER_GROUND, *round_about}
        and not (name in SIGNALS and SIGNALS[name].angle)
    )


def rows_of(problem: Problem, place: int) -> slice:
    """Where the rows of a fitted trial stand in the residual."""
    parts = [p.rows for p in stretches(problem) if p.trial == place]
    return slice(parts[0].start, parts[-1].stop)


def slope_of_scale(fit: Fit, place: int, name: str) -> Vector:
    """What a unit of a log's scale adds to a trial's residual; zero where the ship then leaves."""
    problem, trials = fit.problem, list(fit.problem.trials)
    before = fit.residual[rows_of(problem, place)]
    signals = trials[place].signals
    if name not in signals:
        return np.zeros_like(before)
    scaled = {**signals, name: signals[name] * (1.0 + STEP)}
    trials[place] = replace(trials[place], signals=scaled)
    after = residual_of_trial(replace(problem, trials=tuple(trials)), fit.theta, place)
    return np.zeros_like(before) if isinstance(after, Departure) else (after - before) / STEP
