"""What is played: one trial, the model in step with it, its residual watched."""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.diagnosis.noise.residual import Residual
from trialid.diagnosis.where.doing import ship_activity
from trialid.diagnosis.where.leftover import Leftover
from trialid.identification.fit import Fit
from trialid.identification.output_error import compared_mask, output_error, output_matrix
from trialid.identification.trial_score import of_trial
from trialid.replay.alarm import Alarm, Bands, Monitor
from trialid.replay.stream import Stream
from trialid.threads import one_thread
from trialid.trial import Trial

Vector = NDArray[np.float64]

LOOK_BACK: Final = 10.0
"""Record [s] before a moment that tells what a ship of 175 m was doing; of others by Froude."""


@dataclass(frozen=True)
class Event:
    """Something worth a line: when in the record [s], what, and whether it is a warning."""

    t: float
    words: str
    warning: bool


class Playback:
    """A trial as far as it was played.

    Attributes
    ----------
    prediction_band
        Half-width [SI] about the prediction that holds 95 % of what is measured in a trial that was
        not fitted, by output; empty where the fit does not tell.
    at
        Samples played, counted from the start of the trial.
    furthest
        The most of them, whatever was sought since.
    revised
        The most that a longer log moved a prediction already shown, in deviations of its noise:
        stamps are put right by all of a log, and so is where a held-out trial starts.
    """

    def __init__(
        self,
        fit: Fit,
        trial: Trial,
        bands: Bands,
        growing: bool = False,
        prediction_band: Mapping[str, float] = MappingProxyType({}),
    ) -> None:
        self.fit, self.trial, self.bands, self.growing = fit, trial, bands, growing
        self.prediction_band = prediction_band
        self.stream = Stream(fit.problem.simulator, trial, *of_trial(fit, trial))
        self.monitor = Monitor(bands.of, trial.period, trial.samples)
        self.measured = output_matrix(trial, fit.problem.outputs)
        self.compared = compared_mask(trial, fit.problem.simulator)
        self.at = self.furthest = 0
        self.revised = 0.0
        self._said: dict[tuple[str, float, int], str] = {}

    @property
    def available(self) -> int:
        """Samples that can be played: at a growing end the last few are not settled yet."""
        held = self.stream.open_end if self.growing else 0
        return max(self.trial.samples - held, 0)

    @property
    def residual(self) -> Vector:
        """Measured less predicted [SI], NaN where not compared or not yet played; (N, n_y)."""
        return np.where(self.compared, output_error(self.measured, self.stream.y), np.nan)

    def inside(self, start: float = 0.0) -> dict[str, float]:
        """Share of what was compared and played from a time [s] on within the prediction's band."""
        played = slice(round(start / self.trial.period), self.furthest)
        off = np.abs(self.residual[played])
        shares = {}
        for c, output in enumerate(self.fit.problem.outputs):
            known = off[:, c][np.isfinite(off[:, c])]
            if output in self.prediction_band and len(known):
                shares[output] = float(np.mean(known <= self.prediction_band[output]))
        return shares

    @one_thread
    def go_to(self, samples: int) -> None:
        """Play or seek until so many samples are played; the numbers do not depend on the way."""
        self.at = min(max(samples, 0), self.available)
        first = self.stream.at
        self.stream.advance(self.at)
        if self.stream.departure is None and self.at > self.monitor.at:
            low = max(min(first, self.monitor.at) - self._reach, 0)
            eps = np.zeros((self.at, len(self.bands.of)))
            eps[low:] = output_error(self.measured[low : self.at], self.stream.y[low : self.at])
            self.monitor.advance(eps, self.compared, self.at)
        self.furthest = max(self.furthest, self.at)

    def grown(self, trial: Trial, growing: bool) -> "Playback":
        """The same of a longer reading of the log, played as far."""
        longer = Playback(self.fit, trial, self.bands, growing, self.prediction_band)
        longer.stream.take_over(self.stream)
        longer.go_to(self.furthest)
        longer.go_to(self.at)
        longer.revised = max(self.revised, self._moved(longer))
        return longer

    def _moved(self, longer: "Playback") -> float:
        """The largest difference of two predictions of the same samples, in deviations."""
        n = min(self.furthest, longer.furthest)
        sigma = np.array([band.sigma or np.inf for band in self.bands.of])
        apart = np.abs(longer.stream.y[:n] - self.stream.y[:n]) / sigma
        return float(np.nanmax(apart, initial=0.0))

    def doing(self, samples: int) -> str:
        """What the ship was doing in the last seconds before a sample."""
        n = max(min(samples, self.stream.at), 1)
        so_far = self._so_far(n)
        back = max(round(LOOK_BACK * so_far.time_scale / self.trial.period), 1)
        return ship_activity(so_far, slice(n - back, n)) if n >= back else "the record begins"

    def events(self, start: float = 0.0) -> list[Event]:
        """Alarms and their ends from a time [s] on, as far as the record was played."""
        found = []
        for alarm in self.monitor.alarms:
            over = np.inf if alarm.over is None else alarm.over
            if over >= start:
                found.append(Event(alarm.raised, self._words(alarm), True))
            if start <= over < np.inf:
                found.append(Event(over, f"{alarm.output} is back in its noise band", False))
        gone = self.stream.departure
        if gone is not None:
            found.append(Event(gone.t, f"simulation: {gone}; no prediction from here on", True))
        return sorted(found, key=lambda event: event.t)

    @property
    def _reach(self) -> int:
        return max(len(band.whitening) for band in self.bands.of)

    def _words(self, alarm: Alarm) -> str:
        """An alarm in words, which do not change once it is raised."""
        key = (alarm.output, alarm.raised, alarm.side)
        if key not in self._said:
            self._said[key] = self._put(alarm)
        return self._said[key]

    def _put(self, alarm: Alarm) -> str:
        what = self.doing(round(alarm.raised / self.trial.period) + 1)
        way = "above" if alarm.side > 0 else "below"
        return (
            f"{alarm.output} left its noise band at {alarm.since:.1f} s, measured {way} predicted "
            f"(sure at {alarm.raised:.1f} s): {what}"
        )

    def _so_far(self, n: int) -> Leftover:
        """The record up to a sample, as the report's words take it."""
        trial, y_rms = self.trial, self.fit.problem.y_rms
        signals = {name: x[:n] for name, x in trial.signals.items()}
        valid = {name: x[:n] for name, x in trial.valid.items()}
        cut = Trial(trial.name, trial.use, trial.period, signals, valid)
        compared = self.compared[:n]
        eps = np.where(compared, output_error(self.measured[:n], self.stream.y[:n]) / y_rms, 0.0)
        part = Residual(cut, eps, compared, self.stream.y[:n] / y_rms)
        return Leftover(self.fit, (part,), eps, compared, (slice(0, n),))
