"""What the trials of a fit hold of every input and motion: beyond it a model is a guess."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.identification.fit import Fit
from trialid.identification.trial_score import Score
from trialid.names import labels
from trialid.ship.actuators import actuator_quantities
from trialid.ship.particulars import Ship
from trialid.simulation.integrate import record_for

ENDLESS: Final = frozenset({"psi", "t"})
"""Where a ship heads and since when says nothing of how she moves."""
ROOM: Final = 0.02
"""Share of a value that nobody calls outside: a rudder of 20.3 deg is one of 20 deg."""


@dataclass(frozen=True)
class SeenRange:
    """Smallest and largest value seen [SI]; the same to both sides where the ship is the same."""

    low: float
    high: float

    def excess(self, values: Vector) -> float:
        """The value farthest outside; nan where none is."""
        room = ROOM * max(abs(self.low), abs(self.high))
        low, high = float(np.nanmin(values)), float(np.nanmax(values))
        beyond = [(high - self.high, high), (self.low - low, low)]
        far, value = max(beyond)
        return value if far > room else float("nan")

    def holds(self, value: float) -> bool:
        """Whether a value is one of those seen, or as good as."""
        return not np.isfinite(self.excess(np.array([value])))


def seen_ranges(fit: Fit) -> dict[str, SeenRange]:
    """By name what the fitted trials hold: inputs as recorded, motions as the model makes them.

    What a rudder or a ship does to one side tells what it does to the other.
    """
    found: dict[str, list[Vector]] = {}
    for score in (s for s in fit.scores if s.trial.use == "fit"):
        for name, values in _of_trial(fit, score):
            kept = values[np.isfinite(values)]
            if len(kept):
                found.setdefault(name, []).append(kept)
    own = actuator_quantities(fit.model.ship.actuators)
    return {
        name: _range((own.get(name) or labels.quantity(name)).mirror, np.concatenate(parts))
        for name, parts in found.items()
    }


def _of_trial(fit: Fit, score: Score) -> Iterable[tuple[str, Vector]]:
    equations, trial = fit.problem.simulator.equations, score.trial
    for name in (n for n in equations.inputs if n not in ENDLESS):
        source = record_for(trial, name)
        if source is not None:
            valid = trial.valid.get(source, np.ones(trial.samples, dtype=bool))
            yield name, trial.signals[source][valid]
        elif name == "u":
            yield name, np.array([fit.model.ship.particulars["U0"]])
    for name, column in zip(equations.states, score.response.states.T, strict=True):
        if name not in ENDLESS:
            yield name, column


def _range(mirror: int, values: Vector) -> SeenRange:
    low, high = float(values.min()), float(values.max())
    if mirror < 0:
        high = max(abs(low), abs(high))
        low = -high
    return SeenRange(low, high)


def beyond_words(ship: Ship, seen: Mapping[str, SeenRange], signals: Mapping[str, Vector]) -> str:
    """What leaves the range that was seen of a ship, in a sentence; empty where nothing does."""
    words, own = [], actuator_quantities(ship.actuators)

    def shown(name: str, value: float) -> str:
        known = own.get(name)
        return labels.command_text(known, value) if known else labels.shown_text(name, value)

    if "U" in signals:  # the speed ahead as it acts, whatever is given
        sway = signals.get("v", np.zeros_like(signals["U"]))
        signals = {**signals, "u": np.sqrt(np.maximum(signals["U"] ** 2 - sway**2, 0.0))}
    for name, known in seen.items():
        if name in signals and np.isfinite(signals[name]).any():
            value = known.excess(signals[name])
            if np.isfinite(value):
                at, low, high = (shown(name, x) for x in (value, known.low, known.high))
                words.append(f"{labels.label(name)} {at} (there {low} to {high})")
    if not words:
        return ""
    listed = ", ".join(words)
    held = "what the trials hold, motions as the model simulates them"
    return f"Beyond {held}, where a model and its ranges are a guess: {listed}."
