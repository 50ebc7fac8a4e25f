"""A rudder that is at its place at once: read as its order, whatever the log calls it."""

import dataclasses
from collections.abc import Sequence

from trialid.diagnosis.rudder_jumps import Course, Jump, jump_of
from trialid.names import units
from trialid.workflow.first_pipeline.choice import Chosen, Signal


def with_orders(trials: Sequence[Chosen], own_time: float) -> list[Chosen]:
    """The trials with the order in place of an angle, where the rudder of all together jumps.

    `own_time` is how long the ship takes for her own length [s].
    """
    rudders = [s for one in trials for s in one.signals if s.quantity == "delta"]
    found = jump_of((_course(one) for one in rudders), own_time)
    if found is None or len(rudders) < len(trials):
        return list(trials)
    return [
        dataclasses.replace(one, signals=tuple(_as_order(s, found) for s in one.signals))
        for one in trials
    ]


def _course(rudder: Signal) -> Course:
    seen = rudder.source.sketch
    return seen.t / 1e9, seen.y * units.factor(rudder.unit or "rad", "rad")


def _as_order(signal: Signal, jump: Jump) -> Signal:
    if signal.quantity != "delta":
        return signal
    why = f"{signal.why}; CAREFUL: it {jump}, which no gear does: read as its order"
    return dataclasses.replace(signal, quantity="delta_order", why=why)
