"""What one trial does not show of a channel, as another trial of the recorder shows it.

A heading in radians that never goes round may be in degrees; one that does, beside it, is not. A
turn with the rudder put over once does not tell which side it counts as positive; the zig-zags
beside it, whose channel has the same name, do; whatever a format says of the side it should be.
"""

import dataclasses
from collections import Counter
from collections.abc import Mapping, Sequence

from trialid.inspection.inspected import ChannelInspection, Inspection
from trialid.workflow.first_pipeline.choice import RUDDERS
from trialid.workflow.first_pipeline.chosen import OPEN, Chosen, Reason, Signal

Side = tuple[str, str]
"""Starboard or port, and the log that shows it."""


def with_units(surveys: Sequence[Inspection]) -> list[Inspection]:
    """The logs, angles in the unit that only the numbers of others of them leave.

    Where these disagree, each keeps what its own say.
    """
    found: dict[str, set[str]] = {}
    for one in (c for survey in surveys for c in survey.channels.values()):
        if one.unit_by_size is not None:
            found.setdefault(one.name, set()).add(one.unit_by_size)
    known = {name: units.pop() for name, units in found.items() if len(units) == 1}
    return [
        dataclasses.replace(
            survey, channels={key: _sized(c, known) for key, c in survey.channels.items()}
        )
        for survey in surveys
    ]


def _sized(one: ChannelInspection, known: Mapping[str, str]) -> ChannelInspection:
    if one.name not in known or one.unit is not None or one.unit_in_name is not None:
        return one
    return dataclasses.replace(one, unit_by_size=known[one.name])


def with_sides(trials: Sequence[Chosen]) -> list[Chosen]:
    """The trials, with sides that only others of them show; where these disagree it stays open.

    And so does the side of what steers where most others of the same name show another, unless the
    heading confirms her rate of turn: else one of the two was turned round, and nothing says which.
    """
    known, usual = _shown(trials), _usual(trials)
    return [
        dataclasses.replace(
            one, signals=tuple(_unlike(_told(s, known), one, usual) for s in one.signals)
        )
        for one in trials
    ]


def _usual(trials: Sequence[Chosen]) -> Mapping[str, Side]:
    """The side that most trials show of what steers, by its channel's name; the first log of it."""
    shown: dict[str, list[Side]] = {}
    for one in trials:
        for s in one.signals:
            if _steers(s.quantity) and s.of_side.rests_on("measured"):
                shown.setdefault(s.source.name, []).append((_side(s), one.path.name))
    most = {name: Counter(side for side, _ in them).most_common(1) for name, them in shown.items()}
    return {
        name: next(each for each in them if each[0] == most[name][0][0])
        for name, them in shown.items()
    }


def _steers(quantity: str) -> bool:
    """Whether it is a rudder's angle, or that of a drive that turns."""
    return quantity in RUDDERS or quantity.endswith("_angle")


def _side(signal: Signal) -> str:
    """Where it is positive; of a drive that turns, where nothing is written, clockwise."""
    return signal.positive or "clockwise"


def _unlike(signal: Signal, trial: Chosen, usual: Mapping[str, Side]) -> Signal:
    """What steers, where most others deny its side: told or left open."""
    side, log = usual.get(signal.source.name, ("", ""))
    if not (signal.of_side.rests_on("measured") and side) or _side(signal) == side:
        return signal
    said = f"by the motion {_side(signal)}, and of the same name {side} in {log}"
    rate = next((s for s in trial.signals if s.quantity in ("r", "psi")), None)
    if rate is not None and (rate.quantity == "psi" or rate.of_side.rests_on("measured")):
        return dataclasses.replace(signal, further=(*signal.further, f"CAREFUL: {said}"))
    or_r = rate.source.key if rate else "the rate of turn"
    ask = (
        f"FILL IN starboard or port: {said}: this or {or_r} counts the other way here, and "
        "positive of that one has to say so"
    )
    return dataclasses.replace(signal, positive=OPEN, of_side=Reason(ask, "asked"))


def with_unshown(trials: Sequence[Chosen]) -> list[Chosen]:
    """The trials, a sway or a heading that the turns of others show, and those of none deny."""
    against = {
        s.source.name for one in trials for s, _ in one.beside if s.of_side.rests_on("denied")
    }
    shown = {
        s.source.name: (s.positive, one.path.name)
        for one in trials
        for s in one.signals
        if s.quantity in ("v", "psi") and s.source.name not in against
    }
    return [_with_unshown(one, shown) for one in trials]


def _with_unshown(trial: Chosen, shown: Mapping[str, tuple[str | None, str]]) -> Chosen:
    signals, beside = [*trial.signals], list[tuple[Signal, str]]()
    for s, why in trial.beside:
        if not s.of_side.rests_on("unshown") or s.source.name not in shown:
            beside.append((s, why))
            continue
        positive, log = shown[s.source.name]
        signals.append(dataclasses.replace(s, positive=positive, of_side=as_in(log)))
    return dataclasses.replace(trial, signals=tuple(signals), beside=tuple(beside))


def _shown(trials: Sequence[Chosen]) -> Mapping[str, Side]:
    """Sides by the name of a channel."""
    found: dict[str, dict[str, str]] = {}
    for one in trials:
        for s in one.signals:
            if s.positive not in (None, OPEN) and s.of_side.rests_on("measured"):
                found.setdefault(s.source.name, {}).setdefault(str(s.positive), one.path.name)
    return {
        name: side for name, sides in found.items() if len(sides) == 1 for side in sides.items()
    }


def _told(signal: Signal, known: Mapping[str, Side]) -> Signal:
    unshown = signal.of_side.rests_on("asked", "convention")
    if not unshown or signal.source.name not in known:
        return signal
    side, log = known[signal.source.name]
    return dataclasses.replace(signal, positive=side, of_side=as_in(log))


def as_in(log: str) -> Reason:
    """Words for a side that another log shows."""
    return Reason(f"side as in {log}, of the same name; the motion here does not show it")
