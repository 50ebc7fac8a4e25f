"""Manoeuvres in a long log: each a trial of its own, so that harbour and passage are not fitted."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.design.imo.excursions import rudder_of
from trialid.design.imo.recognise import recognise
from trialid.design.imo.recognition import Recognised
from trialid.errors import TrialidError
from trialid.pipeline_file import Pipeline, TrialSection
from trialid.ship.particulars import read_ship
from trialid.trial import Trial
from trialid.workflow.read_trials import align_trial

LONG: Final = 180.0
"""Ship lengths that are sailed in a log that is looked through: a standard manoeuvre is given 90.
Of thirty simulated days of 156 to 535 lengths 17 are cut, and 65 of their 66 windows hold
manoeuvres whole; with half of it 19 are, 71 of 72, with twice 3, all of 14."""

BEFORE, AFTER = 2.0, 1.0
"""Ship lengths of straight course that belong to a manoeuvre: where her motion starts is seen."""

MOSTLY: Final = 0.5
"""Share of a log that its manoeuvres may take: what is mostly manoeuvre is one trial. With half of
it none of those days is cut, with twice 25, 107 of 110 windows."""

FEW: Final = 8
"""Manoeuvres that a pipeline begins with, the first of each kind and angle first: what a fit learns
from a ninth it has mostly seen."""


ANGLES: Final = 5.0
"""[deg] Steps in which rudder angles are ordered: within one they are the same manoeuvre again."""


@dataclass(frozen=True)
class Window:
    """A stretch of a log [s] in which she was put through something, and how far she was steered.

    `travel` and `variation` [rad] are of the rudder: its greatest angle and its mean, and its
    standard deviation.
    """

    kind: str
    begin: float
    end: float
    travel: float
    variation: float


Windows = tuple[tuple[Window, ...], ...]
"""Of each log; empty where it is a trial as it is."""


def manoeuvre_windows(pipeline: Pipeline, durations: Sequence[float]) -> Windows:
    """The manoeuvres in each log of a pipeline that has just been begun.

    Logs of `durations` [s] that are short are not read; one that cannot be has none, and the run
    says why.
    """
    assert pipeline.ship is not None  # a pipeline is begun with a ship
    particulars = read_ship(pipeline.ship).particulars
    length, speed = (particulars[n] for n in ("L", "U0"))

    def of_log(section: TrialSection, duration: float) -> tuple[Window, ...]:
        if duration < LONG * length / speed:
            return ()
        try:
            return windows_of(align_trial(pipeline, section), length, speed)
        except TrialidError:
            return ()

    return tuple(map(of_log, pipeline.trials, durations))


def windows_of(trial: Trial, length: float, speed: float) -> tuple[Window, ...]:
    """The manoeuvres of a long trial in the order of time, those that are whole.

    None where it is short or mostly theirs, and where there is but one: nothing could be held out.

    Parameters
    ----------
    length, speed
        Of the ship [m] and of her approach [m/s]: her own clock.
    """
    rudder = rudder_of(trial)
    if rudder is None or trial.duration < LONG * length / speed:
        return ()
    found = recognise(trial, length, speed)
    steered = [m for m in found if m.kind != "stop"]
    every = _apart(steered, length / speed / trial.period, trial.samples)
    spans = [span for span in every if any(not m.remark for m in span.parts)]
    taken = sum(span.end - span.begin for span in spans)
    if len(spans) < 2 or taken > MOSTLY * trial.samples:
        return ()
    return tuple(_window(trial, rudder, span) for span in _first_of_each(spans))


@dataclass(frozen=True)
class Span:
    """Manoeuvres that follow at once, and the samples of all of it; `end` is one past the last."""

    parts: tuple[Recognised, ...]
    begin: int
    end: int


def _apart(found: Sequence[Recognised], clock: float, samples: int) -> list[Span]:
    """Manoeuvres that do not run into each other; `clock` samples make a ship length."""
    spans: list[Span] = []
    for one in found:
        begin = max(one.execute - round(BEFORE * clock), 0)
        end = min(one.end + round(AFTER * clock), samples)
        if spans and begin < spans[-1].end:
            last = spans.pop()
            spans.append(Span((*last.parts, one), last.begin, max(end, last.end)))
        else:
            spans.append(Span((one,), begin, end))
    return spans


def _first_of_each(spans: Sequence[Span]) -> list[Span]:
    """At most `FEW`, the first of each kind and angle before a second; in the order of time."""
    seen = dict[tuple[str, int], int]()
    turns = []
    for span in spans:
        first = span.parts[0]
        kind = (first.kind, round(float(np.rad2deg(first.rudder)) / ANGLES))
        seen[kind] = seen.get(kind, 0) + 1
        turns.append((seen[kind], span.begin, span))
    chosen = [span for _, _, span in sorted(turns, key=lambda turn: turn[:2])[:FEW]]
    return sorted(chosen, key=lambda span: span.begin)


def _window(trial: Trial, rudder: Vector, span: Span) -> Window:
    part, first = rudder[span.begin : span.end], span.parts[0]
    return Window(
        f"{first.kind} {abs(np.rad2deg(first.rudder)):.0f}",
        span.begin * trial.period,
        span.end * trial.period,
        float(np.max(np.abs(part)) + abs(np.mean(part))),
        float(np.std(part)),
    )
