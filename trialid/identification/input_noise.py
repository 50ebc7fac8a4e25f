"""Noise of recorded inputs, and what it moves a simulation by.

A rudder angle or a wind that drives the simulation was measured, too. Its noise pushes the ship of
the model as nothing pushed the true one.
"""

import functools
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Final

import numpy as np

from trialid.arrays import Mask, Vector
from trialid.simulation.integrate import Simulator, record_for, respond, starts_of
from trialid.trial import Trial
from trialid.white_noise import white_noise_of_most

QUICK: Final = 0.5
"""Blocks of this times sqrt(L/g) tell the noise: two seconds for 175 m. The filter of a trial's
clock, or a sensor slower than that clock, takes away from what single samples show of it. Of a wind
with white noise of 1, logged at 2 Hz, the mean of 200 records: 1.06 as it is, 0.89 and 0.22 after
means of three and of nine samples, 1.33 with gusts of 1 m/s and 10 s. Half of it: 1.04, 0.51, 0.14
and 1.13; twice: 1.08, 0.98, 0.69 and 1.62."""

GROWS: Final = 1.5
"""Times as much that blocks of twice the length show where motion or gusts begin: gusts, whose
spectrum falls with f^(-5/3), 1.8 times; what is left of a sensor at half its clock 1.2."""


def moved_by(
    simulator: Simulator,
    trial: Trial,
    values: Mapping[str, float],
    level: Mapping[str, float],
    rng: np.random.Generator,
) -> Iterator[Vector]:
    """What draws of white noise on its inputs move a simulation by, without an end; (N, n_y) each.

    Parameters
    ----------
    values
        All the trial is simulated with, initial states by the name of the column.
    level
        Deviation of the noise on each signal [SI].
    """
    run = functools.partial(
        respond, simulator, values=values, start=starts_of(values), sensitivities=False
    )
    clean = run(trial).y
    while True:
        yield run(with_noise(trial, level, rng)).y - clean


def with_noise(trial: Trial, level: Mapping[str, float], rng: np.random.Generator) -> Trial:
    """The trial with more white noise on some of its signals."""
    more = {n: trial.signals[n] + s * rng.standard_normal(trial.samples) for n, s in level.items()}
    return replace(trial, signals={**trial.signals, **more})


def input_noise(simulator: Simulator, trial: Trial) -> dict[str, float]:
    """White noise of each record that drives the simulation, as it has any [SI]."""
    L, g = (simulator.model.ship.particulars[n] for n in ("L", "g"))
    block = max(1, int(QUICK * np.sqrt(L / g) / trial.period))
    records = (record_for(trial, n) for n in simulator.equations.inputs)
    sources = sorted({n for n in records if n is not None})
    level = {n: _level(trial.signals[n], trial.valid.get(n), block) for n in sources}
    return {n: s for n, s in level.items() if s > 0.0}


def _level(y: Vector, valid: Mask | None, block: int) -> float:
    """Deviation of a sample whose slow part is that of the blocks' means."""
    short, long = (_of_blocks(y, valid, size) for size in (block, 2 * block))
    return long if short < long < GROWS * short else short


def _of_blocks(y: Vector, valid: Mask | None, block: int) -> float:
    whole = len(y) // block * block
    means = y[:whole].reshape(-1, block).mean(axis=1)
    seen = None if valid is None else np.all(valid[:whole].reshape(-1, block), axis=1)
    return float(np.sqrt(block)) * white_noise_of_most(means, seen)
