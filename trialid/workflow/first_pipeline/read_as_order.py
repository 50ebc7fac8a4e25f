"""A rudder or a drive that is at its place at once is its order, whatever the log calls it."""

import dataclasses
from collections.abc import Callable, Sequence
from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.diagnosis.records.rudder_jumps import Course, Jump, Steps, jump_of, jump_where
from trialid.inspection.channel_names import ORDERED
from trialid.inspection.name_words import words
from trialid.inspection.own_scale import at_rest
from trialid.names import units
from trialid.workflow.first_pipeline.choice import is_counted
from trialid.workflow.first_pipeline.chosen import OPEN, Chosen, Signal

ORDER_WORDS: Final = ORDERED | {"pwm", "throttle", "servo"}
"""Words of a drive that is an order: what is sent to a motor, never what it makes of it."""
NO_GEAR: Final = "which no ship's gear does (a model's servo may: then call it delta)"
"""Why a rudder that jumps is read as its order."""
LEAST: Final = 0.05
"""Share of the largest drive: jumps less than this are noise. Motors of boats that start from rest
make larger ones, and half or twice of it tells the same of them."""
STILL: Final = 0.02
"""A drive that moves by more than this share of a jump in her next length is on its way yet: of a
motor whose time constant is half a sample as much is left two samples on. With half of it motors
of 0.4 samples are told from orders, with twice those of 0.6."""


def with_orders(trials: Sequence[Chosen], own_time: float, drives: frozenset[str]) -> list[Chosen]:
    """The trials with the order in place of what is fed back, where that of all together jumps.

    Parameters
    ----------
    own_time
        How long the ship takes for her own length [s].
    drives
        Signals of what drives her, beside the rudder.
    """
    rudder = frozenset({"delta"})
    if any(s.quantity == "delta" and is_counted(s) for one in trials for s in one.signals):
        why = _of_drives(trials, rudder, own_time)
    else:
        found = _jump(trials, rudder, lambda courses: jump_of(courses, own_time))
        why = f"it {found}, {NO_GEAR}" if found else ""
    ordered = _read_as(trials, rudder, why)
    return _read_as(ordered, drives, _of_drives(trials, drives, own_time))


def _of_drives(trials: Sequence[Chosen], drives: frozenset[str], own_time: float) -> str:
    """Why drives are orders; empty where they may be what the motors do."""
    ones = [s for one in trials for s in one.signals if s.quantity in drives]
    told = {word for one in ones for word in words(one.source.name)}
    if found := sorted(ORDER_WORDS & told):
        return f"an order by its name ({found[0]})"

    def whole(t: Vector, y: Vector) -> Steps:
        return stays(t, y, own_time)

    jump = _jump(trials, drives, lambda courses: jump_where(courses, whole, LEAST))
    if jump is None:
        return ""
    return f"it {dataclasses.replace(jump, shown='% of its largest')}, which no motor does"


def stays(t: Vector, y: Vector, own_time: float) -> Steps:
    """Which steps are made whole within two samples, and held while she goes her length."""
    held = np.zeros(max(len(t) - 1, 0), np.bool_)
    for k in np.flatnonzero(np.abs(np.diff(y)) > LEAST):
        after = y[k + 2 : np.searchsorted(t, t[k + 1] + own_time)]
        held[k] = len(after) > 0 and np.ptp(after) <= STILL * abs(y[k + 1] - y[k])
    return held


def _jump(
    trials: Sequence[Chosen],
    names: frozenset[str],
    jump: Callable[[list[Course]], Jump | None],
) -> Jump | None:
    """How the signals of these names jump; None where not every trial has one of them.

    None too where a clock was set back: samples of two times stand between one another there.
    """
    signals = [[s for s in one.signals if s.quantity in names] for one in trials]
    every = [s for ones in signals for s in ones]
    if not all(signals) or any(s.source.clock.furthest_back * s.source.rate > 1.0 for s in every):
        return None
    return jump([_course(s) for s in every])


def _course(signal: Signal) -> Course:
    """Angles [rad]; of a drive, and of a rudder on a scale of its own, the share of its largest."""
    seen = signal.source.sketch
    if signal.quantity == "delta" and not is_counted(signal):
        if signal.unit in (None, OPEN):  # a share of full is as large as its radians
            of_full = 0.01 if signal.source.stated_unit == "%" else 1.0
            return seen.t / 1e9, seen.y * of_full
        return seen.t / 1e9, seen.y * units.factor(signal.unit, "rad")
    y = seen.y - at_rest(signal.source)
    return seen.t / 1e9, y / (np.abs(y).max(initial=0.0) or 1.0)


def _read_as(trials: Sequence[Chosen], names: frozenset[str], why: str) -> list[Chosen]:
    if not why:
        return list(trials)
    return [
        dataclasses.replace(
            one, signals=tuple(_order(s, why) if s.quantity in names else s for s in one.signals)
        )
        for one in trials
    ]


def _order(signal: Signal, why: str) -> Signal:
    told = (*signal.further, f"CAREFUL: {why}: read as its order")
    return dataclasses.replace(signal, quantity=f"{signal.quantity}_order", further=told)
