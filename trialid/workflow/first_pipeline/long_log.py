"""Manoeuvres in a long log: each a trial of its own, so that harbour and passage are not fitted.

A log as long that holds no two of them, a passage under an autopilot, is begun with the stretches
in which she is steered most: the rest of it would say the same again. A log in which the recorder
paused between its manoeuvres is as many trials as it has parts.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from trialid.alignment.held_roll import held_roll, released_at
from trialid.alignment.input_gaps import LENGTHS, recorded_parts
from trialid.arrays import Vector
from trialid.design.imo.excursions import rudder_of
from trialid.design.imo.recognise import recognise
from trialid.design.imo.recognition import Recognised
from trialid.errors import TrialidError, list_names
from trialid.inspection.inspected import Inspection
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

STRETCH: Final = 90.0
"""Ship lengths of a stretch without a manoeuvre: what one is given. A day of a 96 m ferry at 15 kn
has 6800, of which the fit then reads 720; with half of it 360, with twice 1440."""

UNDER_WAY: Final = 0.5
"""Share of the approach speed that a ship makes all through such a stretch: less is harbour."""

PAUSE: Final = LENGTHS
"""Ship lengths without any record that part a log in two: as long as what steers her may be unknown
within a trial."""

PART: Final = 15.0
"""Ship lengths that such a part has at least. By reason, not by count: a sixth of what a standard
manoeuvre is given, in which a rudder goes over once or twice; of a boat of 3 m at 1.3 m/s 35 s."""
PAUSED: Final = "recorded without a pause"

KNOWN: Final = 0.9
"""Share of a stretch in which every signal was measured."""

ANGLES: Final = 5.0
"""[deg] Steps in which rudder angles are ordered: within one they are the same manoeuvre again."""


@dataclass(frozen=True, kw_only=True)
class Window:
    """A stretch of a log [s] in which she was put through something, and how far she was steered.

    `travel` and `variation` [rad] are of the rudder: its greatest angle and its mean, and its
    standard deviation; of the roll, where no rudder is. `why` says what else it is than a
    manoeuvre: that she was held before, with an empty `kind`, or that the recorder paused.
    `beside` says which manoeuvres of its log are no trials, and why.
    """

    kind: str
    begin: float
    end: float
    travel: float
    variation: float
    why: str = ""
    beside: str = ""


def window_over(
    moved: Vector, begin: float, end: float, *, kind: str = "", why: str = ""
) -> Window:
    """The window [s] over which the rudder, or the roll where none is, `moved` so [rad]; (n,)."""
    return Window(
        kind=kind,
        begin=begin,
        end=end,
        travel=float(np.max(np.abs(moved)) + np.abs(np.mean(moved))),
        variation=float(np.std(moved)),
        why=why,
    )


Windows = tuple[tuple[Window, ...], ...]
"""Of each log; empty where it is a trial as it is."""


def manoeuvre_windows(pipeline: Pipeline, surveys: Sequence[Inspection]) -> Windows:
    """The manoeuvres in each log of a pipeline that has just been begun, or its swing when let go.

    Logs that are short and without a pause are not read where they hold no roll; one that cannot be
    has none, and the run says why.
    """
    assert pipeline.ship is not None  # a pipeline is begun with a ship
    particulars = read_ship(pipeline.ship).particulars
    length, speed = (particulars[n] for n in ("L", "U0"))

    def of_log(section: TrialSection, survey: Inspection) -> tuple[Window, ...]:
        paused = _paused(survey, PAUSE * length / speed)
        if not paused and survey.duration < LONG * length / speed and "phi" not in section.signals:
            return ()
        try:
            trial = align_trial(pipeline, section)
            return windows_of(trial, length, speed) or _let_go(trial)
        except TrialidError:
            return ()

    return tuple(map(of_log, pipeline.trials, surveys))


def _paused(survey: Inspection, longest: float) -> bool:
    """Whether nothing that moves was recorded without a hole of more than that [s]."""
    moving = [one for one in survey.channels.values() if not one.constant]
    return bool(moving) and all(one.gaps.longest > longest for one in moving)


def windows_of(trial: Trial, length: float, speed: float) -> tuple[Window, ...]:
    """The manoeuvres of a long trial in the order of time, those that are whole.

    Where it is short or mostly theirs its parts between pauses, none where there is no pause. Where
    there is but one manoeuvre nothing could be held out: then the parts, or the stretches in which
    she is steered most, none where they would be most of the trial.

    Parameters
    ----------
    length, speed
        Of the ship [m] and of her approach [m/s]: her own clock.
    """
    rudder = rudder_of(trial)
    if rudder is None:
        return ()
    parts = _between_pauses(trial, rudder, length / speed)
    if trial.duration < LONG * length / speed:
        return parts
    found = recognise(trial, length, speed)
    steered = [m for m in found if m.kind != "stop"]
    every = _apart(steered, length / speed / trial.period, trial.samples)
    whole = [span for span in every if any(not m.remark for m in span.parts)]
    spans = [span for span in whole if not _lacking(trial, span)]
    taken = sum(span.end - span.begin for span in spans)
    if taken > MOSTLY * trial.samples:
        return parts
    if len(spans) < 2:
        stretch = round(STRETCH * length / speed / trial.period)
        return parts or _steered_most(trial, rudder, stretch, speed)
    first, *more = (_manoeuvre(trial, rudder, span) for span in _first_of_each(spans))
    return (replace(first, beside=_left_out(trial, whole)), *more)


def _between_pauses(trial: Trial, rudder: Vector, clock: float) -> tuple[Window, ...]:
    """The parts of a log in which the recorder paused, those that are no scraps.

    At most `FEW`, those in which the rudder varies most; none where there is but one.
    """
    parts = recorded_parts(trial, PAUSE * clock)
    least = PART * clock / trial.period
    able = [(begin, end) for begin, end in parts if end - begin >= least]
    most = sorted(able, key=lambda ends: -float(np.std(rudder[slice(*ends)])))[:FEW]
    found = (_window(trial, rudder, ends, "part") for ends in sorted(most))
    return tuple(replace(one, why=PAUSED) for one in found) if len(able) > 1 else ()


def _let_go(trial: Trial) -> tuple[Window, ...]:
    """What follows a heel that is held, where she is let go from one."""
    if (held := held_roll(trial)) is None:
        return ()
    steered = rudder_of(trial)
    moved = trial.signals.get("phi", np.zeros(1)) if steered is None else steered
    begin, end = released_at(trial, held), trial.opening + trial.duration
    why = f"from where she is let go: {held.stands(trial)}"
    return (window_over(moved[held.release :], begin, end, why=why),)


@dataclass(frozen=True)
class Span:
    """Manoeuvres that follow at once, and the samples of all of it; `end` is one past the last."""

    parts: tuple[Recognised, ...]
    begin: int
    end: int


def _lacking(trial: Trial, span: Span) -> tuple[str, ...]:
    """Signals that are not measured in a manoeuvre, as of a sensor that died on the way."""
    known = {n: float(ok[span.begin : span.end].mean()) for n, ok in trial.valid.items()}
    return tuple(n for n, share in known.items() if share < KNOWN)


def _left_out(trial: Trial, spans: Sequence[Span]) -> str:
    """Which manoeuvres are left out as a signal is not measured in them; else nothing."""
    lost = [(round(span.begin * trial.period), _lacking(trial, span)) for span in spans]
    lost = [(at, names) for at, names in lost if names]
    if not lost:
        return ""
    begins = list_names([f"{at}" for at, _ in lost])
    names = list_names(list(dict.fromkeys(n for _, some in lost for n in some)))
    return f"the manoeuvres from {begins} s on, in which {names} is not measured throughout"


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


def _manoeuvre(trial: Trial, rudder: Vector, span: Span) -> Window:
    first = span.parts[0]
    return _window(trial, rudder, (span.begin, span.end), first.kind, first.rudder)


def _window(
    trial: Trial, rudder: Vector, ends: tuple[int, int], kind: str, angle: float | None = None
) -> Window:
    """With the angle of its order; without one that of the rudder at its farthest."""
    part = rudder[slice(*ends)]
    most = np.max(np.abs(part)) if angle is None else abs(angle)
    begin, end = (place * trial.period for place in ends)
    return window_over(part, begin, end, kind=f"{kind} {np.rad2deg(most):.0f}")


def _steered_most(trial: Trial, rudder: Vector, samples: int, speed: float) -> tuple[Window, ...]:
    """At most `FEW` stretches of so many samples, those in which the rudder varies most."""
    if FEW * samples > MOSTLY * trial.samples:
        return ()
    known = np.all([*trial.valid.values()], axis=0)
    if (ahead := trial.signals.get("u")) is not None:
        known &= ahead > UNDER_WAY * speed
    begins = range(0, trial.samples - samples + 1, samples)
    able = [at for at in begins if known[at : at + samples].mean() >= KNOWN]
    most = sorted(able, key=lambda at: -float(np.std(rudder[at : at + samples])))[:FEW]
    found = [_window(trial, rudder, (at, at + samples), "steered") for at in sorted(most)]
    return tuple(one for one in found if one.variation > 0.0)
