"""A simulated motion with where it is likely to lie, and numbers read from it with theirs."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from trialid.alignment.signal_limits import LIMITS
from trialid.arrays import Vector
from trialid.design.helm import OVER_GROUND, Vessel, track
from trialid.design.imo.measure_slopes import SMALL
from trialid.design.imo.speed_loss import logged_loss
from trialid.design.prediction.likely_spread import LikelySpread, Range
from trialid.names.quantities import SIGNALS, Quantity
from trialid.ship.actuators import actuator_quantities
from trialid.ship.quantity_of import quantity_of
from trialid.simulation.integrate import Departure
from trialid.trial import Trial

MOST: Final = 400
"""Times at which ranges are worked out; between them their ends go straight."""
NEARLY: Final = 0.01
"""Share of all its way within which a gear is at its farthest. Half of it says the same of a lag of
0.1 s and of a gear that overshoots, twice leaves less than 0.7 of what the second is unknown by."""
TRACK: Final = ("x", "y")
"""Ahead of and to starboard of where the ship began, along her first course [m]."""

Read = Callable[[Vector, Mapping[str, Vector]], dict[str, float]]
"""Numbers by name of times [s] and signals; those it does not come to are left out."""

OVER_GROUND_SPEED: Final = "drift_in_speed_record"
"""What reads the drift out of a speed."""


@dataclass(frozen=True, kw_only=True)
class PredictedMotion:
    """Signals of a manoeuvre [SI], and where each is likely to lie.

    Attributes
    ----------
    given
        Orders, rudder and other inputs; a speed as it was sailed; (N,) each.
    motion
        Simulated motions and the track; (N,) each.
    ranges
        Lower and upper end at 95 %, by name of a motion; (N,) each.
    quantities
        What orders and motions are, by name.
    numbers
        Standard numbers by name, each with its range; None where nobody knows.
    remark
        Why there are not all numbers; empty where there are.
    departure
        Where the ship left the domain of her model; everything ends before, a stop long before.
    """

    t: Vector
    given: Mapping[str, Vector]
    motion: Mapping[str, Vector]
    ranges: Mapping[str, tuple[Vector, Vector]]
    quantities: Mapping[str, Quantity] = field(default_factory=dict)
    numbers: Mapping[str, tuple[float, Range | None]] = field(default_factory=dict)
    remark: str = ""
    departure: Departure | None = None

    @property
    def ended_by_departure(self) -> bool:
        """Whether it ends where she left her model's domain, and not before as a stop may."""
        step = float(np.diff(self.t[-2:]).sum())
        return self.departure is not None and self.departure.t <= float(self.t[-1]) + 2.0 * step


def with_ranges(
    ship: Vessel, trial: Trial, by: Vector, spread: LikelySpread, band: Mapping[str, float]
) -> PredictedMotion:
    """The signals of a trial with their ranges, from slopes of the outputs; (N, n_y, n)."""
    outputs, n = ship.simulator.outputs, trial.samples
    speed = ship.model.ship.particulars["U0"]
    signals = dict(trial.signals)
    signals |= dict(zip(TRACK, _track(trial.t, signals, speed), strict=True))
    places = np.unique(np.linspace(0, n - 1, min(n, MOST)).round().astype(int))
    way = _slopes(
        lambda now: np.column_stack(_track(trial.t, now, speed)), trial, outputs, by, speed
    )
    rows = np.concatenate([by, way], axis=1)
    names = (*outputs, *TRACK)
    values = np.column_stack([signals[c] for c in names])
    known = spread.ranges(values[places].ravel(), rows[places].reshape(-1, rows.shape[-1]))
    ends = np.array([r or (np.nan, np.nan) for r in known]).reshape(len(places), len(names), 2)
    ranges = {}
    for c, name in enumerate(names):
        wide = band.get(name, 0.0)
        low, high = (
            np.interp(np.arange(n), places, ends[:, c, i] - values[places, c]) for i in (0, 1)
        )
        lower, upper = np.minimum(low, -wide), np.maximum(high, wide)
        ranges[name] = _possible(name, signals, (lower, upper))
    named = {*SIGNALS, *actuator_quantities(ship.model.ship.actuators)}
    given = [n for n in trial.signals if n in named and n not in (*names, *OVER_GROUND)]
    return PredictedMotion(
        t=trial.t,
        given={n: _as_sailed(ship, n, trial.signals) for n in given},
        motion={n: signals[n] for n in names},
        ranges=ranges,
        quantities={n: quantity_of(ship.model, n) for n in (*given, *outputs)},
    )


def _possible(
    name: str, signals: Mapping[str, Vector], off: tuple[Vector, Vector]
) -> tuple[Vector, Vector]:
    """A range as far as a number of this kind can be at all, the motion always in it.

    What follows an order goes no farther than the order or itself, but for what it is off by there:
    by its slope alone a quick rudder that is put over at an instant nobody knows well would stand
    at 90 deg.
    """
    motion = signals[name]
    lower, upper = (motion + end for end in off)
    if (limit := LIMITS.get(name)) is not None:
        lower = np.maximum(lower, np.minimum(motion, limit.low))
        upper = np.minimum(upper, np.maximum(motion, limit.high))
    if (order := signals.get(f"{name}_order")) is not None:
        lower = np.maximum(lower, -_farthest(-motion, -order, -off[0]))
        upper = np.minimum(upper, _farthest(motion, order, off[1]))
    return lower, upper


def _farthest(motion: Vector, order: Vector, off: Vector) -> float:
    """Where what follows an order may be at most: by what is known of it where it is farthest."""
    low, high = np.nanmin(motion), np.nanmax(motion)
    there = off[motion >= high - NEARLY * (high - low)]
    known = there[np.isfinite(there)]
    beyond = float(np.median(known)) if len(known) else np.inf
    return float(max(high, np.nanmax(order)) + beyond)


def _as_sailed(ship: Vessel, name: str, signals: Mapping[str, Vector]) -> Vector:
    """An input as the ship has it: the speed without what turns have cost, where that was added.

    So her own model, which reads a speed and loses none of it, does the same of what is written;
    one that reads a speed over ground is given it with the drift.
    """
    acting = {e.name for e in ship.model.effects}
    if name != "u" or logged_loss.name not in acting:
        return signals[name]
    if OVER_GROUND_SPEED in acting:
        return signals["U"]
    sway = signals.get("v", np.zeros_like(signals["U"]))
    return np.asarray(np.sqrt(np.maximum(signals["U"] ** 2 - sway**2, 0.0)))


def _track(t: Vector, signals: Mapping[str, Vector], speed: float) -> tuple[Vector, Vector]:
    """The track from where the ship began, along her first course."""
    turned = {**signals, "psi": signals["psi"] - signals["psi"][0]}
    return track(t, turned, speed)


def _slopes(
    of: Callable[[Mapping[str, Vector]], Vector],
    trial: Trial,
    outputs: tuple[str, ...],
    by: Vector,
    speed: float,
) -> Vector:
    """Slopes of what follows from signals, by moving what is simulated a little to each side."""
    found = np.zeros((*of(trial.signals).shape, by.shape[-1]))
    scales = np.array([max(speed, SMALL) if c in ("u", "v", "U") else 1.0 for c in outputs])
    sizes = np.max(np.abs(by) / scales[:, None], axis=(0, 1))
    for i in np.flatnonzero(sizes):
        step = SMALL / sizes[i]
        ends = []
        for side in (step, -step):
            moved = dict(trial.signals)
            moved |= {c: moved[c] + side * by[:, k, i] for k, c in enumerate(outputs)}
            ends.append(of(moved))
        found[..., i] = (ends[0] - ends[1]) / (2.0 * step)
    return found


def read_numbers(
    read: Read, ship: Vessel, trial: Trial, by: Vector, spread: LikelySpread
) -> dict[str, tuple[float, Range | None]]:
    """Numbers of a motion with their ranges."""
    speed = ship.model.ship.particulars["U0"]

    def now(signals: Mapping[str, Vector]) -> dict[str, float]:
        way = dict(zip(TRACK, _track(trial.t, signals, speed), strict=True))
        return read(trial.t, {**signals, **way})

    values = now(trial.signals)

    def again(moved: Mapping[str, Vector]) -> Vector:
        found = now(moved)
        return np.array([found.get(n, x) for n, x in values.items()])

    slopes = _slopes(again, trial, ship.simulator.outputs, by, speed)
    ends = spread.ranges([*values.values()], slopes) if values else []
    return {n: (x, r) for (n, x), r in zip(values.items(), ends, strict=True)}
