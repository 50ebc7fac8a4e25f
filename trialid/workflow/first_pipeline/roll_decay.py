"""Logs of a ship that is let go from a heel and not steered: a pipeline for her roll alone.

Nothing there tells a rudder's side, nor does any yaw: what moves her is her own righting moment,
and what the swings lose is her damping.
"""

import dataclasses
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.alignment.held_roll import NOISE, STEERED, course_span, noise_of
from trialid.arrays import Vector
from trialid.inspection.drives import drives_of
from trialid.inspection.inspected import Inspection
from trialid.inspection.usual_units import to_si
from trialid.names.quantities import SIGNALS
from trialid.ship.particulars import Ship
from trialid.toml_text import array
from trialid.workflow.first_pipeline.choice import (
    RUDDERS,
    Live,
    approach_speed,
    choose_speed,
    live_sources,
    plain_signal,
)
from trialid.workflow.first_pipeline.chosen import Chosen, Signal
from trialid.workflow.first_pipeline.free_lines import free_lines
from trialid.workflow.first_pipeline.long_log import Window, window_over

SWINGS: Final = 4
"""Half swings that tell a decay, each less than the one before. All of 300 drawn decays have them,
damped by 0.02 to 0.15 of what is critical, and 2 of 165 zig-zags and turns whose rudder and yaw
were hidden. Half of it does not tell where the swings die out to, twice of it misses 39."""

SEEN: Final = 0.05
"""Share of the greatest swing above which one counts. Of those decays half of it misses 3, and
twice of it takes 4 of the zig-zags."""

GROWS: Final = 1.1
"""Times the swing before it that one may be, beside `SEEN`: noise adds to it. Of those decays half
of it takes 4, and twice of it takes 6 of the zig-zags."""

DIES: Final = 0.5
"""Share of the first swing that the last may have. Of those decays half of it misses 7, and twice
of it takes 14 of the zig-zags."""

TURNS: Final = float(np.deg2rad(30.0))
"""[rad] What she turns through at most while she swings: a course that nobody keeps. Of models of
5 m let go under way half of it would do, and twice of it is the first part of a turn."""

AS_STATED: Final = "as stated; 0 where she rolled at rest"

FROUDE: Final = 0.02
"""Of what a log of a ship at rest holds as her speed, over sqrt(g L): 0.14 m/s of 5 m, where it
held 0.01 of noise. Half of it would do there, with twice of it a ship of 100 m makes 2.4 knots."""


def decays_among(
    surveys: Sequence[Inspection],
    stated: float | None,
    length: float | None,
    own: Ship | None = None,
) -> list[Chosen]:
    """Each log as a trial of her roll alone; nothing where one of them is something else.

    Parameters
    ----------
    stated
        The user's word for the speed [m/s], where no log tells it.
    length, own
        Of the ship [m], or her file, where it is known: it tells what is at rest.
    """
    if not all(map(_is_decay, surveys)):
        return []
    known = length if own is None else own.particulars.get("L")
    rest = FROUDE * float(np.sqrt(9.81 * (known or 1.0)))
    return [_choose(one, stated, rest) for one in surveys]


def is_of_decays(trials: Sequence[Chosen]) -> bool:
    """Whether trials are those of `decays_among`."""
    return all(one.quantity in ("phi", "u") for trial in trials for one in trial.signals)


def _is_decay(survey: Inspection) -> bool:
    live = {name: live_sources(survey, name) for name in SIGNALS}
    rolls = live.get("phi")
    if not rolls or len(drives_of(survey)) == 2:
        return False
    steered = [plain_signal(name, live, "") for name in RUDDERS if live[name]]
    still = all(_span(one) <= STEERED for one in steered)
    return still and _turned(live) <= TURNS and _decay(rolls[0].sketch.y) is not None


def _span(signal: Signal) -> float:
    """How far an angle goes beside its noise [rad]; of an unknown unit at most, in radians."""
    size = None if signal.source.angle else to_si(signal.unit or "", "rad")
    return course_span(signal.source.sketch.y) * (size or 1.0)


def _turned(live: Live) -> float:
    """Angle that she turns through [rad], by the heading, else by its rate; 0 where none is."""
    if live.get("psi"):
        return _span(plain_signal("psi", live, ""))
    if not live.get("r"):
        return 0.0
    rate = plain_signal("r", live, "")
    size = to_si(rate.unit or "", "rad/s")
    course = rate.source.sketch
    turned = np.cumsum(course.y[1:] * np.diff(course.t) / 1e9)
    return float(np.max(np.abs(turned), initial=0.0)) * (size or 1.0)


@dataclasses.dataclass(frozen=True)
class _Decay:
    """Swings that die out: the sample of the greatest, how many samples a period has."""

    begin: int
    period: float


def _decay(roll: Vector) -> _Decay | None:
    """Swings that die out about a heel; None of anything else.

    What comes before the greatest is none of hers: she is rolled by hand until she swings.
    """
    if len(roll) < 4 * SWINGS:
        return None
    first, _ = _swings(roll, float(np.median(np.array_split(roll, 3)[-1])))
    if len(first) < SWINGS:
        return None
    before, middle, after = roll[first[-3:]]  # what they die by cancels to the second order
    rest = float(before + 2.0 * middle + after) / 4.0
    ends, turns = _swings(roll, rest)
    size = SEEN * float(np.max(np.abs(roll - rest)))
    every = np.abs(roll[ends] - rest)
    free = int(np.argmax(every)) if len(every) else 0
    swings = every[free:].tolist()
    if len(swings) < SWINGS or swings[-1] > DIES * swings[0]:
        return None
    if any(b > GROWS * a + size for a, b in pairwise(swings)):
        return None
    return _Decay(int(ends[free]), 2.0 * float(np.median(np.diff(turns[free:]))))


def _swings(roll: Vector, rest: float) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Samples at which each half swing about a heel ends, and at which another begins."""
    off = roll - rest
    least = max(SEEN * float(np.max(np.abs(off))), NOISE * noise_of(roll))
    at = np.flatnonzero(np.abs(off) > least)
    turns = np.flatnonzero(np.diff(np.sign(off[at]))) + 1
    parts = [part for part in np.split(at, turns) if len(part)]
    ends = [part[np.argmax(np.abs(off[part]))] for part in parts]
    return np.array(ends, dtype=np.intp), at[turns]


def roll_period(trials: Sequence[Chosen]) -> float:
    """Of small rolls [s], the shortest of all logs."""
    rolls = [trial.signals[0].source.sketch for trial in trials]
    found = [(_decay(one.y), float(np.median(np.diff(one.t))) / 1e9) for one in rolls]
    return min(decay.period * step if decay else 0.0 for decay, step in found)


def _rolled_by_hand(trial: Chosen) -> Window | None:
    """What follows the greatest swing, where she is rolled up to it; None where it is the first."""
    roll = trial.signals[0]
    seen, size = roll.source.sketch, to_si(roll.unit or "", "rad") or 1.0
    decay = _decay(seen.y)
    if decay is None or decay.begin < decay.period:
        return None
    begin, end = (float(seen.t[at] - seen.t[0]) / 1e9 for at in (decay.begin, -1))
    why = "her greatest swing; before it she is at rest, or rolled by hand"
    return window_over(size * seen.y[decay.begin :], begin, end, why=why)


def _choose(survey: Inspection, stated: float | None, rest: float) -> Chosen:
    """Her roll, and the speed where she makes any; what else the log holds is left out."""
    live = {name: live_sources(survey, name) for name in SIGNALS}
    roll = plain_signal("phi", live, "she swings and is not steered: her roll alone is fitted")
    speed, words = approach_speed(survey, live, None)
    trial = Chosen(survey=survey, path=survey.path, signals=(roll,), speed=speed, speed_words=words)
    trial = dataclasses.replace(trial, window=_rolled_by_hand(trial))
    if speed is None:
        said = "CAREFUL: no log tells a speed, read as at rest; write hers where she made way"
        return dataclasses.replace(
            trial, speed=stated or 0.0, speed_words=AS_STATED if stated else said
        )
    if speed < rest:
        return dataclasses.replace(trial, speed=0.0, speed_words=f"at rest, by {words}")
    ahead = choose_speed(survey, live, speed, words)
    return dataclasses.replace(trial, signals=(roll, *([ahead] if ahead else [])))


def decay_model(trials: Sequence[Chosen], ship: Ship) -> Iterator[str]:
    """Lines of `[model]` and `[identify]`."""
    rests, sails = (any((t.speed == 0.0) is at_rest for t in trials) for at_rest in (True, False))
    effects = ["linear_roll", *(["still_water_roll_damping"] if rests else [])]
    free = [*(["Kp"] if sails else []), *(["Kp0"] if rests else []), "GM"]
    yield "[model]"
    yield 'states = ["p", "phi"]  # her roll alone: the sway and yaw that go with it are small'
    yield f"effects = {array(effects)}  # `trialid effects` lists what there is"
    yield ""
    yield "[identify]"
    if rests:
        yield "# Kp grows with her speed; at rest Kp0 damps her."
    yield from free_lines(free, ship)
    yield 'outputs = ["phi"]'
    yield 'nuisance = ["initial_state", "bias"]  # of each trial, estimated too'
