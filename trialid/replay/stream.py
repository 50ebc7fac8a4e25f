"""A model in step with a record: the batch run's own arithmetic, a few samples at a time.

The states are those of the same kernel, begun again at the last state it gave: Runge-Kutta steps
look at no earlier one. Outputs are read from the states by the function that reads them for the
batch run. What makes an output of more than one state decides how it can be streamed:

* none: sample by sample;
* a delay: interpolation looks at up to two later samples, `ahead`, and some earlier ones, `back`;
* a low-pass: it begins with the record, so that its beginning is read again each time;
* a delay that moves with a state: read once all is simulated, `ahead` is then the whole record.
"""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from trialid.simulation.delay import REACH
from trialid.simulation.integrate import (
    Departure,
    Simulator,
    arguments,
    departure,
    late_by,
)
from trialid.simulation.readout import sensor_outputs
from trialid.trial import Trial

Vector = NDArray[np.float64]


class Stream:
    """Simulated states and outputs of a trial, so far.

    Attributes
    ----------
    y
        Predicted outputs [SI]; (N, n_y), NaN from sample `at` on.
    at
        Samples predicted so far.
    departure
        Where the simulation left the model's domain, None as long as it has not.
    """

    def __init__(
        self,
        simulator: Simulator,
        trial: Trial,
        values: Mapping[str, float],
        start: Mapping[str, float],
    ) -> None:
        self.simulator, self.trial = simulator, trial
        self._theta, x0, self._u, self._limit = arguments(simulator, trial, values, start)
        self._X = np.full((trial.samples, len(x0)), np.nan)
        self._X[:1] = x0
        self.y = np.full((trial.samples, len(simulator.outputs)), np.nan)
        self.back, self.ahead = self._reach()
        self.open_end = self.ahead + _input_ahead(simulator, trial, values)
        self.at, self._stepped = 0, 1
        self.departure: Departure | None = None

    def advance(self, to: int) -> None:
        """Predict every sample before `to`."""
        to = min(to, self.trial.samples)
        if to > self.at:
            known = min(to + self.ahead, self.trial.samples)
            self._step(known)
            self._read(to, known)

    def take_over(self, earlier: "Stream") -> int:
        """Keep what an earlier reading of a growing log gave; the samples it still stands for.

        Stamps are put right by the whole record, so that a longer one may move what was there.
        """
        same = np.array_equal(self._theta, earlier._theta) and np.array_equal(
            self._X[0], earlier._X[0]
        )
        n = min(len(self._u), earlier._stepped) if same and earlier.departure is None else 0
        moved = np.flatnonzero((self._u[:n] != earlier._u[:n]).any(axis=1))
        n = int(moved[0]) if len(moved) else n
        if n < 1:
            return 0
        self._X[:n], self._stepped = earlier._X[:n], n
        self.at = max(min(earlier.at, n - earlier.ahead), 0)
        self.y[: self.at] = earlier.y[: self.at]
        return self.at

    def _step(self, to: int) -> None:
        """States before sample `to`, from the last one there is."""
        first = self._stepped - 1
        if to <= self._stepped or self.departure is not None:
            return
        run, h = self.simulator.engine, self.trial.period
        u = self._u[first:to]
        X, left = run.simulate(
            self._theta, self._X[first].copy(), u, self._limit, h, self.simulator.substeps
        )
        self._X[first:to] = X
        self._stepped = to
        if left:
            place = first + left
            self.departure = departure(self.simulator, self._X, place, h, self._limit)

    def _read(self, to: int, known: int) -> None:
        """Outputs of the samples before `to`, from states before `known`."""
        first = max(self.at - self.back, 0)
        y, _ = sensor_outputs(
            self.simulator, self.trial.period, self._X[first:known], None, self._u[first:known],
            self._theta,
        )  # fmt: skip
        self.y[self.at : to] = y[self.at - first : to - first]
        self.at = to

    def _reach(self) -> tuple[int, int]:
        """Samples before and after its own that an output is made of."""
        n, read = self.trial.samples, self.simulator.readout
        back = n if any(read.lags[c] for c in self.simulator.outputs) else 0
        ahead = 0
        symbols = [*np.full((self._X.shape[1], n), np.nan), *self._u.T, *self._theta]
        for timing in (t for t in read.delay.values() if not t.absent):
            lag = np.ceil(np.asarray(timing.value(symbols)[0]) / self.trial.period)
            if not np.isfinite(lag).all():
                return n, n
            back = max(back, int(lag.max()) + REACH)
            ahead = max(ahead, REACH - int(lag.min()))
        return back, max(ahead, 0)


def _input_ahead(simulator: Simulator, trial: Trial, values: Mapping[str, float]) -> int:
    """Later samples that a delayed input looks at: at a growing end they are not there yet."""
    late = late_by(simulator.model, {**simulator.fixed, **values}, trial.t)
    early = (int(np.ceil(np.min(tau) / trial.period)) for tau in late.values())
    return max((REACH - whole for whole in early), default=0)
