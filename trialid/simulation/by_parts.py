"""A response and its sensitivities part by part: those of a long record are larger than its rows.

Stated once for all samples, the sensitivities of a record of 100 000 samples by 250 parameters take
2 GB, of which a fit keeps a seventh and a search for what is missing a thirtieth.
"""

from collections.abc import Callable, Mapping, Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.simulation.delay import reach, shift_part
from trialid.simulation.integrate import (
    Response,
    Simulator,
    arguments,
    departure,
    respond,
)
from trialid.simulation.kernel import Kernel, first_slopes
from trialid.simulation.readout import Added, late_outputs, output_slopes
from trialid.trial import Trial

Vector = NDArray[np.float64]
Take = Callable[[slice, Vector], None]
"""Samples, and the sensitivities of the outputs at them; (n, n_y, n_columns)."""

NUMBERS: Final = 1 << 20
"""Sensitivities worked out at a time: with 8 MB they are not far from the processor."""


def respond_by_parts(
    simulator: Simulator,
    trial: Trial,
    values: Mapping[str, float],
    start: Mapping[str, float],
    take: Take,
) -> tuple[Response, list[Added]]:
    """As `respond`, the sensitivities given away part by part.

    Also what is to be added to those that were given: what outputs' own times do. After a departure
    nothing more is given.
    """
    theta, x0, u, limit = arguments(simulator, trial, values, start)
    lags = _lags(simulator, u, theta, trial.period)
    if not isinstance(simulator.engine, Kernel) or lags is None:
        response = respond(simulator, trial, values, start)
        if response.S is not None and response.departure is None:
            take(slice(0, trial.samples), response.S)
        return response, []
    window = _Window(lags, trial.samples, take)
    X, left = _states(simulator, simulator.engine, trial.period, (theta, x0, u, limit), window)
    added: list[Added] = []
    y = late_outputs(simulator, trial.period, len(X), [*X.T, *u.T, *theta], None, added)
    return Response(X, y, None, departure(simulator, X, left, trial.period, limit)), added


def _lags(
    simulator: Simulator, u: Vector, theta: Vector, period: float
) -> list[float | None] | None:
    """By how many samples each output is late, None for one that cannot be.

    None for all where one is slow, or late by more and more: parts would need all before them.
    """
    read = simulator.readout
    unknown = np.full((len(simulator.equations.states), len(u)), np.nan)
    symbols = [*unknown, *u.T, *theta]
    slow = [lag.value(symbols)[0] for c in simulator.outputs for lag in read.lags[c]]
    delays = (read.delay[c] for c in simulator.outputs)
    late = [None if one.absent else one.value(symbols)[0] for one in delays]
    steady = all(tau is None or np.all(tau == np.ravel(tau)[0]) for tau in late)
    if not steady or any(np.any(np.asarray(tau) != 0.0) for tau in slow):
        return None
    return [None if tau is None else float(np.ravel(tau)[0]) / period for tau in late]


def _states(
    simulator: Simulator,
    engine: Kernel,
    period: float,
    run: tuple[Vector, Vector, Vector, Vector],
    window: "_Window",
) -> tuple[Vector, int]:
    """States at all samples, and the one at which they left their domain; 0 where none."""
    theta, x0, u, limit = run
    eq = simulator.equations
    length = max(NUMBERS // max(len(eq.kept) * eq.columns, 1), 1)
    s = first_slopes(eq)
    X = np.full((len(u), len(x0)), np.nan)
    X[0] = x0
    for at in range(0, len(u), length):
        before, end = max(at - 1, 0), min(at + length, len(u))
        part, S, left = engine.sensitivities(
            theta, X[before], u[before:end], limit, h=period, substeps=simulator.substeps, s=s
        )
        X[before:end] = part
        if left:
            return X, before + left
        new = slice(at - before, None)
        symbols = [*part[new].T, *u[at:end].T, *theta]
        window.add(output_slopes(simulator, S[new], symbols))
    return X, 0


class _Window:
    """Sensitivities of outputs that may be late, given away once their neighbours are there."""

    def __init__(self, lags: Sequence[float | None], samples: int, take: Take) -> None:
        self.lags, self.samples, self.take = lags, samples, take
        known = [lag for lag in lags if lag is not None]
        self.behind = max((reach(lag)[0] for lag in known), default=0)
        self.ahead = max(0, *(reach(lag)[1] for lag in known)) if known else 0
        self.begin = self.given = 0
        self.rows: Vector | None = None

    def add(self, more: Vector) -> None:
        """The next samples; (n, n_y, n_columns)."""
        rows = more if self.rows is None else np.concatenate([self.rows, more])
        end = self.begin + len(rows)
        ready = end if end == self.samples else max(end - self.ahead, self.given)
        if ready > self.given:
            self.take(slice(self.given, ready), self._late(rows, slice(self.given, ready)))
        self.given = ready
        first = min(max(ready - max(self.behind, 0), self.begin), ready)
        self.rows, self.begin = rows[first - self.begin :].copy(), first

    def _late(self, rows: Vector, wanted: slice) -> Vector:
        made = rows[wanted.start - self.begin : wanted.stop - self.begin]
        if all(lag is None for lag in self.lags):
            return made
        made = made.copy()
        for c, lag in enumerate(self.lags):
            if lag is not None:
                made[:, c] = shift_part(rows[:, c], self.begin, lag, wanted, self.samples)
        return made
