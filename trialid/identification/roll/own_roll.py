"""Whether the roll that was fitted is a ship's own: how it is damped as she rolls in the record.

A linear coefficient is not what damps her: eddies take the more the further she rolls, fins and
tanks work beside. What counts is what all of the model takes out of her roll along the record, as
a linear damping that takes as much.
"""

from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.arrays import Vector
from trialid.identification.output_error import Problem, output_error, respond_all
from trialid.identification.roll.roll_range import DAMPING_RATIO, NO_SHIPS
from trialid.simulation.integrate import Departure, Simulator, inputs
from trialid.simulation.reference import evaluator

ROLLING: Final = ("phi", "p")

DIES_AWAY: Final = 0.5
"""Share of the roll of a record's first third that its last third may have of a decay; a swell goes
on. Half of it refuses a ship that 0.007 of what is critical stills in thirty cycles, with 0.41;
twice of it all seven drawn ships in zig-zags that were looked at stay above, at 1.04 to 1.43."""


SWINGS_OUT: Final = 0.8
"""The same of a trial in which nothing is recorded that could roll her, a swing let go: that its
fit dies down is the record's. A model of a tanker at rest, 0.006 of what is critical, has 0.55 in
a minute; a swell 1. Half of it doubts her, twice of it believes a swell."""

ABOUT: Final = 1.25
"""Factor to either side of her frequency that counts as hers: one damped by a tenth of what is
critical rolls half as far at the lower end as at her frequency, and a third at the upper."""

OTHERS: Final = 0.5
"""Squared roll about her frequency that the model leaves, over what it explains there, above which
what rolls her is no order of the helm. A ship of 33 s in a swell of 13 s: 1.7 to 9.5 in the 15 of
18 records whose GM was found wrong, 0.003 in the others. Of 120 drawn ships 19 tell their GM, all
of them right: all do with this and with twice of it, 16 with half. Of six in a swell of their own
period with 0.7 to 6.2 twice of it misses two."""

UNMOVED: Final = frozenset(("u", "t"))
"""Inputs that roll no ship."""


def damped_by(problem: Problem, theta: Vector) -> float:
    """The damping over what is critical that takes as much out of her roll, as all of the model.

    That of the middle of ships where she does not roll at all, or cannot be simulated.
    """
    assert problem.roll is not None
    responses, taken, rolled = respond_all(problem, theta, sensitivities=False), 0.0, 0.0
    for i, response in enumerate([] if isinstance(responses, Departure) else responses):
        slowed, p = _slowed(problem, theta, i, response.states)
        taken -= float(slowed @ p)
        rolled += float(p @ p)
    if rolled <= 0.0:
        return DAMPING_RATIO
    return 0.5 * taken / rolled / problem.roll.frequency(theta)


def _slowed(problem: Problem, theta: Vector, trial: int, X: Vector) -> tuple[Vector, Vector]:
    """What rolling does to her roll in one trial [rad/s^2], and her roll rate [rad/s]; (N,)."""
    simulator: Simulator = problem.simulator
    equations, place = simulator.equations, simulator.equations.states.index("p")
    values = {**simulator.fixed, **problem.values(theta, trial)}
    u = inputs(simulator, problem.trials[trial], values)
    known = [np.full(len(X), values[n]) for n in equations.parameters]
    run = evaluator(
        [equations.f[place]],
        (*equations.states, *equations.inputs, *equations.parameters),
        scalar=False,
    )
    still = X.copy()
    still[:, place] = 0.0
    with_roll, without = (run([*x.T, *u.T, *known])[0] for x in (X, still))
    return np.asarray(with_roll - without), X[:, place]


def goes_on(problem: Problem, theta: Vector) -> bool:
    """Whether it hardly dies down by itself, nor in the record: a swell's, that goes on."""
    least = DAMPING_RATIO / NO_SHIPS
    return damped_by(problem, theta) < least and not dies_away(problem)


def only_follows(problem: Problem, theta: Vector) -> bool:
    """Whether it has no period: a heel that follows the turn, or a ship with fins at work."""
    return damped_by(problem, theta) > DAMPING_RATIO * NO_SHIPS


def is_a_ships(problem: Problem, theta: Vector) -> bool:
    """Whether most ships roll so."""
    return not (goes_on(problem, theta) or only_follows(problem, theta))


def is_rolled_by_others(problem: Problem, theta: Vector) -> bool:
    """Whether most of her roll about her own frequency is of nothing that the model has.

    Then a resonance fits what by chance goes with the helm: in a swell of about her period ships
    damped by 0.04 of what is critical were fitted with 0.011 to 0.013, and with a GM 1.8 times
    theirs.
    """
    assert problem.roll is not None
    responses = respond_all(problem, theta, sensitivities=False)
    if isinstance(responses, Departure):
        return False
    frequency, left, explained = problem.roll.frequency(theta), 0.0, 0.0
    for trial, mask, response in zip(problem.trials, problem.compared, responses, strict=True):
        for c, name in enumerate(problem.outputs):
            if name in ROLLING:
                eps = output_error(trial.signals[name], response.y[:, c])
                norm = trial.period / problem.y_rms[c] ** 2
                left += norm * _about(eps, mask[:, c], frequency * trial.period)
                rolled = _about(response.y[:, c], mask[:, c], frequency * trial.period)
                explained += norm * rolled
    return left > OTHERS * explained


def _about(series: Vector, mask: NDArray[np.bool_], frequency: float) -> float:
    """Sum of squares of a series, where it is compared, within `ABOUT` of a frequency [rad/sample].

    Without a taper: a roll that dies away is where one would be next to nothing.
    """
    if not mask.any():
        return 0.0
    swings = np.where(mask, series - series[mask].mean(), 0.0)
    spectrum = np.abs(np.fft.rfft(swings)) ** 2 / len(series)
    there = 2.0 * np.pi * np.fft.rfftfreq(len(series))
    about = (there > frequency / ABOUT) & (there < frequency * ABOUT)
    return 2.0 * float(np.sum(spectrum[about]))


def dies_away(problem: Problem) -> bool:
    """Whether the roll of every trial, as recorded, is by far the greatest in the beginning."""
    places = [c for c, name in enumerate(problem.outputs) if name in ROLLING]
    let_go = {*problem.simulator.equations.inputs} <= UNMOVED
    most = SWINGS_OUT if let_go else DIES_AWAY
    return all(
        _late(trial.signals[problem.outputs[c]][mask[:, c]]) < most
        for trial, mask in zip(problem.trials, problem.compared, strict=True)
        for c in places
    )


def _late(roll: Vector) -> float:
    """Roll of the last third over that of the first, about its middle; 1 of a few samples."""
    if len(roll) < 3:
        return 1.0
    first, *_, last = np.array_split(roll - np.median(roll), 3)
    return float(np.std(last) / max(float(np.std(first)), 1e-300))
